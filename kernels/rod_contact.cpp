#include "kernels/rod_contact.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <type_traits>
#include <utility>

#include "kernels/rod_stretches.h"
#include "kernels/sphere_contact.h"
#include "kernels/sphere_overlap.h"

namespace needlework::kernels {
namespace {

// Interval length in scaled time; a power of two.
constexpr double rod_grid = 0.5;
// So are they where the bound of the error of the distance is above this share of the reach.
constexpr double rod_largest_error = 0x1p-46;
// So often rod_time_apart() halves the time for which it finds the rods to stay apart.
constexpr int rod_tries = 5;

double size_of(const Vec3d& a) { return std::sqrt(dot(a, a)); }

class RodSearch {
 public:
  RodSearch(const RodPair& pair, const Accuracy& accuracy, EvaluationCounters& counters)
      : accuracy_(accuracy), counters_(counters), rods_(pair, counters), stretches_(rods_) {}

  Contact run(double from, double until);
  double time_apart();
  ContactGeometry geometry(const DoubleDouble& elapsed);
  double gap(const DoubleDouble& elapsed);

 private:
  const Frame<double>& frame() { return rods_.frame<double>(); }
  bool meets_at_once(const Instant<double>& start);

  template <class T>
  bool is_below(const Instant<T>& a);
  template <class T>
  std::optional<DoubleDouble> search(const Instant<T>& a, const Instant<T>& b);
  template <class T>
  DoubleDouble root(const Instant<T>& a, const Instant<T>& b);
  template <class T>
  double guess_between(const Instant<T>& a, const Instant<T>& b, double contact) const;
  template <class T>
  Instant<T> refine(const T& begin, const T& end, const T& start);

