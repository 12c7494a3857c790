// The oracle's search: the time in which the bounding spheres meet is cut into pieces, each proven
// free of roots, monotone, or convex, by f, f', f'' at its middle and a bound on f'''. Doubles
// with error bounds throw out most pieces; every decision falls in `Real`.
#pragma once

#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include "tests/support/oracle_noise.h"

namespace needlework::test {

template <class Real>
class OracleSearch {
 public:
  OracleSearch(const FreeNeedle& first, const FreeNeedle& second, double horizon,
               bool just_collided, KnownRoot known_root)
      : motion_(make_motion<Real>(first, second)),
        unit_(unit_of_length<Real>(first, second)),
        coarse_motion_(convert_motion<double>(motion_)),
        curve_(make_curve(motion_)),
        just_collided_(just_collided),
        known_root_(known_root) {
    using std::ldexp;
    horizon_ = ldexp(Real(horizon), motion_.exponent);
  }

  OracleAnswer run();
  /// Something stayed open that more digits may close.
  bool undecided() const { return undecided_; }

 private:
  enum class Piece { free, monotone, convex, mixed, unclear };
  struct Bracket {
    double low, high, guess;
  };

  bool set_window();
  bool start_after_collision();
  void look_at_ends();
  void search();
  template <class T>
  Piece classify(const Curve<T>& curve, const T& middle, const T& half) const;
  Piece classify(const Real& begin, const Real& end);
  int sign(const Real& t);
  int resolve(const Real& t, const typename Curve<Real>::Value& value) const;
  void on_piece(const Real& begin, const Real& end, Piece piece);
  void on_dip(const Real& begin, const Real& end, int side);
  void on_root(const Real& begin, const Real& end, int side);
  Bracket narrow(const Real& begin, const Real& end, int side);
  bool arms_clearly_outside(const Bracket& bracket) const;
  Real refine(Real low, Real high, Real t, int side);
  void judge_root(const Real& t);
  bool judge_parallel(const Geometry<Real>& g, const Real& radius);
  Geometry<double> rounded(const Geometry<Real>& g) const;
  Noise noise(const Geometry<Real>& g, const Real& t, double f1, double f2, double reach = 0) const;
  /// How much of |f| is sure.
  double certain(const Real& t, const Real& f) const {
    using std::abs;
    return std::max(0.0, static_cast<double>(Real(abs(f) - curve_.noise(0, t))));
  }
  void near_decision(double margin) {
    answer_.decision_margin = std::min(answer_.decision_margin, margin);
  }
  void open_question() {
    undecided_ = true;
    near_decision(0);
  }
  /// Doubles only settle what is far from everything: more digits will be asked.
  bool given_up() const {
    return std::is_same_v<Real, double> && (undecided_ || answer_.decision_margin < margin_cap);
  }

