// Order of the flow, by cells of the grid with density rho, flow U, thermal energy T (`thermal_tr`
// of `fields`), spin W and rotational thermal energy R (`thermal_rot`):
//
//   translational   S = sum of (m/2) rho U^2, divided by the sum of rho T
//   rotational      sum of (I/2) rho W^2, divided by the sum of rho R
//   second_moment   <(rho - <rho>)^2> / <rho>^2, means over cells
//
// Independent random velocities give S = C / (N - C) for N needles in C cells that all hold some,
// 1/19 at 20 per cell, and independent positions a second moment of (C - 1) / N on average. S is
// infinite where all needles of a cell move alike, and NaN where none moves.
#include <numeric>

#include "src/observe/registry.h"

namespace needlework::observe {
namespace {

class FlowOrder : public Observable {
 public:
  explicit FlowOrder(const GasSetting& gas) : gas_(gas) {}

  std::vector<SeriesField> fields() const override {
    return {
        {"translational",
         "Energy of the flow of the cells, divided by that of translation relative to it",
         unit::none},
        {"rotational",
         "Energy of the mean rotation of the cells, divided by that of rotation relative to it",
         unit::none},
        {"second_moment", "Variance of the density over the cells, divided by its squared mean",
         unit::none},
    };
  }

  void sample(const Snapshot& now, Row& row) override {
    const CellMeans& cells = now.cells();
    const double mean = std::accumulate(cells.count.begin(), cells.count.end(), 0.0) /
                        static_cast<double>(cells.count.size());
    double flow = 0, thermal = 0, spin = 0, thermal_rot = 0, variance = 0;
    for (std::size_t cell = 0; cell < cells.count.size(); ++cell) {
      // The cells' volume and the factors m/2 and I/2 of the species cancel.
      const double count = cells.count[cell];
      flow += cells.mass[cell] * dot(cells.flow[cell], cells.flow[cell]);
      thermal += count * cells.flow_v2[cell];
      spin += cells.inertia[cell] * dot(cells.spin[cell], cells.spin[cell]);
      thermal_rot += count * cells.spin_w2[cell];
      variance += (count - mean) * (count - mean);
    }
    row.put(flow / thermal);
    row.put(spin / thermal_rot);
    row.put(variance / static_cast<double>(cells.count.size()) / (mean * mean));
  }

 private:
  GasSetting gas_;
};

}  // namespace

ObservablePointer make_flow_order(const GasSetting& gas) {
  return std::make_unique<FlowOrder>(gas);
}

}  // namespace needlework::observe
