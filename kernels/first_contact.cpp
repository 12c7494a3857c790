#include "kernels/first_contact.h"

#include <algorithm>
#include <optional>

#include "kernels/closest_approach.h"
#include "kernels/sphere_overlap.h"
#include "kernels/stretches.h"

namespace needlework::kernels {
namespace {

// Interval length in scaled time; a power of two. Longer ones are halved more often than they save.
constexpr double grid = 0.5;
// Roots whose double value may be off by more than this share of the time since s = 0 are refined
// in double-double.
constexpr double polish_above = 0x1p-39;
// Below this share of the pair's speeds, the velocity at which it separates is rounding.
constexpr double velocity_noise = 0x1p-46;
// Segments farther apart, in scaled lengths, do not touch, however small f is; far above what
// rounding does to them, and below the margins of the SIMD filters.
constexpr double touching = 0x1p-18;

// Pairs that rise by less after a collision, in scaled lengths, are left to double precision.
constexpr double least_rise = 0x1p-8;

struct Root {
  DoubleDouble s;
  int side;  // sign of f before
};

// Finds the first root that is a contact. How intervals are proved free of roots and when precision
// escalates are chosen at compile time, so that the code contains nothing that only the others
// need.
template <Isolation isolation, Escalation escalation>
class RootFinder {
 public:
  RootFinder(const Pair& pair, const PairScale& scale, const Accuracy& accuracy,
             EvaluationCounters& counters)
      : accuracy_(accuracy), values_(pair, scale, counters), stretches_(values_) {}

  Contact run(double from, double until);

 private:
  int sign_at_end(const Interval& interval, const Estimate& e, double end);
  int side_before_root(const Interval& interval, const Estimate& e, double least_slope);

  std::optional<Root> search_samples(const Interval& interval);
  std::optional<Root> search_interval(const Interval& interval);
  std::optional<Root> search_fold(const Interval& interval, const Estimate& e);
  std::optional<Root> search_start(const Interval& interval, const Estimate& e);
  std::optional<Root> search_flat_start(const Interval& interval);
  std::optional<Root> accept(double begin, double end, double start, int side,
                             double least_slope = 0);
  std::optional<Root> accept_precisely(const DoubleDouble& begin, const DoubleDouble& end,
                                       const DoubleDouble& start, int side);

  template <class T>
  struct Refined {
    T root;
    T near;            // where it was last evaluated
    Sample<T> sample;  // there
    Estimate estimate;
  };
  template <class T>
  std::optional<Refined<T>> refine(T begin, T end, T start, int side, double least_slope);

  static constexpr bool escalates = ContactValues<escalation>::escalates;
  // Halving ends here: f, f' and f'' all vanish to the precision there is, and only the signs at
  // the ends decide.
  static constexpr int last_depth = escalates ? 44 : 12;

