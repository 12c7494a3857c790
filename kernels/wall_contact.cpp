#include "kernels/wall_contact.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "kernels/power_of_two.h"

namespace needlework::kernels {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double two_pi = 0x1.921fb54442d18p+2;
const DoubleDouble exact_two_pi{two_pi, 0x1.1a62633145c07p-52};

// The terms of h in numbers of type T, for the tip at +u; the other tip has -turn.
template <class T>
struct Terms {
  T z, v, g;                      // above the middle of the wall's motion
  T cosine, sine, omega;          // l/2 u_n = cosine cos(omega s) + sine sin(omega s)
  T amplitude, turns, frequency;  // of the surface, along the normal
  bool moves = false;
};

template <class T>
struct Height {
  T h, dh, ddh;
  double error_h, error_dh;  // what rounding may have done
};

// Bounds on the terms, for errors and derivatives.
struct Sizes {
  double z, v, g, turn, omega, amplitude, rate;
  double bend() const { return (g + turn * omega * omega) + amplitude * rate * rate; }
  double twist() const { return turn * omega * omega * omega + amplitude * rate * rate * rate; }
};

template <class T>
T two_pi_of();
template <>
double two_pi_of<double>() {
  return two_pi;
}
template <>
DoubleDouble two_pi_of<DoubleDouble>() {
  return exact_two_pi;
}

Terms<DoubleDouble> terms_of(const WallApproach& a) {
  const Flight& flight = *a.flight;
  const int axis = a.wall.axis;
  const double sign = a.wall.normal;
  Terms<DoubleDouble> out;
  const DoubleDouble place = two_sum(component(flight.r, axis), -a.wall.place);
  out.z = {sign * place.hi, sign * place.lo};
  out.v = sign * component(flight.v, axis);
  out.g = sign * a.gravity;
  out.cosine = two_prod(sign * a.half, component(flight.u, axis));
  if (flight.omega > 0) {
    // |w| and w x u / |w| again, to full precision; w first scaled by a power of two.
    const int exponent = exponent_of(flight.omega);
    const Vec3dd w = to_double_double(Vec3d{times_power_of_two(flight.w.x, -exponent),
                                            times_power_of_two(flight.w.y, -exponent),
                                            times_power_of_two(flight.w.z, -exponent)});
    const DoubleDouble length = sqrt(dot(w, w));
    const DoubleDouble p = component(cross(w, to_double_double(flight.u)), axis) / length;
    out.sine = DoubleDouble(sign * a.half) * p;
    out.omega = {times_power_of_two(length.hi, exponent), times_power_of_two(length.lo, exponent)};
  }
  out.moves = a.wall.amplitude > 0;
  out.amplitude = sign * a.wall.amplitude;
  out.turns = a.turns;
  out.frequency = a.wall.frequency;
  return out;
}

Terms<double> rounded(const Terms<DoubleDouble>& terms) {
  return {to_double(terms.z),         to_double(terms.v),
          to_double(terms.g),         to_double(terms.cosine),
          to_double(terms.sine),      to_double(terms.omega),
          to_double(terms.amplitude), to_double(terms.turns),
          to_double(terms.frequency), terms.moves};
}

Sizes sizes_of(const Terms<double>& t) {
  Sizes out;
  out.z = std::abs(t.z);
  out.v = std::abs(t.v);
  out.g = std::abs(t.g) * roundup;
  out.turn = std::sqrt(t.cosine * t.cosine + t.sine * t.sine) * roundup;
  out.omega = t.omega * roundup;
  out.amplitude = t.moves ? std::abs(t.amplitude) * roundup : 0;
  out.rate = t.moves ? two_pi * std::abs(t.frequency) * roundup : 0;
  return out;
}

// h with two derivatives at s, for one of the tips, less what is called 0.
template <class T>
Height<T> height(const Terms<T>& t, const Sizes& sizes, int tip, const T& zero, double s) {
  const T time(s), half(0.5);
  const T sign(tip == 0 ? 1.0 : -1.0);
  const SineCosine<T> turn = sine_cosine(t.omega * time);
  const T along = (t.cosine * turn.cosine + t.sine * turn.sine) * sign;
  const T across = (t.sine * turn.cosine - t.cosine * turn.sine) * sign;
  Height<T> out;
  out.h = ((t.z + t.v * time) + (half * t.g) * (time * time)) + along;
  out.dh = (t.v + t.g * time) + t.omega * across;
  out.ddh = t.g - t.omega * t.omega * along;
  double phase = 0;
  if (t.moves) {
    const T rate = two_pi_of<T>() * t.frequency;
    const T angle = two_pi_of<T>() * (t.turns + t.frequency * time);
    const SineCosine<T> sc = sine_cosine(angle);
    out.h = out.h - t.amplitude * sc.sine;
    out.dh = out.dh - t.amplitude * rate * sc.cosine;
    out.ddh = out.ddh + t.amplitude * rate * rate * sc.sine;
    phase = std::abs(to_double(angle));
  }
  out.h = out.h - zero;
  // A dozen roundings of each term, and of its phase.
  constexpr double rounding = 16 * unit_roundoff<T>;
  const double turned = 1 + sizes.omega * s, moved = 1 + phase;
  out.error_h = rounding * ((sizes.z + sizes.v * s + sizes.g * s * s) + sizes.turn * turned +
                            sizes.amplitude * moved + std::abs(to_double(zero)));
  out.error_dh = rounding * ((sizes.v + sizes.g * s) + sizes.turn * sizes.omega * turned +
                             sizes.amplitude * sizes.rate * moved);
  return out;
}

// The largest time for which low + slope t - bend t^2 / 2 is above 0, for low > 0.
double safe_step(double low, double slope, double bend) {
  const double root = std::sqrt(slope * slope + 2 * bend * low);
  if (slope < 0) return 2 * low / (root - slope);
  return bend > 0 ? (root + slope) / bend : infinity;
}

// From a tip at height 0 on, with these derivatives, so long the height stays above 0.
double safe_step_from_contact(double slope, double curvature, double twist) {
  // slope t + curvature t^2 / 2 - twist t^3 / 6 > 0
  if (twist == 0) {
    if (curvature >= 0) return slope > 0 || curvature > 0 ? infinity : 0;
    return 2 * slope / -curvature;
  }
  const double root = std::sqrt(0.25 * curvature * curvature + (2.0 / 3) * twist * slope);
  if (curvature < 0) return 2 * slope / (root - 0.5 * curvature);
  return 3 * (0.5 * curvature + root) / twist;
}

// The time before which the centre does not come nearer to the surface than half the length;
// infinite if it does not until `to`. That is so for most needles and walls.
double time_to_come_near(const WallApproach& a, double to) {
  const double sign = a.wall.normal, v = sign * component(a.flight->v, a.wall.axis),
               g = sign * a.gravity,
               z = sign * (component(a.flight->r, a.wall.axis) - a.wall.place);
  const double near = a.half + a.wall.amplitude;
  const double apart = z - (near + 0x1p-40 * (std::abs(z) + near));
  if (!(apart > 0)) return 0;
  // The first time at which apart + v s + g s^2 / 2 is 0.
  const double square = v * v - 2 * g * apart;
  if (square < 0 || (v >= 0 && g >= 0)) return infinity;
  const double root = std::sqrt(square);
  const double at = v < 0 ? 2 * apart / (root - v) : (root + v) / -g;
  return at > to ? infinity : at * (1 - 0x1p-40);
}

// The search for the first contact of one tip. It goes by stretches of time whose begin depends on
// nothing but the record, so that it may begin in any of them and still finds the same bits.
class TipSearch {
 public:
  TipSearch(const WallApproach& approach, const Terms<DoubleDouble>& exact,
            const Terms<double>& terms, const Sizes& sizes, int tip)
      : exact_(exact), terms_(terms), sizes_(sizes), tip_(tip), tick_(approach.resolution / 8) {
    bend_ = sizes.bend() * roundup;
    const double v = sizes.v + sizes.turn * sizes.omega + sizes.amplitude * sizes.rate;
    const double rate =
        std::max({v / approach.half, sizes.omega, sizes.rate, std::sqrt(sizes.g / approach.half)});
    stretch_ = rate > 0 ? times_power_of_two(1, 3 - exponent_of(rate)) : infinity;
    was_touching_ = approach.touching >> tip & 1;
    const Height<double> rough = height(terms, sizes, tip, 0.0, 0);
    at_wall_ = was_touching_ || rough.h <= rough.error_h;
    if (!at_wall_) return;
    at_record_ = height(exact, sizes, tip, DoubleDouble(), 0);
    at_wall_ = was_touching_ || to_double(at_record_.h) <= at_record_.error_h;
  }

