#include "kernels/first_contact.h"

#include <algorithm>
#include <optional>

#include "kernels/closest_approach.h"

namespace needlework::kernels {
namespace {

// Interval length in scaled time; a power of two. Longer ones are halved more often than they save.
constexpr double grid = 0.5;
// From this depth on, bounds are sharpened by the coefficients of f: costly, but the only way when
// f is small everywhere, as for needles in nearly one plane.
constexpr int sharpen_depth = 3;
// Halving ends here: f, f' and f'' all vanish to the precision there is, and only the signs at the
// ends decide.
constexpr int last_depth_of(Escalation escalation) {
  return escalation == Escalation::never ? 12 : 44;
}
// Roots whose double value may be off by more than this share of the time since s = 0 are refined
// in double-double.
constexpr double polish_above = 0x1p-40;
// Below this share of the pair's speeds, the velocity at which it separates is rounding.
constexpr double velocity_noise = 0x1p-46;
// Segments farther apart do not touch, however small f is; far above what rounding does to them,
// and below the margins of every filter.
constexpr double touching = 0x1p-18;
// Without error bounds, f is taken to be known up to this share of the distance, and to vanish
// where it stays below eight times as much.
constexpr double noise_in_double = 0x1p-51, flat_in_double = 0x1p-48;
// Bounds computed with a few roundings are enlarged by this.
constexpr double roundup = 1 + 0x1p-40;

constexpr int sign_of(double a) { return (a > 0) - (a < 0); }

// flat: not told from 0 anywhere, even in double-double.
enum class Shape { free, monotone, folded, flat, unknown };

struct Interval {
  double begin, end;
  int depth;
  double middle() const { return begin + 0.5 * (end - begin); }
  double half() const { return 0.5 * (end - begin); }
};

struct Root {
  DoubleDouble s;
  double uncertainty;
  int side;  // sign of f before
};

// The search by one isolation and one escalation: what others need is not in its code.
template <Isolation isolation, Escalation escalation>
class Search {
 public:
  Search(const Pair& pair, const PairScale& scale, const Accuracy& accuracy,
         SearchCounters& counters)
      : pair_(pair),
        scale_(scale),
        accuracy_(accuracy),
        frame_(make_frame<double>(pair, scale)),
        counters_(counters) {
    if (pair.touch.touching) continue_from_touch();
  }

  Contact run(double from, double until);

 private:
  void continue_from_touch();
  const Frame<DoubleDouble>& precise_frame();

  template <class T>
  const Frame<T>& frame();
  Sample<double> sample_at(double s);
  Sample<DoubleDouble> sample_at(const DoubleDouble& s);
  template <class T>
  Estimate estimate_of(const T& s, const Sample<T>& sample);
  Estimate in_double(double s) { return estimate_of(s, sample_at(s)); }
  Estimate in_double_double(const DoubleDouble& s) {
    if constexpr (escalates) {
      return estimate_of(s, sample_at(s));
    } else {
      return in_double(to_double(s));
    }
  }

  // What decides on a sign first.
  Estimate decisive(double s) {
    return escalation == Escalation::always ? in_double_double(s) : in_double(s);
  }

  double third_derivative_bound(const Estimate& e, const Interval& interval) const;
  double second_derivative_bound(const Estimate& e, const Interval& interval) const;
  double bent_by(const Estimate& e, const Interval& interval) const;
  double least_slope(const Estimate& e, const Interval& interval) const;
  double least_bend(const Estimate& e, const Interval& interval) const;
  double most_bend(const Estimate& e, const Interval& interval) const;
  Shape shape_of(const Estimate& e, const Interval& interval) const;
  Shape classify(const Interval& interval, Estimate& e);
  Shape classify_precisely(const Interval& interval, Estimate& e);
  Shape classify_by_intervals(const Interval& interval, Estimate& e);

  int sign_at(double s);
  int side_before_root(const Interval& interval, const Estimate& e, double least_slope);
  int slope_sign_at(double s);

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
  template <class T>
  int arms_inside(const T& s, const Sample<T>& sample,
                  double uncertainty) const;  // 1 inside, -1 outside, 0 undecided
  double root_uncertainty(const Estimate& e, double s, double roundoff) const;

  static constexpr bool escalates = escalation != Escalation::never;
  static constexpr int last_depth = last_depth_of(escalation);

