// The kernels of near_needles.h for one kind of Floats. Included in the namespace of each
// instruction set, which has Floats and Mask.
//
// Margins. A float carries 24 bits, so each operation is off by 2^-24 of its result. Where a fused
// one rounds once, the product in it is off by nothing, so that what is derived for two roundings
// holds; nothing relies on equal products to cancel. Needles are no longer than the unit of length,
// and centres are within a few units (the caller's margin grows with its cells). What words round
// is said where they are read. Directors of motions come from sines and cosines good to 2^-20 and
// phases good to 2^-23 of themselves; times are good to 2^-20 and enter by the speeds. Lengths
// below are off by less than `margin` of SimdBounds, which has a reserve of more than four.
// Rounding does not shrink with the needles: where a margin or an error contains a length, it is
// the unit.
//
// Rough roots and quotients are off by up to `rough_error`. Where a bound grows with one, a
// constant puts it on the safe side of that error and of the roundings beside it; elsewhere it is a
// guess, of which any will do or whose error has a margin. For the twin, `rough_error` and these
// margins are 0. What is not a number must rule nothing out: a bound that may be none is the second
// argument of minimum() or maximum(), so that it is their result.

#include "kernels/vec3_body.h"

using V3 = Vec3<Floats>;

// Sums of products, rounded once where the instruction set can.
NEEDLEWORK_INLINE Floats dot(const V3& a, const V3& b) {
  return multiply_add(a.z, b.z, multiply_add(a.y, b.y, a.x * b.x));
}
NEEDLEWORK_INLINE V3 cross(const V3& a, const V3& b) {
  return {subtract_product(a.y * b.z, a.z, b.y), subtract_product(a.z * b.x, a.x, b.z),
          subtract_product(a.x * b.y, a.y, b.x)};
}
NEEDLEWORK_INLINE V3 add_scaled(const V3& a, const V3& b, Floats s) {
  return {multiply_add(b.x, s, a.x), multiply_add(b.y, s, a.y), multiply_add(b.z, s, a.z)};
}
NEEDLEWORK_INLINE V3 subtract_scaled(const V3& a, const V3& b, Floats s) {
  return {subtract_product(a.x, b.x, s), subtract_product(a.y, b.y, s),
          subtract_product(a.z, b.z, s)};
}

/// What is rough is not too small times 1 + rough_spare, nor too large times 1 - rough_spare, with
/// a quarter of this left for roundings.
constexpr float rough_spare = 4 * rough_error / 3;

/// Not less than the length of a vector, by roundings; not a number if its square is infinite.
NEEDLEWORK_INLINE Floats rough_length(const V3& a) {
  const Floats squares = multiply_add(a.z, a.z, multiply_add(a.y, a.y, rough_square(a.x)));
  return rough_root(squares) * Floats(1 + rough_spare);
}

#include "kernels/closest_approach_body.h"

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

inline V3 broadcast(const float (&a)[3]) { return {Floats(a[0]), Floats(a[1]), Floats(a[2])}; }

inline Floats norm_1(const V3& a) { return absolute(a.x) + absolute(a.y) + absolute(a.z); }

/// Calls test(block, lane, offset) -> Mask for the vectors of all blocks of these cells and stores
/// the needles for which it holds. Without a branch on the outcome, which no processor can predict:
/// a wrong guess would discard the work begun on the next blocks.
template <class Test>
NEEDLEWORK_INLINE Scan scan(const Surroundings& around, const Seeker& seeker, const Found& found,
                            Test&& test) {
  // Copied, because for all the compiler knows the stores below might change these pointers.
  const std::uint32_t* const next = around.next;
  const NeedleBlock* const blocks = around.blocks;
  const auto motions = reinterpret_cast<std::uintptr_t>(around.motions);
  std::uint32_t *const needles = found.needle, *const cells = found.cell;
  const Floats self = number(seeker.needle), nobody = number(NeedleBlock::none);
  std::size_t count = 0, seen = 0;
  for (std::uint32_t n = 0; n < around.cell_count; ++n) {
    const CellView& cell = around.cells[n];
    for (std::uint32_t b = cell.block; b != NeedleBlock::none;) {
      const NeedleBlock& block = blocks[b];
      for (std::size_t lane = 0; lane < block_size; lane += floats_at_once) {
        if (block.needle[lane] == NeedleBlock::none) break;
        const Floats needle = load_numbers(block.needle + lane);
        const Mask taken = !same_numbers(needle, nobody);
        seen += count_of(taken);
        const Packing found_here =
            packing_of(taken & test(block, lane, cell.offset) & !same_numbers(needle, self));
        store_numbers(packed(needle, found_here), needles + count);
        store_numbers(number(n), cells + count);
        // Of several, the first. If there is none, the index is arbitrary and the prefetch useless.
        if (motions) {
          __builtin_prefetch(
              reinterpret_cast<const void*>(motions + sizeof(Motion) * needles[count]));
        }
        count += found_here.count;
      }
      b = block.is_full() ? next[b] : NeedleBlock::none;
    }
  }
  return {seen, count};
}

