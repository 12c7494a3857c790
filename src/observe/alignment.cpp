// Alignment of the directors u. With Q = 3 (u . e)^2 - 1, which is 2 for a needle along e and -1
// across it:
//
//   along_velocity  histogram of Q with e = v / |v|; needles at rest are left out
//   along_axes      histograms of Q with e along x, y and z
//   order_tensor    mean of (3 u u - 1) / 2, whose largest eigenvalue is the nematic order
//
// For random directors Q has the density 1 / (2 sqrt(3 (Q + 1))).
#include <algorithm>

#include "src/observe/histogram.h"
#include "src/observe/order_tensor.h"
#include "src/observe/registry.h"

namespace needlework::observe {
namespace {

class Alignment : public Observable {
 public:
  std::vector<SeriesField> fields() const override {
    using enum SeriesField::Kind;
    const std::size_t bins = along_velocity_.counts().size();
    return {
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
  }

 private:
  static void add(Histogram& histogram, double cosine_squared) {
    // Rounding can lead out of [0, 1]. A needle at rest has NaN, which stays that.
    histogram.add(3 * std::min(cosine_squared, 1.0) - 1);
  }

  Histogram along_velocity_{-1, 2, 60};
  std::array<Histogram, 3> along_axes_{Histogram{-1, 2, 60}, Histogram{-1, 2, 60},
                                       Histogram{-1, 2, 60}};
};

}  // namespace

ObservablePointer make_alignment(const GasSetting&) { return std::make_unique<Alignment>(); }

}  // namespace needlework::observe
