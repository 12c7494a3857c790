// Brackets the first contact of the seeker with each of its candidates from below, in single
// precision. Part of near_needles_body.h, which says what rounding does.

struct Turned {
  Floats cosine, sine;
};

/// Sine and cosine of angles below 2^12 within 2^-20; beyond 2^15 ever worse, and from 2^22 on
/// anything.
NEEDLEWORK_INLINE Turned sine_cosine(Floats angle) {
  // To the nearest quarter of a circle; pi / 2 in three parts of few bits.
  const Floats to_whole(0x1.8p23f);
  const Floats shifted = multiply_add(angle, Floats(0.636619772f), to_whole),
               k = shifted - to_whole;
  const Floats x = subtract_product(
      subtract_product(subtract_product(angle, k, Floats(0x1.92p0f)), k, Floats(0x1.fb4p-12f)), k,
      Floats(0x1.4442d2p-24f));
  // Grouped so that little waits for what comes before.
  const Floats xx = x * x, xxxx = xx * xx;
  Turned out;
  out.sine =
      subtract_product(x, x * xx,
                       multiply_add(xxxx, Floats(1.0f / 5040),
                                    subtract_product(Floats(1.0f / 6), xx, Floats(1.0f / 120))));
  out.cosine =
      multiply_add(xxxx,
                   multiply_add(xxxx, Floats(1.0f / 40320),
                                subtract_product(Floats(1.0f / 24), xx, Floats(1.0f / 720))),
                   subtract_product(Floats(1.0f), xx, Floats(0.5f)));
  turn(shifted, out.cosine, out.sine);
  return out;
}

/// The contact function of pairs at one time each, with three derivatives; and the motion along the
/// gap between the needles: projections on it of the relative centre and velocity, and of the
/// directors and their rates times the half lengths.
struct SimdSample {
  Floats f, df, ddf, dddf;
  Floats gap;  // its length, or a little more: any vector bounds the distance along itself
  Floats centre, velocity, director[2], turning[2];
};

/// The seeker's and the others' rotation and half lengths, and the relative centres, from now on.
struct SimdPairs {
  V3 r, v, u[2], p[2];
  Floats omega[2], age[2], half[2];
};

NEEDLEWORK_INLINE SimdSample sample(const SimdPairs& pair, Floats s) {
  V3 n[2], d[2];
  for (int i = 0; i < 2; ++i) {
    const Turned t = sine_cosine(pair.omega[i] * (s + pair.age[i]));
    n[i] = add_scaled(pair.u[i] * t.cosine, pair.p[i], t.sine);
    d[i] = subtract_scaled(pair.p[i] * t.cosine, pair.u[i], t.sine) * pair.omega[i];
  }
  const V3 c = add_scaled(pair.r, pair.v, s), x = cross(n[0], n[1]);
  const V3 dx[2] = {cross(d[0], n[1]), cross(n[0], d[1])}, dd = cross(d[0], d[1]);
  const Floats square[2] = {pair.omega[0] * pair.omega[0], pair.omega[1] * pair.omega[1]};
  const Floats squares = square[0] + square[1];
  const Floats vx = dot(pair.v, x), vdx = dot(pair.v, dx[0] + dx[1]), vdd = dot(pair.v, dd);
  const Floats cdx[2] = {dot(c, dx[0]), dot(c, dx[1])}, cdd = dot(c, dd);
  SimdSample out;
  out.f = dot(c, x);
  out.df = vx + (cdx[0] + cdx[1]);
  out.ddf = (vdx + vdx) + subtract_product(cdd + cdd, squares, out.f);
  out.dddf =
      subtract_product(subtract_product(Floats(3.0f) * subtract_product(vdd + vdd, squares, vx),
                                        squares + (square[1] + square[1]), cdx[0]),
                       squares + (square[0] + square[0]), cdx[1]);
  const V3 gap = segment_gap(c, n[0], n[1], x, dot(x, x), half_lengths(pair.half[0], pair.half[1]));
  out.gap = rough_length(gap);
  out.centre = dot(gap, c);
  out.velocity = dot(gap, pair.v);
  for (int i = 0; i < 2; ++i) {
    out.director[i] = dot(gap, n[i]) * pair.half[i];
    out.turning[i] = dot(gap, d[i]) * pair.half[i];
  }
  return out;
}