  bool is_across(double within) const { return at_wall_ && to_double(at_record_.h) < -within; }

  // At or after the record; infinite if there is none up to `to`.
  double first(double enter, double from, double to) {
    double begin = enter;
    if (at_wall_) {
      const Height<DoubleDouble>& now = at_record_;
      // It is at the wall, whatever rounding its record has done to that.
      zero_ = now.h;
      const double slope = to_double(now.dh);
      if (slope < -now.error_dh || (slope <= now.error_dh && to_double(now.ddh) < 0)) return 0;
      const double leaves = safe_step_from_contact(std::max(slope, 0.0), to_double(now.ddh),
                                                   sizes_.twist() * roundup);
      if (leaves == 0) return 0;
      begin = std::max(begin, 0.75 * leaves);
    }
    if (begin > to) return infinity;
    // Where the stretch in which to begin is not that of `begin`, there is nothing between.
    const double first_stretch = std::floor(begin / stretch_);
    const double earliest = std::floor(std::max(0.0, from * (1 - 0x1p-40)) / stretch_);
    double s = earliest > first_stretch ? earliest * stretch_ : begin;
    for (double n = std::max(first_stretch, earliest);; ++n) {
      const double end = std::isinf(stretch_) ? infinity : (n + 1) * stretch_;
      const double at = in_stretch(s, std::min(end, to * (1 + 0x1p-40) + tick_));
      if (!std::isinf(at)) return at;
      if (!(end <= to)) return infinity;
      s = end;
    }
  }

