#include "kernels/wall_contact.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

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
  T growth{};  // l/2 u_n is 1 + growth s times as large at s
};

template <class T>
struct Height {
  T h, dh, ddh;
  double error_h, error_dh;  // what rounding may have done
};

// Bounds on the terms, for errors and derivatives.
struct Sizes {
  double z, v, g, turn, omega, amplitude, rate, growth;
  // Of the second and the third derivative of h, up to s.
  double bend(double s) const {
    return (g + turn * omega * (omega * grown(s) + 2 * growth)) + amplitude * rate * rate;
  }
  double twist(double s) const {
    return turn * omega * omega * (omega * grown(s) + 3 * growth) + amplitude * rate * rate * rate;
  }
  double grown(double s) const { return growth == 0 ? 1 : (1 + growth * s) * roundup; }
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
  const DoubleDouble place = DoubleDouble(component(flight.r, axis)) - a.wall.place;
  const DoubleDouble speed = two_sum(component(flight.v, axis), -a.wall.velocity);
  out.z = {sign * place.hi, sign * place.lo};
  out.v = {sign * speed.hi, sign * speed.lo};
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
  out.growth = a.growth;
  return out;
}

// The same from the record's own doubles, of which p and |w| are rounded.
Terms<double> rough_terms_of(const WallApproach& a) {
  const Flight& flight = *a.flight;
  const int axis = a.wall.axis;
  const double sign = a.wall.normal, half = sign * a.half;
  return {.z = sign * ((component(flight.r, axis) - a.wall.place.hi) - a.wall.place.lo),
          .v = sign * (component(flight.v, axis) - a.wall.velocity),
          .g = sign * a.gravity,
          .cosine = half * component(flight.u, axis),
          .sine = half * component(flight.p, axis),
          .omega = flight.omega,
          .amplitude = sign * a.wall.amplitude,
          .turns = to_double(a.turns),
          .frequency = a.wall.frequency,
          .moves = a.wall.amplitude > 0,
          .growth = a.growth};
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
  out.growth = t.growth;
  return out;
}

// h with two derivatives at s, for one of the tips, less what is called 0.
template <class T>
Height<T> height(const Terms<T>& t, const Sizes& sizes, int tip, const T& zero, double s) {
  const T time(s), half(0.5);
  const T sign(tip == 0 ? 1.0 : -1.0);
  const SineCosine<T> turn = sine_cosine(t.omega * time);
  T along = (t.cosine * turn.cosine + t.sine * turn.sine) * sign;
  T across = (t.sine * turn.cosine - t.cosine * turn.sine) * sign;
  Height<T> out;
  if (sizes.growth == 0) {
    out.dh = (t.v + t.g * time) + t.omega * across;
    out.ddh = t.g - t.omega * t.omega * along;
  } else {
    const T grown = T(1.0) + t.growth * time;
    out.dh = (t.v + t.g * time) + (grown * t.omega * across + t.growth * along);
    out.ddh = t.g - t.omega * (grown * t.omega * along - (t.growth + t.growth) * across);
    along = along * grown;
  }
  out.h = ((t.z + t.v * time) + (half * t.g) * (time * time)) + along;
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
  // Two dozen roundings of each term, and of its phase.
  constexpr double rounding = 32 * unit_roundoff<T>;
  const double turned = (1 + sizes.omega * s) * sizes.grown(s), moved = 1 + phase;
  out.error_h = rounding * ((sizes.z + sizes.v * s + sizes.g * s * s) + sizes.turn * turned +
                            sizes.amplitude * moved + std::abs(to_double(zero)));
  out.error_dh =
      rounding * ((sizes.v + sizes.g * s) + sizes.turn * (sizes.omega + sizes.growth) * turned +
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
    // Also of a needle that lies on the wall and moves along it.
    if (curvature >= 0) return infinity;
    return 2 * slope / -curvature;
  }
  const double root = std::sqrt(0.25 * curvature * curvature + (2.0 / 3) * twist * slope);
  if (curvature < 0) return 2 * slope / (root - 0.5 * curvature);
  return 3 * (0.5 * curvature + root) / twist;
}

// The time before which the centre does not come so near to the surface that a tip can touch it;
// infinite if it does not until `to`. That is so for most needles and walls.
double time_to_come_near(const Terms<double>& t, const Sizes& sizes, double to) {
  const double near = sizes.turn + sizes.amplitude;
  const double apart = t.z - (near + 0x1p-40 * (sizes.z + near));
  if (!(apart > 0)) return 0;
  // The first time at which apart + v s + g s^2 / 2 is 0.
  const double v = t.v - t.growth * near, square = v * v - 2 * t.g * apart;
  if (square < 0 || (v >= 0 && t.g >= 0)) return infinity;
  const double root = std::sqrt(square);
  const double at = v < 0 ? 2 * apart / (root - v) : (root + v) / -t.g;
  return at > to ? infinity : at * (1 - 0x1p-40);
}