/// One word for each axis of the needles in a block, see WordFormat.
NEEDLEWORK_INLINE V3 load_words(const NeedleBlock& block, std::size_t lane) {
  return {load_numbers(block.word[0] + lane), load_numbers(block.word[1] + lane),
          load_numbers(block.word[2] + lane)};
}

/// A centre on the scale of places_of(): plus base - low, so that the difference of the two is that
/// of the centres. Rounded to a step: off by half a step, and by half a step more once the offset
/// of a cell is subtracted.
inline V3 on_scale_of_words(const float (&r)[3], const WordFormat& format) {
  const Floats to_base(format.base - format.low);
  return broadcast(r) + V3{to_base, to_base, to_base};
}
NEEDLEWORK_INLINE V3 places_of(const V3& words, Floats base) {
  const Floats mask = number(WordFormat::places - 1);
  return {with_bits(base, words.x, mask), with_bits(base, words.y, mask),
          with_bits(base, words.z, mask)};
}

/// segment_gap() with a third fewer operations, for directors of about length 1. Words hold these
/// to 2^-19 in each component, which puts xx off by d < 2^-15.9, all roundings and its least value
/// included, and the numerator of the first guess by less than |r| 2^-17. So the guess is off by
/// less than e / xx, e = |r| 2^-17 + d / 2 < 2^-15.5 for centres within 1.5 units, and by no more
/// than the length of the first segment. The square of the distance is too large by no more than
/// (xx + d) min(1, e / xx)^2 <= e + d < 2^-14.6. A rough quotient puts the guess off by 2^-12.4
/// more within the first segment, which makes that less than 2^-14.
NEEDLEWORK_INLINE V3 rough_segment_gap(const V3& r, const V3& u1, const V3& u2,
                                       const HalfLengths<Floats>& half) {
  const Floats b = dot(u1, u2), r1 = dot(r, u1), r2 = dot(r, u2);
  const Floats xx = maximum(subtract_product(Floats(1.0f), b, b), Floats(0x1p-21f));
  const Floats guess = minimum(
      maximum(rough_quotient(multiply_subtract(r2, b, r1), xx), half.minus_first), half.first);
  const Floats t = minimum(maximum(multiply_add(guess, b, r2), half.minus_second), half.second);
  const Floats s = minimum(maximum(multiply_subtract(t, b, r1), half.minus_first), half.first);
  return subtract_scaled(add_scaled(r, u1, s), u2, t);
}

Scan overlapping(const Surroundings& around, const Seeker& seeker, float radius,
                 const Found& found) {
  const Floats base(around.format.base);
  const V3 r = on_scale_of_words(seeker.r, around.format), u = broadcast(seeker.u);
  // Along each axis the places of both capsules are off by half a step each, and subtracting them
  // adds up to one more: 2 sqrt(3) steps in all. Directors are off by 2^-19, next to +-1 by 2^-18.
  const float near =
      2 * radius + seeker.margin + 4 * static_cast<float>(around.format.step()) + 0x1p-17f;
  // What rough_segment_gap() may add. Capsules wider than a quarter unit may overlap with centres
  // farther apart, where it adds more; the square grows faster by the margin of lengths.
  const Floats near_squared(near * near + 0x1p-14f);
  const HalfLengths<Floats> half =
      half_lengths(Floats(seeker.motion.half), Floats(seeker.longest_half));
  const auto test = [&](const NeedleBlock& block, std::size_t lane,
                        const float* offset) NEEDLEWORK_TARGET {
    const V3 from{r.x - Floats(offset[0]), r.y - Floats(offset[1]), r.z - Floats(offset[2])};
    const V3 words = load_words(block, lane);
    const V3 d = from - places_of(words, base);
    const V3 a = V3{signed_numbers(words.x), signed_numbers(words.y), signed_numbers(words.z)} *
                 Floats(0x1p-31f);
    // A cheaper test before this one does not pay: of many needles one would nearly always pass it.
    const V3 gap = rough_segment_gap(d, u, a, half);
    return dot(gap, gap) <= near_squared;
  };
  return scan(around, seeker, found, test);
}