  const Accuracy& accuracy_;
  EvaluationCounters& counters_;
  RodInstants rods_;
  RodStretches stretches_;
  double first_ = 0, last_ = 0;  // only contacts between these are looked for
};

template <class T>
bool RodSearch::is_below(const Instant<T>& a) {
  if (std::abs(a.excess) > a.error) return a.excess < 0;
  if constexpr (std::is_same_v<T, double>) return is_below(rods_.at(DoubleDouble(a.s)));
  return false;  // a touch, as far as double-double can tell
}

// The first contact between a and b. The pair is not in contact at a, or touches there as its
// records have it.
template <class T>
std::optional<DoubleDouble> RodSearch::search(const Instant<T>& a, const Instant<T>& b) {
  const double begin = to_double(a.s), end = to_double(b.s), h = end - begin;
  if (end < first_ || begin > last_) return std::nullopt;
  constexpr bool is_double = std::is_same_v<T, double>;
  const bool starts = rods_.starts_at(a);
  if (stretches_.stays_above_chord(a, b, is_double || starts ? 1 : -2)) return std::nullopt;
  const bool below = is_below(b);
  if (!starts && stretches_.falls(a, b)) {
    if (!below) return std::nullopt;
    return root(a, b);
  }
  if (!below && (stretches_.stays_beyond_plane(a, b, starts) ||
                 (!starts && stretches_.stays_beyond_plane(b, a, false)))) {
    return std::nullopt;
  }
  if (counters_.is_spent()) return std::nullopt;
  if constexpr (is_double) {
    if (stretches_.is_limited_by_rounding(a, b))
      return search(rods_.at(DoubleDouble(begin)), rods_.at(DoubleDouble(end)));
  }
  const double middle = begin + 0.5 * h;
  const double most = a.distance + b.distance + rods_.rates().velocity * h;
  const bool is_last = middle == begin || middle == end ||
                       (!is_double && 2 * most * rods_.rates().velocity * h <= a.error);
  if (is_last) {
    if (!below) return std::nullopt;
    // It comes back before it has left.
    if (starts) return DoubleDouble();
    return root(a, b);
  }
  const Instant<T> m = rods_.at(T(middle));
  if (auto found = search(a, m)) return found;
  return search(m, b);
}

// The share of the time from a to b at which the distance is about that at contact, by a cubic.
template <class T>
double RodSearch::guess_between(const Instant<T>& a, const Instant<T>& b, double contact) const {
  const double h = to_double(b.s - a.s);
  const double before = std::max(a.excess, 0.0) / (a.distance + contact),
               after = b.excess / (b.distance + contact), change = after - before;
  double at = before / -change;
  if (a.distance > 0 && b.distance > 0) {
    const double begin = 0.5 * h * a.rate / a.distance, end = 0.5 * h * b.rate / b.distance;
    const double c3 = begin + end - 2 * change, c2 = 3 * change - 2 * begin - end;
    for (int i = 0; i < 3; ++i) {
      const double slope = begin + at * (2 * c2 + 3 * at * c3);
      const double next = at - (before + at * (begin + at * (c2 + at * c3))) / slope;
      if (!(next >= 0 && next <= 1)) break;
      at = next;
    }
  }
  return std::clamp(at, 0x1p-10, 1 - 0x1p-10);
}

// Newton's iteration, safeguarded: at the begin the excess is not below 0, at the end it is.
template <class T>
Instant<T> RodSearch::refine(const T& begin, const T& end, const T& start) {
  const double share =
      std::is_same_v<T, double> ? std::max(0x1p-52, accuracy_.root_tolerance) : 0x1p-98;
  const double contact = std::sqrt(to_double(rods_.threshold<T>()));
  T low = begin, high = end, s = start;
  Instant<T> now;
  for (int i = 0; i < 200; ++i) {
    now = rods_.at(s);
    (now.excess > 0 ? low : high) = s;
    // The length of the gap is nearer to linear than its square.
    const double step = -now.excess / (now.distance + contact) * (2 * now.distance / now.rate);
    const T next = s + T(step);
    const bool is_inside =
        now.rate < 0 && to_double(next - begin) >= 0 && to_double(end - next) >= 0;
    // What the step leaves is of second order. Downwards, the distance bends as fast as the nearest
    // points slide along the axes, which grows as rods become parallel.
    const double slide = now.speed + now.distance * frame().w_sum;
    const double rest = 4 * (slide * slide) * (step * step);
    const double xx = to_double(dot(now.rods.x, now.rods.x));
    // Within the rounding, signs say nothing, but this step still leads to the middle of it.
    if (std::abs(now.excess) <= now.error || (is_inside && rest <= 0x1p-4 * now.error * xx)) {
      if (is_inside) now.s = next;
      return now;
    }
    const bool inside = is_inside && to_double(next - low) > 0 && to_double(high - next) > 0;
    const T target = inside ? next : low + (high - low) * T(0.5);
    const double moved = std::abs(to_double(target - s));
    s = target;
    if (moved <= share * std::abs(to_double(s)) || !(to_double(high - low) > 0)) break;
  }
  now.s = s;
  return now;
}

template <class T>
DoubleDouble RodSearch::root(const Instant<T>& a, const Instant<T>& b) {
  const double contact = std::sqrt(to_double(rods_.threshold<T>()));
  const T start = a.s + (b.s - a.s) * T(guess_between(a, b, contact));
  const Instant<T> found = refine(a.s, b.s, start);
  if constexpr (std::is_same_v<T, double>) {
    const double enough = std::max(rod_polish_above, accuracy_.root_tolerance);
    const bool is_known = found.error <= enough * found.s * (-found.rate - found.rate_error) &&
                          found.rods.error <= std::max(rod_largest_error, accuracy_.root_tolerance);
    if (is_known) return found.s;
    return refine<DoubleDouble>(a.s, b.s, found.s).s;
  } else {
    return found.s;
  }
}

// Whether rods that touch at s = 0 approach.
bool RodSearch::meets_at_once(const Instant<double>& start) {
  if (start.rate > start.rate_error) return false;
  const Instant<DoubleDouble> fine = rods_.at(DoubleDouble());
  if (fine.excess > fine.error) return false;
  return fine.rate < -rods_.noise_of_rate(start);
}

Contact RodSearch::run(double from, double until) {
  const double end = until * rods_.scale().per_time;
  const double reach = frame().half[0] + frame().half[1] + rods_.distance();
  TimeSpan overlap = sphere_overlap(frame().r, frame().v, reach);
  // Rods whose centres are beyond reach at s = 0 are farther apart than at a contact.
  std::optional<Instant<double>> start;
  if (overlap.begin <= 0 && overlap.end >= 0) {
    start = rods_.at(0.0);
    rods_.begin(*start);
    if (rods_.are_touching() && rods_.overlaps(*start)) return overlap_found();
    if (rods_.are_touching() && from == 0 && rods_.scale().moves && meets_at_once(*start)) {
      return {.found = true, .elapsed = {}, .side = 1};
    }
  }
  if (!rods_.scale().moves) return {};
  if (frame().growth > 0) [[unlikely]]
    overlap = {time_of_comoving(frame(), overlap.begin), time_of_comoving(frame(), overlap.end)};
  last_ = std::min(end, overlap.end * roundup);
  first_ = std::max({0.0, from * rods_.scale().per_time, overlap.begin * (1 - 0x1p-20) - 0x1p-40});
  if (rods_.are_touching() && from == 0) first_ = 0;
  if (!(first_ <= last_)) return {};
  // A contact at the end of an interval belongs to it, so the first ends at first_ or later.
  const double first_begin = std::max(0.0, (std::ceil(first_ / rod_grid) - 1) * rod_grid);
  Instant<double> a = first_begin == 0 && start ? *start : rods_.at(first_begin);
  if (first_begin == 0 && rods_.are_touching()) a = rods_.at(0.0);
  if (first_begin > 0 && rods_.overlaps(a)) return overlap_found();
  for (double s = first_begin; s <= last_; s += rod_grid) {
    if (stretches_.stays_apart_for(a, last_ - s)) return {};
    Instant<double> b = rods_.at(s + rod_grid);
    const auto found = accuracy_.escalation == Escalation::always
                           ? search(rods_.at(DoubleDouble(a.s)), rods_.at(DoubleDouble(b.s)))
                           : search(a, b);
    if (found) return contact_at(rods_, *found, end);
    a = b;
  }
  return {};
}

double RodSearch::time_apart() {
  if (!rods_.scale().moves) return 0;
  Instant<double> start = rods_.at(0.0);
  rods_.begin(start);
  if (!rods_.are_touching()) return 0;
  start.excess = 0;
  double h = rod_grid;
  for (int i = 0; i < rod_tries; ++i, h *= 0.5) {
    const Instant<double> b = rods_.at(h);
    if (!stretches_.stays_above_chord(start, b, 1) &&
        !stretches_.stays_beyond_plane(start, b, true))
      continue;
    // From there on the axes come nearer by no more than this velocity.
    const double apart = b.distance - b.rods.error - rods_.distance();
    return (h + 0.5 * apart / rods_.rates().velocity) * rods_.scale().per_rate;
  }
  return 0;
}

ContactGeometry RodSearch::geometry(const DoubleDouble& elapsed) {
  const DoubleDouble s{elapsed.hi * rods_.scale().per_time, elapsed.lo * rods_.scale().per_time};
  const double grown = 1 + frame().growth * s.hi;
  ContactGeometry out;
  const auto fill = [&](const auto& rods) {
    out.u_first = to_double(rods.u[0]);
    out.u_second = to_double(rods.u[1]);
    out.sin_angle = size_of(to_double(rods.x));
    const Vec3d gap = to_double(rods.gap);
    const double length = size_of(gap);
    out.normal = {gap.x / length, gap.y / length, gap.z / length};
    out.arm_first = to_double(rods.arm[0]) * grown / rods_.scale().per_length;
    out.arm_second = to_double(rods.arm[1]) * grown / rods_.scale().per_length;
  };
  fill(rods_at(frame(), s.hi));
  // Arms lose the digits that |u1 x u2| has lost, and the normal those that the distance has.
  const bool is_rough = !(out.sin_angle > 0x1p-10) || rods_.distance() < 0x1p-10;
  if (is_rough) fill(rods_at(rods_.frame<DoubleDouble>(), s));
  return out;
}

double RodSearch::gap(const DoubleDouble& elapsed) {
  const DoubleDouble s{elapsed.hi * rods_.scale().per_time, elapsed.lo * rods_.scale().per_time};
  const DoubleDouble square = rods_at(rods_.frame<DoubleDouble>(), s).square;
  const double length = std::sqrt(to_double(square)) + rods_.distance();
  return to_double(square - two_prod(rods_.distance(), rods_.distance())) / length *
         (1 + frame().growth * s.hi) / rods_.scale().per_length;
}

}  // namespace

Contact rod_contact(const RodPair& pair, double from, double until, EvaluationCounters& counters,
                    const Accuracy& accuracy) {
  if (are_spheres(pair)) return sphere_contact(pair, until, counters, accuracy);
  const OrderedRods ordered(pair);
  return RodSearch(ordered.pair(), accuracy, counters).run(from, until);
}

ContactGeometry rod_geometry(const RodPair& pair, const DoubleDouble& elapsed) {
  if (are_spheres(pair)) return sphere_geometry(pair, elapsed);
  const OrderedRods ordered(pair);
  EvaluationCounters ignored;
  ContactGeometry out = RodSearch(ordered.pair(), standard_accuracy, ignored).geometry(elapsed);
  if (ordered.is_exchanged()) {
    std::swap(out.u_first, out.u_second);
    std::swap(out.arm_first, out.arm_second);
    out.normal = -out.normal;
  }
  return out;
}

double rod_time_apart(const RodPair& pair) {
  if (are_spheres(pair)) return sphere_time_apart(pair);
  const OrderedRods ordered(pair);
  EvaluationCounters ignored;
  return RodSearch(ordered.pair(), standard_accuracy, ignored).time_apart();
}

double rod_gap(const RodPair& pair, const DoubleDouble& elapsed) {
  const OrderedRods ordered(pair);
  EvaluationCounters ignored;
  return RodSearch(ordered.pair(), standard_accuracy, ignored).gap(elapsed);
}

}  // namespace needlework::kernels