  const Accuracy& accuracy_;
  ContactValues<escalation> values_;
  Stretches<isolation, escalation> stretches_;
  double first_ = 0, last_ = 0;  // only roots between these can be contacts
};

// Sign of f just after an end of the interval that was classified by e. The expansion of e often
// decides it.
template <Isolation isolation, Escalation escalation>
int RootFinder<isolation, escalation>::sign_at_end(const Interval& interval, const Estimate& e,
                                                   double end) {
  const bool carried = end == 0 && values_.pair().touch.touching;
  if (escalation != Escalation::always && !carried) {
    const Estimate there =
        expanded(e, end - interval.middle(), stretches_.third_derivative_bound(e, interval));
    if (std::abs(there.f) > there.error_f) return sign_of(there.f);
  }
  return values_.sign_at(end);
}

// The sign of f at the beginning of an interval on which |f'| is at least `least_slope`, when f has
// a root there; else 0. The values in the middle often decide both.
template <Isolation isolation, Escalation escalation>
int RootFinder<isolation, escalation>::side_before_root(const Interval& interval, const Estimate& e,
                                                        double least_slope) {
  const int slope = sign_of(e.df);
  const bool carried = interval.begin == 0 && values_.pair().touch.touching;
  if (carried || !(std::abs(e.f) > e.error_f)) {
    const int before = values_.sign_at(interval.begin), after = values_.sign_at(interval.end);
    return before == -after ? before : 0;
  }
  const bool rooted = least_slope * interval.half() > (std::abs(e.f) + e.error_f) * roundup;
  if (rooted) return -slope;
  const bool in_first_half = sign_of(e.f) == slope;
  const int outer = sign_at_end(interval, e, in_first_half ? interval.begin : interval.end);
  return outer == (in_first_half ? -slope : slope) ? -slope : 0;
}

// Halley's iteration, safeguarded. f has the sign `side` at `begin` and the other at `end`; where f
// is monotone, |f'| is at least `least_slope` between them, else that is 0. Stops where the
// rounding error of T takes over, or, with nothing, as soon as the root is known to have an arm
// beyond a tip.
template <Isolation isolation, Escalation escalation>
template <class T>
auto RootFinder<isolation, escalation>::refine(T begin, T end, T start, int side,
                                               double least_slope) -> std::optional<Refined<T>> {
  const double share =
      std::is_same_v<T, double> ? std::max(0x1p-52, accuracy_.root_tolerance) : 0x1p-98;
  std::optional<Refined<T>> out(std::in_place);
  T& s = out->root;
  s = start;
  for (int i = 0; i < 200; ++i) {
    out->near = s;
    const Sample<T>& sample = out->sample = values_.sample_at(s);
    const Estimate& e = out->estimate = values_.estimate_of(s, sample);
    if (e.f == 0) break;
    if (i == 1 && least_slope > 0) {
      if (values_.arms_inside(s, sample, (std::abs(e.f) + e.error_f) / least_slope) < 0)
        return std::nullopt;
    }
    const T next = s - sample.f / (sample.df - sample.f * sample.ddf / (sample.df + sample.df));
    const bool last = std::abs(e.f) <= (escalates ? e.error_f : noise_in_double * e.distance);
    if (last) {
      if (to_double(next - begin) >= 0 && to_double(end - next) >= 0) s = next;
      break;
    }
    (sign_of(e.f) == side ? begin : end) = s;
    const bool within = to_double(next - begin) > 0 && to_double(end - next) > 0;
    // A root may be among the least of numbers, a thousand halvings from here.
    const T target = within ? next : begin + (end - begin) * T(i < 60 ? 0.5 : 0x1p-32);
    const double step = std::abs(to_double(target - s));
    s = target;
    const double size = share * std::abs(to_double(s));
    if (step <= size || to_double(end - begin) <= size) break;
  }
  return out;
}

// The root between begin and end, when it is a contact.
template <Isolation isolation, Escalation escalation>
std::optional<Root> RootFinder<isolation, escalation>::accept(double begin, double end,
                                                              double start, int side,
                                                              double least_slope) {
  const auto refined = refine(begin, end, start, side, least_slope);
  if (!refined) return std::nullopt;
  const auto& [s, near, sample, e] = *refined;
  const double off = values_.root_uncertainty(e, near, 0x1p-53);
  if constexpr (!escalates) {
    // Where the last step was more than rounding, the arms are those after it.
    const bool moved = std::abs(s - near) > 0x1p-50 * s;
    const int inside = moved ? values_.arms_inside(s, values_.sample_at(s), 0)
                             : values_.arms_inside(near, sample, 0);
    if (inside < 0) return std::nullopt;
    return Root{s, side};
  }
  const int inside = std::isfinite(off) ? values_.arms_inside(near, sample, off) : 0;
  if (inside < 0) return std::nullopt;
  const double enough = std::max(polish_above, accuracy_.root_tolerance);
  const bool known = escalation == Escalation::undecided && inside > 0 && off <= enough * s;
  if (known) return Root{s, side};
  return accept_precisely(DoubleDouble(begin), DoubleDouble(end), DoubleDouble(s), side);
}

template <Isolation isolation, Escalation escalation>
std::optional<Root> RootFinder<isolation, escalation>::accept_precisely(const DoubleDouble& begin,
                                                                        const DoubleDouble& end,
                                                                        const DoubleDouble& start,
                                                                        int side) {
  if constexpr (!escalates) return accept(begin.hi, end.hi, start.hi, side);
  const auto [s, near, sample, e] = *refine(begin, end, start, side, 0);
  const double off = values_.root_uncertainty(e, to_double(near), 0x1p-102);
  // What double-double cannot distinguish from a tip or from parallel directors is no contact.
  if (!std::isfinite(off) || values_.arms_inside(near, sample, off) <= 0) return std::nullopt;
  return Root{s, side};
}

// f'' keeps its sign on the interval.
template <Isolation isolation, Escalation escalation>
std::optional<Root> RootFinder<isolation, escalation>::search_fold(const Interval& interval,
                                                                   const Estimate& e) {
  const int before = sign_at_end(interval, e, interval.begin),
            after = sign_at_end(interval, e, interval.end);
  const int bend = sign_of(e.ddf);
  if (before == 0 || after == 0) return std::nullopt;
  if (before != after) {
    // From the end where f and f'' have one sign, steps go towards the root.
    return accept(interval.begin, interval.end, before == bend ? interval.begin : interval.end,
                  before);
  }
  if (before != bend) return std::nullopt;  // f is concave seen from its side
  if (values_.slope_sign_at(interval.begin) != -bend ||
      values_.slope_sign_at(interval.end) != bend) {
    return std::nullopt;
  }
  // The extremum: Newton's iteration on f'.
  double begin = interval.begin, end = interval.end, s = interval.middle();
  for (int i = 0; i < 60; ++i) {
    const Estimate here = values_.in_double(s);
    if (escalates && std::abs(here.df) <= here.error_df) break;
    (sign_of(here.df) == -bend ? begin : end) = s;
    double next = s - here.df / here.ddf;
    if (!(next > begin && next < end)) next = begin + 0.5 * (end - begin);
    const bool done = std::abs(next - s) <= 0x1p-50 * std::abs(s);
    s = next;
    if (done) break;
  }
  const double bend_at_least = stretches_.least_bend(e, interval);
  Estimate extreme = values_.in_double(s);
  const auto clear = [&] {
    const double slope = std::abs(extreme.df) + extreme.error_df;
    return std::abs(extreme.f) > extreme.error_f + slope * slope / bend_at_least * roundup;
  };
  DoubleDouble turn = s;
  if (escalates && !clear()) {
    for (int i = 0; i < 3; ++i) {
      const Sample<DoubleDouble> sample = values_.sample_at(turn);
      turn = turn - sample.df / sample.ddf;
    }
    extreme = values_.in_double_double(turn);
    if (!clear()) return std::nullopt;  // a touch, as far as double-double can decide
  }
  if (sign_of(extreme.f) == before) return std::nullopt;
  const DoubleDouble from = interval.begin, to = interval.end;
  if (auto first = accept_precisely(from, turn, from, before)) return first;
  return accept_precisely(turn, to, to, -before);
}

// The interval that begins where the pair has just collided: f(0) = 0 is known and f does not
// approach there. Only called where f'' keeps its sign or f' does.
template <Isolation isolation, Escalation escalation>
std::optional<Root> RootFinder<isolation, escalation>::search_start(const Interval& interval,
                                                                    const Estimate& e) {
  const int side = values_.pair().touch.side, after = sign_at_end(interval, e, interval.end);
  if (after == side || after == 0) return std::nullopt;
  if (sign_of(e.ddf) == side) return std::nullopt;
  // f rises from 0, bends back and has passed 0 by the end. Until half of the least time of return
  // it is surely above.
  Estimate start = values_.in_double(0);
  if (escalates && !(start.df * side > 0x1p10 * start.error_df)) {
    const Sample<DoubleDouble> sample = values_.sample_at(DoubleDouble());
    start = values_.estimate_of(DoubleDouble(), sample);
    // Velocities in double leave f' uncertain by a few roundings of |u1 x u2| times the speeds.
    const double noise = std::sqrt(to_double(dot(sample.x, sample.x))) * velocity_noise *
                         (values_.frame().v_norm + values_.frame().w_sum);
    if (!(start.df * side > noise)) return Root{0.0, side};
  }
  if (!escalates && !(start.df * side > 0)) return Root{0.0, side};
  const double slope = (start.df * side) * (1 - 0x1p-9);
  const double lift = slope / stretches_.most_bend(e, interval);
  // The parabola's return is a good start for short bounces.
  const double bend = -start.ddf * side;
  const double back = bend > 0 ? std::clamp(2 * slope / bend, lift, interval.end) : interval.end;
  return accept(lift, interval.end, back, side);
}

// The interval that begins at a touch, where f cannot be distinguished from 0: f leaves it on one
// side, which need not be the pair's. f' and f'' vanish too when the contact points of rough
// needles have come to rest on each other.
template <Isolation isolation, Escalation escalation>
std::optional<Root> RootFinder<isolation, escalation>::search_flat_start(const Interval& interval) {
  const int side = values_.pair().touch.side;
  if (side == 0 || values_.sign_at(interval.end) != -side) return std::nullopt;
  return Root{0.0, side};
}

// Looks only at the signs at equal steps.
template <Isolation isolation, Escalation escalation>
std::optional<Root> RootFinder<isolation, escalation>::search_samples(const Interval& interval) {
  const double length = interval.end - interval.begin;
  const double steps = std::max(1.0, std::ceil(length / accuracy_.sampling_step));
  double begin = interval.begin;
  int before = values_.sign_at(begin);
  for (double n = 1; n <= steps; ++n) {
    const double end = interval.begin + length * (n / steps);
    const int after = values_.sign_at(end);
    if (before == -after && after != 0) {
      const auto root = accept(begin, end, begin + 0.5 * (end - begin), before);
      if (root) return root;
    }
    begin = end;
    before = after;
  }
  return std::nullopt;
}

template <Isolation isolation, Escalation escalation>
std::optional<Root> RootFinder<isolation, escalation>::search_interval(const Interval& interval) {
  if (interval.end < first_ || interval.begin > last_) return std::nullopt;
  if constexpr (isolation == Isolation::sampling) return search_samples(interval);
  if (stretches_.vanishes(interval.depth)) return std::nullopt;
  Estimate e;
  const Shape shape = stretches_.classify(interval, e);
  const bool starts = values_.just_collided() && interval.begin == 0;
  switch (shape) {
    case Shape::free:
      return std::nullopt;
    case Shape::flat:
      return values_.pair().touch.touching && interval.begin == 0 ? search_flat_start(interval)
                                                                  : std::nullopt;
    case Shape::monotone:
      if (starts) {
        // f leaves 0 and does not return, unless it approaches, which only rounding can claim.
        return sign_of(e.df) == values_.pair().touch.side ? std::nullopt
                                                          : search_start(interval, e);
      } else {
        const double slope = stretches_.least_slope(e, interval);
        const int before = side_before_root(interval, e, slope);
        if (before == 0) return std::nullopt;
        return accept(interval.begin, interval.end, interval.middle(), before, slope);
      }
    case Shape::folded:
      return starts ? search_start(interval, e) : search_fold(interval, e);
    case Shape::unknown:
      break;
  }
  if (values_.counters().is_spent()) return std::nullopt;
  const double middle = interval.middle();
  if (interval.depth >= last_depth || middle == interval.begin || middle == interval.end) {
    const int before = values_.sign_at(interval.begin), after = values_.sign_at(interval.end);
    if (before == after || before == 0 || after == 0) return std::nullopt;
    return accept_precisely(interval.begin, interval.end, middle, before);
  }
  if (auto root = search_interval({interval.begin, middle, interval.depth + 1})) return root;
  return search_interval({middle, interval.end, interval.depth + 1});
}

template <Isolation isolation, Escalation escalation>
Contact RootFinder<isolation, escalation>::run(double from, double until) {
  const double end = until * values_.scale().per_time;
  // A root at which the spheres do not overlap has an arm beyond a tip.
  const Frame<double>& frame = values_.frame();
  const TimeSpan overlap = sphere_overlap(frame.r, frame.v, frame.half[0] + frame.half[1]);
  last_ = std::min(end, overlap.end * roundup);
  first_ =
      std::max({0.0, from * values_.scale().per_time, overlap.begin * (1 - 0x1p-20) - 0x1p-40});
  if (values_.pair().touch.touching && from == 0) first_ = 0;
  if (!(first_ <= last_)) return {};
  if (values_.pair().touch_within > 0 && from == 0 && !values_.pair().touch.touching) {
    const Sample<double> start = values_.sample_at(0.0);
    if (std::abs(start.f) <= values_.pair().touch_within * values_.scale().per_length &&
        segment_distance_squared(start.r, start.u[0], start.u[1], start.x, dot(start.x, start.x),
                                 half_lengths(frame.half[0], frame.half[1])) <
            touching * touching) {
      Contact unknown;
      unknown.side_unknown = true;
      return unknown;
    }
  }
  // Needles at rest relative to each other touch for good or never.
  if (!values_.scale().moves) return {};
  if (values_.just_collided() && frame.w_sum == 0) return {};  // f is linear and leaves 0 for good
  // A root at the end of an interval belongs to it, so the first ends at first_ or later.
  const double start = std::max(0.0, (std::ceil(first_ / grid) - 1) * grid);
  for (double begin = start; begin <= last_; begin += grid) {
    if (const auto root = search_interval({begin, begin + grid, 0})) {
      const double s = to_double(root->s);
      if (s > end) return {};
      return {
          .found = true,
          .unresolvable = values_.just_collided() && s == 0,
          .elapsed = {root->s.hi * values_.scale().per_rate, root->s.lo * values_.scale().per_rate},
          .side = root->side};
    }
    if (stretches_.vanishes(0)) return {};
  }
  return {};
}

}  // namespace

Contact first_contact(const Pair& pair, double from, double until, EvaluationCounters& counters,
                      const Accuracy& accuracy) {
  const PairScale scale = scale_of(pair);
  const auto by = [&]<Isolation isolation>() {
    const auto with = [&]<Escalation escalation>() {
      return RootFinder<isolation, escalation>(pair, scale, accuracy, counters).run(from, until);
    };
    if (accuracy.escalation == Escalation::undecided) {
      return with.template operator()<Escalation::undecided>();
    }
    return accuracy.escalation == Escalation::never
               ? with.template operator()<Escalation::never>()
               : with.template operator()<Escalation::always>();
  };
  if (accuracy.isolation == Isolation::bounds) return by.operator()<Isolation::bounds>();
  return accuracy.isolation == Isolation::sampling ? by.operator()<Isolation::sampling>()
                                                   : by.operator()<Isolation::intervals>();
}

ContactGeometry contact_geometry(const Pair& pair, const DoubleDouble& elapsed) {
  const PairScale scale = scale_of(pair);
  const DoubleDouble s{elapsed.hi * scale.per_time, elapsed.lo * scale.per_time};
  ContactGeometry out;
  const auto fill = [&](const auto& frame, const auto& time) {
    const auto sample = evaluate(frame, time);
    using T = std::decay_t<decltype(sample.f)>;
    out.u_first = to_double(sample.u[0]);
    out.u_second = to_double(sample.u[1]);
    const Vec3d x = to_double(sample.x);
    out.sin_angle = std::sqrt(dot(x, x));
    out.normal = {x.x / out.sin_angle, x.y / out.sin_angle, x.z / out.sin_angle};
    const T xx = dot(sample.x, sample.x);
    const auto arm = [&](int i) {
      const double length = to_double(dot(cross(sample.u[1 - i], sample.r), sample.x) / xx);
      return std::clamp(length, -frame.half[i], frame.half[i]) / scale.per_length;
    };
    out.arm_first = arm(0);
    out.arm_second = arm(1);
  };
  fill(make_frame<double>(pair, scale), s.hi);
  // Arms lose the digits that |u1 x u2| has lost.
  if (!(out.sin_angle > 0x1p-10)) fill(make_frame<DoubleDouble>(pair, scale), s);
  return out;
}

double time_apart(const Pair& pair) {
  const PairScale scale = scale_of(pair);
  if (!scale.moves) return 0;
  const Frame<double> frame = make_frame<double>(pair, scale);
  const Sample<double> start = evaluate(frame, 0.0);
  const double slope = start.df * pair.touch.side, bend = 0.5 * start.ddf * pair.touch.side;
  // Needles whose centres get farther apart than this do not meet any more.
  const double reach = frame.half[0] + frame.half[1];
  const double v = frame.v_length, turn = reach * frame.w_sum;
  // Far above the rounding of the slope, and above what first_contact() takes for a return at once.
  if (!(slope > 0x1p-20 * (v + turn))) return 0;
  // |f'''| is at most (3 |v| + |r| w) w^2, so that |f| is not below (slope + bend s - twist s^2) s.
  const double twist = (3 * v + turn) * frame.w_sum * frame.w_sum * (1.0 / 6);
  const double root = std::sqrt(bend * bend + 4 * twist * slope);
  const double end = bend > 0 ? 0.5 * (bend + root) / twist : 2 * slope / (root - bend);
  if (!(slope * end > least_rise)) return 0;
  // A quarter is left for all rounding, here and where the caller rounds the time, and so that f is
  // well above 0 at its end.
  return 0.75 * end * scale.per_rate;
}

int side_after(const Pair& pair) {
  const PairScale scale = scale_of(pair);
  if (!scale.moves) return 0;
  const Frame<DoubleDouble> frame = make_frame<DoubleDouble>(pair, scale);
  const Estimate e = estimate(frame, DoubleDouble(), evaluate(frame, DoubleDouble()));
  return std::abs(e.df) > e.error_df ? sign_of(e.df) : sign_of(e.ddf);
}

double gap_at(const Pair& pair, const DoubleDouble& elapsed) {
  const PairScale scale = scale_of(pair);
  EvaluationCounters ignored;
  ContactValues<Escalation::undecided> values(pair, scale, ignored);
  const DoubleDouble s{elapsed.hi * scale.per_time, elapsed.lo * scale.per_time};
  return to_double(values.sample_at(s).f) / scale.per_length;
}

}  // namespace needlework::kernels
