#include "src/physics/mean_free_time.h"

#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <limits>

namespace needlework {
namespace {

// The mean of f(x, y) over the square [0, 1/2]^2, by a product quadrature.
template <class Function>
double mean_on_square(const Function& f) {
  using Rule = boost::math::quadrature::gauss<double, 10>;
  double nodes[10], weights[10];
  for (std::size_t i = 0; i < 5; ++i) {
    nodes[2 * i] = 0.25 * (1 - Rule::abscissa()[i]);
    nodes[2 * i + 1] = 0.25 * (1 + Rule::abscissa()[i]);
    weights[2 * i] = weights[2 * i + 1] = 0.5 * Rule::weights()[i];
  }
  double sum = 0;
  for (int i = 0; i < 10; ++i) {
    for (int j = 0; j < 10; ++j) sum += weights[i] * weights[j] * f(nodes[i], nodes[j]);
  }
  return sum;
}

double inverse_rate(double rate) {
  return rate > 0 ? 1 / rate : std::numeric_limits<double>::infinity();
}

}  // namespace

double mean_free_time(const ThermalGas& gas) {
  constexpr double half_root_pi = 0.886226925452758;
  const double sum = mean_on_square([&](double x, double y) {
    const double r2 = x * x + y * y;
    return std::sqrt((gas.t_tr + gas.t_rot * gas.k * r2) / gas.mass);
  });
  return inverse_rate(gas.density * (gas.length * gas.length) * half_root_pi * sum);
}

double mean_free_time(const Composition& composition, double volume,
                      std::span<const SpeciesTemperatures> temperatures) {
  constexpr double root_pi_eighths = 0.6266570686577501;
  // Thin needles count as partners of themselves, so that equal ones are as often hit as those of
  // the function above.
  const double self = composition.has_width() ? 1 : 0;
  double sum = 0, count = 0;
  for (std::size_t a = 0; a < composition.size(); ++a) {
    const Species& first = composition[a];
    if (first.fixed) continue;
    const double count_a = static_cast<double>(first.count);
    count += count_a;
    for (std::size_t b = 0; b < composition.size(); ++b) {
      const Species& second = composition[b];
      const double count_b = static_cast<double>(second.count) - (a == b ? self : 0);
      if (!(count_a > 0 && count_b > 0 && composition.meets(a, b))) continue;
      const SpeciesTemperatures &t_a = temperatures[a], &t_b = temperatures[b];
      const double flight = t_a.t_tr / first.mass + t_b.t_tr / second.mass;
      // Of the tips, whose distance from the centre is half a length.
      const double turn_a =
          first.has_axis() ? t_a.t_rot / first.inertia() * (first.length * first.length) : 0;
      const double turn_b =
          second.has_axis() ? t_b.t_rot / second.inertia() * (second.length * second.length) : 0;
      // The speed at which points at these distances from the centres approach, in lengths.
      const auto speed = [&](double square_a, double square_b) {
        return std::sqrt(flight + (turn_a * square_a + turn_b * square_b));
      };
      const double sides = mean_on_square([&](double x, double y) { return speed(x * x, y * y); });
      sum += count_a * count_b * (first.length * second.length) * sides;
      const double distance = composition.contact_distance(a, b);
      if (distance == 0) continue;
      // The caps see all directions alike: of a tip, the part of its distance normal to one.
      const auto of_tip = [](double mu) { return 0.25 * (1 - 4 * (mu * mu)); };
      const double tip_on_second =
          mean_on_square([&](double x, double y) { return speed(of_tip(x), y * y); });
      const double tip_on_first =
          mean_on_square([&](double x, double y) { return speed(x * x, of_tip(y)); });
      const double tips =
          mean_on_square([&](double x, double y) { return speed(of_tip(x), of_tip(y)); });
      sum += count_a * count_b *
             (4 * distance * (second.length * tip_on_second + first.length * tip_on_first) +
              8 * (distance * distance) * tips);
    }
  }
  return inverse_rate(sum * root_pi_eighths / (volume * count));
}

}  // namespace needlework
