#include "src/scene/rod_room.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <numeric>
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

// Of a fluid of so many bodies per volume, over its temperature.
double pressure_of(const ConvexBody& fluid, double number) {
  const double free = 1 - fluid.volume;
  const double r = fluid.radius / free, s = fluid.surface / free;
  return number / free + r * s + s * s * s / (12 * pi);
}

// How many tries a body needs among so many others per volume, whose measures these are, and which
// exclude each other.
double tries_among(const ConvexBody& body, const ConvexBody& fluid, double number) {
  const double free = 1 - fluid.volume;
  if (!(free > 0)) return std::numeric_limits<double>::infinity();
  const double r = fluid.radius / free, s = fluid.surface / free;
  const double pressure = pressure_of(fluid, number);
  return std::exp(body.radius * s + body.surface * r + body.surface * s * s / (8 * pi) +
                  pressure * body.volume) /
         free;
}

// The same among bodies that lie anywhere, so that the places that they leave are fewer by a factor
// for each of them.
double tries_among_strewn(const ConvexBody& body, const ConvexBody& strewn, double number) {
  return std::exp(strewn.volume + body.radius * strewn.surface + body.surface * strewn.radius +
                  number * body.volume);
}

// What is in the way of a body.
struct Others {
  ConvexBody fluid;  ///< of those that exclude each other
  double number = 0;
  ConvexBody strewn;  ///< of those that may overlap each other
  double strewn_number = 0;

  void add(const Species& each, double density) {
    const bool overlap = each.fixed && each.overlap;
    needlework::add(overlap ? strewn : fluid, convex_body(each), density);
    (overlap ? strewn_number : number) += density;
  }
  double tries(const ConvexBody& body) const {
    return tries_among(body, fluid, number) * tries_among_strewn(body, strewn, strewn_number);
  }
};

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

double estimated_pressure(const Composition& composition, double volume) {
  ConvexBody fluid;
  const double number = static_cast<double>(composition.count()) / volume;
  for (const Species& each : composition.species())
    add(fluid, convex_body(each), static_cast<double>(each.count) / volume);
  if (!(fluid.volume < 1)) return std::numeric_limits<double>::infinity();
  return pressure_of(fluid, number) / number;
}

double estimated_tries(const Composition& composition, double volume) {
  std::vector<std::size_t> order(composition.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::ranges::greater(), [&](std::size_t n) {
    return excluded_volume(composition[n], composition[n]);
  });
  constexpr int parts = 16;
  std::vector<Others> in_the_way(composition.size());  // of each species
  double tries = 0, count = 0;
  for (const std::size_t n : order) {
    const Species& each = composition[n];
    const ConvexBody body = convex_body(each);
    const double part = static_cast<double>(each.count) / parts;
    const auto add_half = [&] {
      for (std::size_t other = 0; other < composition.size(); ++other) {
        if (composition.may_overlap(n, other)) continue;
        in_the_way[other].add(each, 0.5 * part / volume);
      }
    };
    for (int i = 0; i < parts && part > 0; ++i) {
      add_half();
      tries += part * in_the_way[n].tries(body);
      add_half();
    }
    count += static_cast<double>(each.count);
  }
  return count > 0 ? tries / count : 0;
}

}  // namespace needlework
