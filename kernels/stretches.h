// What the contact function does on an interval of time, found in one of three ways (`Isolation`).
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "kernels/contact_values.h"
#include "kernels/range.h"

namespace needlework::kernels {

/// What f does on an interval: it keeps its sign; its first, or second, derivative does; or it
/// cannot be distinguished from 0 anywhere, even in double-double.
enum class Shape { free, monotone, folded, flat, unknown };

struct Interval {
  double begin, end;
  int depth;
  double middle() const { return begin + 0.5 * (end - begin); }
  double half() const { return 0.5 * (end - begin); }
};

/// Finds the shape of f on an interval. The answer depends on that interval alone, not on what was
/// searched before.
template <Isolation isolation, Escalation escalation>
class Stretches {
 public:
  explicit Stretches(ContactValues<escalation>& values) : values_(values) {}

  /// e is the estimate on which the decision rests.
  Shape classify(const Interval& interval, Estimate& e);
  /// |f'|, or |f''|, is not below this on the interval that was classified last, if its sign is the
  /// same everywhere.
  double least_slope(const Estimate& e, const Interval& interval) const;
  double least_bend(const Estimate& e, const Interval& interval) const;
  /// |f''| is not above this on it.
  double most_bend(const Estimate& e, const Interval& interval) const;
  /// |f'''| is not above this on it.
  double third_derivative_bound(const Estimate& e, const Interval& interval) const;
  /// Whether f is found to be identically 0, now that intervals of this depth are needed.
  bool vanishes(int depth);

 private:
  // From this depth on, bounds are sharpened by the coefficients of f: costly, but the only way
  // when f is small everywhere, as for needles in nearly one plane.
  static constexpr int sharpen_depth = 3;
  // From this depth on, those bounds are tried too where interval arithmetic does not decide.
  static constexpr int forget_depth = 6;
  // Without error bounds, f is taken to vanish where it stays below this share of the distance.
  static constexpr double flat_in_double = 8 * noise_in_double;
  static constexpr bool escalates = ContactValues<escalation>::escalates;

  double second_derivative_bound(const Estimate& e, const Interval& interval) const;
  double bent_by(const Estimate& e, const Interval& interval) const;
  Shape shape_of(const Estimate& e, const Interval& interval) const;
  Shape classify_precisely(const Interval& interval, Estimate& e);
  Shape classify_by_intervals(const Interval& interval, Estimate& e);

