// Integrals over all configurations in which two needles touch.
#include "src/theory/contact_integrals.h"

#include <cmath>
#include <numbers>

#include "src/theory/graded_rule.h"

namespace needlework::theory {

namespace {

constexpr double quarter_pi = std::numbers::pi / 4.0;

Shares operator*(double factor, const Shares& shares) {
  return {factor * shares.translation, factor * shares.exchange, factor * shares.rotation};
}

Shares& operator+=(Shares& sum, const Shares& shares) {
  sum.translation += shares.translation;
  sum.exchange += shares.exchange;
  sum.rotation += shares.rotation;
  return sum;
}

Shares normal_shares(double mu) {
  const double fast = 1.0 / (1.0 + mu);  // the part of the inverse mass that is translational
  const double slow = mu * fast;
  return {fast * fast, fast * slow, slow * slow};
}

/// In the plane of the needles, mu takes the two eigenvalues of k (s12^2 P1 + s21^2 P2), P = 1 - u
/// u. Their sum is e = a + b and their product a b sin^2(theta), with a = k s12^2, b = k s21^2. So
/// the sums of the shares are rational in sin^2(theta), and their averages over the density (2/pi)
/// sin^2(theta) are elementary. With p = 1 + e, w = (1 + a)(1 + b) and d = p + a b sin^2(theta),
/// the averages of 1/d^2, (a b sin^2)/d^2 and (a b sin^2)^2/d^2 are c0, c1 and c2 below, written
/// without cancellation.
Shares tangential_shares(double a, double b) {
  const double e = a + b;
  const double ab = a * b;
  const double root_p = std::sqrt(1.0 + e);
  const double root_w = std::sqrt(1.0 + a) * std::sqrt(1.0 + b);
  const double sum = root_w + root_p;
  const double cube = root_w * root_w * root_w;
  const double c0 = 1.0 / (root_p * cube);
  const double c1 = ab * (2.0 * root_w + root_p) / (cube * sum * sum);
  const double c2 = ab * ab * (root_w * root_w + 3.0 * root_w * root_p + root_p * root_p) /
                    (cube * sum * sum * sum);
  return {(2.0 + 2.0 * e + e * e) * c0 - 2.0 * c1, e * c0 + (4.0 + e) * c1,
          e * e * c0 + 2.0 * (e - 1.0) * c1 + 2.0 * c2};
}

/// Integral of the tangential shares over the part of the circle of radius r that lies in the
/// square: eight equal pieces, each from `least_angle` to pi/4 off an axis.
Shares tangential_arc(double k, double r, double least_angle) {
  // The shares change fastest near an axis, over angles of 1 / (sqrt(k) r).
  const double finest = 0.5 / std::sqrt(1.0 + k * r * r);
  Shares arc;
  for (const auto& [x, weight] : graded_rule(1.0, finest)) {
    const double angle = least_angle + (quarter_pi - least_angle) * x;
    const double s12 = r * std::cos(angle);
    const double s21 = r * std::sin(angle);
    arc += weight * tangential_shares(k * s12 * s12, k * s21 * s21);
  }
  return 8.0 * (quarter_pi - least_angle) * arc;
}

}  // namespace

ContactIntegrals::ContactIntegrals(double k, bool tangential) : k_(k) {
  // Whole circles. The weight g has a feature at r = sqrt(T_tr / (k T_rot)), which may be
  // anywhere, and the other factors at 1 / sqrt(k). The disk below `finest` holds 1e-12 of all
  // contacts even if large arms are cut off.
  const double finest = 1e-6 / std::sqrt(1.0 + k);
  for (const auto& [r, weight] : graded_rule(0.5, finest)) add_ring(r, 0.0, r * weight, tangential);

  // Circles cut by the sides of the square. They start at an angle x from an axis, where r cos(x)
  // = 1/2. All factors are smooth in x, but not in r: r dr = sin(x)/(4 cos^3(x)) dx.
  for (const auto& [x, weight] : graded_rule(quarter_pi, 0.25 / std::sqrt(1.0 + k))) {
    const double r = 0.5 / std::cos(x);
    add_ring(r, x, 2.0 * r * r * r * std::sin(x) * weight, tangential);
  }
}

void ContactIntegrals::add_ring(double r, double least_angle, double weight, bool tangential) {
  const double arc = 8.0 * (quarter_pi - least_angle);
  const double mu = k_ * r * r;
  Ring ring{mu, arc * weight, arc * weight * normal_shares(mu), {}};
  if (tangential) ring.tangential = weight * tangential_arc(k_, r, least_angle);
  rings_.push_back(ring);
}

ContactSums ContactIntegrals::sums(Temperatures temperatures) const {
  ContactSums sums;
  for (const Ring& ring : rings_) {
    const double g = std::sqrt(temperatures.t_tr + temperatures.t_rot * ring.k_r2);
    sums.flux += g * ring.weight;
    sums.normal += g * ring.normal;
    sums.tangential += g * ring.tangential;
  }
  return sums;
}

}  // namespace needlework::theory
