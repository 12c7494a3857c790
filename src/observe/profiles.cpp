// Profiles: the quantities of `fields` in slabs that cut the box across one axis, for each of the
// three axes. All axes have as many slabs as the grid has cells along the axis where it has most.
// Where walls with a velocity move edges, slabs fill the box of the instant.
#include <algorithm>

#include "src/observe/registry.h"

namespace needlework::observe {
namespace {

class Profiles : public Observable {
 public:
  explicit Profiles(const GasSetting& gas)
      : gas_(gas), slabs_(*std::max_element(gas.cells.begin(), gas.cells.end())) {}

  std::vector<SeriesField> fields() const override {
    const std::vector<SeriesField::Extent> scalar{{"3", 3},
                                                  {"slabs", static_cast<std::size_t>(slabs_)}};
    auto vector = scalar;
    vector.push_back({"3", 3});
    return {
        {"density", "Number of needles in each slab across each axis, divided by its volume",
         unit::density, scalar},
        {"flow", "Mean velocity in each slab across each axis", unit::speed, vector},
        {"spin", "Mean angular velocity in each slab across each axis", unit::angular_speed,
         vector},
        {"thermal_tr", "Mean energy of translation relative to the flow of each slab", unit::energy,
         scalar},
        {"thermal_rot", "Mean energy of rotation relative to the spin of each slab", unit::energy,
         scalar},
        position(scalar),
    };
  }

  void sample(const Snapshot& now, Row& row) override {
    std::vector<CellMeans> axes;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      std::array<int, 3> cells{1, 1, 1};
      cells[axis] = slabs_;
      const Grid slabs(now.edges(), cells, now.low());
      axes.push_back(means_in_cells(slabs, now.state, now.weights()));
    }
    const double volume = now.volume() / slabs_;
    for (const auto& axis : axes)
      for (const double count : axis.count) row.put(count / volume);
    for (const auto& axis : axes)
      for (const Vector& flow : axis.flow) row.put_all(flow);
    for (const auto& axis : axes)
      for (const Vector& spin : axis.spin) row.put_all(spin);
    for (const auto& axis : axes)
      for (const double v2 : axis.flow_v2) row.put(gas_.mass * v2 / 2);
    for (const auto& axis : axes)
      for (const double w2 : axis.spin_w2) row.put(gas_.t_rot(w2));
    if (gas_.moving_edges) row.put_all(middles(now.edges(), now.low()));
  }

 private:
  SeriesField position(const std::vector<SeriesField::Extent>& shape) const {
    SeriesField out{"position", "Middle of each slab along its axis", unit::length, shape};
    if (gas_.moving_edges) return out;
    out.kind = SeriesField::Kind::constant;
    out.values = middles(gas_.box.edges(), {});
    return out;
  }

  std::vector<double> middles(const Vector& edges, const Vector& low) const {
    std::vector<double> out;
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (int n = 0; n < slabs_; ++n) out.push_back(low[axis] + edges[axis] * (n + 0.5) / slabs_);
    return out;
  }

  GasSetting gas_;
  int slabs_;
};

}  // namespace

ObservablePointer make_profiles(const GasSetting& gas) { return std::make_unique<Profiles>(gas); }

}  // namespace needlework::observe
