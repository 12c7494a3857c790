#include "src/audit/contact_finder.h"

#include <algorithm>
#include <cmath>

namespace needlework::audit {
namespace {

/// Number of intervals of a flight after which f is assumed to be small everywhere, as for needles
/// nearly in one plane, and is bounded by its coefficients.
constexpr int patience = 32;
/// Number of intervals of a flight after which the rest counts as doubtful.
constexpr int most_stretches = 10000;
/// Factor by which bounds computed from a few doubles are enlarged.
constexpr double enlarged = 1 + 0x1p-40;

int sign_of(double a) { return (a > 0) - (a < 0); }

}  // namespace

// Bound on |f''| over the interval.
double ContactFinder::bend(const Sample& sample, double s, double half) const {
  return pair_.bend(s - half, s + half, sample.distance + pair_.speed() * half) * enlarged;
}

// Whether the interval has no contact: f keeps its sign, or a contact point stays off its needle.
bool ContactFinder::is_free(const Sample& e, double s, double half) const {
  const double change =
      ((std::abs(e.df) + e.df_error) + 0.5 * bend(e, s, half) * half) * half * enlarged;
  if (std::abs(e.f) > e.f_error + change + 2 * pair_.limit(e, s, half)) return true;
  const double reach = e.distance + pair_.speed() * half;
  const double sine = e.sine + pair_.spin() * half;
  const double blur = 0x1p-46 * (1 + pair_.limit(e, s, half) * 0x1p53);
  for (int i = 0; i < 2; ++i) {
    const double nearest = e.moment_least[i] - pair_.moment_rate(i, reach) * half * enlarged;
    if (nearest > pair_.half_length(i) * sine * enlarged + blur) return true;
  }
  return false;
}

// Whether all of the interval is within the condition limit.
bool ContactFinder::is_noise(const Sample& e, double s, double half) const {
  const double change = (std::abs(e.df) + 0.5 * bend(e, s, half) * half) * half;
  return std::abs(e.f) + change <= 2 * pair_.limit(e, s);
}

bool ContactFinder::is_monotone(const Sample& e, double s, double half) const {
  return std::abs(e.df) > e.df_error + bend(e, s, half) * half * enlarged;
}

// A sample in the arithmetic that the required precision needs.
Sample ContactFinder::sample_of(double s, double half) {
  const Sample e = pair_.sample(s);
  const double change = (std::abs(e.df) + 0.5 * bend(e, s, half) * half) * half;
  const double enough = 0.125 * std::max(std::abs(e.f), change);
  return e.f_error > enough + pair_.limit(e, s) ? pair_.precise(s) : e;
}

int ContactFinder::sign(double s) {
  Sample e = pair_.sample(s);
  if (std::abs(e.f) <= e.f_error + 2 * pair_.limit(e, s)) e = pair_.precise(s);
  return std::abs(e.f) > e.f_error + 2 * pair_.limit(e, s) ? sign_of(e.f) : 0;
}

int ContactFinder::on_needles(double begin, double end) {
  const double half = 0.5 * (end - begin), middle = begin + half;
  const double w = pair_.spin(), v = pair_.speed();
  // Both margins are at least those at the ends, less the bound on their change in between.
  const auto inside = [&](double s, const Sample& e) {
    const double reach = e.distance + 2 * v * half;
    const double bent = 0.5 * pair_.margin_bend(reach) * half * half * enlarged;
    const double least = bent + pair_.margin_limit(e, s);
    return e.margin[0] > least + e.margin_error[0] && e.margin[1] > least + e.margin_error[1];
  };
  if (inside(begin, pair_.sample(begin)) && inside(end, pair_.sample(end))) return 1;
  const auto outside = [&](const Sample& e) {
    const double reach = e.distance + v * half;
    for (int i = 0; i < 2; ++i) {
      const double rate = pair_.moment_rate(i, reach);
      const double most = e.moment_most[i] + rate * half;
      const double change = ((e.sine + w * half) * (rate + w) + most * w) * half * enlarged;
      if (e.margin[i] < -(e.margin_error[i] + change + pair_.margin_limit(e, middle))) return true;
    }
    return false;
  };
  if (outside(pair_.sample(middle)) || outside(pair_.precise(middle))) return -1;
  return inside(begin, pair_.precise(begin)) && inside(end, pair_.precise(end)) ? 1 : 0;
}

// A pair that starts with f = 0 leaves it with slope f'(0). Sets `left` to where the search
// continues.
std::optional<ContactInterval> ContactFinder::leave_start(double to, double& left) {
  const int side = pair_.start().side;
  const Sample e = pair_.precise(0);
  const double slope = std::max(0.0, std::abs(e.df) - e.df_error);
  const double soon = 0.5 / pair_.rate(), curvature = bend(e, 0, soon);
  // Until then f' keeps its sign and at least half its size.
  left = std::min({to, soon, slope / (2 * curvature)});
  const bool monotone = left > 0 && sign(left) != 0;
  if (!monotone) {
    left = std::min(to, std::max(left, 0x1p-60 / pair_.rate()));
    while (left < to && sign(left) == 0) left = std::min(to, 2 * left);
    return ContactInterval{false, 0, left, side};
  }
  if (side == 0 || sign(left) == side) return std::nullopt;
  // The pair crosses to the other side at once.
  const double across = 4 * pair_.limit(e, 0) / slope;
  const double end = across < left && sign(across) == -side ? across : left;
  const int inside = on_needles(0, end);
  if (inside < 0) return std::nullopt;
  return ContactInterval{inside > 0, 0, end, side};
}

std::optional<ContactInterval> ContactFinder::first(double from, double to) {
  if (pair_.start().kind == Start::apart) return next(from, to);
  double left = 0;
  if (const auto contact = leave_start(to, left)) return contact;
  return left < to ? next(left, to) : std::nullopt;
}

// The root in an interval in which f is monotone with certain signs at its ends.
std::optional<ContactInterval> ContactFinder::cross(const Stretch& stretch, int side) {
  double low = stretch.begin, high = stretch.end;
  double s = low + 0.5 * (high - low), width = 0;
  for (int i = 0; i < 60; ++i) {
    Sample e = pair_.sample(s);
    if (std::abs(e.f) < 4 * e.f_error) e = pair_.precise(s);
    width = 3 * pair_.limit(e, s) / std::abs(e.df) + 0x1p-50 * std::abs(s);
    (sign_of(e.f) == side ? low : high) = s;
    double target = s - e.f / e.df;
    if (!(target > low && target < high)) target = low + 0.5 * (high - low);
    const double step = std::abs(target - s);
    s = target;
    if (step < width || high - low < width) break;
  }
  low = std::max(stretch.begin, s - width);
  high = std::min(stretch.end, s + width);
  while (low > stretch.begin && sign(low) != side) {
    low = std::max(stretch.begin, s - 2 * (s - low));
  }
  while (high < stretch.end && sign(high) != -side) {
    high = std::min(stretch.end, s + 2 * (high - s));
  }
  const int inside = on_needles(low, high);
  if (inside < 0) return std::nullopt;
  return ContactInterval{inside > 0, low, high, side};
}

// Where to halve the interval: if possible, not where the sign of f is open.
double ContactFinder::cut(const Stretch& stretch) {
  const double length = stretch.end - stretch.begin;
  for (const double share : {0.5, 0.4375, 0.546875}) {
    const double at = stretch.begin + share * length;
    if (sign(at) != 0) return at;
  }
  return stretch.begin + 0.5 * length;
}

std::optional<ContactInterval> ContactFinder::next(double from, double to) {
  stretches_.assign(1, {from, to});
  for (; !stretches_.empty(); ++looked_at_) {
    if (looked_at_ == patience) pair_.find_coefficients();
    const Stretch stretch = stretches_.back();
    stretches_.pop_back();
    const double half = 0.5 * (stretch.end - stretch.begin), middle = stretch.begin + half;
    const Sample e = sample_of(middle, half);
    if (is_free(e, middle, half)) continue;
    const bool finest = half <= 0x1p-51 * std::max(std::abs(stretch.begin), std::abs(stretch.end));
    if (is_noise(e, middle, half) || finest) {
      return ContactInterval{false, stretch.begin, stretch.end, sign(stretch.begin)};
    }
    if (looked_at_ >= most_stretches) return ContactInterval{false, stretch.begin, to, 0};
    if (is_monotone(e, middle, half)) {
      const int before = sign(stretch.begin), after = sign(stretch.end);
      if (before != 0 && before == after) continue;
      if (before != 0 && after == -before) {
        if (const auto contact = cross(stretch, before)) return contact;
        continue;
      }
    }
    const double at = cut(stretch);
    stretches_.push_back({at, stretch.end});
    stretches_.push_back({stretch.begin, at});
  }
  return std::nullopt;
}

}  // namespace needlework::audit