  Motion<Real> motion_;
  Real unit_;  ///< of length
  Motion<double> coarse_motion_;
  Curve<Real> curve_;
  Curve<double> coarse_;
  bool just_collided_;
  KnownRoot known_root_;
  Real horizon_;
  Real begin_, end_;        ///< the window
  double guard_ = 0;        ///< |f| beyond which no margin is below the cap
  double residual_ = 0;     ///< |f(0)| of a pair that has just collided
  bool skip_root_ = false;  ///< the next root is the known one
  int skip_side_ = 0;
  bool found_ = false, undecided_ = false;
  bool arms_outside_ = false, parallel_ = false;
  OracleAnswer answer_;
};

template <class Real>
OracleAnswer OracleSearch<Real>::run() {
  answer_.time = std::numeric_limits<double>::infinity();
  answer_.arm_first = answer_.arm_second = std::numeric_limits<double>::quiet_NaN();
  answer_.digits = std::numeric_limits<Real>::digits10;
  if (!set_window()) {
    answer_.outcome = Outcome::spheres_apart;
    return answer_;
  }
  // f is identically 0, or cannot be distinguished from 0: the needles stay in one plane.
  const Real last = curve_.bound(0, begin_) + curve_.bound(0, end_);
  const bool nothing = last <= curve_.noise(0, begin_) + curve_.noise(0, end_);
  if (nothing) {
    answer_.outcome = Outcome::coplanar;
    open_question();
    undecided_ = last != 0;
    return answer_;
  }
  if (just_collided_ && !start_after_collision()) {
    answer_.outcome = Outcome::no_sign_change;
    return answer_;
  }
  coarse_ = round_curve(curve_);
  const double u = unit_roundoff<double>(), time = static_cast<double>(end_);
  guard_ = margin_cap * (2 * residual_ + u * (norm(coarse_motion_.separation) +
                                              2 * norm(coarse_motion_.velocity) * time + 5 +
                                              2 * coarse_motion_.total_spin() * time));
  search();
  if (!just_collided_ || !found_) look_at_ends();
  if (!found_) {
    answer_.outcome = arms_outside_ ? Outcome::arms_outside
                      : parallel_   ? Outcome::parallel
                                    : Outcome::no_sign_change;
  }
  return answer_;
}

/// Contacts need |r12| < 1. The window is a little wider, so that a root at its end has a change of
/// sign around it. The width hides the rounding, in double for needles less than 2^9 apart.
template <class Real>
bool OracleSearch<Real>::set_window() {
  using std::max;
  using std::min;
  using std::sqrt;
  const Real pad = Real(1) / (1 << 30);
  const Real reach = 1 + pad;
  const Real vv = dot(motion_.velocity, motion_.velocity);
  const Real rv = dot(motion_.separation, motion_.velocity);
  const Real gap = dot(motion_.separation, motion_.separation) - reach * reach;
  begin_ = 0;
  end_ = horizon_;
  if (std::is_same_v<Real, double> && gap > (1 << 18)) open_question();
  if (vv > 0) {
    const Real discriminant = rv * rv - vv * gap;
    if (discriminant < 0) return false;
    const Real root = sqrt(discriminant);
    begin_ = max<Real>(begin_, (-rv - root) / vv);
    end_ = min<Real>(end_, (-rv + root) / vv);
  } else if (gap > 0) {
    return false;
  }
  if (begin_ > end_) return false;
  if (begin_ == 0 && !just_collided_) begin_ = -pad;
  end_ += pad * max<Real>(Real(1), end_);
  return true;
}

/// Finds the pair's side and a stretch behind t = 0 in which it cannot change. False when the pair
/// stays where it is for ever.
template <class Real>
bool OracleSearch<Real>::start_after_collision() {
  using std::abs;
  const auto start = curve_(Real(0));
  residual_ = std::abs(static_cast<double>(start.f));
  if (std::is_same_v<Real, double>) residual_ += static_cast<double>(curve_.noise(0, Real(0)));
  const Geometry<double> g = at(coarse_motion_, 0.0);
  const double u = unit_roundoff<double>();
  const double slope_noise =
      u * (norm(coarse_motion_.velocity) * (4 + norm(g.x)) +
           4 * norm(coarse_motion_.separation) * coarse_motion_.total_spin());
  near_decision(over(static_cast<double>(start.f1), slope_noise));
  const bool slope = abs(start.f1) > curve_.noise(1, Real(0));
  const bool bend = abs(start.f2) > curve_.noise(2, Real(0));
  if (!slope) open_question();
  const int side = slope ? (start.f1 > 0 ? 1 : -1) : (start.f2 > 0 ? 1 : -1);
  const int begin = resolve(Real(0), start);
  if (known_root_ == KnownRoot::as_rounded && begin != 0) {
    skip_root_ = begin != side;
    skip_side_ = side;
    begin_ = 0;
    return true;
  }
  curve_.offset = start.f;
  if (!slope && !bend) return false;
  Real first = end_;
  for (int halvings = 0; halvings < 400; ++halvings) {
    const Real third =
        first * first / 6 * std::max<Real>(curve_.bound(3, Real(0)), curve_.bound(3, first));
    const Real lead = slope ? abs(start.f1) : abs(start.f2) * first / 2;
    const Real rest = slope ? abs(start.f2) * first / 2 + third : third;
    if (lead > rest * (1 + Real(1) / 16)) break;
    first /= 2;
  }
  begin_ = first;
  return first < end_;
}

/// A root just outside of the interval, or on its end, could as well lie inside.
template <class Real>
void OracleSearch<Real>::look_at_ends() {
  const auto look = [&](const Real& t) {
    if (t < begin_ || t > end_) return;
    const auto value = curve_(t);
    const Noise here =
        noise(at(motion_, t), t, static_cast<double>(value.f1), static_cast<double>(value.f2));
    Conditions conditions;
    conditions.add(false, over(certain(t, value.f), here.inputs));
    conditions.add_arms(here);
    near_decision(conditions.margin());
  };
  if (!just_collided_) look(Real(0));
  if (!found_) look(horizon_);
}

template <class Real>
template <class T>
typename OracleSearch<Real>::Piece OracleSearch<Real>::classify(const Curve<T>& curve,
                                                                const T& middle,
                                                                const T& half) const {
  using std::abs;
  using std::max;
  const auto value = curve(middle);
  const T third = max<T>(curve.bound(3, middle - half), curve.bound(3, middle + half)) * half *
                  (1 + T(1) / (1 << 30));
  const auto decide = [&](const T& n0, const T& n1, const T& n2) {
    const T bend = (abs(value.f2) + n2) * half;
    if (abs(value.f) - n0 - guard_ > (abs(value.f1) + n1 + bend / 2 + third * half / 6) * half) {
      return Piece::free;
    }
    if (abs(value.f1) - n1 > bend + third * half / 2) return Piece::monotone;
    if (abs(value.f2) - n2 > third) return Piece::convex;
    return Piece::mixed;
  };
  const Piece piece =
      decide(curve.noise(0, middle), curve.noise(1, middle), curve.noise(2, middle));
  if (piece != Piece::mixed) return piece;
  return decide(T(0), T(0), T(0)) == Piece::mixed ? Piece::mixed : Piece::unclear;
}

template <class Real>
typename OracleSearch<Real>::Piece OracleSearch<Real>::classify(const Real& begin,
                                                                const Real& end) {
  const Real middle = (begin + end) / 2, half = (end - begin) / 2;
  const double t = static_cast<double>(middle);
  const double unit = 2 * unit_roundoff<double>();
  const double width = static_cast<double>(half) * (1 + 4 * unit) + 2 * unit * std::abs(t);
  ++answer_.evaluations;
  const Piece piece = classify(coarse_, t, width);
  if (piece != Piece::unclear) return piece;
  if (std::is_same_v<Real, double>) {
    open_question();
    return piece;
  }
  ++answer_.precise;
  return classify(curve_, middle, half);
}

template <class Real>
void OracleSearch<Real>::search() {
  using std::abs;
  using std::ldexp;
  using std::max;
  std::vector<std::pair<Real, Real>> pieces = {{begin_, end_}};
  const Real finest = ldexp(Real(1), 24 - std::numeric_limits<Real>::digits);
  while (!pieces.empty() && !found_ && !given_up()) {
    const auto [begin, end] = pieces.back();
    pieces.pop_back();
    const Piece piece = classify(begin, end);
    if (piece == Piece::free) continue;
    if (piece == Piece::monotone || piece == Piece::convex) {
      on_piece(begin, end, piece);
    } else if (end - begin < finest * max<Real>(Real(1), abs(end)) || answer_.precise > 200000) {
      open_question();
    } else {
      // Not the middle: roots of hand-made pairs like to lie on round fractions.
      const Real cut = begin + (end - begin) * Real(0.4891357421875);
      pieces.emplace_back(cut, end);
      pieces.emplace_back(begin, cut);
    }
  }
}

template <class Real>
int OracleSearch<Real>::resolve(const Real& t, const typename Curve<Real>::Value& value) const {
  using std::abs;
  if (abs(value.f) <= curve_.noise(0, t)) return 0;
  return value.f > 0 ? 1 : -1;
}

/// 1 or -1. A root exactly at t counts as positive, for both pieces that meet there.
template <class Real>
int OracleSearch<Real>::sign(const Real& t) {
  const double rounded = static_cast<double>(t);
  const auto coarse = coarse_(rounded);
  ++answer_.evaluations;
  const double noise =
      coarse_.noise(0, rounded) + (std::abs(coarse.f1) + coarse_.noise(1, rounded)) *
                                      std::abs(rounded) * unit_roundoff<double>() * 2;
  if (std::abs(coarse.f) > noise) return coarse.f > 0 ? 1 : -1;
  if (std::is_same_v<Real, double>) open_question();
  ++answer_.precise;
  return resolve(t, curve_(t)) < 0 ? -1 : 1;
}

template <class Real>
void OracleSearch<Real>::on_piece(const Real& begin, const Real& end, Piece piece) {
  const int left = sign(begin), right = sign(end);
  if (left != right) {
    on_root(begin, end, left);
  } else if (piece == Piece::convex) {
    on_dip(begin, end, left);
  }
}

/// A convex or concave piece with equal signs at its ends: two roots, a touch or none.
template <class Real>
void OracleSearch<Real>::on_dip(const Real& begin, const Real& end, int side) {
  using std::abs;
  answer_.precise += 2;
  Real low = begin, high = end;
  if (curve_(low).f1 * side >= 0 || curve_(high).f1 * side <= 0) return;
  Real t = (low + high) / 2;
  typename Curve<Real>::Value value;
  for (int step = 0; step < 2 * std::numeric_limits<Real>::digits; ++step) {
    value = curve_(t);
    ++answer_.precise;
    if (abs(value.f1) <= curve_.noise(1, t)) break;
    (value.f1 * side < 0 ? low : high) = t;
    Real next = t - value.f1 / value.f2;
    if (!(next > low && next < high)) next = (low + high) / 2;
    if (next == t) break;
    t = next;
  }
  const int there = resolve(t, value);
  if (there == -side) {
    on_root(begin, t, side);
    if (!found_) on_root(t, end, -side);
    return;
  }
  if (there == 0 && std::is_same_v<Real, double>) open_question();
  // No change of sign, or an exact touch, which is none either. Would it be one for other inputs?
  if (t <= 0 || t > horizon_) return;
  const double f2 = static_cast<double>(value.f2);
  const Geometry<Real> g = at(motion_, t);
  const double inputs = noise(g, t, 0, f2).inputs;
  const double depth = certain(t, value.f);
  const double reach = std::sqrt(over(2 * (depth + margin_cap * inputs), f2));
  Conditions conditions;
  conditions.add(false, over(depth, inputs));
  conditions.add_arms(noise(g, t, 0, f2, reach));
  if (there == 0 && conditions.margin() < 1) {
    open_question();
  } else {
    near_decision(conditions.margin());
  }
}

template <class Real>
void OracleSearch<Real>::on_root(const Real& begin, const Real& end, int side) {
  if (skip_root_ && side == -skip_side_) {
    skip_root_ = false;
    return;
  }
  Real guess = (begin + end) / 2;
  if (static_cast<double>(end - begin) > 1e-12 * std::abs(static_cast<double>(end))) {
    const Bracket bracket = narrow(begin, end, side);
    if (arms_clearly_outside(bracket)) {
      arms_outside_ = true;
      return;
    }
    if (bracket.guess > begin && bracket.guess < end) guess = bracket.guess;
  }
  judge_root(refine(begin, end, guess, side));
}

}  // namespace needlework::test
