#include "src/scene/rod_room.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <vector>

#include "src/composition/convex_body.h"

namespace needlework {
namespace {

constexpr double pi = std::numbers::pi;

// Of parallel rods of one shape.
double densest_packing(const Species& species) {
  const double width = species.diameter;
  if (width == 0) return 0;
  const double layer = species.length + std::sqrt(2.0 / 3) * width;
  return species.volume() / (0.5 * std::sqrt(3.0) * width * width * layer);
}

// How many tries a body needs among so many others per volume, whose measures these are.
double tries_among(const ConvexBody& body, const ConvexBody& fluid, double number) {
  const double free = 1 - fluid.volume;
  if (!(free > 0)) return std::numeric_limits<double>::infinity();
  const double r = fluid.radius / free, s = fluid.surface / free;
  const double pressure = number / free + r * s + s * s * s / (12 * pi);
  return std::exp(body.radius * s + body.surface * r + body.surface * s * s / (8 * pi) +
                  pressure * body.volume) /
         free;
}

}  // namespace

double densest_packing(const Composition& composition) {
  std::vector<const Species*> shapes;
  double left = 1;
  for (const Species& each : composition.species()) {
    if (each.count == 0 && composition.size() > 1) continue;
    const bool known = std::ranges::any_of(shapes, [&](const Species* other) {
      return other->length * each.diameter == each.length * other->diameter &&
             other->diameter == each.diameter;
    });
    if (known) continue;
    shapes.push_back(&each);
    left *= 1 - densest_packing(each);
  }
  return 1 - left;
}

double estimated_tries(const Composition& composition, double volume) {
  std::vector<Species> species = composition.species();
  std::ranges::stable_sort(species, std::ranges::greater(),
                           [](const Species& s) { return excluded_volume(s, s); });
  constexpr int parts = 16;
  ConvexBody fluid;
  double number = 0, tries = 0, count = 0;
  for (const Species& each : species) {
    const ConvexBody body = convex_body(each);
    const double part = static_cast<double>(each.count) / parts;
    for (int n = 0; n < parts && part > 0; ++n) {
      add(fluid, body, 0.5 * part / volume);
      number += 0.5 * part / volume;
      tries += part * tries_among(body, fluid, number);
      add(fluid, body, 0.5 * part / volume);
      number += 0.5 * part / volume;
    }
    count += static_cast<double>(each.count);
  }
  return count > 0 ? tries / count : 0;
}

}  // namespace needlework
