// Bodies i and j meet w_ij <sigma> times per unit of time, with a weight w_ij of their sizes and
// the standard deviation sigma of the relative velocity of their contact points along the normal,
//
//   sigma^2 = a + a',  a = T_tr / m + T_rot s^2 / I of either body,
//
// s the distance of the point from the centre, or for caps its part across the normal. A root is
//
//   sqrt(a + a') = 1 / (2 sqrt(pi)) int_0^inf (1 - e^(-t a) e^(-t a')) t^(-3/2) dt,
//
// in which the two bodies are apart. The weights are polynomials of lengths and diameters, so that
// at each t the sum over all pairs is one of products of sums over bodies.
#include "needlework/body_rates.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "src/theory/requirements.h"
#include "src/theory/sphere_fluid.h"

namespace needlework::theory {
namespace {

using std::numbers::pi;

// Numbers with these first bits are alike: at most 2^-10 apart.
std::uint64_t first_bits(double x) {
  constexpr int bits_of_mantissa = 10;
  return std::bit_cast<std::uint64_t>(x) >> (52 - bits_of_mantissa);
}

// The mean of exp(-z x^2) over x from -1/2 to 1/2, the places on an axis.
double mean_on_axis(double z) {
  const double y = 0.5 * std::sqrt(z);
  return y > 0 ? 0.5 * std::sqrt(pi) * std::erf(y) / y : 1;
}

// The mean of exp(-(z/4) (1 - x^2)) over x from 0 to 1, the cosines on a cap: Dawson's integral of
// sqrt(z)/2, over that.
double mean_on_caps(double z) {
  const double square = 0.25 * z;
  if (square > 40) {
    double term = 1 / (2 * square), sum = term;
    for (int n = 1; n <= 20; ++n) sum += term *= (2 * n - 1) / (2 * square);
    return sum;
  }
  double power = 1, sum = 1;
  for (int n = 1; power > 1e-17 * sum; ++n) {
    power *= square / n;
    sum += power / (2 * n + 1);
  }
  return std::exp(-square) * sum;
}

}  // namespace

BodyRates::BodyRates(const Composition& composition)
    : composition_(composition),
      has_caps_(composition.has_width()),
      groups_(composition.size()),
      known_(composition.size()),
      added_(composition.size()) {}

void BodyRates::add(std::size_t species, const Body& body) {
  const double length = body.length, diameter = body.diameter;
  require_not_negative("length", length);
  require_not_negative("diameter", diameter);
  require_positive("mass", body.mass);
  require_valid(body.now);
  const double flight = body.now.t_tr / body.mass;
  const double turn = length > 0 ? body.now.t_rot * (length * length) / body.inertia : 0;
  const std::uint64_t key = first_bits(flight) << 32 | first_bits(turn);
  const auto [place, is_new] = known_[species].try_emplace(key, groups_[species].size());
  if (is_new) groups_[species].emplace_back();
  ++added_[species];
  Group& group = groups_[species][place->second];
  const double square = diameter * diameter;
  group.flight += flight;
  group.turn += turn;
  ++group.count;
  group.length += length;
  group.diameter += diameter;
  group.product += length * diameter;
  group.square += square;
  group.length2 += length * length;
  group.diameter3 += square * diameter;
  group.diameter4 += square * square;
}

BodyRates::Parts BodyRates::Group::parts(double t, bool has_caps) const {
  const double stays = std::exp(-t * (flight / count)), z = t * (turn / count);
  return {stays * mean_on_axis(z), has_caps ? stays * mean_on_caps(z) : 0};
}

// Of a pair the faces have the weight sqrt(pi / 8) L L', the sides sqrt(2 pi) d L' and sqrt(2 pi) d
// L, the caps 2 sqrt(2 pi) d^2, with d = (D + D') / 2.
double BodyRates::pairs_of(const Sums& a, const Sums& b, const Crowding& crowding) {
  const double faces = a.length * b.length;
  const double sides =
      a.diameter * b.length + a.count * b.product + a.length * b.diameter + a.product * b.count;
  const double caps =
      crowding.constant * (a.square * b.count + 2 * a.diameter * b.diameter + a.count * b.square) +
      crowding.linear * (a.square * b.diameter + a.diameter * b.square) +
      crowding.square * (a.square * b.square);
  return std::sqrt(pi / 8) * (faces + 2 * (sides + caps));
}

// The same of each body with itself.
double BodyRates::selves_of(const Group& group, const Parts& parts, const Crowding& crowding) {
  const double faces = group.length2 * (parts.axis * parts.axis);
  const double sides = 4 * group.product * (parts.axis * parts.caps);
  const double caps = (4 * crowding.constant * group.square +
                       2 * crowding.linear * group.diameter3 + crowding.square * group.diameter4) *
                      (parts.caps * parts.caps);
  return std::sqrt(pi / 8) * (faces + 2 * (sides + caps));
}

// By pair of species, each two bodies once.
std::vector<double> BodyRates::pairs_at(double t, const Crowding& crowding) const {
  std::vector<Sums> sums(groups_.size());
  std::vector<double> selves(groups_.size());
  for (std::size_t n = 0; n < groups_.size(); ++n) {
    for (const Group& group : groups_[n]) {
      const Parts parts = group.parts(t, has_caps_);
      sums[n].length += group.length * parts.axis;
      sums[n].product += group.product * parts.axis;
      sums[n].count += group.count * parts.caps;
      sums[n].diameter += group.diameter * parts.caps;
      sums[n].square += group.square * parts.caps;
      selves[n] += selves_of(group, parts, crowding);
    }
  }
  std::vector<double> out(composition_.pairs());
  for (std::size_t a = 0; a < sums.size(); ++a) {
    for (std::size_t b = a; b < sums.size(); ++b) {
      if (!composition_.meets(a, b)) continue;
      if (a == b && added_[a] < 2) continue;
      const double pairs = pairs_of(sums[a], sums[b], crowding);
      out[composition_.pair_index(a, b)] = a == b ? 0.5 * (pairs - selves[a]) : pairs;
    }
  }
  return out;
}

std::vector<double> BodyRates::collisions(double volume) const { return integrated(volume, {}); }

std::vector<double> BodyRates::collisions_of_spheres(double volume) const {
  const SphereFluid fluid = sphere_fluid(fluid_of(composition_, volume));
  return integrated(volume, {fluid.constant, fluid.linear, fluid.square});
}

std::vector<double> BodyRates::integrated(double volume, const Crowding& crowding) const {
  require_positive("volume", volume);
  std::vector<double> out(composition_.pairs());
  double fastest = 0, slowest = 0;  // squares of speeds, but for those at rest
  for (const std::vector<Group>& groups : groups_) {
    for (const Group& group : groups) {
      const double square = (group.flight + 0.25 * group.turn) / group.count;
      if (!(square > 0)) continue;
      fastest = std::max(fastest, square);
      slowest = slowest > 0 ? std::min(slowest, square) : square;
    }
  }
  if (!(fastest > 0)) return out;
  // The trapezoidal rule over log t, which converges exponentially: e^(-9.9 / step) of the whole.
  constexpr double step = 0.4, first = 1e-7;
  // What it has below the first and above the last point, where the integrand is a power of t.
  const double beyond = std::exp(-0.5 * step) / (1 - std::exp(-0.5 * step));
  const std::vector<double> all = pairs_at(0, crowding);
  std::vector<double> before = all;
  for (int n = 0;; ++n) {
    const double t = first / fastest * std::exp(step * n);
    const std::vector<double> now = pairs_at(t, crowding);
    bool changes = t * slowest < 1;
    for (std::size_t pair = 0; pair < out.size(); ++pair) {
      out[pair] += (all[pair] - now[pair]) / std::sqrt(t) * (n == 0 ? 1 + beyond : 1);
      changes = changes || std::abs(before[pair] - now[pair]) > 1e-12 * all[pair];
    }
    before = now;
    if (changes) continue;
    for (std::size_t pair = 0; pair < out.size(); ++pair)
      out[pair] += (all[pair] - now[pair]) / std::sqrt(t) * beyond;
    break;
  }
  for (double& each : out) each *= step / (2 * std::sqrt(pi)) / volume;
  return out;
}

}  // namespace needlework::theory