/// Those of the vector that begins with pair k.
NEEDLEWORK_INLINE SimdPairs load_pairs(const Seeker& seeker, const PairColumns& pairs,
                                       std::size_t k) {
  using C = PairColumns;
  const auto column = [&](int c) NEEDLEWORK_TARGET { return load_floats(pairs.column[c] + k); };
  SimdPairs pair;
  pair.r = {column(C::r_x), column(C::r_y), column(C::r_z)};
  pair.v = {column(C::v_x), column(C::v_y), column(C::v_z)};
  pair.u[0] = broadcast(seeker.motion.u);
  pair.p[0] = broadcast(seeker.motion.p);
  pair.omega[0] = Floats(seeker.motion.omega);
  pair.age[0] = Floats(0.0f);
  pair.half[0] = Floats(seeker.motion.half);
  pair.u[1] = {column(C::u_x), column(C::u_y), column(C::u_z)};
  pair.p[1] = {column(C::p_x), column(C::p_y), column(C::p_z)};
  pair.omega[1] = column(C::omega);
  pair.age[1] = column(C::age);
  pair.half[1] = column(C::half);
  return pair;
}

/// Bounds on the contact function of pairs up to a time, and on its rounding errors.
struct SimdBounds {
  Floats speed, margin;  // speed of a point half a unit from its centre relative to another
  Floats reach_squared;  // of the centres, where needles may touch
  // While the bounding spheres overlap f'' is at most `bend`, and the fourth derivative 4! `coil`:
  // derivative n of u1 x u2 is at most (|w1| + |w2|)^n, and the second of the centres is 0.
  Floats bend, coil;
  Floats tips_bend;  // times t^2: how far tips depart from straight lines in a time t
  Floats error_f, error_df, error_ddf, error_dddf;
  Mask trusted;  // the phases are not too large for these bounds on errors
};

/// `distance`: how near each other axes touch, for rods.
template <bool wide = false>
NEEDLEWORK_INLINE SimdBounds bounds_of(const Seeker& seeker, const SimdPairs& pair, Floats until,
                                       Floats distance = Floats(0.0f)) {
  SimdBounds out;
  const Floats half(0.5f), one(1.0f), w = pair.omega[0] + pair.omega[1];
  // What follows from speeds and from the arm grows with them, and none may be too small.
  const Floats v = rough_length(pair.v);
  out.speed = multiply_add(half, w, v);
  // The errors of times, 2^-20, and of phases, 2^-23 of themselves, and the caller's margin.
  const Floats swift = norm_1(broadcast(seeker.motion.v)) + (norm_1(pair.v) + w);
  const Floats phase = multiply_add(pair.omega[1], pair.age[1] + until, pair.omega[0] * until);
  out.margin = multiply_add(phase, Floats(0x1p-20f),
                            multiply_add(swift, Floats(0x1p-18f), Floats(seeker.margin)));
  out.trusted = phase < Floats(0x1p12f);
  Floats reach = (pair.half[0] + pair.half[1] + Floats(0x1p-10f)) + out.margin;
  if constexpr (wide) reach = reach + distance;
  out.reach_squared = multiply_add(reach, reach, dot(pair.r, pair.r) * Floats(0x1p-18f));
  const Floats arm = Floats((1 + 0x1p-8f) * (1 + rough_spare)) * rough_root(out.reach_squared);
  const Floats turn = arm * w;
  out.bend = ((v + v) + turn) * w;
  out.coil = multiply_add(Floats(4.0f), v, turn) * (w * w * w) * Floats(1.0f / 24);
  out.tips_bend = half * multiply_add(pair.half[0], pair.omega[0] * pair.omega[0],
                                      pair.half[1] * (pair.omega[1] * pair.omega[1]));
  // The largest second and third derivatives of needles whose centres are one unit apart or more.
  const Floats unit_turn = maximum(one, arm) * w;
  const Floats bend = ((v + v) + unit_turn) * w, twist = ((v + v + v) + unit_turn) * (w * w);
  out.error_f = out.margin + out.margin;
  out.error_df = out.margin * (out.speed + out.speed);
  out.error_ddf = out.margin * (bend + bend);
  out.error_dddf = out.margin * (twist + twist);
  return out;
}

void contact_function(const Seeker& seeker, const PairColumns& pairs, std::size_t n, float s,
                      const ContactColumns& out) {
  using C = ContactColumns;
  for (std::size_t k = 0; k < n; k += floats_at_once) {
    const SimdPairs pair = load_pairs(seeker, pairs, k);
    const SimdSample e = sample(pair, Floats(s));
    const SimdBounds bounds = bounds_of(seeker, pair, Floats(s));
    const Floats values[C::columns] = {e.f,
                                       e.df,
                                       e.ddf,
                                       e.dddf,
                                       e.gap,
                                       bounds.error_f,
                                       bounds.error_df,
                                       bounds.error_ddf,
                                       bounds.error_dddf};
    for (int c = 0; c < C::columns; ++c) store_floats(values[c], out.column[c] + k);
  }
}

