// The centre of mass along the axes with walls: sum of m r / sum of m, r from the low edge of the
// box, and its velocity. Along periodic axes there is none.
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
    return {
        {"position",
         "Centre of mass of all needles along each axis with walls, from the low edge of the box",
         unit::length, each},
        {"velocity", "Its velocity along each axis with walls", unit::speed, each},
        {"axis", "Number of each axis with walls: 0 x, 1 y, 2 z", unit::none, each,
         SeriesField::Kind::constant, axes},
    };
  }

  void sample(const Snapshot& now, Row& row) override {
    const State& state = now.state;
    std::vector<double> position, velocity;
    for (const Slabs& slabs : gas_.wall_slabs) {
      double mass = 0, moment = 0, momentum = 0;
      for (std::size_t i = 0; i < state.size(); ++i) {
        const std::size_t species = state.species.empty() ? 0 : state.species[i];
        const double m = gas_.composition[species].mass;
        mass += m;
        moment += m * state.position[i][slabs.axis];
        momentum += m * state.velocity[i][slabs.axis];
      }
      position.push_back(moment / mass);  // NaN without needles
      velocity.push_back(momentum / mass);
    }
    row.put_all(position);
    row.put_all(velocity);
  }

 private:
  GasSetting gas_;
};

}  // namespace

ObservablePointer make_centre_of_mass(const GasSetting& gas) {
  return std::make_unique<CentreOfMass>(gas);
}

}  // namespace needlework::observe
