// Temperatures of gases in steady uniform shear: loss by collisions balances the work of the flow.
//
// Spheres: of the moments of second order of the Boltzmann equation, linearised in the stress
// (Grad), with nu = (16/5) n d^2 sqrt(pi T / m), zeta = 5 (1 - eps^2) / 12 and b = (1 + eps) (1 -
// (1 - eps) / 3) / 2: the rate is nu sqrt(3 zeta / 2 b) (b + zeta).
#include <cmath>
#include <numbers>

#include "needlework/theory.h"

namespace needlework::theory {

std::optional<SteadyShear> steady_shear(const Species& body, double epsilon, double density,
                                        double rate) {
  if (!(epsilon < 1 && epsilon >= 0.5 && density > 0) || rate == 0) return std::nullopt;
  const double loss = 1 - epsilon * epsilon;
  if (!body.has_axis()) {
    if (body.turns()) return std::nullopt;
    const double zeta = 5 * loss / 12, b = 0.5 * (1 + epsilon) * (1 - (1 - epsilon) / 3);
    const double of_rate = std::sqrt(1.5 * zeta / b) * (b + zeta);
    // rate = of_rate * nu, nu ~ sqrt(T).
    const double nu = std::abs(rate) / of_rate;
    const double root = nu / (3.2 * density * body.diameter * body.diameter *
                              std::sqrt(std::numbers::pi / body.mass));
    return SteadyShear{root * root, 0, 2.85 / loss};
  }
  if (body.diameter > 0 || std::abs(body.k - 6) > 1e-9) return std::nullopt;
  // F_tr (1 - eps^2) and T_rot / T_tr depend on eps nearly linearly: 13.52(5) and 0.8873(7) at 0.9,
  // 4.714(10) and 0.7161(10) at 0.7.
  const double share = (epsilon - 0.7) / 0.2;
  const double f = (2.404 + share * (2.569 - 2.404)) / loss,
               ratio = 0.7161 + share * (0.8873 - 0.7161);
  const double square = density * body.length * body.length / std::abs(rate);
  const double t_tr = f * body.mass / (square * square);
  return SteadyShear{t_tr, ratio * t_tr, 5.1 / loss};
}

}  // namespace needlework::theory
