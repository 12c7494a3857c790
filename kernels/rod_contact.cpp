#include "kernels/rod_contact.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <type_traits>
#include <utility>

#include "kernels/power_of_two.h"
#include "kernels/rod_distance.h"
#include "kernels/sphere_overlap.h"

namespace needlework::kernels {
namespace {

// Interval length in scaled time; a power of two.
constexpr double rod_grid = 0.5;
// Roots in double are refined in double-double where the bound of their error is above this share
// of the time since s = 0, or that of the distance above this share of the reach. The bounds are at
// least three times the error, and fifty times what it is mostly.
constexpr double rod_polish_above = 0x1p-42, rod_largest_error = 0x1p-46;
// Below this share of the pair's speeds, the velocity at which it separates is rounding.
constexpr double rod_velocity_noise = 0x1p-46;
// What the rounding of records may move rods by, as a share of the numbers in them, where the pair
// does not say it.
constexpr double rod_record_noise = 0x1p-46;
// Where rounding is no smaller a share of the curvature than this, an interval goes to
// double-double.
constexpr double rod_least_share = 0x1p-6;
// So often rod_time_apart() halves the time for which it finds the rods to stay apart.
constexpr int rod_tries = 5;
// Spheres that fly apart do not meet again; a time for which all numbers stay finite.
constexpr double rod_time_of_spheres = 0x1p20;

double largest(const Vec3d& a) { return std::max({std::abs(a.x), std::abs(a.y), std::abs(a.z)}); }

PairScale rod_scale_of(const RodPair& pair) {
  PairScale out;
  const double reach = (pair.half_first + pair.half_second) + pair.distance;
  out.per_length = times_power_of_two(1, -exponent_of(reach));
  const Vec3d v = pair.fall ? to_double(falling_velocity(pair)) : pair.first->v - pair.second->v;
  // A tip moves by h w and is accelerated by h w^2.
  const auto rate_of = [&](const Flight& rod, double half) {
    return std::sqrt(half * out.per_length) * rod.omega;
  };
  const double rate = largest(v) * out.per_length + (rate_of(*pair.first, pair.half_first) +
                                                     rate_of(*pair.second, pair.half_second));
  if (!(rate > 0)) return out;
  // Clamped so that both factors are normal numbers.
  const int exponent = std::clamp(exponent_of(rate), -1000, 1000);
  out.moves = true;
  out.per_rate = times_power_of_two(1, -exponent);
  out.per_time = times_power_of_two(1, exponent);
  return out;
}

double size_of(const Vec3d& a) { return std::sqrt(dot(a, a)); }

// The rods in an order that does not depend on which of them is given first.
bool is_in_order(const RodPair& pair) {
  const Flight &a = *pair.first, &b = *pair.second;
  if (pair.half_first != pair.half_second) return pair.half_first > pair.half_second;
  if (a.omega != b.omega) return a.omega > b.omega;
  const double rr_a = dot(a.r, a.r), rr_b = dot(b.r, b.r);
  if (rr_a != rr_b) return rr_a > rr_b;
  for (const auto& [p, q] : {std::pair{&a.r, &b.r}, std::pair{&a.v, &b.v}, std::pair{&a.u, &b.u},
                             std::pair{&a.w, &b.w}}) {
    if (p->x != q->x) return p->x > q->x;
    if (p->y != q->y) return p->y > q->y;
    if (p->z != q->z) return p->z > q->z;
  }
  // Records of equal numbers: only their times may differ.
  return !(pair.elapsed_first.hi < pair.elapsed_second.hi);
}

RodPair exchanged(RodPair pair) {
  std::swap(pair.first, pair.second);
  std::swap(pair.elapsed_first, pair.elapsed_second);
  std::swap(pair.half_first, pair.half_second);
  pair.shift = -pair.shift;
  if (pair.fall) pair.fall = Fall{-pair.fall->velocity, -pair.fall->place};
  return pair;
}

// A pair whose rods are in order.
class Ordered {
 public:
  explicit Ordered(const RodPair& pair) : pair_(&pair) {
    if (!is_in_order(pair)) pair_ = &other_.emplace(exchanged(pair));
  }
  Ordered(const Ordered&) = delete;
  Ordered& operator=(const Ordered&) = delete;

