#include "src/audit/windows.h"

#include <boost/math/constants/constants.hpp>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <limits>
#include <utility>

namespace needlework::audit {

std::vector<Temperatures> temperatures_of(std::span<const Needle> needles,
                                          std::span<const AuditedBody> bodies) {
  struct Squares {
    long double count = 0, v2 = 0, w2 = 0;  // weighted by m, and by I
  };
  std::vector<Squares> sums(bodies.size());
  for (const Needle& needle : needles) {
    const auto v = to<long double>(needle.record.v), w = to<long double>(needle.record.w);
    Squares& sum = sums[needle.body.species];
    ++sum.count;
    const long double mass = needle.body.moving_mass();
    sum.v2 += mass * dot(v, v);
    sum.w2 += mass * needle.body.inertia_per_mass<long double>() * dot(w, w);
  }
  std::vector<Temperatures> out(bodies.size());
  for (std::size_t n = 0; n < out.size(); ++n) {
    const Squares& sum = sums[n];
    if (sum.count == 0) continue;
    // m <v^2> = 3 T_tr and I <w^2> = 2 T_rot, 3 T_rot of rough spheres.
    out[n] = {static_cast<double>(sum.count), static_cast<double>(sum.v2 / (3 * sum.count)),
              static_cast<double>(sum.w2 / (bodies[n].rotations() * sum.count))};
  }
  return out;
}

double energy_of(std::span<const Needle> needles) {
  long double sum = 0;
  for (const Needle& needle : needles) {
    const auto v = to<long double>(needle.record.v), w = to<long double>(needle.record.w);
    sum += needle.body.moving_mass() *
           (dot(v, v) + needle.body.inertia_per_mass<long double>() * dot(w, w)) / 2;
  }
  return static_cast<double>(sum);
}

namespace {

// The mean of sqrt(a + b y^2) over y from 0 to 1/2.
double mean_over_side(double a, double b) {
  constexpr double half = 0.5;
  const double tip = std::sqrt(a + b * half * half);
  if (!(b > 0)) return tip;
  // a asinh(half sqrt(b / a)) / sqrt(b), which vanishes with a.
  const double rest = a > 0 ? a / std::sqrt(b) * std::asinh(half * std::sqrt(b / a)) : 0;
  return (half * tip + rest) / 2 / half;
}

// The mean of sqrt(a + b (1 - mu^2) / 4) over mu from 0 to 1.
double mean_over_end(double a, double b) {
  const double most = a + b / 4;
  if (!(b > 0)) return std::sqrt(a);
  const double root = std::sqrt(b) / 2;
  return (std::sqrt(a) + most / root * std::asin(std::min(1.0, root / std::sqrt(most)))) / 2;
}

enum class Touches { side, end };

// <sigma> of a contact with these parts of the two. One of the means is elementary; a feature at
// small arms, where the other needle decides, is spread out by x = t^2 / 2.
double mean_sigma(const Temperatures& gas_a, const AuditedBody& a, Touches part_a,
                  const Temperatures& gas_b, const AuditedBody& b, Touches part_b) {
  const double flight = gas_a.t_tr / a.mass + gas_b.t_tr / b.mass;
  // T_rot s^2 / I with s = L x.
  const auto turn = [](const Temperatures& gas, const AuditedBody& body) {
    return body.has_axis() ? 2 * body.k * gas.t_rot / body.mass : 0;
  };
  const double turn_a = turn(gas_a, a), turn_b = turn(gas_b, b);
  const auto over_first = [&](double t) {
    // Of an end 1 - mu = t^2, so that small arms are at small t.
    const double x = t * t / 2, y = t * t;
    const double square = part_a == Touches::side ? x * x : y * (2 - y) / 4;
    const double rest = flight + turn_a * square;
    return 2 * t *
           (part_b == Touches::side ? mean_over_side(rest, turn_b) : mean_over_end(rest, turn_b));
  };
  return boost::math::quadrature::gauss<double, 30>::integrate(over_first, 0.0, 1.0);
}

// The mean of sigma over what the axes of two rods exclude, times sqrt(8 / pi) / 2 of its area.
double excluded(const Temperatures& gas_a, const AuditedBody& a, const Temperatures& gas_b,
                const AuditedBody& b) {
  const auto sigma = [&](Touches part_a, Touches part_b) {
    return mean_sigma(gas_a, a, part_a, gas_b, b, part_b);
  };
  using enum Touches;
  const double sides = a.length * b.length * sigma(side, side);
  const double distance = 0.5 * (a.diameter + b.diameter);
  if (distance == 0) return sides;
  return sides + 4 * distance * (a.length * sigma(side, end) + b.length * sigma(end, side)) +
         8 * distance * distance * sigma(end, end);
}

}  // namespace

double mean_free_time(std::span<const Temperatures> gas, std::span<const AuditedBody> bodies,
                      const Composition& composition, double volume) {
  // Thin needles count as partners of themselves.
  const bool thin =
      std::ranges::none_of(bodies, [](const AuditedBody& b) { return b.diameter > 0; });
  double collisions = 0, count = 0;  // those of a needle with each other, both counted
  for (std::size_t a = 0; a < gas.size(); ++a) {
    if (composition[a].fixed) continue;
    count += gas[a].count;
    for (std::size_t b = 0; b < gas.size(); ++b) {
      const double partners = gas[b].count - (a == b && !thin ? 1 : 0);
      if (!(gas[a].count > 0 && partners > 0 && composition.meets(a, b))) continue;
      collisions += gas[a].count * partners * excluded(gas[a], bodies[a], gas[b], bodies[b]);
    }
  }
  if (!(collisions > 0)) return std::numeric_limits<double>::infinity();
  return volume * count / (std::sqrt(boost::math::constants::pi<double>() / 8) * collisions);
}

Windows::Windows(std::span<const Needle> needles, std::vector<AuditedBody> bodies,
                 Composition composition, double volume, double between_kicks)
    : bodies_(std::move(bodies)),
      composition_(std::move(composition)),
      volume_(volume),
      between_kicks_(between_kicks) {
  open({}, needles);
}

void Windows::open(const Instant& now, std::span<const Needle> needles) {
  mean_free_time_ =
      audit::mean_free_time(temperatures_of(needles, bodies_), bodies_, composition_, volume_);
  if (!std::isfinite(usual_time())) {
    end_ = {std::numeric_limits<std::int64_t>::max(), 0};
    return;
  }
  const double span = std::ldexp(1.0, std::ilogb(usual_time()));
  const auto power_of = [&](double factor) {
    return std::ilogb(std::min(mean_free_time_ * factor, between_kicks_));
  };
  if (power_of(1 - tolerance) != power_of(1 + tolerance)) certain_ = false;
  end_ = later(now, span);
}

}  // namespace needlework::audit