 private:
  // From s, where the height is above 0 or 0, to the end.
  double in_stretch(double s, double end) {
    while (s <= end) {
      const Height<double> rough = height(terms_, sizes_, tip_, to_double(zero_), s);
      const double step = step_from(rough, rough.h);
      if (step > 1024 * tick_ && step > 0x1p-30 * s) {
        s += step;
        continue;
      }
      const Height<DoubleDouble> fine = height(exact_, sizes_, tip_, zero_, s);
      const double fine_step = step_from(fine, to_double(fine.h));
      if (fine_step > tick_ && s + fine_step > s) {
        s += fine_step;
        continue;
      }
      const double slope = to_double(fine.dh);
      if (slope < 0) return s;
      // It grazes the wall, and leaves it.
      const double leaves = safe_step_from_contact(slope, to_double(fine.ddh) - bend_rounding(),
                                                   sizes_.twist() * roundup);
      if (!(0.75 * leaves > tick_ && s + 0.75 * leaves > s)) return s;
      s += 0.75 * leaves;
    }
    return infinity;
  }
  template <class T>
  double step_from(const Height<T>& at, double h) const {
    const double low = h - at.error_h;
    if (!(low > 0)) return 0;
    return safe_step(low, to_double(at.dh) - at.error_dh, bend_) * (1 - 0x1p-40);
  }
  double bend_rounding() const { return bend_ * 0x1p-40; }

  const Terms<DoubleDouble>& exact_;
  const Terms<double>& terms_;
  const Sizes& sizes_;
  const int tip_;
  const double tick_;
  double bend_, stretch_;
  bool was_touching_, at_wall_;
  Height<DoubleDouble> at_record_;
  DoubleDouble zero_;
};

}  // namespace

WallSurface surface_at(const WallPlane& wall, const DoubleDouble& turns) {
  if (!(wall.amplitude > 0)) return {wall.place, 0};
  const SineCosine<DoubleDouble> sc = sine_cosine(exact_two_pi * turns);
  return {wall.place + wall.amplitude * to_double(sc.sine),
          wall.amplitude * (two_pi * wall.frequency) * to_double(sc.cosine)};
}

WallContact first_wall_contact(const WallApproach& approach, double from, double to) {
  WallContact out;
  const double enter = time_to_come_near(approach, to);
  if (std::isinf(enter)) return out;
  const Terms<DoubleDouble> exact = terms_of(approach);
  const Terms<double> terms = rounded(exact);
  const Sizes sizes = sizes_of(terms);
  // Besides the rounding of the record, that of the time of a contact.
  const double within =
      approach.tolerance +
      4 * approach.resolution * (sizes.v + sizes.turn * sizes.omega + sizes.amplitude * sizes.rate);
  for (int tip = 0; tip < 2; ++tip) {
    TipSearch search(approach, exact, terms, sizes, tip);
    if (search.is_across(within)) return {.found = true, .tip = tip, .across = true};
    const double at = search.first(enter, from, to);
    if (std::isinf(at) || (out.found && at >= out.elapsed)) continue;
    out.found = true;
    out.elapsed = at;
    out.tip = tip;
    out.unresolvable = (approach.touching >> tip & 1) && at > 0 && at < 64 * approach.resolution;
    to = at;
  }
  return out;
}

}  // namespace needlework::kernels
