// The centre of mass along the axes with walls: sum of m r / sum of m, r from where the low edge of
// the box is at the start, and its velocity, of the needles that move; in mixtures of each species,
// too. Along periodic axes there is none.
#include "src/observe/registry.h"

namespace needlework::observe {
namespace {

class CentreOfMass : public Observable {
 public:
  explicit CentreOfMass(const GasSetting& gas) : gas_(gas) {}

  std::vector<SeriesField> fields() const override {
    const std::vector<SeriesField::Extent> each{{"walled axes", gas_.wall_slabs.size()}};
    std::vector<double> axes;
    for (const Slabs& slabs : gas_.wall_slabs) axes.push_back(static_cast<double>(slabs.axis));
    std::vector<SeriesField> out{
        {"position",
         "Centre of mass of all needles along each axis with walls, from where the low edge of the "
         "box is at the start",
         unit::length, each},
        {"velocity", "Its velocity along each axis with walls", unit::speed, each},
        {"axis", "Number of each axis with walls: 0 x, 1 y, 2 z", unit::none, each,
         SeriesField::Kind::constant, axes},
    };
    if (gas_.composition.is_mixture()) {
      const std::vector<SeriesField::Extent> by_species{{"species", gas_.composition.size()},
                                                        each.front()};
      out.push_back({"species_position", "Centre of mass of each species in the same way",
                     unit::length, by_species});
      out.push_back({"species_velocity", "Velocity of each species' centre of mass", unit::speed,
                     by_species});
    }
    return out;
  }

  void sample(const Snapshot& now, Row& row) override {
    const State& state = now.state;
    const std::size_t kinds = gas_.composition.size(), axes = gas_.wall_slabs.size();
    // Of each species, then of all; without needles NaN.
    std::vector<double> mass(kinds + 1), position((kinds + 1) * axes), velocity((kinds + 1) * axes);
    const Weights& weights = now.weights();
    for (std::size_t i = 0; i < state.size(); ++i) {
      const std::size_t species = state.species.empty() ? 0 : state.species[i];
      const double m = gas_.composition[species].mass * weights.mass(i);
      for (const std::size_t of : {species, kinds}) {
        if (of == kinds && gas_.composition[species].fixed) continue;
        mass[of] += m;
        for (std::size_t n = 0; n < axes; ++n) {
          const std::size_t axis = gas_.wall_slabs[n].axis;
          position[of * axes + n] += m * state.position[i][axis];
          velocity[of * axes + n] += m * state.velocity[i][axis];
        }
      }
    }
    const auto put = [&](const std::vector<double>& moment, std::size_t of) {
      for (std::size_t n = 0; n < axes; ++n) row.put(moment[of * axes + n] / mass[of]);
    };
    put(position, kinds);
    put(velocity, kinds);
    if (!gas_.composition.is_mixture()) return;
    for (std::size_t of = 0; of < kinds; ++of) put(position, of);
    for (std::size_t of = 0; of < kinds; ++of) put(velocity, of);
  }

 private:
  GasSetting gas_;
};

}  // namespace

ObservablePointer make_centre_of_mass(const GasSetting& gas) {
  return std::make_unique<CentreOfMass>(gas);
}

}  // namespace needlework::observe