  const Pair& pair_;
  PairScale scale_;
  const Accuracy& accuracy_;
  Frame<double> frame_;
  std::optional<Frame<DoubleDouble>> precise_;
  std::optional<Amplitude> amplitude_;
  // With isolation by intervals: the frame, and what it says of the interval at hand, if that
  // settled it.
  struct Enclosure {
    Range df, ddf;
  };
  std::optional<Frame<Range>> ranges_;
  std::optional<Enclosure> enclosure_;
  // The sample in the middle of the interval at hand, where the root is looked for first.
  double middle_ = std::numeric_limits<double>::quiet_NaN();
  Sample<double> at_middle_;
  double first_ = 0, last_ = 0;  // only roots between these can be contacts
  bool just_collided_ = false;
  bool vanishes_ = false;  // f is identically 0
  SearchCounters& counters_;
};

// f is continued from the gap it had. In double, so far as that tells whether f leaves the touch on
// its side.
template <Isolation isolation, Escalation escalation>
void Search<isolation, escalation>::continue_from_touch() {
  just_collided_ = pair_.touch.collided;
  const Estimate start = in_double(0);
  if constexpr (!escalates) {
    frame_.offset = pair_.touch.gap - start.f;
    if (just_collided_ && start.df * pair_.touch.side < 0) frame_.slope = -start.df;
    return;
  }
  if (just_collided_ && start.df * pair_.touch.side <= start.error_df) {
    const Frame<DoubleDouble>& frame = precise_frame();
    frame_.offset = to_double(frame.offset);
    frame_.slope = to_double(frame.slope);
  } else {
    frame_.offset = pair_.touch.gap - start.f;
    frame_.offset_error = start.error_f;
  }
}

template <Isolation isolation, Escalation escalation>
const Frame<DoubleDouble>& Search<isolation, escalation>::precise_frame() {
  if (precise_) return *precise_;
  Frame<DoubleDouble>& frame = precise_.emplace(make_frame<DoubleDouble>(pair_, scale_));
  if (!pair_.touch.touching) return frame;
  ++counters_.escalated;
  const Sample<DoubleDouble> start = evaluate(frame, DoubleDouble());
  frame.offset = DoubleDouble(pair_.touch.gap) - start.f;
  // A just-collided pair does not approach; what rounding of the velocities says otherwise is
  // taken off.
  if (pair_.touch.collided && to_double(start.df) * pair_.touch.side < 0) frame.slope = -start.df;
  return frame;
}

template <Isolation isolation, Escalation escalation>
template <class T>
const Frame<T>& Search<isolation, escalation>::frame() {
  if constexpr (std::is_same_v<T, double>) {
    return frame_;
  } else {
    return precise_frame();
  }
}

template <Isolation isolation, Escalation escalation>
Sample<double> Search<isolation, escalation>::sample_at(double s) {
  if (s == middle_) return at_middle_;
  ++counters_.evaluated;
  return evaluate(frame_, s);
}

template <Isolation isolation, Escalation escalation>
Sample<DoubleDouble> Search<isolation, escalation>::sample_at(const DoubleDouble& s) {
  ++counters_.escalated;
  return evaluate(precise_frame(), s);
}

// f and its derivatives, without a look at their errors where double decides everything.
template <Isolation isolation, Escalation escalation>
template <class T>
Estimate Search<isolation, escalation>::estimate_of(const T& s, const Sample<T>& sample) {
  if constexpr (escalates) {
    return estimate(frame<T>(), s, sample);
  } else {
    return {.f = to_double(sample.f),
            .df = to_double(sample.df),
            .ddf = to_double(sample.ddf),
            .error_f = 0,
            .error_df = 0,
            .error_ddf = 0,
            .distance = std::sqrt(to_double(dot(sample.r, sample.r)))};
  }
}

// Whether the sharper bounds apply is a matter of the interval alone, not of what was searched
// before.
template <Isolation isolation, Escalation escalation>
double Search<isolation, escalation>::second_derivative_bound(const Estimate& e,
                                                              const Interval& interval) const {
  const double w = frame_.w_sum, v = frame_.v_length;
  const double general = (2 * v + (e.distance + v * interval.half()) * w) * w;
  if (!escalates || interval.depth < sharpen_depth) return general;
  return std::min(general, amplitude_->derivative_bound(2, interval.end));
}

template <Isolation isolation, Escalation escalation>
double Search<isolation, escalation>::third_derivative_bound(const Estimate& e,
                                                             const Interval& interval) const {
  const double w = frame_.w_sum, v = frame_.v_length;
  const double general = (3 * v + (e.distance + v * interval.half()) * w) * w * w;
  if (!escalates || interval.depth < sharpen_depth) return general;
  return std::min(general, amplitude_->derivative_bound(3, interval.end));
}

// How much f' can change between the middle of the interval, where e was taken, and its ends.
template <Isolation isolation, Escalation escalation>
double Search<isolation, escalation>::bent_by(const Estimate& e, const Interval& interval) const {
  const double half = interval.half();
  const double ddf =
      std::abs(e.ddf) + e.error_ddf + 0.5 * half * third_derivative_bound(e, interval);
  return half * std::min(second_derivative_bound(e, interval), ddf) * roundup;
}

// |f'| is not below this on the interval, if its sign is the same everywhere.
template <Isolation isolation, Escalation escalation>
double Search<isolation, escalation>::least_slope(const Estimate& e,
                                                  const Interval& interval) const {
  if (enclosure_) return enclosure_->df.least();
  return std::abs(e.df) - e.error_df - bent_by(e, interval);
}

// The same for |f''|.
template <Isolation isolation, Escalation escalation>
double Search<isolation, escalation>::least_bend(const Estimate& e,
                                                 const Interval& interval) const {
  if (enclosure_) return enclosure_->ddf.least();
  return std::abs(e.ddf) - e.error_ddf - interval.half() * third_derivative_bound(e, interval);
}

template <Isolation isolation, Escalation escalation>
double Search<isolation, escalation>::most_bend(const Estimate& e, const Interval& interval) const {
  if (enclosure_) return enclosure_->ddf.most();
  return std::abs(e.ddf) + e.error_ddf + interval.half() * third_derivative_bound(e, interval);
}

template <Isolation isolation, Escalation escalation>
Shape Search<isolation, escalation>::shape_of(const Estimate& e, const Interval& interval) const {
  const double half = interval.half();
  const double m2 = second_derivative_bound(e, interval);
  const double m3 = third_derivative_bound(e, interval);
  const double ddf = std::abs(e.ddf) + e.error_ddf;
  const double curved = half * half * std::min(0.5 * m2, 0.5 * ddf + half * m3 * (1.0 / 6));
  const double df = std::abs(e.df) + e.error_df;
  const double change = (df * half + curved) * roundup;
  if (std::abs(e.f) > change + e.error_f) return Shape::free;
  if (std::abs(e.df) > bent_by(e, interval) + e.error_df) return Shape::monotone;
  if (std::abs(e.ddf) > half * m3 * roundup + e.error_ddf) return Shape::folded;
  // The terms of the errors in `change` shrink with the interval, f's own does not.
  const double noise = escalates ? 4 * e.error_f : flat_in_double * e.distance;
  if (std::abs(e.f) + change <= noise) return Shape::flat;
  return Shape::unknown;
}

// Classifies in double, then, when the error bounds rather than the bounds on derivatives prevent a
// decision, in double-double. e is the estimate on which the decision rests.
template <Isolation isolation, Escalation escalation>
Shape Search<isolation, escalation>::classify(const Interval& interval, Estimate& e) {
  if constexpr (isolation == Isolation::intervals) return classify_by_intervals(interval, e);
  const double middle = interval.middle();
  at_middle_ = sample_at(middle);
  middle_ = middle;
  e = estimate_of(middle, at_middle_);
  const Shape shape = shape_of(e, interval);
  if (!escalates || (shape != Shape::unknown && shape != Shape::flat)) return shape;
  const double half = interval.half();
  const double m3 = third_derivative_bound(e, interval);
  const double curved = half * half * half * m3;
  if (e.error_f < 0x1p-6 * curved && e.error_df * half < 0x1p-6 * curved &&
      e.error_ddf * half * half < 0x1p-6 * curved) {
    return Shape::unknown;
  }
  return classify_precisely(interval, e);
}

template <Isolation isolation, Escalation escalation>
Shape Search<isolation, escalation>::classify_precisely(const Interval& interval, Estimate& e) {
  e = in_double_double(interval.middle());
  return shape_of(e, interval);
}

// Encloses f and its derivatives on the whole interval: as they come, and by expansion at the
// middle.
template <Isolation isolation, Escalation escalation>
Shape Search<isolation, escalation>::classify_by_intervals(const Interval& interval, Estimate& e) {
  enclosure_.reset();
  if (!ranges_) ranges_ = enclose(precise_frame(), pair_);
  counters_.evaluated += 2;
  const Sample<Range> whole = evaluate(*ranges_, Range(interval.begin, interval.end));
  const Sample<Range> middle = evaluate(*ranges_, Range(interval.middle()));
  const double half = interval.half();
  const Range way(-half, half), bent = Range(0, round_up(half * half)) * (whole.ddf * Range(0.5));
  const Range ddf = whole.ddf, df = common(whole.df, middle.df + way * ddf);
  const Range f = common(whole.f, middle.f + way * middle.df + bent);
  const auto centre = [](const Range& a) { return a.lo + 0.5 * (a.hi - a.lo); };
  const auto width = [](const Range& a) { return round_up(a.hi - a.lo); };
  // The centre may lie beyond what is known of the whole interval, and then not have its sign.
  const auto within = [&](const Range& a, const Range& known) {
    return std::clamp(centre(a), known.lo, known.hi);
  };
  e = {.f = centre(middle.f),
       .df = within(middle.df, df),
       .ddf = within(middle.ddf, ddf),
       .error_f = width(middle.f),
       .error_df = width(middle.df),
       .error_ddf = width(middle.ddf),
       .distance = round_up(std::sqrt(dot(middle.r, middle.r).most()))};
  const Shape shape = !f.has_zero()     ? Shape::free
                      : !df.has_zero()  ? Shape::monotone
                      : !ddf.has_zero() ? Shape::folded
                                        : Shape::unknown;
  if (shape != Shape::unknown) {
    enclosure_ = {df, ddf};
    return shape;
  }
  const bool by_rounding = width(middle.f) > 0x1p-6 * width(f) ||
                           width(middle.df) > 0x1p-6 * width(df) ||
                           width(middle.ddf) > 0x1p-6 * width(ddf);
  return by_rounding ? classify_precisely(interval, e) : shape;
}

// Sign of f just after s.
template <Isolation isolation, Escalation escalation>
int Search<isolation, escalation>::sign_at(double s) {
  if (s == 0 && pair_.touch.touching) return pair_.touch.side;
  Estimate e = decisive(s);
  if (std::abs(e.f) > e.error_f) return sign_of(e.f);
  if constexpr (escalation == Escalation::undecided) e = in_double_double(s);
  if (std::abs(e.f) > e.error_f) return sign_of(e.f);
  if (std::abs(e.df) > e.error_df) return sign_of(e.df);
  if (std::abs(e.ddf) > e.error_ddf) return sign_of(e.ddf);
  return 0;
}

// The sign of f at the beginning of an interval on which |f'| is at least `least_slope`, when f has
// a root there; else 0. The middle often tells both.
template <Isolation isolation, Escalation escalation>
int Search<isolation, escalation>::side_before_root(const Interval& interval, const Estimate& e,
                                                    double least_slope) {
  const int slope = sign_of(e.df);
  const bool carried = interval.begin == 0 && pair_.touch.touching;
  if (carried || !(std::abs(e.f) > e.error_f)) {
    const int before = sign_at(interval.begin), after = sign_at(interval.end);
    return before == -after ? before : 0;
  }
  const bool rooted = least_slope * interval.half() > (std::abs(e.f) + e.error_f) * roundup;
  if (rooted) return -slope;
  const bool in_first_half = sign_of(e.f) == slope;
  const int outer = sign_at(in_first_half ? interval.begin : interval.end);
  return outer == (in_first_half ? -slope : slope) ? -slope : 0;
}

template <Isolation isolation, Escalation escalation>
int Search<isolation, escalation>::slope_sign_at(double s) {
  Estimate e = decisive(s);
  if (escalation == Escalation::undecided && std::abs(e.df) <= e.error_df) e = in_double_double(s);
  return std::abs(e.df) > e.error_df ? sign_of(e.df) : 0;
}

// Safeguarded Newton iteration. f has the sign `side` at `begin` and the other at `end`; where f is
// monotone, |f'| is at least `least_slope` between them, else that is 0. Stops where the rounding
// error of T takes over, or, with nothing, as soon as the root is known to have an arm beyond a
// tip.
template <Isolation isolation, Escalation escalation>
template <class T>
auto Search<isolation, escalation>::refine(T begin, T end, T start, int side, double least_slope)
    -> std::optional<Refined<T>> {
  constexpr bool in_double = std::is_same_v<T, double>;
  const double share = in_double ? std::max(0x1p-52, accuracy_.root_tolerance) : 0x1p-98;
  std::optional<Refined<T>> out(std::in_place);
  T& s = out->root;
  s = start;
  for (int i = 0; i < 200; ++i) {
    out->near = s;
    const Sample<T>& sample = out->sample = sample_at(s);
    const Estimate& e = out->estimate = estimate_of(s, sample);
    if (e.f == 0) break;
    if (i == 1 && least_slope > 0) {
      if (arms_inside(s, sample, (std::abs(e.f) + e.error_f) / least_slope) < 0)
        return std::nullopt;
    }
    const T next = s - sample.f / sample.df;
    const bool last = std::abs(e.f) <= (escalates ? e.error_f : noise_in_double * e.distance);
    if (last) {
      if (to_double(next - begin) >= 0 && to_double(end - next) >= 0) s = next;
      break;
    }
    (sign_of(e.f) == side ? begin : end) = s;
    const bool within = to_double(next - begin) > 0 && to_double(end - next) > 0;
    const T target = within ? next : begin + (end - begin) * T(0.5);
    const double step = std::abs(to_double(target - s));
    s = target;
    const double size = share * std::abs(to_double(s));
    if (step <= size || to_double(end - begin) <= size) break;
  }
  return out;
}

template <Isolation isolation, Escalation escalation>
double Search<isolation, escalation>::root_uncertainty(const Estimate& e, double s,
                                                       double roundoff) const {
  const double slope = std::abs(e.df) - e.error_df;
  if (!(slope > 0)) return std::numeric_limits<double>::infinity();
  return (e.error_f + std::abs(e.f)) / slope + 4 * roundoff * std::abs(s);
}

template <Isolation isolation, Escalation escalation>
template <class T>
int Search<isolation, escalation>::arms_inside(const T& s, const Sample<T>& sample,
                                               double uncertainty) const {
  // |s12| < 1/2 as |c . x| < x . x / 2, c = u2 x r12: no division by what may be nearly 0. Near a
  // contact c is s12 x, so that every error below shrinks with |x|; near parallel directors that is
  // what tells contacts from the roots at which only x vanishes.
  const T xx = dot(sample.x, sample.x);
  const double w = frame_.w_sum, v = frame_.v_norm;
  const double rounding = escalates ? 16 * unit_roundoff<T> : 0;
  const double eu = escalates ? director_error(sample) + rounding : 0;
  const double er = rounding * (frame_.r_norm + v * std::abs(to_double(s)));
  const double r = std::sqrt(to_double(dot(sample.r, sample.r))) + v * uncertainty;
  // How far x and c may be off, by rounding and over the uncertainty of the root.
  const double off_x = eu + uncertainty * w;
  const double off_c = 2 * r * eu + er + uncertainty * (v + r * w);
  const double x = std::sqrt(to_double(xx)) + off_x;
  int verdict = 1;
  for (int i = 0; i < 2; ++i) {
    const Vec3<T> c = cross(sample.u[1 - i], sample.r);
    const T n = dot(c, sample.x);
    const double length = std::sqrt(to_double(dot(c, c))) + off_c;
    const double error = (off_c * x + (length + x) * off_x) * roundup;
    // Formed in T: inside and outside may differ in the last bits of a double.
    const double margin = to_double(xx * T(0.5) - (to_double(n) < 0 ? -n : n));
    if (margin < -error) return -1;
    if (!(margin > error)) verdict = 0;
  }
  return verdict;
}

// The root between begin and end, when it is a contact.
template <Isolation isolation, Escalation escalation>
std::optional<Root> Search<isolation, escalation>::accept(double begin, double end, double start,
                                                          int side, double least_slope) {
  const auto refined = refine(begin, end, start, side, least_slope);
  if (!refined) return std::nullopt;
  const auto& [s, near, sample, e] = *refined;
  const double off = root_uncertainty(e, near, 0x1p-53);
  if constexpr (!escalates) {
    if (arms_inside(near, sample, 0) < 0) return std::nullopt;
    return Root{s, off, side};
  }
  const int inside = std::isfinite(off) ? arms_inside(near, sample, off) : 0;
  if (inside < 0) return std::nullopt;
  const double enough = std::max(polish_above, accuracy_.root_tolerance);
  const bool known = escalation == Escalation::undecided && inside > 0 && off <= enough * s;
  if (known) return Root{s, off, side};
  return accept_precisely(DoubleDouble(begin), DoubleDouble(end), DoubleDouble(s), side);
}

template <Isolation isolation, Escalation escalation>
std::optional<Root> Search<isolation, escalation>::accept_precisely(const DoubleDouble& begin,
                                                                    const DoubleDouble& end,
                                                                    const DoubleDouble& start,
                                                                    int side) {
  if constexpr (!escalates) return accept(begin.hi, end.hi, start.hi, side);
  const auto [s, near, sample, e] = *refine(begin, end, start, side, 0);
  const double off = root_uncertainty(e, to_double(near), 0x1p-102);
  // What double-double cannot tell from a tip or from parallel directors is no contact.
  if (!std::isfinite(off) || arms_inside(near, sample, off) <= 0) return std::nullopt;
  return Root{s, off, side};
}

// f'' keeps its sign on the interval.
template <Isolation isolation, Escalation escalation>
std::optional<Root> Search<isolation, escalation>::search_fold(const Interval& interval,
                                                               const Estimate& e) {
  const int before = sign_at(interval.begin), after = sign_at(interval.end);
  const int bend = sign_of(e.ddf);
  if (before == 0 || after == 0) return std::nullopt;
  if (before != after) {
    // Newton's iteration is monotone from the end where f and f'' have one sign.
    return accept(interval.begin, interval.end, before == bend ? interval.begin : interval.end,
                  before);
  }
  if (before != bend) return std::nullopt;  // f is concave seen from its side
  if (slope_sign_at(interval.begin) != -bend || slope_sign_at(interval.end) != bend) {
    return std::nullopt;
  }
  // The extremum: Newton's iteration on f'.
  DoubleDouble turn = interval.middle();
  double begin = interval.begin, end = interval.end, s = interval.middle();
  for (int i = 0; i < 60; ++i) {
    const Estimate here = in_double(s);
    if (escalates && std::abs(here.df) <= here.error_df) break;
    (sign_of(here.df) == -bend ? begin : end) = s;
    double next = s - here.df / here.ddf;
    if (!(next > begin && next < end)) next = begin + 0.5 * (end - begin);
    const bool done = std::abs(next - s) <= 0x1p-50 * std::abs(s);
    s = next;
    if (done) break;
  }
  const double bend_at_least = least_bend(e, interval);
  Estimate extreme = in_double(s);
  const auto clear = [&] {
    const double slope = std::abs(extreme.df) + extreme.error_df;
    return std::abs(extreme.f) > extreme.error_f + slope * slope / bend_at_least * roundup;
  };
  turn = s;
  if (escalates && !clear()) {
    for (int i = 0; i < 3; ++i) {
      const Sample<DoubleDouble> sample = sample_at(turn);
      turn = turn - sample.df / sample.ddf;
    }
    extreme = in_double_double(turn);
    if (!clear()) return std::nullopt;  // a touch, as far as double-double can tell
  }
  if (sign_of(extreme.f) == before) return std::nullopt;
  const DoubleDouble from = interval.begin, to = interval.end;
  if (auto first = accept_precisely(from, turn, from, before)) return first;
  return accept_precisely(turn, to, to, -before);
}

// The interval that begins where the pair has just collided: f(0) = 0 is known and f does not
// approach there. Only called where f'' keeps its sign or f' does.
template <Isolation isolation, Escalation escalation>
std::optional<Root> Search<isolation, escalation>::search_start(const Interval& interval,
                                                                const Estimate& e) {
  const int side = pair_.touch.side, after = sign_at(interval.end);
  if (after == side || after == 0) return std::nullopt;
  if (sign_of(e.ddf) == side) return std::nullopt;
  // f rises from 0, bends back and has passed 0 by the end. Until half of the least time of return
  // it is surely above.
  Estimate start = in_double(0);
  if (escalates && !(start.df * side > 0x1p10 * start.error_df)) {
    const Sample<DoubleDouble> sample = sample_at(DoubleDouble());
    start = estimate_of(DoubleDouble(), sample);
    // Velocities in double leave f' uncertain by a few roundings of |u1 x u2| times the speeds.
    const double noise = std::sqrt(to_double(dot(sample.x, sample.x))) * velocity_noise *
                         (frame_.v_norm + frame_.w_sum);
    if (!(start.df * side > noise)) return Root{0.0, 0.0, side};
  }
  if (!escalates && !(start.df * side > 0)) return Root{0.0, 0.0, side};
  const double slope = (start.df * side) * (1 - 0x1p-9);
  const double lift = slope / most_bend(e, interval);
  // The parabola's return is a good start for short bounces.
  const double bend = -start.ddf * side;
  const double back = bend > 0 ? std::clamp(2 * slope / bend, lift, interval.end) : interval.end;
  return accept(lift, interval.end, back, side);
}

// The interval that begins at a touch, where f is not told from 0: f leaves it on one side, which
// need not be the pair's. f' and f'' vanish too when the contact points of rough needles have come
// to rest on each other.
template <Isolation isolation, Escalation escalation>
std::optional<Root> Search<isolation, escalation>::search_flat_start(const Interval& interval) {
  const int side = pair_.touch.side;
  if (side == 0 || sign_at(interval.end) != -side) return std::nullopt;
  return Root{0.0, 0.0, side};
}

// Looks only at the signs at equal steps.
template <Isolation isolation, Escalation escalation>
std::optional<Root> Search<isolation, escalation>::search_samples(const Interval& interval) {
  const double length = interval.end - interval.begin;
  const double steps = std::max(1.0, std::ceil(length / accuracy_.sampling_step));
  double begin = interval.begin;
  int before = sign_at(begin);
  for (double n = 1; n <= steps; ++n) {
    const double end = interval.begin + length * (n / steps);
    const int after = sign_at(end);
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
std::optional<Root> Search<isolation, escalation>::search_interval(const Interval& interval) {
  if (interval.end < first_ || interval.begin > last_) return std::nullopt;
  if constexpr (isolation == Isolation::sampling) return search_samples(interval);
  if (escalates && interval.depth >= sharpen_depth && !amplitude_) {
    amplitude_ = amplitude(precise_frame());
    const auto& [slow, fast] = *amplitude_;
    // Below the errors of f everywhere: every interval is flat, so the rest need not be searched.
    vanishes_ =
        slow.a + fast.a <= 0x1p-98 * frame_.r_norm && slow.b + fast.b <= 0x1p-98 * frame_.v_norm;
  }
  if (vanishes_) return std::nullopt;
  Estimate e;
  const Shape shape = classify(interval, e);
  const bool starts = just_collided_ && interval.begin == 0;
  switch (shape) {
    case Shape::free:
      return std::nullopt;
    case Shape::flat:
      return pair_.touch.touching && interval.begin == 0 ? search_flat_start(interval)
                                                         : std::nullopt;
    case Shape::monotone:
      if (starts) {
        // f leaves 0 and does not return, unless it approaches, which only rounding can claim.
        return sign_of(e.df) == pair_.touch.side ? std::nullopt : search_start(interval, e);
      } else {
        const double slope = least_slope(e, interval);
        const int before = side_before_root(interval, e, slope);
        if (before == 0) return std::nullopt;
        return accept(interval.begin, interval.end, interval.middle(), before, slope);
      }
    case Shape::folded:
      return starts ? search_start(interval, e) : search_fold(interval, e);
    case Shape::unknown:
      break;
  }
  const double middle = interval.middle();
  if (interval.depth >= last_depth || middle == interval.begin || middle == interval.end) {
    const int before = sign_at(interval.begin), after = sign_at(interval.end);
    if (before == after || before == 0 || after == 0) return std::nullopt;
    return accept_precisely(interval.begin, interval.end, middle, before);
  }
  if (auto root = search_interval({interval.begin, middle, interval.depth + 1})) return root;
  return search_interval({middle, interval.end, interval.depth + 1});
}

// The times at which |r + v s| <= 1, with a margin; empty when begin > end.
struct Window {
  double begin, end;
};

Window sphere_window(const Vec3d& r, const Vec3d& v) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const double r2 = dot(r, r);
  // The second term covers the rounding of r x v and of r . r, for needles far apart.
  const double radius2 = 1 + 0x1p-20 + 0x1p-48 * r2;
  const double c = r2 - radius2;
  const double b = dot(r, v);
  const double a = dot(v, v);
  const Vec3d n = cross(r, v);
  const double d = a * radius2 - dot(n, n);
  if (c > 0 && (b >= 0 || !(d > 0))) return {infinity, -infinity};
  if (!(d > 0)) return {-infinity, infinity};
  const double root = std::sqrt(d);
  // The two roots of a s^2 + 2 b s + c without cancellation.
  const double q = b > 0 ? -(b + root) : root - b;
  if (q == 0) return {-infinity, infinity};
  const double s1 = c / q, s2 = a > 0 ? q / a : std::copysign(infinity, q);
  return {std::min(s1, s2), std::max(s1, s2)};
}

template <Isolation isolation, Escalation escalation>
Contact Search<isolation, escalation>::run(double from, double until) {
  const double end = until * scale_.per_time;
  // A root outside the window of the spheres has an arm beyond a tip.
  const Window window = sphere_window(frame_.r, frame_.v);
  last_ = std::min(end, window.end * roundup);
  first_ = std::max({0.0, from * scale_.per_time, window.begin * (1 - 0x1p-20) - 0x1p-40});
  if (pair_.touch.touching && from == 0) first_ = 0;
  if (!(first_ <= last_)) return {};
  if (pair_.touch_within > 0 && from == 0 && !pair_.touch.touching) {
    const Sample<double> start = sample_at(0.0);
    if (std::abs(start.f) <= pair_.touch_within &&
        segment_distance_squared(start.r, start.u[0], start.u[1], start.x, dot(start.x, start.x)) <
            touching * touching) {
      Contact unknown;
      unknown.side_unknown = true;
      return unknown;
    }
  }
  if (just_collided_ && frame_.w_sum == 0) return {};  // f is linear and leaves 0 for good
  // A root at the end of an interval belongs to it, so the first ends at first_ or later.
  const double start = std::max(0.0, (std::ceil(first_ / grid) - 1) * grid);
  for (double begin = start; begin <= last_; begin += grid) {
    if (const auto root = search_interval({begin, begin + grid, 0})) {
      const double s = to_double(root->s);
      if (s > end) return {};
      return {.found = true,
              .unresolvable = just_collided_ && s == 0,
              .elapsed = {root->s.hi * scale_.per_velocity, root->s.lo * scale_.per_velocity},
              .side = root->side};
    }
    if (vanishes_) return {};
  }
  return {};
}

}  // namespace

Contact first_contact(const Pair& pair, double from, double until, SearchCounters& counters,
                      const Accuracy& accuracy) {
  const PairScale scale = scale_of(pair);
  if (!scale.moves) return {};
  const auto by = [&]<Isolation isolation>() {
    const auto with = [&]<Escalation escalation>() {
      return Search<isolation, escalation>(pair, scale, accuracy, counters).run(from, until);
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
  const auto fill = [&](const auto& sample) {
    using T = std::decay_t<decltype(sample.f)>;
    out.u_first = to_double(sample.u[0]);
    out.u_second = to_double(sample.u[1]);
    const Vec3d x = to_double(sample.x);
    out.sin_angle = std::sqrt(dot(x, x));
    out.normal = {x.x / out.sin_angle, x.y / out.sin_angle, x.z / out.sin_angle};
    const T xx = dot(sample.x, sample.x);
    const auto arm = [&](const Vec3<T>& other) {
      return std::clamp(to_double(dot(cross(other, sample.r), sample.x) / xx), -0.5, 0.5);
    };
    out.arm_first = arm(sample.u[1]);
    out.arm_second = arm(sample.u[0]);
  };
  fill(evaluate(make_frame<double>(pair, scale), s.hi));
  // Arms lose the digits that |u1 x u2| has lost.
  if (!(out.sin_angle > 0x1p-10)) fill(evaluate(make_frame<DoubleDouble>(pair, scale), s));
  return out;
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
  const Frame<DoubleDouble> frame = make_frame<DoubleDouble>(pair, scale);
  const DoubleDouble s{elapsed.hi * scale.per_time, elapsed.lo * scale.per_time};
  const DoubleDouble f = evaluate(frame, s).f;
  if (!pair.touch.touching) return to_double(f);
  return to_double(f - evaluate(frame, DoubleDouble()).f + DoubleDouble(pair.touch.gap));
}

}  // namespace needlework::kernels
