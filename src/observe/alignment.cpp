// Alignment of the directors u. With Q = 3 (u . e)^2 - 1, which is 2 for a needle along e and -1
// across it:
//
//   along_velocity  histogram of Q with e = v / |v|; needles at rest are left out
//   along_axes      histograms of Q with e along x, y and z
//   order_tensor    mean of (3 u u - 1) / 2, whose largest eigenvalue is the nematic order
//
// and in a flow along x that grows with y
//
//   flow_angle      of the director of the tensor from x in the plane of x and y,
//                   atan2(2 Q_xy, Q_xx - Q_yy) / 2
//   spin_over_rate  mean angular velocity about z over the rate of shear
//
// For random directors Q has the density 1 / (2 sqrt(3 (Q + 1))).
#include <algorithm>
#include <cmath>
#include <limits>

#include "src/observe/histogram.h"
#include "src/observe/order_tensor.h"
#include "src/observe/registry.h"

namespace needlework::observe {
namespace {

class Alignment : public Observable {
 public:
  explicit Alignment(const GasSetting& gas)
      : is_sheared_(gas.is_sheared), shear_rate_(gas.shear_rate) {}

  std::vector<SeriesField> fields() const override {
    using enum SeriesField::Kind;
    const std::size_t bins = along_velocity_.counts().size();
    std::vector<SeriesField> out{
        {"along_velocity",
         "Number of needles by Q = 3 cos^2 - 1 of the angle between orientation and velocity",
         unit::none,
         {{"Q bins", bins}},
         count},
        {"along_axes",
         "Number of needles by Q = 3 cos^2 - 1 of the angle between orientation and each axis",
         unit::none,
         {{"3", 3}, {"Q bins", bins}},
         count},
        {"order_tensor",
         "Mean of (3 u u - 1) / 2 over the orientations u",
         unit::none,
         {{"3", 3}, {"3", 3}}},
        {"borders",
         "Borders of the bins of Q",
         unit::none,
         {{"Q bins + 1", bins + 1}},
         constant,
         along_velocity_.borders()},
    };
    if (is_sheared_) {
      out.push_back({"flow_angle",
                     "In a flow, angle of the director of this tensor from it in the plane of x "
                     "and y, atan2(2 Q_xy, Q_xx - Q_yy) / 2",
                     unit::angle});
      out.push_back({"spin_over_rate",
                     "In a flow, mean angular velocity about z over the rate of shear",
                     unit::none});
    }
    return out;
  }

  void sample(const Snapshot& now, Row& row) override {
    along_velocity_.clear();
    for (Histogram& histogram : along_axes_) histogram.clear();
    OrderTensor order;
    for (std::size_t i = 0; i < now.state.size(); ++i) {
      const Vector& u = now.state.orientation[i];
      const Vector& v = now.state.velocity[i];
      const double along = dot(u, v);
      add(along_velocity_, along * along / dot(v, v));
      for (std::size_t a = 0; a < 3; ++a) add(along_axes_[a], u[a] * u[a]);
      order.add(u);
    }
    row.put_all(along_velocity_.counts());
    for (const Histogram& histogram : along_axes_) row.put_all(histogram.counts());
    order.put(row);
    if (!is_sheared_) return;
    row.put(std::atan2(2 * order.at(0, 1), order.at(0, 0) - order.at(1, 1)) / 2);
    double spin = 0;
    for (const Vector& w : now.state.angular_velocity) spin += w[2];
    const double over = shear_rate_ * static_cast<double>(now.state.size());
    row.put(over != 0 ? spin / over : std::numeric_limits<double>::quiet_NaN());
  }

 private:
  static void add(Histogram& histogram, double cosine_squared) {
    // Rounding can lead out of [0, 1]. A needle at rest has NaN, which stays that.
    histogram.add(3 * std::min(cosine_squared, 1.0) - 1);
  }

  bool is_sheared_;
  double shear_rate_;
  Histogram along_velocity_{-1, 2, 60};
  std::array<Histogram, 3> along_axes_{Histogram{-1, 2, 60}, Histogram{-1, 2, 60},
                                       Histogram{-1, 2, 60}};
};

}  // namespace

ObservablePointer make_alignment(const GasSetting& gas) { return std::make_unique<Alignment>(gas); }

}  // namespace needlework::observe
