#include "src/scene/growth_plan.h"

#include <cmath>

#include "src/scene/confinement.h"
#include "src/scene/rod_room.h"

namespace needlework {

GrowthPlan growth_plan(const Scene& scene, const Composition& species,
                       const std::array<double, 3>& box) {
  const Scene::Growth& growth = *scene.driving.growth;
  GrowthPlan out{.start = growth.from};
  if (growth.from < 1) return out;
  const double packing = species.packing_fraction(box[0] * box[1] * box[2]);
  out.largest = std::cbrt(growth.until_packing.value_or(densest_packing(species)) / packing);
  const Room room(scene);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double by_edge = box[axis] / room.least(axis);
    if (by_edge >= out.largest) continue;
    out.largest = by_edge;
    out.end = Stop::no_room;
  }
  return out;
}

Composition enlarged(const Composition& species, double factor) {
  Composition out = species;
  const double square = factor * factor, cube = square * factor;
  const auto times = [](Spread spread, double by) {
    return Spread{spread.mean * by, spread.width, spread.least * by, spread.greatest * by};
  };
  for (std::size_t n = 0; n < species.size(); ++n) {
    Species each = species[n];
    each.length *= factor;
    each.diameter *= factor;
    each.k *= square;
    each.q /= square;
    each.given_inertia.reset();
    if (each.sizes) {
      Sizes& sizes = *each.sizes;
      sizes.product *= square;
      sizes.square *= square;
      sizes.cube *= cube;
      sizes.volume *= cube;
      sizes.least_extent *= factor;
      sizes.greatest_extent *= factor;
      sizes.length = times(sizes.length, factor);
      sizes.diameter = times(sizes.diameter, factor);
      sizes.k = times(sizes.k, square);
    }
    out.set_species(n, each);
  }
  return out;
}

}  // namespace needlework