Scan approaching(const Surroundings& around, const Seeker& seeker, const Found& found) {
  const Floats base(around.format.base);
  const V3 r = on_scale_of_words(seeker.motion.r, around.format), v = broadcast(seeker.motion.v);
  const Floats now(seeker.now), ahead(seeker.ahead), zero(0.0f);
  // Along each axis a velocity is off by 2^-11 of itself, which makes 4 of the 2^13 steps that a
  // needle may fly before it is placed again; a place is off by half a step, and subtracting it
  // adds up to one more: 5.5 sqrt(3) steps in all.
  const float rounding = 10 * static_cast<float>(around.format.step());
  // The errors of times, 2^-20, enter by the speeds. That of the other needle is at most the
  // seeker's and the relative one w, of which (x + |w| 2^-17)^2 <= x^2 (1 + 2^-10) + w^2 2^-23.
  const Floats reach =
      Floats(seeker.motion.half + seeker.longest_half + seeker.margin + rounding + 0x1p-10f) +
      norm_1(v) * Floats(0x1p-17f);
  const Floats reach_squared = reach * reach * Floats(1 + 0x1p-10f);
  const auto test = [&](const NeedleBlock& block, std::size_t lane,
                        const float* offset) NEEDLEWORK_TARGET {
    const V3 from{r.x - Floats(offset[0]), r.y - Floats(offset[1]), r.z - Floats(offset[2])};
    // A word is a velocity as it is.
    const V3 other_v = load_words(block, lane);
    const Floats age = now - load_floats(block.time + lane);
    const V3 d = subtract_scaled(from - places_of(other_v, base), other_v, age), w = v - other_v;
    const Floats b = dot(d, w), a = dot(w, w);
    // The square of the distance less that of the reach: now, and at the end of the time ahead.
    const Floats c = subtract_product(
        multiply_subtract(dot(d, d), Floats(1 - 0x1p-18f), reach_squared), a, Floats(0x1p-23f));
    const Floats b_then = multiply_add(a, ahead, b), c_then = multiply_add(b + b_then, ahead, c);
    // It may be less between the two, at -b / a.
    const Mask apart_between = (b >= zero) | (b_then <= zero) | (c * a > b * b);
    return !((c > zero) & (c_then > zero) & apart_between);
  };
  return scan(around, seeker, found, test);
}

/// How much segment_gap() may be too large for the rough quotient of its first guess, squared:
/// within the first segment the guess is off by rough_error times half its length, and this is
/// seven times its square. So it leaves room for the products with the other errors of the guess.
inline float rough_guess_adds(float half) {
  return (4 * rough_spare * rough_spare) * (half * half);
}

Scan near_capsules(const Surroundings& around, const Seeker& seeker, float distance,
                   const Found& found) {
  const Floats base(around.format.base);
  const V3 r = on_scale_of_words(seeker.r, around.format), u = broadcast(seeker.u);
  // As for overlapping(), but what rounding does to the gap grows with the seeker's segment.
  const float near = distance + seeker.margin + 4 * static_cast<float>(around.format.step()) +
                     (1 + seeker.axis_half) * 0x1p-17f;
  const Floats near_squared(near * near + rough_guess_adds(seeker.axis_half));
  const HalfLengths<Floats> half =
      half_lengths(Floats(seeker.axis_half), Floats(seeker.longest_half));
  const auto test = [&](const NeedleBlock& block, std::size_t lane,
                        const float* offset) NEEDLEWORK_TARGET {
    const V3 from{r.x - Floats(offset[0]), r.y - Floats(offset[1]), r.z - Floats(offset[2])};
    const V3 words = load_words(block, lane);
    const V3 d = from - places_of(words, base);
    const V3 a = V3{signed_numbers(words.x), signed_numbers(words.y), signed_numbers(words.z)} *
                 Floats(0x1p-31f);
    const V3 x = cross(u, a);
    return segment_distance_squared(d, u, a, x, dot(x, x), half) <= near_squared;
  };
  return scan(around, seeker, found, test);
}

