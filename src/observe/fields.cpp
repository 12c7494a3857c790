// Fields on the grid of output.grid, which fills the box of the instant. In a cell of volume V_c
// with n needles:
//
//   density      n / V_c
//   flow         U = mean of v, by mass
//   spin         mean of the angular velocity w, by moment of inertia
//   thermal_tr   mean of m |v - U|^2 / 2, which is the mean of m v^2 / 2 less m U^2 / 2
//   thermal_rot  mean of I |w - spin|^2 / 2
//
// A cell without needles has zeros.
#include "src/observe/registry.h"

namespace needlework::observe {
namespace {

class Fields : public Observable {
 public:
  explicit Fields(const GasSetting& gas) : gas_(gas) {}

  std::vector<SeriesField> fields() const override {
    const auto extent = [&](const char* name, std::size_t axis) {
      return SeriesField::Extent{name, static_cast<std::size_t>(gas_.cells[axis])};
    };
    const std::vector<SeriesField::Extent> scalar{extent("cells x", 0), extent("cells y", 1),
                                                  extent("cells z", 2)};
    auto vector = scalar;
    vector.push_back({"3", 3});
    return {
        {"density", "Number of needles in each cell, divided by its volume", unit::density, scalar},
        {"flow", "Mean velocity in each cell", unit::speed, vector},
        {"spin", "Mean angular velocity in each cell", unit::angular_speed, vector},
        {"thermal_tr", "Mean energy of translation relative to the flow of each cell", unit::energy,
         scalar},
        {"thermal_rot", "Mean energy of rotation relative to the spin of each cell", unit::energy,
         scalar},
    };
  }

  void sample(const Snapshot& now, Row& row) override {
    const CellMeans& cells = now.cells();
    const double volume = now.grid().cell_volume();
    for (const double count : cells.count) row.put(count / volume);
    for (const Vector& flow : cells.flow) row.put_all(flow);
    for (const Vector& spin : cells.spin) row.put_all(spin);
    for (const double v2 : cells.flow_v2) row.put(gas_.mass * v2 / 2);
    for (const double w2 : cells.spin_w2) row.put(gas_.t_rot(w2));
  }

 private:
  GasSetting gas_;
};

}  // namespace

ObservablePointer make_fields(const GasSetting& gas) { return std::make_unique<Fields>(gas); }

}  // namespace needlework::observe