  const RodPair& pair() const { return *pair_; }
  bool is_exchanged() const { return other_.has_value(); }

 private:
  std::optional<RodPair> other_;
  const RodPair* pair_;
};

// How far rounding of the records may have moved the rods [L].
double allowance_of(const RodPair& pair) {
  if (pair.touch_within > 0) return pair.touch_within;
  return rod_record_noise *
         (((size_of(pair.first->r) + size_of(pair.second->r)) + size_of(to_double(pair.shift))) +
          (size_of(pair.first->v) * pair.elapsed_first.hi +
           size_of(pair.second->v) * pair.elapsed_second.hi) +
          ((pair.half_first + pair.half_second) + pair.distance));
}

// The rods at one time, and the square of their distance less that at contact.
template <class T>
struct Instant {
  T s;
  RodSample<T> rods;
  double distance;
  double excess, error;
  double rate;   // of the excess
  double speed;  // of a point of one axis relative to one of the other, not below
};

Contact overlap_found() {
  return {.found = true, .unresolvable = true, .overlap = true, .elapsed = {}, .side = 1};
}

class RodSearch {
 public:
  RodSearch(const RodPair& pair, const Accuracy& accuracy, EvaluationCounters& counters)
      : pair_(pair),
        scale_(rod_scale_of(pair)),
        accuracy_(accuracy),
        counters_(counters),
        frame_(make_frame<double>(pair, scale_)),
        rates_(rod_rates(frame_)),
        distance_(pair.distance * scale_.per_length),
        threshold_(distance_ * distance_),
        threshold_error_(unit_roundoff<double> * threshold_) {}

  Contact run(double from, double until);
  double time_apart();
  ContactGeometry geometry(const DoubleDouble& elapsed);
  double gap(const DoubleDouble& elapsed);

 private:
  template <class T>
  const Frame<T>& frame();
  /// Square of the distance at which contact is.
  template <class T>
  T threshold();
  template <class T>
  Instant<T> at(const T& s);

  Contact result(const DoubleDouble& root, double end);
  bool returns_by_rounding(const DoubleDouble& root);
  // A rate of the excess at s = 0 that rounding of the velocities and of the normal may explain.
  double noise_of_rate(const Instant<double>& start) const {
    return 2 * rates_.velocity * (rod_velocity_noise * start.distance + start.rods.error);
  }
  void begin(const Instant<double>& start);
  bool meets_at_once(const Instant<double>& start);
  bool overlaps(const Instant<double>& at) const;
  Contact run_spheres(double end);
  template <class T>
  bool solve(std::optional<DoubleDouble>& root);

  double largest_speed(const Vec3d& first_turn, const Vec3d& second_turn) const;
  // The second derivative of the square of the distance is not above this where the speed and the
  // distance are not.
  double curvature(double speed, double distance) const {
    return 2 * (speed * speed + distance * rates_.acceleration) * roundup;
  }
  // Speeds and distances between a and b are not above these.
  template <class T>
  double speed_between(const Instant<T>& a, const Instant<T>& b) const {
    return 0.5 * ((a.speed + b.speed) + rates_.acceleration * std::abs(to_double(b.s - a.s)));
  }
  template <class T>
  bool starts_at(const Instant<T>& a) const {
    return touching_ && to_double(a.s) == 0 &&
           !(std::is_same_v<T, DoubleDouble> && a.excess > a.error);
  }
  template <class T>
  bool stays_above_chord(const Instant<T>& a, const Instant<T>& b, double noise) const;
  template <class T>
  bool stays_beyond_plane(const Instant<T>& a, const Instant<T>& b, bool starts);
  bool stays_apart_for(const Instant<double>& a, double h) const;
  template <class T>
  bool falls(const Instant<T>& a, const Instant<T>& b) const;
  template <class T>
  bool is_below(const Instant<T>& a);
  template <class T>
  bool is_limited_by_rounding(const Instant<T>& a, const Instant<T>& b) const;

