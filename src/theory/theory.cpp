// Kinetic theory of the homogeneous needle gas: rates and ratios.
#include "needlework/theory.h"

#include <boost/math/special_functions/gamma.hpp>
#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

#include "src/theory/contact_integrals.h"
#include "src/theory/cooling_law.h"
#include "src/theory/requirements.h"

namespace needlework::theory {

namespace {

const double half_root_pi = 0.5 * std::sqrt(std::numbers::pi);

double flux(Temperatures temperatures, double k) {
  return ContactIntegrals(k, /*tangential=*/false).sums(temperatures).flux;
}

}  // namespace

double collision_integral(double q, double k) {
  require_not_negative("q", q);
  require_positive("k", k);
  return flux({.t_tr = 1.0, .t_rot = q}, k);
}

double collision_rate(double density, Temperatures temperatures, double k) {
  require_not_negative("density", density);
  require_valid(temperatures);
  require_positive("k", k);
  return density * half_root_pi * flux(temperatures, k);
}

// Velocities lie on a sphere in D dimensions. A relative velocity does not depend on the momentum.
Equilibrium equilibrium_of(double count, double total_energy, int conserved) {
  require(std::isfinite(count) && count >= 1.0, "count", count, "a finite number, 1 or more");
  require_not_negative("total_energy", total_energy);
  require(conserved >= 0 && conserved <= 3, "conserved", conserved, "0, 1, 2 or 3");
  const double degrees = 5.0 * count - conserved;
  return {2.0 * total_energy / degrees,
          std::sqrt(0.5 * degrees) * boost::math::tgamma_delta_ratio(0.5 * degrees, 0.5)};
}

double equilibrium_rate(double count, double volume, double total_energy, double k, int conserved) {
  require(std::isfinite(count) && count >= 2.0, "count", count, "a finite number, 2 or more");
  require_positive("volume", volume);
  const auto [temperature, speed] = equilibrium_of(count, total_energy, conserved);
  return speed *
         collision_rate((count - 1.0) / volume, {.t_tr = temperature, .t_rot = temperature}, k);
}

// Momentum correlates velocities of two needles just so that their relative one has T/m + T/m'.
std::vector<double> mixture_equilibrium_rates(const Composition& composition, double volume,
                                              double total_energy, int conserved) {
  const double all = static_cast<double>(composition.count());
  require(all >= 2.0, "count", all, "2 or more");
  const Equilibrium gas =
      equilibrium_of(all - static_cast<double>(composition.fixed()), total_energy, conserved);
  std::vector<Temperatures> now;
  for (const Species& each : composition.species()) {
    const double t = each.fixed ? 0 : gas.temperature;
    now.push_back({t, t});
  }
  std::vector<double> out = mixture_rates(composition, volume, now).collisions;
  for (double& rate : out) rate *= gas.speed;
  return out;
}

Temperatures cooling_rates(const Gas& gas, Temperatures now) {
  require_valid(now);
  return CoolingLaw(gas).rates(now).temperatures;
}

// Per (4/3) collisions of a sphere T_tr loses a T_tr - b T_rot and T_rot c T_rot - b T_tr.
double asymptotic_ratio_of_spheres(double q, const Restitution& rule) {
  require_positive("q", q);
  const double epsilon = rule.epsilon, eta = 0.5 * (1 + rule.beta) * q / (1 + q);
  const double a = (1 - epsilon * epsilon) / 4 + eta * (1 - eta), b = eta * eta / q,
               c = eta / q * (1 - eta / q);
  const bool is_elastic = epsilon == 1 && rule.beta == 1;
  if (b == 0 || is_elastic) return std::numeric_limits<double>::quiet_NaN();
  const double root = std::hypot(a - c, 2 * b);
  // The same twice; of two numbers that nearly cancel, one would lose its digits.
  return a > c ? 2 * b / (a - c + root) : (c - a + root) / (2 * b);
}

double asymptotic_ratio(const Gas& gas) {
  const CoolingLaw law(gas);
  if (law.is_elastic()) return std::numeric_limits<double>::quiet_NaN();
  return 1.0 / law.stationary_q();
}

double equipartition_k() {
  // At q = 1 both rates of a smooth gas are proportional to 1 - epsilon^2, so any epsilon gives
  // the same k.
  const auto drift = [](double k) {
    const Temperatures change =
        cooling_rates({.k = k, .epsilon = 0.0, .beta = -1.0}, {.t_tr = 1.0, .t_rot = 1.0});
    return change.t_rot - change.t_tr;
  };
  std::uintmax_t iterations = 100;
  const auto [low, high] = boost::math::tools::bracket_and_solve_root(
      drift, 4.0, 2.0, /*rising=*/false, boost::math::tools::eps_tolerance<double>(52), iterations);
  return 0.5 * (low + high);
}

}  // namespace needlework::theory