/// The time from now on in which the bounding spheres of pairs overlap, widened by a margin.
struct SimdTimeSpan {
  Floats begin, end;
  Mask never;
};

NEEDLEWORK_INLINE SimdTimeSpan overlap_of_spheres(const V3& r, const V3& v, Floats reach_squared) {
  const Floats zero(0.0f), margin(static_cast<float>(time_margin));
  const Floats a = dot(v, v), b = dot(r, v);
  const Floats c = dot(r, r) - reach_squared;
  const Floats discriminant = subtract_product(b * b, a, c);
  const Floats root = square_root(maximum(discriminant, zero));
  const Mask outside = c > zero;
  const Floats q = select(b > zero, -(b + root), root - b);
  return {select(outside, c / q, zero), select(b > zero, c / q, q / a) + margin,
          outside & ((b >= zero) | (discriminant < zero))};
}

/// Shares of a span, before and after the time of a sample, in which pairs surely do not meet.
struct SimdShares {
  Floats before, after;
};

/// Those of the span h, by two bounds on how far the needles are from a contact: the contact
/// function with its sign, by Taylor's expansion, and the distance along the gap between the
/// needles at the time of the sample, which alone holds for rods and is less by the distance at
/// which these touch. Each bound is a value less a term linear in time and one quadratic in time.
template <bool wide>
NEEDLEWORK_INLINE SimdShares free_around(const SimdSample& e, const SimdBounds& bounds, Floats h,
                                         Floats distance) {
  const Floats zero(0.0f), one(1.0f), half(0.5f), sixth(1.0f / 6);
  const Mask known = bounds.trusted & (e.gap < Floats(0x1p10f));

  const Mask negative = e.f < zero;
  const Floats f_now = subtract_product(absolute(e.f) - bounds.error_f, h, bounds.error_df);
  const Floats f_rises = h * select(negative, -e.df, e.df);
  const Floats f_twists =
      multiply_add(h, bounds.coil, sixth * (absolute(e.dddf) + bounds.error_dddf));
  const Floats f_bends =
      multiply_add(h, f_twists, half * (bounds.error_ddf - select(negative, -e.ddf, e.ddf)));
  const Floats f_bent = h * h * maximum(zero, f_bends);

  const auto along_gap = [&](Floats centre, Floats a, Floats b)
                             NEEDLEWORK_TARGET { return centre - (absolute(a) + absolute(b)); };
  const Floats g = along_gap(e.centre, e.director[0], e.director[1]);
  Floats g_error = bounds.error_f;
  if constexpr (wide) g_error = g_error + distance;
  const Floats g_now = subtract_product(g, g_error, e.gap);
  const Floats g_before = along_gap(subtract_product(e.centre, h, e.velocity),
                                    subtract_product(e.director[0], h, e.turning[0]),
                                    subtract_product(e.director[1], h, e.turning[1])) -
                          g;
  const Floats g_after =
      along_gap(multiply_add(h, e.velocity, e.centre), multiply_add(h, e.turning[0], e.director[0]),
                multiply_add(h, e.turning[1], e.director[1])) -
      g;
  const Floats g_bent = bounds.tips_bend * (h * h) * e.gap;

  // The share of h in which a bound stays above 0: the root of now + rises x - bent x^2, rounded
  // towards 0, that is with a spread not below the root, of which an infinite one is not a number.
  // A share that is not a number counts as 0.
  const auto spread = [&](Floats now, Floats rises, Floats bent) NEEDLEWORK_TARGET {
    const Floats twice = now + now;
    return rough_root(multiply_add(twice + twice, bent, rough_square(rises))) *
           Floats((1 + rough_spare) * (1 + 0x1p-20f));
  };
  // Not one but for the first reason, and never the quotient of subnormal numbers.
  const auto share = [&](Floats now, Floats falls) NEEDLEWORK_TARGET {
    const Floats twice = now + now;
    return select(
        now > Floats(0x1p-100f),
        select(falls <= twice, one, rough_quotient(twice * Floats(1 - rough_spare), falls)), zero);
  };
  const Floats along_before = share(g_now, spread(g_now, g_before, g_bent) - g_before),
               along_after = share(g_now, spread(g_now, g_after, g_bent) - g_after);
  if constexpr (wide) return {select(known, along_before, zero), select(known, along_after, zero)};
  const Floats f_spread = spread(f_now, f_rises, f_bent);
  return {select(known, maximum(share(f_now, f_spread + f_rises), along_before), zero),
          select(known, maximum(share(f_now, f_spread - f_rises), along_after), zero)};
}

