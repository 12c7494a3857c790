#include "src/audit/windows.h"

#include <boost/math/constants/constants.hpp>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <limits>

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

Temperatures temperatures_of(std::span<const Needle> needles, double k) {
  long double v2 = 0, w2 = 0;
  for (const Needle& needle : needles) {
    const auto v = to<long double>(needle.record.v), w = to<long double>(needle.record.w);
    v2 += dot(v, v);
    w2 += dot(w, w);
  }
  const auto count = static_cast<long double>(needles.size());
  // <v^2> = 3 T_tr and <w^2> = 2 T_rot / I with I = 1 / (2 k).
  return {static_cast<double>(v2 / (3 * count)), static_cast<double>(w2 / (4 * k * count))};
}

// In polar coordinates about the centre of the square, the integral over the radius is
// elementary. The eight triangles between an axis and a diagonal contribute alike.
double mean_free_time(const Temperatures& gas, double density, double k) {
  using boost::math::constants::pi;
  const double a = gas.t_tr, b = gas.t_rot * k, inner = std::sqrt(a);
  const auto over_radius = [&](double angle) {
    const double secant = 1 / std::cos(angle), outer = std::sqrt(a + b * secant * secant / 4);
    if (outer == 0) return 0.0;
    const double squares = outer * outer + outer * inner + inner * inner;
    return secant * secant / 12 * squares / (outer + inner);
  };
  const double integral =
      8 * boost::math::quadrature::gauss<double, 30>::integrate(over_radius, 0.0, pi<double>() / 4);
  return 1 / (density * std::sqrt(pi<double>()) / 2 * integral);
}

Windows::Windows(std::span<const Needle> needles, double density, double k)
    : density_(density), k_(k) {
  open({}, needles);
}

void Windows::open(const Instant& now, std::span<const Needle> needles) {
  mean_free_time_ = audit::mean_free_time(temperatures_of(needles, k_), density_, k_);
  if (!std::isfinite(mean_free_time_)) {
    end_ = {std::numeric_limits<std::int64_t>::max(), 0};
    return;
  }
  const double span = std::ldexp(1.0, std::ilogb(mean_free_time_));
  const auto power_of = [&](double factor) { return std::ilogb(mean_free_time_ * factor); };
  if (power_of(1 - tolerance) != power_of(1 + tolerance)) certain_ = false;
  end_ = later(now, span);
}

void Windows::advance(const Instant& now, std::span<const Needle> needles) {
  while (certain_ && end_ <= now) open(end_, needles);
}

}  // namespace needlework::audit
