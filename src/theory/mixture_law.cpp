// A pair with the inverse-mass matrix M = (1/m + 1/m') 1 + (s^2/I) P + (s'^2/I') P' gets the
// impulse J = -(1 + epsilon) M^-1 V_n - (1 + beta) M^-1 V_t from the relative velocity V of its
// contact points. V is Gaussian with covariance S = (T/m + T'/m') 1 + (T_rot s^2/I) P + (T_rot'
// s'^2/I') P', and its normal component has the density of a flux, so that <V_n^2> = 2 sigma^2 with
// sigma^2 = n.S n. A freedom x of one needle with dx = y J and cov(x, V) = C then gains the energy
// <C M^-1 J ...>; written out for both parts,
//     (1 + epsilon) / M_n (-2 c_n + (1 + epsilon) y_n sigma^2 / M_n)
//     - (1 + beta) tr(M^-1 C) + (1 + beta)^2 / 2 tr(M^-1 S M^-1 Y),
// with C = (T/m) 1 and Y = 1/m for translation, C = (T_rot s^2/I) P and Y = (s^2/I) P for rotation.
// Directors at a contact have the density (2/pi) sin^2 of the angle between them. The caps of
// smooth rods have contacts of another density, with s^2 |u x n|^2 in place of s^2.
#include "src/theory/mixture_law.h"

#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "src/theory/requirements.h"

namespace needlework::theory {
namespace {

// A symmetric matrix in the plane of the directors.
struct Matrix {
  double xx = 1, xy = 0, yy = 1;