#include "kernels/intervals_body.h"

/// In each lane, the pair of this number among those of the vector that begins with pair k.
NEEDLEWORK_INLINE SimdPairs in_lanes(const SimdPairs& all, const PairColumns& pairs, std::size_t k,
                                     Floats number) {
  using C = PairColumns;
  const auto of = [&](int c) NEEDLEWORK_TARGET {
    return permuted(load_floats(pairs.column[c] + k), number);
  };
  SimdPairs out = all;  // of the seeker
  out.r = {of(C::r_x), of(C::r_y), of(C::r_z)};
  out.v = {of(C::v_x), of(C::v_y), of(C::v_z)};
  out.u[1] = {of(C::u_x), of(C::u_y), of(C::u_z)};
  out.p[1] = {of(C::p_x), of(C::p_y), of(C::p_z)};
  out.omega[1] = of(C::omega);
  out.age[1] = of(C::age);
  out.half[1] = of(C::half);
  return out;
}

/// The bounds that free_around() takes.
NEEDLEWORK_INLINE SimdBounds in_lanes(const SimdBounds& all, Floats number, Mask trusted) {
  const auto of = [&](Floats a) NEEDLEWORK_TARGET { return permuted(a, number); };
  SimdBounds out = all;
  out.coil = of(all.coil);
  out.tips_bend = of(all.tips_bend);
  out.error_f = of(all.error_f);
  out.error_df = of(all.error_df);
  out.error_ddf = of(all.error_ddf);
  out.error_dddf = of(all.error_dddf);
  out.trusted = trusted;
  return out;
}

/// Leaves of each interval what may hold a contact: a part that ends before its middle, if there is
/// one, or the one that begins after it, which is `second` where both are left. Those not longer
/// than `least` are settled.
NEEDLEWORK_INLINE void cut(Intervals& now, Intervals& second, const SimdShares& free, Floats least,
                           float* from) {
  const Floats zero(0.0f), one(1.0f), half(0.5f);
  const Floats middle = half * (now.low + now.high), h = half * (now.high - now.low);
  // A share that is not a number is none.
  const Floats before = maximum(free.before, zero), after = maximum(free.after, zero);
  const Floats end = subtract_product(middle, h, before), begin = multiply_add(h, after, middle);
  const Mask left_first = now.taken & (before < one), left_second = now.taken & (after < one);
  // What is not a number is settled.
  Mask first = left_first & (end - now.low > least),
       last = left_second & (now.high - begin > least);
  const Mask first_settled = left_first & !first, settled = first_settled | (left_second & !last);
  if (any(settled)) {
    settle(from, select(first_settled, now.low, begin), now.pair, settled);
    const Floats known = permuted(load_floats(from), now.pair);
    first = first & (now.low < known);
    last = last & (begin < known);
  }
  second = {begin, now.high, now.pair, first & last};
  now.low = select(first, now.low, begin);
  now.high = select(first, end, now.high);
  now.taken = first | last;
}