// A needle and a wall: their terms, and what follows from them.
class Approach {
 public:
  explicit Approach(const WallApproach& given)
      : given_(given), rough_(rough_terms_of(given)), sizes_(sizes_of(rough_)) {
    const double v =
        sizes_.v + sizes_.turn * (sizes_.omega + sizes_.growth) + sizes_.amplitude * sizes_.rate;
    // Besides the rounding of the record, that of the time of a contact.
    within_ = given.tolerance + 4 * given.resolution * v;
    const double size = given.half + given.radius;
    const double rate =
        std::max({v / size, sizes_.omega, sizes_.rate, std::sqrt(sizes_.g / size), sizes_.growth});
    stretch_ = rate > 0 ? times_power_of_two(1, 3 - exponent_of(rate)) : infinity;
    bend_ = sizes_.bend(stretch_) * roundup;
    twist_ = sizes_.twist(stretch_) * roundup;
  }

  double time_to_come_near(double to) const {
    return kernels::time_to_come_near(rough_, sizes_, to);
  }
  Height<double> rough(int tip, double zero, double s) const {
    return height(rough_, sizes_, tip, zero, s);
  }
  Height<DoubleDouble> exact(int tip, const DoubleDouble& zero, double s) {
    if (!exact_) exact_ = terms_of(given_);
    return height(*exact_, sizes_, tip, zero, s);
  }
  bool is_touching(int tip) const { return given_.touching >> tip & 1; }
  double within() const { return within_; }  ///< a tip at the wall may be so far beyond it [L]
  double stretch() const {
    return stretch_;
  }                                      ///< in which the needle moves a few lengths or radians
  double bend() const { return bend_; }  ///< in the first stretch
  double twist() const { return twist_; }
  /// The same up to the end of a later one.
  double bend_until(double end) const {
    return sizes_.growth == 0 ? bend_ : sizes_.bend(end) * roundup;
  }
  double twist_until(double end) const {
    return sizes_.growth == 0 ? twist_ : sizes_.twist(end) * roundup;
  }
  bool grows() const { return sizes_.growth != 0; }

 private:
  const WallApproach& given_;
  Terms<double> rough_;
  Sizes sizes_;
  std::optional<Terms<DoubleDouble>> exact_;
  double within_, stretch_, bend_, twist_;
};

// The search for the first contact of one tip. It goes by stretches of time whose begin depends on
// nothing but the record, so that it may begin in any of them and still finds the same bits.
class TipSearch {
 public:
  TipSearch(Approach& approach, int tip, double resolution)
      : approach_(approach), tip_(tip), tick_(resolution / 8) {
    if (!approach.is_touching(tip)) exact_zero_ = DoubleDouble();
  }
  // The same tip from the time on at which the wall comes to rest, if it has not touched before.
  // What is called height 0 stays so.
  TipSearch(TipSearch& moving, Approach& rests, double halt)
      : approach_(rests),
        tip_(moving.tip_),
        tick_(moving.tick_),
        begin_(halt),
        rough_zero_(moving.rough_zero_),
        exact_zero_(moving.exact_zero()) {}

  // From the tip's height at the record: its contact may be then, at 0, or come no earlier than
  // begin().
  enum class Start { above, leaves, hits, across };
  Start start() {
    const Height<double> rough = approach_.rough(tip_, 0, 0);
    const bool touching = approach_.is_touching(tip_);
    if (!touching && rough.h > rough.error_h) return Start::above;
    // Of a tip that leaves fast, double tells enough.
    if (touching && std::abs(rough.h) < approach_.within() && rough.dh > 0x1p20 * rough.error_dh) {
      rough_zero_ = rough.h;
      return leave(rough.dh - rough.error_dh, rough.ddh - 0x1p-40 * approach_.bend());
    }
    const Height<DoubleDouble> exact = approach_.exact(tip_, DoubleDouble(), 0);
    const double h = to_double(exact.h), slope = to_double(exact.dh);
    if (h < -approach_.within()) return Start::across;
    if (!touching && h > exact.error_h) return Start::above;
    // It is at the wall, whatever rounding its record has done to that.
    rough_zero_ = h;
    exact_zero_ = exact.h;
    const double curvature = to_double(exact.ddh);
    if (slope < -exact.error_dh || (slope <= exact.error_dh && curvature < 0)) return Start::hits;
    return leave(std::max(slope, 0.0), curvature);
  }

  // After start(): the contact at or after `enter`; infinite if there is none up to `to`.
  double first(double enter, double from, double to) {
    const double begin = std::max(enter, begin_), stretch = approach_.stretch();
    if (begin > to) return infinity;
    // Where the stretch in which to begin is not that of `begin`, there is nothing between.
    const double first_stretch = std::floor(begin / stretch);
    const double earliest = std::floor(std::max(0.0, from * (1 - 0x1p-40)) / stretch);
    double s = earliest > first_stretch ? earliest * stretch : begin;
    for (double n = std::max(first_stretch, earliest);; ++n) {
      const double end = std::isinf(stretch) ? infinity : (n + 1) * stretch;
      const double at = in_stretch(s, end, to * (1 + 0x1p-40) + tick_);
      if (!std::isinf(at)) return at;
      if (!(end <= to)) return infinity;
      s = end;
    }
  }

