#include <algorithm>
#include <cmath>

#include "needlework/theory.h"
#include "src/composition/convex_body.h"

namespace needlework::theory {
namespace {

// Of a fluid of one species, from its pressure p V / (N T) = 1 + (second virial coefficient) n g.
double contact_value(const ConvexBody& body, double packing) {
  const double a = body.radius * body.surface / (3 * body.volume), room = 1 - packing;
  const double pressure =
      (1 + packing * ((3 * a - 2) + packing * ((a * a + a - 1) - packing * (a * (5 * a - 4))))) /
      (room * room * room);
  return (pressure - 1) / (packing * (1 + 3 * a));
}

// g (1 - packing) = 1 + x / 2 + x^2 / 18, with x = s h / (1 - packing): s is the surface of all per
// volume, and h of two spheres d d' / (d + d').
double value_of(double x, double room) { return (1 + x / 2 + x * x / 18) / room; }
double solved_for_x(double value, double room) {
  // Long rods would be in order where the pressure of a fluid without order falls below that of
  // points in the room that is left.
  const double above = std::max(0.0, value * room - 1);
  return 9 * (std::sqrt(0.25 + above * (2.0 / 9)) - 0.5);
}

}  // namespace

std::vector<double> contact_values(const Composition& composition, double volume) {
  std::vector<double> out(composition.pairs(), 1.0);
  ConvexBody fluid;
  for (const Species& each : composition.species()) {
    add(fluid, convex_body(each), static_cast<double>(each.count) / volume);
  }
  // Beyond, no fluid is known; the values must stay finite.
  const double packing = std::min(fluid.volume, 0.75), room = 1 - packing;
  if (!(packing > 0)) return out;
  std::vector<double> diameter;
  for (const Species& each : composition.species()) {
    const ConvexBody body = convex_body(each);
    if (body.volume == 0) {
      diameter.push_back(0);
      continue;
    }
    const double x = solved_for_x(contact_value(body, packing), room);
    diameter.push_back(2 * x * room * body.volume / (packing * body.surface));
  }
  for (std::size_t a = 0; a < composition.size(); ++a) {
    for (std::size_t b = a; b < composition.size(); ++b) {
      const double both = diameter[a] + diameter[b];
      const double h = both > 0 ? diameter[a] * diameter[b] / both : 0;
      out[composition.pair_index(a, b)] = value_of(fluid.surface * h / room, room);
    }
  }
  return out;
}

}  // namespace needlework::theory
