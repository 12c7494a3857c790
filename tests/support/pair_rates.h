// How often two bodies meet, by quadrature over their points of contact: what the sums over all
// pairs of the theory are compared with.
#pragma once

#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <numbers>

#include "needlework/body_rates.h"

namespace needlework::test {

/// Collisions per unit of time in a unit of volume, of bodies that are anywhere and have any
/// directors.
inline double rate_of_pair(const theory::Body& a, const theory::Body& b) {
  const double flight = a.now.t_tr / a.mass + b.now.t_tr / b.mass;
  const auto turn = [](const theory::Body& body) {
    return body.length > 0 ? body.now.t_rot * body.length * body.length / body.inertia : 0;
  };
  const double turn_a = turn(a), turn_b = turn(b);
  const auto axis = [](double x) { return 0.25 * x * x; };
  const auto cap = [](double x) { return 0.25 * (1 - x * x); };
  const auto mean = [](const auto& f) {
    return boost::math::quadrature::gauss<double, 20>::integrate(f, 0.0, 1.0);
  };
  const auto speed = [&](const auto& place_a, const auto& place_b) {
    return mean([&](double x) {
      return mean(
          [&](double y) { return std::sqrt(flight + turn_a * place_a(x) + turn_b * place_b(y)); });
    });
  };
  const double faces = std::sqrt(std::numbers::pi / 8) * a.length * b.length * speed(axis, axis);
  const double d = 0.5 * (a.diameter + b.diameter);
  if (d == 0) return faces;
  return faces +
         std::sqrt(2 * std::numbers::pi) * d *
             (b.length * speed(cap, axis) + a.length * speed(axis, cap) + 2 * d * speed(cap, cap));
}

}  // namespace needlework::test
