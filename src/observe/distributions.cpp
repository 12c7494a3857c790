// Histograms, as counts:
//
//   needles_in_cell  number of cells of the grid with n needles, n = 0, 1, ... up to ten times the
//                    mean; a Poisson law for independent positions
//   velocity         components of v along x, y and z, in units of sqrt(T_tr / m), m its own mass
//   energy_tr        m v^2 / 2 of each needle, in units of T_tr; for Gaussian velocities its
//                    density is 2 sqrt(e / pi) exp(-e)
//   energy_rot       I w^2 / 2 of each needle, in units of T_rot; for Gaussian ones exp(-e), of
//                    rough spheres as energy_tr
//
// T_tr and T_rot are those of the whole gas, or species, at this time. Values outside the borders
// are left out, and so are all values where the unit is 0.
#include <algorithm>
#include <cmath>

#include "src/observe/histogram.h"
#include "src/observe/registry.h"

namespace needlework::observe {
namespace {

class Distributions : public Observable {
 public:
  explicit Distributions(const GasSetting& gas)
      : gas_(gas),
        occupations_(static_cast<std::size_t>(
            std::ceil(10 * std::max(2.0, static_cast<double>(gas.all) /
                                             static_cast<double>(cells_in(gas)))) +
            1)) {}

  static std::size_t cells_in(const GasSetting& gas) {
    return Grid(gas.box.edges(), gas.cells).size();
  }

  std::vector<SeriesField> fields() const override {
    using enum SeriesField::Kind;
    const SeriesField::Extent energies{"energy bins", energy_tr_.counts().size()};
    const SeriesField::Extent borders{"energy bins + 1", energies.size + 1};
    const SeriesField::Extent velocities{"velocity bins", velocity_[0].counts().size()};
    return {
        {"needles_in_cell",
         "Number of cells with no, one, two ... needles",
         unit::none,
         {{"occupations", occupations_}},
         count},
        {"velocity",
         "Number of needles by the x, y and z component of the velocity in units of "
         "sqrt(T_tr / m)",
         unit::none,
         {{"3", 3}, velocities},
         count},
        {"energy_tr",
         "Number of needles by energy of translation in units of T_tr",
         unit::none,
         {energies},
         count},
        {"energy_rot",
         "Number of needles by energy of rotation in units of T_rot",
         unit::none,
         {energies},
         count},
        {"velocity_borders",
         "Borders of the bins of velocity, in units of sqrt(T_tr / m)",
         unit::none,
         {{"velocity bins + 1", velocities.size + 1}},
         constant,
         velocity_[0].borders()},
        {"energy_borders",
         "Borders of the bins of energy, in units of T_tr or T_rot",
         unit::none,
         {borders},
         constant,
         energy_tr_.borders()},
    };
  }

  void sample(const Snapshot& now, Row& row) override {
    count_cells(now, row);
    const double speed = std::sqrt(now.totals.t_tr / gas_.mass);
    for (Histogram& histogram : velocity_) histogram.clear();
    energy_tr_.clear();
    energy_rot_.clear();
    // Divisions by 0 give NaN or infinity, which the histograms leave out.
    const Weights& weights = now.weights();
    for (std::size_t i = 0; i < now.state.size(); ++i) {
      const Vector& v = now.state.velocity[i];
      const Vector& w = now.state.angular_velocity[i];
      const double mass = weights.mass(i), root = std::sqrt(mass);
      for (std::size_t axis = 0; axis < 3; ++axis) velocity_[axis].add(root * v[axis] / speed);
      energy_tr_.add(gas_.mass * mass * dot(v, v) / 2 / now.totals.t_tr);
      energy_rot_.add(gas_.inertia * weights.inertia(i) * dot(w, w) / 2 / now.totals.t_rot);
    }
    for (const Histogram& histogram : velocity_) row.put_all(histogram.counts());
    row.put_all(energy_tr_.counts());
    row.put_all(energy_rot_.counts());
  }

 private:
  void count_cells(const Snapshot& now, Row& row) const {
    std::vector<double> cells(occupations_);
    for (const double count : now.cells().count) {
      const auto needles = static_cast<std::size_t>(count);
      if (needles < cells.size()) ++cells[needles];
    }
    row.put_all(cells);
  }

  GasSetting gas_;
  std::size_t occupations_;
  std::array<Histogram, 3> velocity_{Histogram{-6, 6, 120}, Histogram{-6, 6, 120},
                                     Histogram{-6, 6, 120}};
  Histogram energy_tr_{0, 15, 150}, energy_rot_{0, 15, 150};
};

}  // namespace

ObservablePointer make_distributions(const GasSetting& gas) {
  return std::make_unique<Distributions>(gas);
}

}  // namespace needlework::observe