  ContactValues<escalation>& values_;
  std::optional<Amplitude> amplitude_;
  bool vanishes_ = false;
  // For interval arithmetic: the frame, and the ranges of the derivatives on the present interval,
  // where they decided its shape.
  struct Enclosure {
    Range df, ddf;
  };
  std::optional<Frame<Range>> ranges_;
  std::optional<Enclosure> enclosure_;
};

template <Isolation isolation, Escalation escalation>
bool Stretches<isolation, escalation>::vanishes(int depth) {
  if (depth >= sharpen_depth && !amplitude_) {
    // In double the coefficients of an f that is small everywhere would be nothing but rounding.
    if constexpr (escalates) {
      amplitude_ = amplitude(values_.precise_frame());
    } else {
      amplitude_ = amplitude(make_frame<DoubleDouble>(values_.pair(), values_.scale()));
    }
    const auto& [slow, fast] = *amplitude_;
    // Below the errors of f everywhere: every interval is flat, so the rest need not be searched.
    const Frame<double>& frame = values_.frame();
    vanishes_ =
        slow.a + fast.a <= 0x1p-98 * frame.r_norm && slow.b + fast.b <= 0x1p-98 * frame.v_norm;
  }
  return vanishes_;
}

// Whether the sharper bounds apply is a matter of the interval alone, not of what was searched
// before.
template <Isolation isolation, Escalation escalation>
double Stretches<isolation, escalation>::second_derivative_bound(const Estimate& e,
                                                                 const Interval& interval) const {
  const double w = values_.frame().w_sum, v = values_.frame().v_length;
  const double general = (2 * v + (e.distance + v * interval.half()) * w) * w;
  if (interval.depth < sharpen_depth) return general;
  return std::min(general, amplitude_->derivative_bound(2, interval.end));
}

template <Isolation isolation, Escalation escalation>
double Stretches<isolation, escalation>::third_derivative_bound(const Estimate& e,
                                                                const Interval& interval) const {
  const double general = kernels::third_derivative_bound(values_.frame(), e, interval.half());
  if (interval.depth < sharpen_depth) return general;
  return std::min(general, amplitude_->derivative_bound(3, interval.end));
}

// How much f' can change between the middle of the interval, where e was taken, and its ends.
template <Isolation isolation, Escalation escalation>
double Stretches<isolation, escalation>::bent_by(const Estimate& e,
                                                 const Interval& interval) const {
  const double half = interval.half();
  const double ddf =
      std::abs(e.ddf) + e.error_ddf + 0.5 * half * third_derivative_bound(e, interval);
  return half * std::min(second_derivative_bound(e, interval), ddf) * roundup;
}

// |f'| is not below this on the interval, if its sign is the same everywhere.
template <Isolation isolation, Escalation escalation>
double Stretches<isolation, escalation>::least_slope(const Estimate& e,
                                                     const Interval& interval) const {
  if (enclosure_) return enclosure_->df.least();
  return std::abs(e.df) - e.error_df - bent_by(e, interval);
}

// The same for |f''|.
template <Isolation isolation, Escalation escalation>
double Stretches<isolation, escalation>::least_bend(const Estimate& e,
                                                    const Interval& interval) const {
  if (enclosure_) return enclosure_->ddf.least();
  return std::abs(e.ddf) - e.error_ddf - interval.half() * third_derivative_bound(e, interval);
}

template <Isolation isolation, Escalation escalation>
double Stretches<isolation, escalation>::most_bend(const Estimate& e,
                                                   const Interval& interval) const {
  if (enclosure_) return enclosure_->ddf.most();
  return std::abs(e.ddf) + e.error_ddf + interval.half() * third_derivative_bound(e, interval);
}

template <Isolation isolation, Escalation escalation>
Shape Stretches<isolation, escalation>::shape_of(const Estimate& e,
                                                 const Interval& interval) const {
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
Shape Stretches<isolation, escalation>::classify(const Interval& interval, Estimate& e) {
  if constexpr (isolation == Isolation::intervals) return classify_by_intervals(interval, e);
  const double middle = interval.middle();
  const Sample<double> sample = values_.sample_at(middle);
  values_.keep(middle, sample);  // where a root is looked for first
  e = values_.estimate_of(middle, sample);
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
Shape Stretches<isolation, escalation>::classify_precisely(const Interval& interval, Estimate& e) {
  e = values_.in_double_double(interval.middle());
  return shape_of(e, interval);
}

// Encloses f and its derivatives on the whole interval: as they come, and by expansion at the
// middle.
template <Isolation isolation, Escalation escalation>
Shape Stretches<isolation, escalation>::classify_by_intervals(const Interval& interval,
                                                              Estimate& e) {
  enclosure_.reset();
  if (!ranges_) ranges_ = enclose(values_.precise_frame(), values_.pair(), values_.scale());
  values_.counters().evaluated += 2;
  const Sample<Range> whole = evaluate(*ranges_, Range(interval.begin, interval.end));
  const Sample<Range> middle = evaluate(*ranges_, Range(interval.middle()));
  const double half = interval.half();
  const Range way(-half, half), bent = Range(0, round_up(half * half)) * (whole.ddf * Range(0.5));
  const Range ddf = whole.ddf, df = common(whole.df, middle.df + way * ddf);
  const Range f = common(whole.f, middle.f + way * middle.df + bent);
  const auto centre = [](const Range& a) { return a.lo + 0.5 * (a.hi - a.lo); };
  const auto width = [](const Range& a) { return round_up(a.hi - a.lo); };
  // The centre may lie outside the range known for the whole interval, and then have another sign.
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
  // Interval arithmetic does not see that f is small everywhere, as for needles in nearly one
  // plane.
  const bool forgotten = interval.depth >= forget_depth;
  return by_rounding || forgotten ? classify_precisely(interval, e) : shape;
}

}  // namespace needlework::kernels