 private:
  Start leave(double slope, double curvature) {
    const double leaves = safe_step_from_contact(slope, curvature, approach_.twist());
    begin_ = 0.75 * leaves;
    if (approach_.grows()) begin_ = std::min(begin_, approach_.stretch());
    if (leaves > 0) return Start::leaves;
    // An impulse on the other tip may leave this one without speed and acceleration. It is then so
    // near to the wall for so long that nothing can happen to it.
    if (slope == 0 && curvature == 0 && approach_.is_touching(tip_)) {
      begin_ = 0x1p-20 * approach_.stretch();
      return Start::leaves;
    }
    return Start::hits;
  }
  // From s, where the height is above 0 or 0, to the end of the stretch, or to the last time asked
  // for.
  double in_stretch(double s, double end, double last) {
    const double bend = approach_.bend_until(end), twist = approach_.twist_until(end);
    while (s < end && s <= last) {
      const Height<double> rough = approach_.rough(tip_, rough_zero_, s);
      const double step = step_from(rough, rough.h, bend);
      if (step > 1024 * tick_ && step > 0x1p-30 * s) {
        s += step;
        continue;
      }
      // Of a tip that comes fast, double tells the time of contact well enough.
      const double fall = -(rough.dh + rough.error_dh);
      if (2 * rough.error_h <= fall * (0x1p-45 * approach_.stretch())) {
        const double at = s + std::max(rough.h, 0.0) / -rough.dh;
        return at < end ? at : infinity;
      }
      const Height<DoubleDouble> fine = approach_.exact(tip_, exact_zero(), s);
      const double fine_step = step_from(fine, to_double(fine.h), bend);
      if (fine_step > tick_ && s + fine_step > s) {
        s += fine_step;
        continue;
      }
      const double slope = to_double(fine.dh);
      if (slope < 0) return s;
      // It grazes the wall, and leaves it.
      const double leaves =
          safe_step_from_contact(slope, to_double(fine.ddh) - 0x1p-40 * bend, twist);
      if (!(0.75 * leaves > tick_ && s + 0.75 * leaves > s)) return s;
      s += 0.75 * leaves;
    }
    return infinity;
  }
  // Heights of double-double need a zero as good: that of double shifts the contact of a tip that
  // rebounds slowly by its rounding over the tip's speed.
  const DoubleDouble& exact_zero() {
    if (!exact_zero_) exact_zero_ = approach_.exact(tip_, DoubleDouble(), 0).h;
    return *exact_zero_;
  }
  template <class T>
  double step_from(const Height<T>& at, double h, double bend) const {
    const double low = h - at.error_h;
    if (!(low > 0)) return 0;
    return safe_step(low, to_double(at.dh) - at.error_dh, bend) * (1 - 0x1p-40);
  }

  Approach& approach_;
  const int tip_;
  const double tick_;
  double begin_ = 0;
  double rough_zero_ = 0;  // what is called height 0; of a tip that has hit, its height then
  std::optional<DoubleDouble> exact_zero_;
};

// A needle and a wall that comes to rest before the search ends, from then on.
struct Halted {
  Halted(const WallApproach& moving, double to) : given(moving) {
    given.wall = moving.wall.halted();
    approach.emplace(given);
    enter = approach->time_to_come_near(to);
  }
  Halted(const Halted&) = delete;

  WallApproach given;
  std::optional<Approach> approach;
  double enter;
};

}  // namespace

WallSurface surface_at(const WallPlane& wall, const DoubleDouble& turns, double s) {
  if (s >= wall.halt) return {to_double(wall.halt_place), 0};
  if (wall.velocity != 0)
    return {to_double(wall.place + two_prod(wall.velocity, s)), wall.velocity};
  const double place = to_double(wall.place);
  if (!(wall.amplitude > 0)) return {place, 0};
  const SineCosine<DoubleDouble> sc = sine_cosine(exact_two_pi * turns);
  return {place + wall.amplitude * to_double(sc.sine),
          wall.amplitude * (two_pi * wall.frequency) * to_double(sc.cosine)};
}

WallContact first_wall_contact(const WallApproach& given, double from, double to) {
  WallContact out;
  Approach approach(given);
  const double enter = approach.time_to_come_near(to), halt = given.wall.halt;
  std::optional<Halted> halted;
  if (halt <= to) halted.emplace(given, to);
  if (std::isinf(enter) && !halted) return out;
  for (int tip = 0; tip < 2; ++tip) {
    TipSearch search(approach, tip, given.resolution);
    const TipSearch::Start start = search.start();
    if (start == TipSearch::Start::across) return {.found = true, .tip = tip, .across = true};
    double at = start == TipSearch::Start::hits ? 0 : search.first(enter, from, std::min(to, halt));
    if (halt <= to && !(at <= halt))
      at = TipSearch(search, *halted->approach, halt).first(halted->enter, from, to);
    if (std::isinf(at) || (out.found && at >= out.elapsed)) continue;
    out.found = true;
    out.elapsed = at;
    out.tip = tip;
    out.unresolvable = approach.is_touching(tip) && at > 0 && at < 64 * given.resolution;
    to = at;
  }
  return out;
}

}  // namespace needlework::kernels
