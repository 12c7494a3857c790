// The contact function of one pair at one time: in double with error bounds, and in double-double
// where these leave a decision open.
#pragma once

#include <cmath>
#include <limits>
#include <optional>
#include <type_traits>

#include "kernels/contact_function.h"
#include "kernels/first_contact.h"
#include "needlework/accuracy.h"

namespace needlework::kernels {

/// Without error bounds, f is taken to be known up to this share of the distance.
inline constexpr double noise_in_double = 0x1p-51;

constexpr int sign_of(double a) { return (a > 0) - (a < 0); }

/// Lengths and times are scaled; times count from s = 0 of the pair.
template <Escalation escalation>
class ContactValues {
 public:
  static constexpr bool escalates = escalation != Escalation::never;

  ContactValues(const Pair& pair, const PairScale& scale, EvaluationCounters& counters)
      : pair_(pair), scale_(scale), frame_(make_frame<double>(pair, scale)), counters_(counters) {
    if (pair.touch.touching) continue_from_touch();
  }

  const Pair& pair() const { return pair_; }
  const PairScale& scale() const { return scale_; }
  EvaluationCounters& counters() { return counters_; }
  const Frame<double>& frame() const { return frame_; }
  const Frame<DoubleDouble>& precise_frame();
  bool just_collided() const { return pair_.touch.collided; }

  Sample<double> sample_at(double s);
  Sample<DoubleDouble> sample_at(const DoubleDouble& s);
  /// Keeps a sample that will be asked for again.
  void keep(double s, const Sample<double>& sample) {
    kept_at_ = s;
    kept_ = sample;
  }

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

  /// Sign of f just after s, and that of f' at s; 0 when it cannot be decided.
  int sign_at(double s);
  int slope_sign_at(double s);
  /// Whether both arms are inside the needles at a root that may be off by `uncertainty`: 1 inside,
  /// -1 outside, 0 undecided.
  template <class T>
  int arms_inside(const T& s, const Sample<T>& sample, double uncertainty) const;
  /// By how much the root next to s may be off, given an estimate of f at s.
  double root_uncertainty(const Estimate& e, double s, double roundoff) const;

 private:
  void continue_from_touch();
  // f(0) as the touch has it, in scaled lengths.
  double gap() const { return pair_.touch.gap * scale_.per_length; }
  template <class T>
  const Frame<T>& frame_in();
  // The estimate by which a sign is decided first.
  Estimate decisive(double s) {
    return escalation == Escalation::always ? in_double_double(s) : in_double(s);
  }

  const Pair& pair_;
  PairScale scale_;
  Frame<double> frame_;
  std::optional<Frame<DoubleDouble>> precise_;
  double kept_at_ = std::numeric_limits<double>::quiet_NaN();
  Sample<double> kept_;
  EvaluationCounters& counters_;
};

// f is continued from the gap it had: in double, where that decides whether f leaves the touch on
// the pair's side.
template <Escalation escalation>
void ContactValues<escalation>::continue_from_touch() {
  const Estimate start = in_double(0);
  if constexpr (!escalates) {
    frame_.offset = gap() - start.f;
    if (just_collided() && start.df * pair_.touch.side < 0) frame_.slope = -start.df;
    return;
  }
  if (just_collided() && start.df * pair_.touch.side <= start.error_df) {
    const Frame<DoubleDouble>& frame = precise_frame();
    frame_.offset = to_double(frame.offset);
    frame_.slope = to_double(frame.slope);
  } else {
    frame_.offset = gap() - start.f;
    frame_.offset_error = start.error_f;
  }
}

template <Escalation escalation>
const Frame<DoubleDouble>& ContactValues<escalation>::precise_frame() {
  if (precise_) return *precise_;
  Frame<DoubleDouble>& frame = precise_.emplace(make_frame<DoubleDouble>(pair_, scale_));
  if (!pair_.touch.touching) return frame;
  ++counters_.escalated;
  const Sample<DoubleDouble> start = evaluate(frame, DoubleDouble());
  frame.offset_error = estimate(frame, DoubleDouble(), start).error_f;
  frame.offset = DoubleDouble(gap()) - start.f;
  // A just-collided pair does not approach; a slope to the contrary is due to rounding of the
  // velocities and is subtracted.
  if (pair_.touch.collided && to_double(start.df) * pair_.touch.side < 0) frame.slope = -start.df;
  return frame;
}

template <Escalation escalation>
template <class T>
const Frame<T>& ContactValues<escalation>::frame_in() {
  if constexpr (std::is_same_v<T, double>) {
    return frame_;
  } else {
    return precise_frame();
  }
}

template <Escalation escalation>
Sample<double> ContactValues<escalation>::sample_at(double s) {
  if (s == kept_at_) return kept_;
  ++counters_.evaluated;
  return evaluate(frame_, s);
}

template <Escalation escalation>
Sample<DoubleDouble> ContactValues<escalation>::sample_at(const DoubleDouble& s) {
  ++counters_.escalated;
  return evaluate(precise_frame(), s);
}

// f and its derivatives, without their errors if double decides everything.
template <Escalation escalation>
template <class T>
Estimate ContactValues<escalation>::estimate_of(const T& s, const Sample<T>& sample) {
  if constexpr (escalates) {
    return estimate(frame_in<T>(), s, sample);
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

// Sign of f just after s.
template <Escalation escalation>
int ContactValues<escalation>::sign_at(double s) {
  if (s == 0 && pair_.touch.touching) return pair_.touch.side;
  Estimate e = decisive(s);
  if (std::abs(e.f) > e.error_f) return sign_of(e.f);
  if constexpr (escalation == Escalation::undecided) e = in_double_double(s);
  if (std::abs(e.f) > e.error_f) return sign_of(e.f);
  if (std::abs(e.df) > e.error_df) return sign_of(e.df);
  if (std::abs(e.ddf) > e.error_ddf) return sign_of(e.ddf);
  return 0;
}

template <Escalation escalation>
int ContactValues<escalation>::slope_sign_at(double s) {
  Estimate e = decisive(s);
  if (escalation == Escalation::undecided && std::abs(e.df) <= e.error_df) e = in_double_double(s);
  return std::abs(e.df) > e.error_df ? sign_of(e.df) : 0;
}

template <Escalation escalation>
double ContactValues<escalation>::root_uncertainty(const Estimate& e, double s,
                                                   double roundoff) const {
  const double slope = std::abs(e.df) - e.error_df;
  if (!(slope > 0)) return std::numeric_limits<double>::infinity();
  // Twice as far, where f bends so much that its slope at the root is half of that here.
  return 2 * (e.error_f + std::abs(e.f)) / slope + 4 * roundoff * std::abs(s);
}

template <Escalation escalation>
template <class T>
int ContactValues<escalation>::arms_inside(const T& s, const Sample<T>& sample,
                                           double uncertainty) const {
  // |s12| < h, the half length, as |c . x| < h x . x, c = u2 x r12: no division by what may be
  // nearly 0. Near a contact c is s12 x, so that every error below shrinks with |x|; near parallel
  // directors that distinguishes contacts from the roots at which only x vanishes.
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
    const double half = frame_.half[i];
    const double error = (off_c * x + (length + 2 * half * x) * off_x) * roundup;
    // Formed in T: inside and outside may differ in the last bits of a double.
    const double margin = to_double(xx * T(half) - (to_double(n) < 0 ? -n : n));
    if (margin < -error) return -1;
    if (!(margin > error)) verdict = 0;
  }
  return verdict;
}

}  // namespace needlework::kernels
