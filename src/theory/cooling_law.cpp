// Rates of change of the two temperatures of a Gaussian, homogeneous gas of needles.
#include "src/theory/cooling_law.h"

#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <cstdint>

#include "src/theory/requirements.h"

namespace needlework::theory {

namespace {

/// Mean changes of a pair's two energies by the part of the impulse along one direction e, summed
/// over contacts. V = x + y is the sum of translation and rotation, with <x^2> = 2 T_tr and <y^2>
/// = 2 mu T_rot. An impulse p = -(1 + restitution) V / (2 (1 + mu)) changes the energies by p x +
/// p^2 and p y + mu p^2. Terms are grouped so that without loss the two changes cancel exactly.
Temperatures changes_along(const Shares& shares, double restitution, Temperatures now) {
  const double kept = 0.5 * (1.0 + restitution);
  const double lost = 0.5 * (1.0 - restitution);
  return {
      .t_tr =
          2.0 * kept *
          ((kept * now.t_rot - now.t_tr) * shares.exchange - lost * now.t_tr * shares.translation),
      .t_rot =
          2.0 * kept *
          ((kept * now.t_tr - now.t_rot) * shares.exchange - lost * now.t_rot * shares.rotation)};
}

const Gas& checked(const Gas& gas) {
  require_valid(gas);
  return gas;
}

}  // namespace

CoolingLaw::CoolingLaw(const Gas& gas)
    : gas_(checked(gas)), integrals_(gas.k, /*tangential=*/gas.beta > -1.0) {}

Rates CoolingLaw::rates(Temperatures now) const {
  const ContactSums sums = integrals_.sums(now);
  const Temperatures normal = changes_along(sums.normal, gas_.epsilon, now);
  const Temperatures tangential = changes_along(sums.tangential, gas_.beta, now);
  // The normal velocity is flux weighted, <V_n^2> = 2 sigma^2, and the tangential ones are not,
  // hence the 2. A needle takes part in (3/4) flux collisions per unit of tau. Half of the change
  // of a pair's energy belongs to each needle, as 3/2 T_tr or T_rot.
  const double per_needle = 0.5 * 0.75;
  return {.temperatures = {.t_tr = (per_needle / 1.5) * (2.0 * normal.t_tr + tangential.t_tr),
                           .t_rot = per_needle * (2.0 * normal.t_rot + tangential.t_rot)},
          .collisions = 0.75 * sums.flux};
}

double CoolingLaw::stationary_q() const {
  // dq/dtau = T_rot' - q T_tr' at T_tr = 1. It is positive at q = 0, where collisions only feed
  // the rotation, and negative for q -> infinity, where they only feed the translation.
  const auto drift = [this](double q) {
    const Temperatures change = rates({.t_tr = 1.0, .t_rot = q}).temperatures;
    return change.t_rot - q * change.t_tr;
  };
  std::uintmax_t iterations = 500;
  const auto [low, high] = boost::math::tools::bracket_and_solve_root(
      drift, 1.0, 2.0, /*rising=*/false, boost::math::tools::eps_tolerance<double>(52), iterations);
  return std::sqrt(low) * std::sqrt(high);
}

bool CoolingLaw::is_elastic() const { return gas_.epsilon == 1.0 && std::abs(gas_.beta) == 1.0; }

}  // namespace needlework::theory
