// The second half of the oracle's search: one root, isolated, is refined and judged.
#pragma once

#include "tests/support/oracle_search.h"

namespace needlework::test {

/// Shrinks the bracket as far as the signs in double are certain.
template <class Real>
typename OracleSearch<Real>::Bracket OracleSearch<Real>::narrow(const Real& begin, const Real& end,
                                                                int side) {
  const double unit = 2 * unit_roundoff<double>();
  Bracket bracket{static_cast<double>(begin), static_cast<double>(end), 0};
  const auto widen = [&](double t) { return 2 * unit * std::abs(t); };
  bracket.low -= widen(bracket.low);
  bracket.high += widen(bracket.high);
  double t = bracket.guess = (bracket.low + bracket.high) / 2;
  const auto sign_here = [&](double time, Curve<double>::Value& value) {
    value = coarse_(time);
    ++answer_.evaluations;
    if (std::abs(value.f) <= coarse_.noise(0, time)) return 0;
    const int found = value.f > 0 ? 1 : -1;
    (found == side ? bracket.low : bracket.high) = time;
    return found;
  };
  Curve<double>::Value value;
  for (int step = 0; step < 100; ++step) {
    const int found = sign_here(t, value);
    bracket.guess = t;
    if (found == 0) break;
    double next = t - value.f / value.f1;
    if (!(next > bracket.low && next < bracket.high)) next = (bracket.low + bracket.high) / 2;
    if (next == t) break;
    t = next;
  }
  const double radius = over(8 * coarse_.noise(0, t), value.f1) + 4 * widen(t);
  for (const double near : {t - radius, t + radius}) {
    if (near > bracket.low && near < bracket.high) sign_here(near, value);
  }
  return bracket;
}

/// Proof in double that one of |s12|, |s21| exceeds its half length by 0.001 all over the bracket:
/// |r12| < 1 gives |d(s x.x)/dt| <= |v12| + 2W and |d(x.x)/dt| <= 2W.
template <class Real>
bool OracleSearch<Real>::arms_clearly_outside(const Bracket& bracket) const {
  const double middle = (bracket.low + bracket.high) / 2, half = (bracket.high - bracket.low) / 2;
  const Geometry<double> g = at(coarse_motion_, middle);
  const double spin = coarse_motion_.total_spin(), speed = norm(coarse_motion_.velocity);
  const double noise = 128 * unit_roundoff<double>() * (1 + spin * std::abs(middle)) *
                       (1 + norm(coarse_motion_.separation) + speed * std::abs(middle));
  const auto most = [&](int i) {
    return (coarse_motion_.half[i] + 0.001) * (g.xx + 2 * spin * half + noise);
  };
  const double lost = 1.001 * (speed + 2 * spin) * half + noise;
  return std::abs(g.numerator[0]) - lost > most(0) || std::abs(g.numerator[1]) - lost > most(1);
}

template <class Real>
Real OracleSearch<Real>::refine(Real low, Real high, Real t, int side) {
  for (int step = 0; step < 2 * std::numeric_limits<Real>::digits; ++step) {
    const auto value = curve_(t);
    ++answer_.precise;
    const int found = resolve(t, value);
    if (found == 0) break;
    (found == side ? low : high) = t;
    Real next = t - value.f / value.f1;
    if (!(next > low && next < high)) next = (low + high) / 2;
    if (next == t) break;
    t = next;
  }
  return t;
}

template <class Real>
Geometry<double> OracleSearch<Real>::rounded(const Geometry<Real>& g) const {
  Geometry<double> to;
  to.separation = convert<double>(g.separation);
  to.x = convert<double>(g.x);
  to.dx = convert<double>(g.dx);
  to.xx = static_cast<double>(g.xx);
  for (int i = 0; i < 2; ++i) {
    to.u[i] = convert<double>(g.u[i]);
    to.du[i] = convert<double>(g.du[i]);
    to.numerator[i] = static_cast<double>(g.numerator[i]);
    to.arm_rate[i] = static_cast<double>(g.arm_rate[i]);
  }
  return to;
}

template <class Real>
Noise OracleSearch<Real>::noise(const Geometry<Real>& g, const Real& t, double f1, double f2,
                                double reach) const {
  const double time = std::abs(static_cast<double>(t));
  return noise_at(coarse_motion_, rounded(g), time, f1, f2, residual_, reach);
}

/// True when x = u1 x u2 may vanish within `radius` of the root, so that the root may be one of x
/// and not a contact. A contact needs the part of r12 normal to a director to be below |x| times a
/// half length.
template <class Real>
bool OracleSearch<Real>::judge_parallel(const Geometry<Real>& g, const Real& radius) {
  using std::sqrt;
  const Real tiny = motion_.total_spin() * radius + 256 * unit_roundoff<Real>();
  const Real sine = sqrt(g.xx);
  // Doubles settle only where the arms hardly change over the root's uncertainty.
  if (sine > (std::is_same_v<Real, double> ? 4096 : 4) * tiny) return false;
  parallel_ = true;
  const Real apart = norm(cross(g.u[0], g.separation));
  if (apart > sine + 4 * tiny && !std::is_same_v<Real, double>) {
    const double noise = unit_roundoff<double>() * 4 * (1 + norm(coarse_motion_.separation));
    near_decision(over(static_cast<double>(apart), noise));
  } else {
    open_question();
  }
  return true;
}

template <class Real>
void OracleSearch<Real>::judge_root(const Real& t) {
  using std::abs;
  using std::ldexp;
  using std::min;
  using std::sqrt;
  const auto value = curve_(t);
  const Real error = 2 * curve_.noise(0, t);
  Real radius = 4 * unit_roundoff<Real>() * abs(t);
  if (value.f1 != 0) radius += error / abs(value.f1);
  const Geometry<Real> g = at(motion_, t);
  if (judge_parallel(g, radius)) return;

  const double f1 = static_cast<double>(value.f1), f2 = static_cast<double>(value.f2);
  // In double, f' must be large enough for `radius`.
  if (std::is_same_v<Real, double> && f1 * f1 < 16 * std::abs(f2) * static_cast<double>(error)) {
    open_question();
  }
  const Noise here = noise(g, t, f1, f2);
  const double time = static_cast<double>(t), last = static_cast<double>(horizon_);
  Conditions conditions;
  conditions.add_arms(here);
  conditions.add(true, over(over(f1 * f1, 2 * f2), here.inputs));
  if (!just_collided_) conditions.add(t > radius, over(time, here.shift_inputs));
  const bool in_time = t <= horizon_ + radius;
  conditions.add(in_time, over(static_cast<double>(horizon_ - t),
                               here.shift_inputs + unit_roundoff<double>() * last));
  near_decision(conditions.margin());

  bool inside = true;
  for (int i = 0; i < 2; ++i) {
    const Real arm = g.numerator[i] / g.xx;
    const Real wrong =
        64 * unit_roundoff<Real>() * (1 + abs(arm)) / sqrt(g.xx) + abs(g.arm_rate[i]) * radius;
    const Real margin = motion_.half[i] - abs(arm);
    if (abs(margin) <= wrong) open_question();
    inside = inside && margin > wrong;
  }
  if (!inside) arms_outside_ = true;
  if (!inside || !in_time || (!just_collided_ && t <= radius)) return;

  found_ = true;
  const Real exact = ldexp(min<Real>(t, horizon_), -motion_.exponent);
  answer_.contact = true;
  answer_.outcome = Outcome::contact;
  answer_.time = static_cast<double>(exact);
  answer_.time_low = static_cast<double>(Real(exact - Real(answer_.time)));
  answer_.arm_first = static_cast<double>(Real(unit_ * g.numerator[0] / g.xx));
  answer_.arm_second = static_cast<double>(Real(unit_ * g.numerator[1] / g.xx));
  answer_.time_limit = over(here.evaluation, f1 * time);
  answer_.input_limit = over(here.inputs, f1 * time);
  answer_.root_depth = over(over(f1 * f1, 2 * f2), here.evaluation);
  answer_.arm_limit =
      static_cast<double>(unit_) * std::max(here.arms_evaluation[0], here.arms_evaluation[1]);
}

}  // namespace needlework::test
