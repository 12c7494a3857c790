#include "src/audit/windows.h"

#include <boost/math/constants/constants.hpp>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <limits>
#include <utility>

namespace needlework::audit {
namespace {

// From here on times are not followed: the run is older than any.
constexpr double most_epochs = 0x1p62;

Instant later(const Instant& time, double epochs) {
  const double offset = time.offset + (epochs - std::floor(epochs));
  const double carry = std::floor(offset);
  const double whole = std::floor(epochs) + carry;
  if (!(whole + static_cast<double>(time.epoch) < most_epochs)) {
    return {std::numeric_limits<std::int64_t>::max(), 0};
  }
  return {time.epoch + static_cast<std::int64_t>(whole), offset - carry};
}

}  // namespace

std::vector<Temperatures> temperatures_of(std::span<const Needle> needles,
                                          std::span<const Body> bodies) {
  struct Squares {
    long double count = 0, v2 = 0, w2 = 0;
  };
  std::vector<Squares> sums(bodies.size());
  for (const Needle& needle : needles) {
    const auto v = to<long double>(needle.record.v), w = to<long double>(needle.record.w);
    Squares& sum = sums[needle.body.species];
    ++sum.count;
    sum.v2 += dot(v, v);
    sum.w2 += dot(w, w);
  }
  std::vector<Temperatures> out(bodies.size());
  for (std::size_t n = 0; n < out.size(); ++n) {
    const Squares& sum = sums[n];
    if (sum.count == 0) continue;
    // m <v^2> = 3 T_tr and I <w^2> = 2 T_rot with I = m L^2 / (2 k).
    const long double mass = bodies[n].mass, length = bodies[n].length, k = bodies[n].k;
    out[n] = {static_cast<double>(sum.count), static_cast<double>(mass * sum.v2 / (3 * sum.count)),
              static_cast<double>(mass * length * length * sum.w2 / (4 * k * sum.count))};
  }
  return out;
}

double energy_of(std::span<const Needle> needles) {
  long double sum = 0;
  for (const Needle& needle : needles) {
    const auto v = to<long double>(needle.record.v), w = to<long double>(needle.record.w);
    const long double length = needle.body.length;
    sum += needle.body.mass * (dot(v, v) + length * length / (2 * needle.body.k) * dot(w, w)) / 2;
  }
  return static_cast<double>(sum);
}

namespace {

// The mean of sqrt(a + b y^2) over y from 0 to 1/2.
double mean_root(double a, double b) {
  constexpr double half = 0.5;
  const double tip = std::sqrt(a + b * half * half);
  if (!(b > 0)) return tip;
  // a asinh(half sqrt(b / a)) / sqrt(b), which vanishes with a.
  const double rest = a > 0 ? a / std::sqrt(b) * std::asinh(half * std::sqrt(b / a)) : 0;
  return (half * tip + rest) / 2 / half;
}

// <sigma>. One of the means is elementary; a feature at small x, where the other needle decides, is
// spread out by x = t^2 / 2.
double mean_sigma(const Temperatures& gas_a, const Body& a, const Temperatures& gas_b,
                  const Body& b) {
  const double flight = gas_a.t_tr / a.mass + gas_b.t_tr / b.mass;
  // T_rot s^2 / I with s = L x.
  const double turn_a = 2 * a.k * gas_a.t_rot / a.mass, turn_b = 2 * b.k * gas_b.t_rot / b.mass;
  const auto over_first = [&](double t) {
    const double x = t * t / 2;
    return 2 * t * mean_root(flight + turn_a * x * x, turn_b);
  };
  return boost::math::quadrature::gauss<double, 30>::integrate(over_first, 0.0, 1.0);
}

}  // namespace

double mean_free_time(std::span<const Temperatures> gas, std::span<const Body> bodies,
                      double volume) {
  double collisions = 0, count = 0;  // those of a needle with each other, both counted
  for (std::size_t a = 0; a < gas.size(); ++a) {
    count += gas[a].count;
    for (std::size_t b = 0; b < gas.size(); ++b) {
      const double partners = gas[b].count - (a == b && gas.size() > 1 ? 1 : 0);
      if (!(gas[a].count > 0 && partners > 0)) continue;
      collisions += gas[a].count * partners * bodies[a].length * bodies[b].length *
                    mean_sigma(gas[a], bodies[a], gas[b], bodies[b]);
    }
  }
  if (!(collisions > 0)) return std::numeric_limits<double>::infinity();
  return volume * count / (std::sqrt(boost::math::constants::pi<double>() / 8) * collisions);
}

Windows::Windows(std::span<const Needle> needles, std::vector<Body> bodies, double volume,
                 double between_kicks)
    : bodies_(std::move(bodies)), volume_(volume), between_kicks_(between_kicks) {
  open({}, needles);
}

void Windows::open(const Instant& now, std::span<const Needle> needles) {
  mean_free_time_ = audit::mean_free_time(temperatures_of(needles, bodies_), bodies_, volume_);
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

void Windows::advance(const Instant& now, std::span<const Needle> needles) {
  while (certain_ && end_ <= now) open(end_, needles);
}

}  // namespace needlework::audit
