#include "src/physics/mean_free_time.h"

#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <limits>

namespace needlework {

double mean_free_time(const ThermalGas& gas) {
  constexpr double half_root_pi = 0.886226925452758;
  using Rule = boost::math::quadrature::gauss<double, 10>;
  // A product quadrature on a quarter of the square, [0, 1/2]^2.
  double nodes[10], weights[10];
  for (std::size_t i = 0; i < 5; ++i) {
    nodes[2 * i] = 0.25 * (1 - Rule::abscissa()[i]);
    nodes[2 * i + 1] = 0.25 * (1 + Rule::abscissa()[i]);
    weights[2 * i] = weights[2 * i + 1] = 0.5 * Rule::weights()[i];
  }
  double sum = 0;
  for (int i = 0; i < 10; ++i) {
    for (int j = 0; j < 10; ++j) {
      const double r2 = nodes[i] * nodes[i] + nodes[j] * nodes[j];
      sum += weights[i] * weights[j] * std::sqrt((gas.t_tr + gas.t_rot * gas.k * r2) / gas.mass);
    }
  }
  const double rate = gas.density * (gas.length * gas.length) * half_root_pi * sum;
  return rate > 0 ? 1 / rate : std::numeric_limits<double>::infinity();
}

}  // namespace needlework
