#include <algorithm>
#include <cmath>
#include <numbers>

#include "needlework/theory.h"
#include "src/theory/sphere_fluid.h"

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

// Beyond, no fluid is known; the values must stay finite.
double packing_of(const ConvexBody& fluid) { return std::min(fluid.volume, 0.75); }

// g (1 - packing) = 1 + x / 2 + x^2 / 18, with x = s h / (1 - packing): s is the surface of all per
// volume, and h of two spheres d d' / (d + d').
double solved_for_x(double value, double room) {
  // Long rods would be in order where the pressure of a fluid without order falls below that of
  // points in the room that is left.
  const double above = std::max(0.0, value * room - 1);
  return 9 * (std::sqrt(0.25 + above * (2.0 / 9)) - 0.5);
}

// Means of the diameters of spheres, and of their squares.
struct Diameters {
  double mean = 0, square = 0;
};

// Those of spheres, or of spheres that are in contact as often as the rods of a species.
Diameters diameters_of(const Species& species, double packing) {
  if (!species.has_axis()) return {species.diameter, species.square()};
  const ConvexBody body = convex_body(species);
  if (body.volume == 0) return {};
  const double room = 1 - packing, x = solved_for_x(contact_value(body, packing), room);
  const double diameter = 2 * x * room * body.volume / (packing * body.surface);
  return {diameter, diameter * diameter};
}

}  // namespace

ConvexBody fluid_of(const Composition& composition, double volume) {
  ConvexBody out;
  for (const Species& each : composition.species()) {
    if (each.fixed && each.overlap) continue;
    add(out, convex_body(each), static_cast<double>(each.count) / volume);
  }
  return out;
}

SphereFluid sphere_fluid(const ConvexBody& fluid) {
  const double room = 1 - packing_of(fluid), share = fluid.surface / room;
  return {1 / room, share / 2 / room, share * share / 18 / room};
}

std::vector<double> contact_values(const Composition& composition, double volume) {
  std::vector<double> out(composition.pairs(), 1.0);
  const ConvexBody all = fluid_of(composition, volume);
  const double packing = packing_of(all);
  if (!(packing > 0)) return out;
  const SphereFluid fluid = sphere_fluid(all);
  std::vector<Diameters> diameters;
  for (const Species& each : composition.species())
    diameters.push_back(diameters_of(each, packing));
  for (std::size_t first = 0; first < composition.size(); ++first) {
    for (std::size_t second = first; second < composition.size(); ++second) {
      const Diameters &a = diameters[first], &b = diameters[second];
      // Each two bodies count by (D + D')^2, as they meet.
      const double both = a.square + 2 * a.mean * b.mean + b.square;
      const double linear = a.square * b.mean + a.mean * b.square, square = a.square * b.square;
      out[composition.pair_index(first, second)] =
          fluid.constant + (both > 0 ? (fluid.linear * linear + fluid.square * square) / both : 0);
    }
  }
  return out;
}

double sphere_compressibility(const Composition& composition, double volume) {
  double count = 0, mean = 0, square = 0, cube = 0;
  for (const Species& each : composition.species()) {
    const auto its = static_cast<double>(each.count);
    count += its;
    mean += its * each.diameter;
    square += its * each.square();
    cube += its * each.cube();
  }
  if (!(cube > 0)) return 1;
  const double packing = packing_of(
                   {.radius = 0, .surface = 0, .volume = std::numbers::pi / 6 * cube / volume}),
               room = 1 - packing;
  const double first = mean / cube * square / count;
  const double second = square / cube * (square / cube) * (square / count);
  return (1 + 3 * packing * first / room +
          packing * packing * (3 - packing) * second / (room * room)) /
         room;
}

}  // namespace needlework::theory