  template <class T>
  std::optional<DoubleDouble> search(const Instant<T>& a, const Instant<T>& b);
  template <class T>
  DoubleDouble root(const Instant<T>& a, const Instant<T>& b);
  template <class T>
  double guess_between(const Instant<T>& a, const Instant<T>& b, double contact) const;
  template <class T>
  Instant<T> refine(const T& begin, const T& end, const T& start);

  const RodPair& pair_;
  PairScale scale_;
  const Accuracy& accuracy_;
  EvaluationCounters& counters_;
  Frame<double> frame_;
  RodRates rates_;
  std::optional<Frame<DoubleDouble>> precise_frame_;
  double distance_;
  double threshold_, threshold_error_;
  std::optional<DoubleDouble> precise_threshold_;
  bool touching_ = false;  // at s = 0, to within rounding
  double first_ = 0, last_ = 0;
};

template <class T>
const Frame<T>& RodSearch::frame() {
  if constexpr (std::is_same_v<T, double>) {
    return frame_;
  } else {
    if (!precise_frame_) precise_frame_ = make_frame<DoubleDouble>(pair_, scale_);
    return *precise_frame_;
  }
}

template <class T>
T RodSearch::threshold() {
  if constexpr (std::is_same_v<T, double>) {
    return threshold_;
  } else {
    if (!precise_threshold_) {
      precise_threshold_ = two_prod(distance_, distance_);
      if (touching_) {
        ++counters_.escalated;
        const DoubleDouble now = rods_at(frame<DoubleDouble>(), DoubleDouble()).square;
        if (to_double(now - *precise_threshold_) < 0) precise_threshold_ = now;
      }
    }
    return *precise_threshold_;
  }
}

template <class T>
Instant<T> RodSearch::at(const T& s) {
  ++(std::is_same_v<T, double> ? counters_.evaluated : counters_.escalated);
  Instant<T> out;
  out.s = s;
  out.rods = rods_at(frame<T>(), s);
  const double square = to_double(out.rods.square);
  out.distance = std::sqrt(square);
  out.excess = to_double(out.rods.square - threshold<T>());
  const double length = out.rods.error;
  out.error = (2 * out.distance + length) * length + 4 * unit_roundoff<T> * square;
  if constexpr (std::is_same_v<T, double>) out.error += threshold_error_;
  out.rate = to_double(out.rods.rate);
  out.speed = largest_speed(to_double(out.rods.turn[0]), to_double(out.rods.turn[1]));
  return out;
}

// That of two tips, since the velocity is linear in the places on both axes.
double RodSearch::largest_speed(const Vec3d& first_turn, const Vec3d& second_turn) const {
  const Vec3d v = to_double(frame_.v);
  const double half0 = frame_.half[0], half1 = frame_.half[1];
  const double v0 = half0 * dot(v, first_turn), v1 = half1 * dot(v, second_turn),
               both = half0 * half1 * dot(first_turn, second_turn);
  const double most = std::max(std::abs(v0 + v1) + both, std::abs(v0 - v1) - both);
  return std::sqrt((rates_.squares + 2 * most) * roundup);
}

// Whether the excess stays above 0 between a and b, for the chord and the curvature. `noise` times
// the errors is taken off. Where the pair touches at a, it must leave 0 for good.
template <class T>
bool RodSearch::stays_above_chord(const Instant<T>& a, const Instant<T>& b, double noise) const {
  const double h = to_double(b.s - a.s);
  const double speed = speed_between(a, b);
  const double c = curvature(speed, 0.5 * (a.distance + b.distance + speed * h));
  const double after = b.excess - noise * b.error;
  if (starts_at(a)) return after > 0.5 * c * h * h;
  const double before = a.excess - noise * a.error;
  if (!(before > 0 && after > 0)) return false;
  // before + slope t + c t^2 / 2
  const double slope = (after - before) / h - 0.5 * c * h;
  if (slope >= 0 || slope + c * h <= 0) return true;
  return 2 * c * before > slope * slope * roundup;
}

// Whether the rods stay apart between a and b, for the plane through the nearest points at a. The
// distance is not below n . r - half1 |n . u1| - half2 |n . u2| for any unit vector n, in which r
// is linear and each n . u departs from its chord by no more than its second derivative allows.
template <class T>
bool RodSearch::stays_beyond_plane(const Instant<T>& a, const Instant<T>& b, bool starts) {
  if (!(a.distance > 0)) return false;
  T length, contact;
  if constexpr (std::is_same_v<T, double>) {
    length = a.distance;
    contact = std::sqrt(threshold_ + threshold_error_) * roundup;
  } else {
    length = sqrt(a.rods.square);
    contact = sqrt(threshold<T>());
  }
  const T per_length = T(1.0) / length;
  const Vec3<T> n = a.rods.gap * per_length;
  T beyond = dot(n, b.rods.r) - contact;
  double bend = 0;
  for (int i = 0; i < 2; ++i) {
    const double half = frame_.half[i];
    const T along = dot(n, b.rods.u[i]);
    beyond = beyond - (to_double(along) < 0 ? -along : along) * T(half);
    const double omega = frame_.omega[i];
    const double cosine = omega * to_double(dot(n, a.rods.u[i])),
                 sine = to_double(dot(n, a.rods.turn[i]));
    bend += half * omega * std::sqrt(cosine * cosine + sine * sine);
  }
  const double h = to_double(b.s - a.s);
  const double error = 2 * (a.rods.error + b.rods.error);
  // What double-double does not tell from a touch is none of the contacts.
  const double noise = std::is_same_v<T, double> ? error : -error;
  if (starts) return to_double(beyond) - error > 0.5 * bend * h * h * roundup;
  const double least = std::min(to_double(length - contact), to_double(beyond));
  return least - noise > 0.125 * bend * h * h * roundup;
}

// Whether the rods stay apart for a time h from a on, for the plane through the nearest points at
// a.
bool RodSearch::stays_apart_for(const Instant<double>& a, double h) const {
  if (!(a.excess > a.error)) return false;
  const Vec3d n = a.rods.gap * (1 / a.distance);
  double beyond = dot(n, a.rods.r) + dot(n, frame_.v) * h, bend = 0;
  for (int i = 0; i < 2; ++i) {
    const double half = frame_.half[i], omega = frame_.omega[i];
    const double along = dot(n, a.rods.u[i]), turn = dot(n, a.rods.turn[i]);
    beyond -= half * std::abs(along + turn * h);
    bend += half * omega * std::sqrt(omega * along * (omega * along) + turn * turn);
  }
  const double noise = 0x1p-40 * (frame_.r_norm + rates_.velocity * (std::abs(a.s) + h));
  return beyond - 0.5 * bend * h * h * roundup > distance_ * roundup + 4 * a.rods.error + noise;
}

// Whether the distance falls throughout from a to b.
template <class T>
bool RodSearch::falls(const Instant<T>& a, const Instant<T>& b) const {
  return 0.75 * a.rate + curvature(speed_between(a, b), a.distance) * to_double(b.s - a.s) < 0;
}

template <class T>
bool RodSearch::is_below(const Instant<T>& a) {
  if (std::abs(a.excess) > a.error) return a.excess < 0;
  if constexpr (std::is_same_v<T, double>) return is_below(at(DoubleDouble(a.s)));
  return false;  // a touch, as far as double-double can tell
}

template <class T>
bool RodSearch::is_limited_by_rounding(const Instant<T>& a, const Instant<T>& b) const {
  const double h = to_double(b.s - a.s), error = std::max(a.error, b.error);
  const double bend =
      0.125 * curvature(speed_between(a, b), std::max(a.distance, b.distance)) * h * h;
  if (rod_least_share * bend < error) return true;
  const double enough = 1 / rod_least_share;
  return std::abs(a.excess) < enough * a.error && std::abs(b.excess) < enough * b.error;
}

// The first contact between a and b. The pair is not in contact at a, or touches there as its
// records have it.
template <class T>
std::optional<DoubleDouble> RodSearch::search(const Instant<T>& a, const Instant<T>& b) {
  const double begin = to_double(a.s), end = to_double(b.s), h = end - begin;
  if (end < first_ || begin > last_) return std::nullopt;
  constexpr bool is_double = std::is_same_v<T, double>;
  const bool starts = starts_at(a);
  if (stays_above_chord(a, b, is_double || starts ? 1 : -2)) return std::nullopt;
  const bool below = is_below(b);
  if (!starts && falls(a, b)) {
    if (!below) return std::nullopt;
    return root(a, b);
  }
  if (!below &&
      (stays_beyond_plane(a, b, starts) || (!starts && stays_beyond_plane(b, a, false)))) {
    return std::nullopt;
  }
  if (counters_.is_spent()) return std::nullopt;
  if constexpr (is_double) {
    if (is_limited_by_rounding(a, b)) return search(at(DoubleDouble(begin)), at(DoubleDouble(end)));
  }
  const double middle = begin + 0.5 * h;
  const double most = a.distance + b.distance + rates_.velocity * h;
  const bool is_last =
      middle == begin || middle == end || (!is_double && 2 * most * rates_.velocity * h <= a.error);
  if (is_last) {
    if (!below) return std::nullopt;
    // It comes back before it has left.
    if (starts) return DoubleDouble();
    return root(a, b);
  }
  const Instant<T> m = at(T(middle));
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
  const double contact = std::sqrt(to_double(threshold<T>()));
  T low = begin, high = end, s = start;
  Instant<T> now;
  for (int i = 0; i < 200; ++i) {
    now = at(s);
    (now.excess > 0 ? low : high) = s;
    // The length of the gap is nearer to linear than its square.
    const double step = -now.excess / (now.distance + contact) * (2 * now.distance / now.rate);
    const T next = s + T(step);
    const bool is_inside =
        now.rate < 0 && to_double(next - begin) >= 0 && to_double(end - next) >= 0;
    // What the step leaves is of second order. Downwards, the distance bends as fast as the nearest
    // points slide along the axes, which grows as rods become parallel.
    const double slide = now.speed + now.distance * frame_.w_sum;
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
  const double contact = std::sqrt(to_double(threshold<T>()));
  const T start = a.s + (b.s - a.s) * T(guess_between(a, b, contact));
  const Instant<T> found = refine(a.s, b.s, start);
  if constexpr (std::is_same_v<T, double>) {
    const double enough = std::max(rod_polish_above, accuracy_.root_tolerance);
    const bool is_known = found.error <= enough * found.s * -found.rate &&
                          found.rods.error <= std::max(rod_largest_error, accuracy_.root_tolerance);
    if (is_known) return found.s;
    return refine<DoubleDouble>(a.s, b.s, found.s).s;
  } else {
    return found.s;
  }
}

bool RodSearch::overlaps(const Instant<double>& at) const {
  return distance_ - at.distance > allowance_of(pair_) * scale_.per_length + at.rods.error;
}

// Where the rods touch at s = 0 to within rounding, the distance at contact may be the one that
// they have then.
void RodSearch::begin(const Instant<double>& start) {
  touching_ = start.excess <= start.error;
  if (!touching_) return;
  threshold_ = std::min(threshold_, to_double(start.rods.square));
  threshold_error_ += start.error;
}

// Whether rods that touch at s = 0 approach.
bool RodSearch::meets_at_once(const Instant<double>& start) {
  const double v = rates_.velocity;
  const double x = size_of(start.rods.x);
  // The arms are off by rounding divided by |x|.
  const double arms = 0x1p-49 * (frame_.r_norm + frame_.half[0] + frame_.half[1]) / x;
  const double error =
      2 * v * start.rods.error + 2 * start.distance * (0x1p-48 * v + frame_.w_sum * arms);
  if (start.rate > 2 * error) return false;
  const Instant<DoubleDouble> fine = at(DoubleDouble());
  if (fine.excess > fine.error) return false;
  return fine.rate < -noise_of_rate(start);
}

Contact RodSearch::result(const DoubleDouble& root, double end) {
  if (root.hi > end) return {};
  return {.found = true,
          .unresolvable = pair_.touch.collided && returns_by_rounding(root),
          .elapsed = {root.hi * scale_.per_rate, root.lo * scale_.per_rate},
          .side = 1};
}

// Whether rods that have just collided part with no more velocity than rounding may have left them,
// and meet again with no more than they gain over the gap that it may have left.
bool RodSearch::returns_by_rounding(const DoubleDouble& root) {
  if (root.hi == 0) return true;
  const Instant<double> start = at(0.0);
  const double noise = 4 * noise_of_rate(start);
  if (start.rate > 4 * noise || at(DoubleDouble()).rate > noise) return false;
  const double gained = 64 * curvature(start.speed, start.distance) * start.error;
  const double rate = at(root).rate;
  return rate * rate <= noise * noise + gained;
}

Contact RodSearch::run(double from, double until) {
  const double end = until * scale_.per_time;
  const double reach = frame_.half[0] + frame_.half[1] + distance_;
  const bool spheres = frame_.half[0] == 0 && frame_.half[1] == 0;
  if (spheres) return run_spheres(end);
  const TimeSpan overlap = sphere_overlap(frame_.r, frame_.v, reach);
  // Rods whose centres are beyond reach at s = 0 are farther apart than at a contact.
  std::optional<Instant<double>> start;
  if (overlap.begin <= 0 && overlap.end >= 0) {
    start = at(0.0);
    begin(*start);
    if (touching_ && overlaps(*start)) return overlap_found();
    if (touching_ && from == 0 && scale_.moves && meets_at_once(*start)) {
      return {.found = true, .elapsed = {}, .side = 1};
    }
  }
  if (!scale_.moves) return {};
  last_ = std::min(end, overlap.end * roundup);
  first_ = std::max({0.0, from * scale_.per_time, overlap.begin * (1 - 0x1p-20) - 0x1p-40});
  if (touching_ && from == 0) first_ = 0;
  if (!(first_ <= last_)) return {};
  // A contact at the end of an interval belongs to it, so the first ends at first_ or later.
  const double first_begin = std::max(0.0, (std::ceil(first_ / rod_grid) - 1) * rod_grid);
  Instant<double> a = first_begin == 0 && start ? *start : at(first_begin);
  if (first_begin == 0 && touching_) a = at(0.0);
  if (first_begin > 0 && overlaps(a)) return overlap_found();
  for (double s = first_begin; s <= last_; s += rod_grid) {
    if (stays_apart_for(a, last_ - s)) return {};
    Instant<double> b = at(s + rod_grid);
    const auto found = accuracy_.escalation == Escalation::always
                           ? search(at(DoubleDouble(a.s)), at(DoubleDouble(b.s)))
                           : search(a, b);
    if (found) return result(*found, end);
    a = b;
  }
  return {};
}

// The first root of |r + v s|^2 = distance^2, for spheres that approach; whether its error and that
// of the decision that there is one are bounded well enough.
template <class T>
bool RodSearch::solve(std::optional<DoubleDouble>& root) {
  using std::sqrt;
  constexpr bool is_double = std::is_same_v<T, double>;
  ++(is_double ? counters_.evaluated : counters_.escalated);
  const Frame<T>& spheres = frame<T>();
  const Vec3<T>&r = spheres.r, &v = spheres.v, n = cross(r, v);
  const T contact = threshold<T>(), vv = dot(v, v);
  const T excess = dot(r, r) - contact, d = contact * vv - dot(n, n);
  const double size = to_double(dot(r, r)) + to_double(contact);
  const double error = 16 * unit_roundoff<T> * size + (is_double ? threshold_error_ : 0);
  const double error_d = error * to_double(vv);
  // What double-double does not tell from a touch is one.
  if (!(to_double(d) > (is_double ? -error_d : error_d))) return true;
  const T s = excess / (sqrt(d) - dot(r, v));
  root = DoubleDouble(s);
  return error <= rod_polish_above * to_double(excess) &&
         error_d <= rod_polish_above * to_double(d);
}

Contact RodSearch::run_spheres(double end) {
  const double rr = dot(frame_.r, frame_.r);
  const double error = 16 * unit_roundoff<double> * (rr + threshold_);
  if (!(rr - threshold_ > error)) {
    const Instant<double> start = at(0.0);
    begin(start);
    if (touching_ && overlaps(start)) return overlap_found();
    if (touching_ && start.rate < 0) {
      const Instant<DoubleDouble> fine = at(DoubleDouble());
      if (!(fine.excess > fine.error)) {
        // They fly along a line, so that a velocity which is rounding takes them no deeper.
        if (!(fine.rate < -noise_of_rate(start))) return {};
        return {.found = true, .elapsed = {}, .side = 1};
      }
    }
  }
  if (!(dot(frame_.r, frame_.v) < 0)) return {};
  std::optional<DoubleDouble> root;
  const bool always = accuracy_.escalation == Escalation::always;
  if (always || !solve<double>(root)) {
    root.reset();
    solve<DoubleDouble>(root);
  }
  return root ? result(*root, end) : Contact{};
}

double RodSearch::time_apart() {
  if (!scale_.moves) return 0;
  Instant<double> start = at(0.0);
  begin(start);
  if (frame_.half[0] == 0 && frame_.half[1] == 0) {
    return start.rate > 0 ? rod_time_of_spheres * scale_.per_rate : 0;
  }
  if (!touching_) return 0;
  start.excess = 0;
  double h = rod_grid;
  for (int i = 0; i < rod_tries; ++i, h *= 0.5) {
    const Instant<double> b = at(h);
    if (!stays_above_chord(start, b, 1) && !stays_beyond_plane(start, b, true)) continue;
    // From there on the axes come nearer by no more than this velocity.
    const double apart = b.distance - b.rods.error - distance_;
    return (h + 0.5 * apart / rates_.velocity) * scale_.per_rate;
  }
  return 0;
}

ContactGeometry RodSearch::geometry(const DoubleDouble& elapsed) {
  const DoubleDouble s{elapsed.hi * scale_.per_time, elapsed.lo * scale_.per_time};
  ContactGeometry out;
  const auto fill = [&](const auto& rods) {
    out.u_first = to_double(rods.u[0]);
    out.u_second = to_double(rods.u[1]);
    out.sin_angle = size_of(to_double(rods.x));
    const Vec3d gap = to_double(rods.gap);
    const double length = size_of(gap);
    out.normal = {gap.x / length, gap.y / length, gap.z / length};
    out.arm_first = to_double(rods.arm[0]) / scale_.per_length;
    out.arm_second = to_double(rods.arm[1]) / scale_.per_length;
  };
  fill(rods_at(frame_, s.hi));
  const bool spheres = frame_.half[0] == 0 && frame_.half[1] == 0;
  // Arms lose the digits that |u1 x u2| has lost, and the normal those that the distance has.
  const bool is_rough = (!spheres && !(out.sin_angle > 0x1p-10)) || distance_ < 0x1p-10;
  if (is_rough) fill(rods_at(frame<DoubleDouble>(), s));
  return out;
}

double RodSearch::gap(const DoubleDouble& elapsed) {
  const DoubleDouble s{elapsed.hi * scale_.per_time, elapsed.lo * scale_.per_time};
  const DoubleDouble square = rods_at(frame<DoubleDouble>(), s).square;
  const double length = std::sqrt(to_double(square)) + distance_;
  return to_double(square - two_prod(distance_, distance_)) / length / scale_.per_length;
}

}  // namespace

Contact rod_contact(const RodPair& pair, double from, double until, EvaluationCounters& counters,
                    const Accuracy& accuracy) {
  const Ordered ordered(pair);
  return RodSearch(ordered.pair(), accuracy, counters).run(from, until);
}

ContactGeometry rod_geometry(const RodPair& pair, const DoubleDouble& elapsed) {
  const Ordered ordered(pair);
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
  const Ordered ordered(pair);
  EvaluationCounters ignored;
  return RodSearch(ordered.pair(), standard_accuracy, ignored).time_apart();
}

double rod_gap(const RodPair& pair, const DoubleDouble& elapsed) {
  const Ordered ordered(pair);
  EvaluationCounters ignored;
  return RodSearch(ordered.pair(), standard_accuracy, ignored).gap(elapsed);
}

}  // namespace needlework::kernels