  Matrix inverse() const {
    const double determinant = xx * yy - xy * xy;
    return {yy / determinant, -xy / determinant, xx / determinant};
  }
};

Matrix combination(double one, double first, const Matrix& p, double second, const Matrix& q) {
  return {one + first * p.xx + second * q.xx, first * p.xy + second * q.xy,
          one + first * p.yy + second * q.yy};
}

double trace_of_product(const Matrix& a, const Matrix& b) {
  return a.xx * b.xx + 2 * a.xy * b.xy + a.yy * b.yy;
}

// A B A.
Matrix between(const Matrix& a, const Matrix& b) {
  const double xx = a.xx * b.xx + a.xy * b.xy, xy = a.xx * b.xy + a.xy * b.yy;
  const double yx = a.xy * b.xx + a.yy * b.xy, yy = a.xy * b.xy + a.yy * b.yy;
  return {xx * a.xx + xy * a.xy, xx * a.xy + xy * a.yy, yx * a.xy + yy * a.yy};
}

// Of the angle between the directors, with weights (2/pi) sin^2: Gauss-Chebyshev of the second
// kind.
constexpr int angles = 48;

// The contact points that one body has: of each, the moment of inertia's share, s^2 / I normal to
// the direction of the impulse, and a weight [L, or 1 for caps].
std::vector<Node> along_axis(const Species& species, double masses) {
  if (!species.has_axis()) return {};
  const double half = species.length / 2;
  const double feature = std::sqrt(1 + half * half / species.inertia() / masses);
  std::vector<Node> out = graded_rule(half, 0.02 * half / feature);
  for (auto& [s, weight] : out) {
    s = s * s / species.inertia();
    weight *= 2;
  }
  return out;
}

// All directions of the impulse are alike for a cap: (L/2)^2 (1 - mu^2), mu uniform.
std::vector<Node> of_caps(const Species& species, double masses) {
  if (!species.has_axis()) return {{0, 1}};
  const double square = 0.25 * species.length * species.length / species.inertia();
  std::vector<Node> out = graded_rule(1, 0.02 / (1 + square / masses));
  for (auto& [x, weight] : out) x = square * (x * (2 - x));
  return out;
}

// a^2 / I of a rough sphere of radius a, 0 of a smooth one.
double share_of_spin(const Species& species) {
  return species.turns() ? 0.25 * species.diameter * species.diameter / species.inertia() : 0;
}

// The energy of rotation over its temperature.
double freedoms_of(const Species& species) { return species.has_axis() ? 1 : 1.5; }

}  // namespace

MixtureLaw::Traces MixtureLaw::traces_of_spheres(const Contact& contact, double masses) {
  const double along = masses + contact.first_along + contact.second_along;
  Traces out;
  for (int i = 0; i < 3; ++i) {
    out.once[i] = 2 / along;
    for (int j = 0; j < 3; ++j) out.twice[i][j] = 2 / (along * along);
  }
  return out;
}

MixtureLaw::MixtureLaw(const Composition& composition, double volume, WithoutPairs)
    : composition_(composition), volume_(volume) {
  require_positive("volume", volume);
}

MixtureLaw::MixtureLaw(const Composition& composition, double volume, std::vector<double> contact)
    : MixtureLaw(composition, volume, WithoutPairs{}) {
  contact_ = std::move(contact);
  for (std::size_t a = 0; a < composition.size(); ++a) {
    for (std::size_t b = a; b < composition.size(); ++b) pairs_.push_back(tabulated(a, b));
  }
}

MixtureLaw::Pair MixtureLaw::tabulated(std::size_t first, std::size_t second) const {
  Pair out{.first = first, .second = second, .contacts = {}, .traces = {}};
  tabulate(out);
  return out;
}

void MixtureLaw::tabulate(Pair& pair) const {
  const Species &a = composition_[pair.first], &b = composition_[pair.second];
  const double masses = 1 / a.mass + 1 / b.mass;
  const double distance = composition_.contact_distance(pair.first, pair.second);
  // Contacts of a pair per volume and time are <<sigma>> / sqrt(2 pi), with the surface of the
  // body that the centre of one is excluded from by the other: faces (pi/2) L L', sides 2 pi D L
  // and 2 pi D L', caps 4 pi D^2. Needles have faces alone.
  const auto axis_a = along_axis(a, masses), axis_b = along_axis(b, masses);
  tabulate(pair, axis_a, axis_b, std::sqrt(std::numbers::pi / 8));
  if (distance == 0) return;
  const auto caps_a = of_caps(a, masses), caps_b = of_caps(b, masses);
  const double side = std::sqrt(2 * std::numbers::pi) * distance;
  tabulate(pair, caps_a, axis_b, side);
  tabulate(pair, axis_a, caps_b, side);
  tabulate(pair, caps_a, caps_b, 2 * side * distance);
}

void MixtureLaw::tabulate(Pair& pair, std::span<const Node> first, std::span<const Node> second,
                          double unit) const {
  const Species &a = composition_[pair.first], &b = composition_[pair.second];
  const bool rough = composition_.restitution(pair.first, pair.second).is_rough();
  const bool spheres = composition_.are_spheres(pair.first, pair.second);
  const double masses = 1 / a.mass + 1 / b.mass;
  for (const auto& [share_a, weight_a] : first) {
    for (const auto& [share_b, weight_b] : second) {
      Contact contact{.weight = unit * weight_a * weight_b,
                      .first = share_a,
                      .second = share_b,
                      .normal = masses + share_a + share_b,
                      .first_along = spheres ? share_of_spin(a) : share_a,
                      .second_along = spheres ? share_of_spin(b) : share_b};
      Traces traces;
      if (rough && spheres) traces = traces_of_spheres(contact, masses);
      for (int n = 1; rough && !spheres && n <= angles; ++n) {
        const double angle = std::numbers::pi * n / (angles + 1);
        const double sine = std::sin(angle), cosine = std::cos(angle);
        const double weight = 2 * sine * sine / (angles + 1);
        const std::array<Matrix, 3> x = {Matrix{1, 0, 1}, Matrix{0, 0, 1},
                                         Matrix{sine * sine, -sine * cosine, cosine * cosine}};
        const Matrix inverse =
            combination(masses, contact.first, x[1], contact.second, x[2]).inverse();
        for (int i = 0; i < 3; ++i) {
          traces.once[i] += weight * trace_of_product(inverse, x[i]);
          for (int j = 0; j < 3; ++j) {
            traces.twice[i][j] += weight * trace_of_product(between(inverse, x[j]), x[i]);
          }
        }
      }
      pair.contacts.push_back(contact);
      if (rough) pair.traces.push_back(traces);
    }
  }
}

void MixtureLaw::add(const Pair& pair, std::span<const Temperatures> now, MixtureRates& out) const {
  pair.traces.empty() ? add<false>(pair, now, out) : add<true>(pair, now, out);
}

template <bool rough>
void MixtureLaw::add(const Pair& pair, std::span<const Temperatures> now, MixtureRates& out) const {
  const Species &a = composition_[pair.first], &b = composition_[pair.second];
  const Temperatures &t = now[pair.first], &u = now[pair.second];
  const Restitution& rule = composition_.restitution(pair.first, pair.second);
  const double epsilon = rule.epsilon, beta = rule.beta;
  const double flight = t.t_tr / a.mass + u.t_tr / b.mass;
  // Gains of energy over all contacts: translation and rotation of one needle of each species.
  double rate = 0, gain[4] = {};
  for (std::size_t n = 0; n < pair.contacts.size(); ++n) {
    const Contact& c = pair.contacts[n];
    const double turn_a = t.t_rot * c.first, turn_b = u.t_rot * c.second;
    const double slip_a = t.t_rot * c.first_along, slip_b = u.t_rot * c.second_along;
    const double sigma2 = flight + (turn_a + turn_b);
    const double weight = c.weight * std::sqrt(sigma2);
    rate += weight;
    const auto normal = [&](double x, double y) {
      return (1 + epsilon) / c.normal * (-2 * x + (1 + epsilon) * sigma2 * y / c.normal);
    };
    // `matrix`: 1 for translation, P or P' for rotation.
    const auto tangential = [&](int matrix, double x, double y) {
      if constexpr (!rough) return 0.0;
      const Traces& traces = pair.traces[n];
      const double* twice = traces.twice[matrix];
      return (1 + beta) *
             (-x * traces.once[matrix] +
              0.5 * (1 + beta) * y * (flight * twice[0] + slip_a * twice[1] + slip_b * twice[2]));
    };
    gain[0] +=
        weight * (normal(t.t_tr / a.mass, 1 / a.mass) + tangential(0, t.t_tr / a.mass, 1 / a.mass));
    gain[1] += weight * (normal(turn_a, c.first) + tangential(1, slip_a, c.first_along));
    gain[2] +=
        weight * (normal(u.t_tr / b.mass, 1 / b.mass) + tangential(0, u.t_tr / b.mass, 1 / b.mass));
    gain[3] += weight * (normal(turn_b, c.second) + tangential(2, slip_b, c.second_along));
  }
  const double count_a = static_cast<double>(a.count), count_b = static_cast<double>(b.count);
  const bool alike = pair.first == pair.second;
  double pairs = alike ? count_a * (count_a - 1) / 2 : count_a * count_b;
  if (!(pairs > 0 && composition_.meets(pair.first, pair.second))) return;
  const std::size_t index = composition_.pair_index(pair.first, pair.second);
  if (!contact_.empty()) pairs *= contact_[index];
  out.collisions[index] = pairs * rate / volume_;
  // Both needles of a pair gain; those of one species are both counted by their own gain.
  const auto gains = [&](std::size_t species, double count, const double* each) {
    const double share = pairs / (volume_ * count);
    out.temperatures[species].t_tr += share * each[0] / 1.5;
    out.temperatures[species].t_rot += share * each[1] / freedoms_of(composition_[species]);
  };
  gains(pair.first, count_a, gain);
  gains(pair.second, count_b, gain + 2);
}

MixtureRates MixtureLaw::rates(std::span<const Temperatures> now) const {
  MixtureRates out = no_rates(now);
  for (const Pair& pair : pairs_) add(pair, now, out);
  return out;
}

MixtureRates MixtureLaw::rates_once(const Composition& composition, double volume,
                                    std::span<const Temperatures> now) {
  const MixtureLaw law(composition, volume, WithoutPairs{});
  MixtureRates out = law.no_rates(now);
  for (std::size_t a = 0; a < composition.size(); ++a) {
    for (std::size_t b = a; b < composition.size(); ++b) law.add(law.tabulated(a, b), now, out);
  }
  return out;
}

MixtureRates MixtureLaw::no_rates(std::span<const Temperatures> now) const {
  require(now.size() == composition_.size(), "temperatures", static_cast<double>(now.size()),
          "those of each species");
  for (const Temperatures& each : now) require_valid(each);
  MixtureRates out;
  out.collisions.resize(composition_.pairs());
  out.temperatures.assign(composition_.size(), {.t_tr = 0, .t_rot = 0});
  return out;
}

}  // namespace needlework::theory
