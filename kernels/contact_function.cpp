#include "kernels/contact_function.h"

#include <algorithm>

#include "kernels/power_of_two.h"

namespace needlework::kernels {
namespace {

double largest(const Vec3d& a) { return std::max({std::abs(a.x), std::abs(a.y), std::abs(a.z)}); }

double norm_1(const Vec3d& a) { return (std::abs(a.x) + std::abs(a.y)) + std::abs(a.z); }

Vec3dd scaled(const Vec3dd& a, double power_of_two) {
  const auto times = [&](const DoubleDouble& x) {
    return DoubleDouble(x.hi * power_of_two, x.lo * power_of_two);
  };
  return {times(a.x), times(a.y), times(a.z)};
}

template <class T>
void set_half_lengths(Frame<T>& frame, const Pair& pair, const PairScale& scale) {
  frame.half[0] = pair.half_first * scale.per_length;
  frame.half[1] = pair.half_second * scale.per_length;
}

template <class T>
void set_norms(Frame<T>& frame) {
  const Vec3d v{to_double(frame.v.x), to_double(frame.v.y), to_double(frame.v.z)};
  const Vec3d r{to_double(frame.r.x), to_double(frame.r.y), to_double(frame.r.z)};
  frame.r_norm = norm_1(r) * roundup;
  frame.v_norm = norm_1(v) * roundup;
  frame.v_length = std::sqrt(dot(v, v)) * roundup;
  frame.w_sum = (to_double(frame.omega[0]) + to_double(frame.omega[1])) * roundup;
}

// Errors of what has been gained in a fall count relative to itself.
template <class T>
[[gnu::noinline]] void add_fall_to_norms(Frame<T>& frame, const Pair& pair,
                                         const PairScale& scale) {
  frame.v_norm += norm_1(to_double(pair.fall->velocity)) * (scale.per_velocity() * roundup);
}

}  // namespace

// What is 0, as the shift mostly is and one of the times always, is left out: adding it would
// change nothing.
Vec3dd separation(const Pair& pair) {
  const Vec3d &a = pair.first->r, &b = pair.second->r;
  Vec3dd out{two_sum(a.x, -b.x), two_sum(a.y, -b.y), two_sum(a.z, -b.z)};
  if (!(pair.shift == Vec3dd{})) out = out - pair.shift;
  if (!(pair.elapsed_first == DoubleDouble())) {
    out = out + to_double_double(pair.first->v) * pair.elapsed_first;
  }
  if (!(pair.elapsed_second == DoubleDouble())) {
    out = out - to_double_double(pair.second->v) * pair.elapsed_second;
  }
  return pair.fall ? out + pair.fall->place : out;
}

// Kept out of the code of needles that do not fall.
[[gnu::noinline]] Vec3dd falling_velocity(const Pair& pair) {
  const Vec3d &a = pair.first->v, &b = pair.second->v;
  return Vec3dd{two_sum(a.x, -b.x), two_sum(a.y, -b.y), two_sum(a.z, -b.z)} + pair.fall->velocity;
}

void set_rotation(Flight& flight) {
  const double size = largest(flight.w);
  if (size == 0) {
    flight.omega = 0;
    flight.p = {};
    return;
  }
  // Scaled by a power of two, so that squares neither overflow nor vanish.
  const int exponent = exponent_of(size);
  const Vec3d w{times_power_of_two(flight.w.x, -exponent),
                times_power_of_two(flight.w.y, -exponent),
                times_power_of_two(flight.w.z, -exponent)};
  const double length = std::sqrt(dot(w, w));
  flight.omega = times_power_of_two(length, exponent);
  const Vec3d p = cross(w, flight.u);
  flight.p = {p.x / length, p.y / length, p.z / length};
}

Vec3d director_after(const Flight& flight, double elapsed) {
  const SineCosine<double> sc = sine_cosine(flight.omega * elapsed);
  return flight.u * sc.cosine + flight.p * sc.sine;
}

PairScale scale_of(const Pair& pair) {
  return scale_of(pair, times_power_of_two(1, -exponent_of(pair.half_first + pair.half_second)),
                  pair.first->omega + pair.second->omega);
}

PairScale scale_of(const Pair& pair, double per_length, double turning) {
  PairScale out;
  out.per_length = per_length;
  const Vec3d v = pair.fall ? to_double(falling_velocity(pair)) : pair.first->v - pair.second->v;
  const double rate = largest(v) * per_length + turning;
  if (!(rate > 0)) return out;
  // Clamped so that both factors are normal numbers.
  const int exponent = std::clamp(exponent_of(rate), -1000, 1000);
  out.moves = true;
  out.per_rate = times_power_of_two(1, -exponent);
  out.per_time = times_power_of_two(1, exponent);
  return out;
}

// Once more, of needles that fall; so that others ask once.
[[gnu::noinline]] static void let_fall(Frame<double>& frame, const Pair& pair,
                                       const PairScale& scale) {
  frame.v = to_double(falling_velocity(pair)) * scale.per_velocity();
  set_norms(frame);
  add_fall_to_norms(frame, pair, scale);
}

template <>
Frame<double> make_frame<double>(const Pair& pair, const PairScale& scale) {
  Frame<double> out;
  out.r = to_double(separation(pair)) * scale.per_length;
  const Flight* flight[2] = {pair.first, pair.second};
  const DoubleDouble elapsed[2] = {pair.elapsed_first, pair.elapsed_second};
  out.v = (flight[0]->v - flight[1]->v) * scale.per_velocity();
  for (int i = 0; i < 2; ++i) {
    out.u[i] = flight[i]->u;
    out.p[i] = flight[i]->p;
    out.omega[i] = flight[i]->omega * scale.per_rate;
    out.delay[i] = elapsed[i].hi * scale.per_time;
  }
  set_half_lengths(out, pair, scale);
  set_norms(out);
  if (pair.fall) let_fall(out, pair, scale);
  return out;
}

template <>
Frame<DoubleDouble> make_frame<DoubleDouble>(const Pair& pair, const PairScale& scale) {
  Frame<DoubleDouble> out;
  out.r = scaled(separation(pair), scale.per_length);
  const Flight* flight[2] = {pair.first, pair.second};
  const DoubleDouble elapsed[2] = {pair.elapsed_first, pair.elapsed_second};
  out.v = to_double_double(flight[0]->v * scale.per_velocity()) -
          to_double_double(flight[1]->v * scale.per_velocity());
  if (pair.fall) out.v = scaled(falling_velocity(pair), scale.per_velocity());
  for (int i = 0; i < 2; ++i) {
    out.u[i] = to_double_double(flight[i]->u);
    // |w| and w x u / |w| again, to full precision; w first scaled by a power of two of its own.
    if (flight[i]->omega > 0) {
      const int exponent = exponent_of(largest(flight[i]->w));
      const Vec3dd w = to_double_double(Vec3d{times_power_of_two(flight[i]->w.x, -exponent),
                                              times_power_of_two(flight[i]->w.y, -exponent),
                                              times_power_of_two(flight[i]->w.z, -exponent)});
      const DoubleDouble length = sqrt(dot(w, w));
      const Vec3dd p = cross(w, out.u[i]);
      out.p[i] = {p.x / length, p.y / length, p.z / length};
      const auto rescaled = [&](double a) {
        return times_power_of_two(a, exponent) * scale.per_rate;
      };
      out.omega[i] = {rescaled(length.hi), rescaled(length.lo)};
    }
    out.delay[i] = {elapsed[i].hi * scale.per_time, elapsed[i].lo * scale.per_time};
  }
  set_half_lengths(out, pair, scale);
  set_norms(out);
  if (pair.fall) add_fall_to_norms(out, pair, scale);
  return out;
}

Estimate expanded(const Estimate& e, double off, double third) {
  // What the sums here are off by; e may be known to more digits than double has.
  constexpr double rounding = 0x1p-50;
  const double size = std::abs(off), bent = size * third;
  const double f = std::abs(e.f), df = std::abs(e.df), ddf = std::abs(e.ddf);
  Estimate out = e;
  out.f = e.f + off * (e.df + 0.5 * off * e.ddf);
  out.df = e.df + off * e.ddf;
  out.error_ddf = (e.error_ddf + bent + rounding * ddf) * roundup;
  out.error_df =
      (e.error_df + size * (e.error_ddf + 0.5 * bent) + rounding * (df + size * ddf)) * roundup;
  out.error_f = (e.error_f + size * (e.error_df + 0.5 * size * (e.error_ddf + bent * (1.0 / 3))) +
                 rounding * (f + size * (df + size * ddf))) *
                roundup;
  return out;
}

Frame<Range> enclose(const Frame<DoubleDouble>& frame, const Pair& pair, const PairScale& scale) {
  // What a few operations in double-double may be off by, as a share of the largest number in them.
  constexpr double share = 0x1p-96;
  const auto number = [&](const DoubleDouble& a) { return range_of(a, share * std::abs(a.hi)); };
  const auto vector = [&](const Vec3dd& a, double besides = 0) {
    const double error = share * (largest({a.x.hi, a.y.hi, a.z.hi}) + besides);
    return Vec3<Range>{range_of(a.x, error), range_of(a.y, error), range_of(a.z, error)};
  };
  Frame<Range> out;
  const double far = scale.per_length * (largest(pair.first->r) + largest(pair.second->r) +
                                         largest(to_double(pair.shift)) +
                                         (pair.fall ? largest(to_double(pair.fall->place)) : 0) +
                                         largest(pair.first->v) * pair.elapsed_first.hi +
                                         largest(pair.second->v) * pair.elapsed_second.hi);
  out.r = {range_of(frame.r.x, share * far), range_of(frame.r.y, share * far),
           range_of(frame.r.z, share * far)};
  out.v = vector(frame.v, pair.fall ? frame.v_norm : 0);
  for (int i = 0; i < 2; ++i) {
    out.u[i] = vector(frame.u[i]);
    out.p[i] = vector(frame.p[i]);
    out.omega[i] = number(frame.omega[i]);
    out.delay[i] = number(frame.delay[i]);
  }
  // What continues from a touch is a difference of numbers up to |r|, or |v| + |r| w.
  const double r = frame.r_norm + far;
  out.offset = range_of(frame.offset, share * r + frame.offset_error);
  out.slope = range_of(frame.slope, share * (frame.v_norm + r * frame.w_sum));
  set_half_lengths(out, pair, scale);
  set_norms(out);
  if (pair.fall) add_fall_to_norms(out, pair, scale);
  return out;
}

Amplitude amplitude(const Frame<DoubleDouble>& frame) {
  const auto part = [&](double sign) {
    // cos cos and sin sin, cos sin and sin cos, join in the cosine and sine of the sum (sign +1)
    // and of the difference (-1) of the phases.
    const DoubleDouble minus(-sign), plus(sign), half(0.5);
    const Vec3dd c = cross(frame.u[0], frame.u[1]) + cross(frame.p[0], frame.p[1]) * minus;
    const Vec3dd s = cross(frame.p[0], frame.u[1]) + cross(frame.u[0], frame.p[1]) * plus;
    const auto size = [&](const Vec3dd& r) {
      return (std::abs(to_double(dot(r, c) * half)) + std::abs(to_double(dot(r, s) * half))) *
             roundup;
    };
    const double w = std::abs(to_double(frame.omega[0] + frame.omega[1] * plus));
    return Amplitude::Part{size(frame.r), size(frame.v), w * roundup};
  };
  return {part(-1), part(1)};
}

double Amplitude::derivative_bound(int n, double s) const {
  double sum = 0;
  for (const Part& part : {slow, fast}) {
    const double w = part.w, w2 = n == 2 ? w : w * w;
    sum += ((part.a + part.b * s) * w + n * part.b) * w2;
  }
  return sum * roundup;
}

}  // namespace needlework::kernels