/// bracket() for the vector that begins with pair k, of n that are left. `alone`: there are no
/// other vectors, which would make the lanes that a pair gets depend on its place.
template <bool wide>
NEEDLEWORK_INLINE std::size_t bracket_vector(const Seeker& seeker, const PairColumns& pairs,
                                             std::size_t k, std::size_t n, bool alone) {
  using C = PairColumns;
  constexpr float infinity = std::numeric_limits<float>::infinity();
  const Floats zero(0.0f), one(1.0f), half(0.5f), margin(static_cast<float>(time_margin));
  const auto column = [&](int c) NEEDLEWORK_TARGET { return load_floats(pairs.column[c] + k); };
  const SimdPairs all = load_pairs(seeker, pairs, k);
  const SimdBounds bounds =
      bounds_of<wide>(seeker, all, column(C::until), wide ? column(C::distance) : zero);
  const SimdTimeSpan overlap = overlap_of_spheres(all.r, all.v, bounds.reach_squared);
  Intervals now{maximum(maximum(overlap.begin, column(C::from)) - margin, zero),
                minimum(overlap.end, column(C::until)),
                numbers_of_lanes(),
                {}};
  const Mask meet = first_lanes(n) & (!overlap.never) & (now.low <= now.high);
  // Over half a step f'' changes f by no more than 3, so that longer ones are seldom free. No pair
  // is searched in more than 32 of them, nor up to a time of which no parts can be computed.
  const Floats step = Floats(4.8989795f) * rough_inverse_root(bounds.bend);  // sqrt(8 * 3)
  const Floats farthest = minimum(multiply_add(Floats(32.0f), step, now.low), Floats(0x1p60f)),
               end = select(bounds.trusted, farthest, now.low);
  // The earliest time at which each pair may meet, of those that are settled.
  float from[floats_at_once];
  store_floats(select(meet & (end <= now.high), end, Floats(infinity)), from);
  now.high = minimum(end, now.high);
  now.taken = meet & bounds.trusted & (now.low <= now.high);
  // What is shorter is not worth another step, or nothing but what rounding makes of times.
  const Floats least = maximum(rough_quotient(Floats(0x1p-9f), bounds.speed),
                               Floats(0x1p-20f) * maximum(now.high, one));

  Waiting waiting;
  std::size_t evaluations = 0, count = count_of(now.taken);
  for (bool spreads = alone; count > 0 && evaluations < 1000; ++evaluations) {
    if (spreads) spread(now, count);
    const Floats middle = half * (now.low + now.high), h = half * (now.high - now.low);
    const SimdShares free = free_around<wide>(
        sample(in_lanes(all, pairs, k, now.pair), middle), in_lanes(bounds, now.pair, now.taken), h,
        wide ? permuted(column(C::distance), now.pair) : zero);
    Intervals second;
    cut(now, second, free, permuted(least, now.pair), from);
    count = count_of(now.taken);
    const std::size_t more = count_of(second.taken);
    if (more > 0 && count + more <= floats_at_once) {
      add(now, second);
      count += more;
    } else if (more > 0) {
      // From here on, which intervals are in lanes together depends on the order of pairs.
      spreads = false;
      push(waiting, second, from);
    }
    while (waiting.count > 0 && count < floats_at_once) {
      pop(waiting, now, floats_at_once - count);
      now.taken = now.taken & (now.low < permuted(load_floats(from), now.pair));
      count = count_of(now.taken);
    }
  }
  // Given up, which no pair of a gas is.
  settle(from, now.low, now.pair, now.taken);
  lower(from, waiting.low, waiting.pair, waiting.count);
  store_floats(maximum(load_floats(from) - margin, zero), pairs.column[C::from] + k);
  return evaluations;
}

template <bool wide>
inline std::size_t bracket_all(const Seeker& seeker, const PairColumns& pairs, std::size_t n) {
  std::size_t evaluations = 0;
  for (std::size_t k = 0; k < n; k += floats_at_once) {
    evaluations += bracket_vector<wide>(seeker, pairs, k, n - k, n <= floats_at_once);
  }
  return evaluations;
}

std::size_t bracket(const Seeker& seeker, const PairColumns& pairs, std::size_t n) {
  return bracket_all<false>(seeker, pairs, n);
}

std::size_t bracket_rods(const Seeker& seeker, const PairColumns& pairs, std::size_t n) {
  return bracket_all<true>(seeker, pairs, n);
}

/// They meet when their centres come that near, which is the time at which their bounding spheres
/// do. The margins are those of bounds_of() for bodies without length and rotation.
std::size_t bracket_spheres(const Seeker& seeker, const PairColumns& pairs, std::size_t n) {
  using C = PairColumns;
  const Floats infinity(std::numeric_limits<float>::infinity()), zero(0.0f);
  const Floats margin(static_cast<float>(time_margin)), least(0x1p-10f), seekers(seeker.margin);
  const Floats speed = norm_1(broadcast(seeker.motion.v));
  std::size_t evaluations = 0;
  for (std::size_t k = 0; k < n; k += floats_at_once) {
    ++evaluations;
    const auto column = [&](int c) NEEDLEWORK_TARGET { return load_floats(pairs.column[c] + k); };
    const V3 r{column(C::r_x), column(C::r_y), column(C::r_z)};
    const V3 v{column(C::v_x), column(C::v_y), column(C::v_z)};
    const Floats until = column(C::until);
    const Floats reach =
        (least + multiply_add(speed + norm_1(v), Floats(0x1p-18f), seekers)) + column(C::distance);
    const SimdTimeSpan overlap =
        overlap_of_spheres(r, v, multiply_add(reach, reach, dot(r, r) * Floats(0x1p-18f)));
    const Floats from = maximum(maximum(overlap.begin, column(C::from)) - margin, zero);
    const Mask apart = overlap.never | (from > minimum(overlap.end, until));
    store_floats(select(apart, infinity, from), pairs.column[C::from] + k);
  }
  return evaluations;
}