Scan near_paths(const Surroundings& around, const Seeker& seeker, float distance,
                const Found& found) {
  const Floats base(around.format.base);
  const V3 r = on_scale_of_words(seeker.r, around.format), u = broadcast(seeker.u);
  const Floats now(seeker.now), ahead(seeker.ahead), half(0.5f), one(1.0f);
  const auto step = static_cast<float>(around.format.step());
  // By then each has been placed again. Longer paths would lose their digits.
  const Floats farthest(2 * WordFormat::places * step);
  // Places and velocities are off as for approaching(), up to where a needle is placed again. The
  // errors of times, 2^-20, enter by the speed.
  const Floats near_now(distance + seeker.margin + 10 * step + (1 + seeker.axis_half) * 0x1p-17f);
  const Floats guess_adds(rough_guess_adds(seeker.axis_half));
  const auto test = [&](const NeedleBlock& block, std::size_t lane,
                        const float* offset) NEEDLEWORK_TARGET {
    const V3 from{r.x - Floats(offset[0]), r.y - Floats(offset[1]), r.z - Floats(offset[2])};
    const V3 v = load_words(block, lane);
    const Floats age = now - load_floats(block.time + lane);
    const Floats speed = square_root(dot(v, v)),
                 half_path = half * minimum(speed * ahead, farthest);
    const V3 along = v * (one / speed);
    const V3 middle =
        subtract_scaled(subtract_scaled(from - places_of(v, base), v, age), along, half_path);
    const V3 x = cross(u, along);
    const Floats near = multiply_add(speed, Floats(0x1p-17f), near_now);
    const HalfLengths<Floats> halves = half_lengths(Floats(seeker.axis_half), half_path);
    return segment_distance_squared(middle, u, along, x, dot(x, x), halves) <=
           multiply_add(near, near, guess_adds);
  };
  return scan(around, seeker, found, test);
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

NEEDLEWORK_INLINE SimdTimeSpan overlap_of_spheres(const SimdPairs& pair, const SimdBounds& bounds) {
  const Floats zero(0.0f), margin(static_cast<float>(time_margin));
  const Floats a = dot(pair.v, pair.v), b = dot(pair.r, pair.v);
  const Floats c = dot(pair.r, pair.r) - bounds.reach_squared;
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

/// bracket() for the vector that begins with pair k, of those before `end`. `part` holds which of
/// the `parts` of its pair's time each pair of the vector is searched in.
template <bool wide>
NEEDLEWORK_INLINE std::size_t bracket_vector(const Seeker& seeker, const PairColumns& pairs,
                                             std::size_t k, std::size_t end, const float* part,
                                             std::size_t parts) {
  using C = PairColumns;
  constexpr float infinity = std::numeric_limits<float>::infinity();
  const Floats zero(0.0f), one(1.0f), half(0.5f), margin(static_cast<float>(time_margin));
  const auto column = [&](int c) NEEDLEWORK_TARGET { return load_floats(pairs.column[c] + k); };
  const SimdPairs pair = load_pairs(seeker, pairs, k);
  Floats distance = zero;
  if constexpr (wide) distance = column(C::distance);
  const SimdBounds bounds = bounds_of<wide>(seeker, pair, column(C::until), distance);
  const SimdTimeSpan overlap = overlap_of_spheres(pair, bounds);
  Floats until = minimum(overlap.end, column(C::until));
  Floats low = maximum(maximum(overlap.begin, column(C::from)) - margin, zero);
  if (parts > 1) {
    const Floats span = (until - low) * Floats(1.0f / static_cast<float>(parts)),
                 begin = load_floats(part);
    const Mask last = begin >= Floats(static_cast<float>(parts - 1));
    until = select(last, until, multiply_add(span, begin + one, low));
    low = multiply_add(span, begin, low);
  }

  const Floats least = rough_quotient(Floats(0x1p-9f), bounds.speed);
  // Over half a step f'' changes f by no more than 3: longer steps are seldom free. Any step will
  // do, as what it leaves is searched again; one that is not a number is all the time.
  const Floats step = Floats(4.8989795f) * rough_inverse_root(bounds.bend);  // sqrt(8 * 3)
  // Still to be searched: from low to high, and from next on.
  Floats high = minimum(low + step, until), next = high;
  Mask searching = first_lanes(end - k) & (!overlap.never) & (low <= until);
  Floats from(infinity);
  std::size_t evaluations = 0;
  for (int round = 0; round < 40 && any(searching); ++round) {
    ++evaluations;
    const Floats middle = half * (low + high), h = half * (high - low);
    const SimdShares free = free_around<wide>(sample(pair, middle), bounds, h, distance);
    const Mask left = free.before >= one, right = free.after >= one, both = left & right;

    // If the whole first half is free, the search continues in the second half, or after it.
    // Otherwise it continues in the rest of the first half, and then in the rest of the second.
    const Floats freed = multiply_add(h, free.after, middle);
    low = select(left, select(right, next, freed), low);
    high = select(both, minimum(next + step, until),
                  select(left, high, subtract_product(middle, h, free.before)));
    next = select(both, high, select(left | right, next, freed));

    const Mask done = both & (low >= until);
    const Mask found = searching & (!both) & (high - low <= least);
    from = select(found, low, from);
    searching = searching & (!found) & !done;
  }
  from = select(searching, low, from);
  store_floats(maximum(from - margin, zero), pairs.column[C::from] + k);
  return evaluations;
}

/// Copies the `count` pairs from k on behind themselves, once for each further part of their time,
/// and stores in `part` which part each of them is.
template <bool wide>
NEEDLEWORK_INLINE void repeat_pairs(const PairColumns& pairs, std::size_t k, std::size_t count,
                                    std::size_t parts, float* part) {
  static_assert(PairColumns::distance + 1 == PairColumns::columns);
  constexpr int columns = wide ? PairColumns::columns : PairColumns::distance;
  for (std::size_t p = 1; p < parts; ++p) {
    for (std::size_t lane = 0; lane < count; lane += floats_at_once) {
      for (float* const* each = pairs.column; each != pairs.column + columns; ++each) {
        float* const column = *each;
        store_floats(load_floats(column + k + lane), column + k + p * count + lane);
      }
      store_floats(Floats(static_cast<float>(p)), part + p * count + lane);
    }
  }
}

template <bool wide>
inline std::size_t bracket_all(const Seeker& seeker, const PairColumns& pairs, std::size_t n) {
  using C = PairColumns;
  if (n == 0) return 0;
  // Few pairs do not fill the vectors: each is searched in several parts of its time at once. How
  // many parts depends on nothing but n, so that no result depends on the position of its pair.
  const std::size_t parts = std::clamp<std::size_t>(block_size / n, 1, 4);
  std::size_t evaluations = 0;
  for (std::size_t k = 0; k < n; k += block_size) {
    const std::size_t count = std::min(n - k, block_size);
    float part[2 * block_size] = {};
    repeat_pairs<wide>(pairs, k, count, parts, part);
    const std::size_t end = k + parts * count;
    for (std::size_t at = k; at < end; at += floats_at_once) {
      evaluations += bracket_vector<wide>(seeker, pairs, at, end, part + (at - k), parts);
    }
    float* from = pairs.column[C::from] + k;
    for (std::size_t i = count; i < parts * count; ++i) {
      if (from[i] < from[i % count]) from[i % count] = from[i];
    }
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
/// do.
std::size_t bracket_spheres(const Seeker& seeker, const PairColumns& pairs, std::size_t n) {
  using C = PairColumns;
  const Floats infinity(std::numeric_limits<float>::infinity()), zero(0.0f);
  const Floats margin(static_cast<float>(time_margin));
  std::size_t evaluations = 0;
  for (std::size_t k = 0; k < n; k += floats_at_once) {
    ++evaluations;
    const auto column = [&](int c) NEEDLEWORK_TARGET { return load_floats(pairs.column[c] + k); };
    const SimdPairs pair = load_pairs(seeker, pairs, k);
    const Floats until = column(C::until);
    const SimdTimeSpan overlap =
        overlap_of_spheres(pair, bounds_of<true>(seeker, pair, until, column(C::distance)));
    const Floats from = maximum(maximum(overlap.begin, column(C::from)) - margin, zero);
    const Mask apart = overlap.never | (from > minimum(overlap.end, until));
    store_floats(select(apart, infinity, from), pairs.column[C::from] + k);
  }
  return evaluations;
}
