// The kernels of near_needles.h for one kind of Floats. Included in the namespace of each
// instruction set, which has Floats and Mask.
//
// Margins. A float carries 24 bits, so each operation is off by 2^-24 of its result. Centres are
// within a few L (the caller's margin grows with its cells), directors come from sines and cosines
// good to 2^-20 and phases good to 2^-23 of themselves, times are good to 2^-20 and count through
// the speeds. Lengths below are off by less than `margin` of SimdBounds, which has a reserve of
// more than four.

#include "kernels/vec3_body.h"

using V3 = Vec3<Floats>;

#include "kernels/closest_approach_body.h"

struct Turned {
  Floats cosine, sine;
};

/// Sine and cosine of angles below 2^12 within 2^-20; beyond 2^15 ever worse, and from 2^22 on
/// anything.
NEEDLEWORK_INLINE Turned sine_cosine(Floats angle) {
  // To the nearest quarter of a circle; pi / 2 in three parts of few bits.
  const Floats to_whole(0x1.8p23f);
  const Floats shifted = angle * Floats(0.636619772f) + to_whole, k = shifted - to_whole;
  const Floats x =
      ((angle - k * Floats(0x1.92p0f)) - k * Floats(0x1.fb4p-12f)) - k * Floats(0x1.4442d2p-24f);
  // Grouped so that little waits for what comes before.
  const Floats xx = x * x, xxxx = xx * xx;
  Turned out;
  out.sine =
      x - (x * xx) * ((Floats(1.0f / 6) - xx * Floats(1.0f / 120)) + xxxx * Floats(1.0f / 5040));
  out.cosine = (Floats(1.0f) - xx * Floats(0.5f)) +
               xxxx * ((Floats(1.0f / 24) - xx * Floats(1.0f / 720)) + xxxx * Floats(1.0f / 40320));
  turn(shifted, out.cosine, out.sine);
  return out;
}

inline V3 broadcast(const float (&a)[3]) { return {Floats(a[0]), Floats(a[1]), Floats(a[2])}; }

inline Floats norm_1(const V3& a) { return absolute(a.x) + absolute(a.y) + absolute(a.z); }

/// Calls test(block, lane, offset) -> Mask for the lanes of all blocks of these cells and notes the
/// needles for which it holds. Without a branch on the outcome, which nothing foretells: a wrong
/// guess would throw away what had begun on the next blocks.
template <class Test>
NEEDLEWORK_INLINE Scan scan(const Surroundings& around, const Seeker& seeker, const Found& found,
                            Test&& test) {
  // Copied, for what is stored might be these, as far as a compiler can tell.
  const BlockLink* const links = around.links;
  const NeedleBlock* const blocks = around.blocks;
  const auto motions = reinterpret_cast<std::uintptr_t>(around.motions);
  std::uint32_t *const needles = found.needle, *const cells = found.cell;
  const Floats self = number(seeker.needle);
  std::size_t count = 0, seen = 0;
  for (std::uint32_t n = 0; n < around.cell_count; ++n) {
    const CellView& cell = around.cells[n];
    for (std::uint32_t b = cell.block; b != BlockLink::none; b = links[b].next) {
      const NeedleBlock& block = blocks[b];
      const std::uint32_t size = links[b].size;
      seen += size;
      for (std::uint32_t lane = 0; lane < size; lane += floats_at_once) {
        // Places beyond the last needle hold anything.
        const Mask taken = counting() < Floats(static_cast<float>(size - lane));
        const Floats needle = load_numbers(block.needle + lane);
        const Packing found_here =
            packing_of(taken & test(block, lane, cell.offset) & !same_numbers(needle, self));
        store_numbers(packed(needle, found_here), needles + count);
        store_numbers(number(n), cells + count);
        // Of several the first; and where there is none, whatever stands there.
        __builtin_prefetch(
            reinterpret_cast<const void*>(motions + sizeof(Motion) * needles[count]));
        count += found_here.count;
      }
    }
  }
  return {seen, count};
}

inline V3 load(const NeedleBlock& block, int first_column, std::size_t lane) {
  return {load_floats(block.column[first_column] + lane),
          load_floats(block.column[first_column + 1] + lane),
          load_floats(block.column[first_column + 2] + lane)};
}

Scan overlapping(const Surroundings& around, const Seeker& seeker, float radius,
                 const Found& found) {
  const V3 r = broadcast(seeker.r), u = broadcast(seeker.u);
  const float near = 2 * radius + seeker.margin;
  const Floats near_squared(near * near);
  return scan(
      around, seeker, found,
      [&](const NeedleBlock& block, std::size_t lane, const float* offset) NEEDLEWORK_TARGET {
        const V3 from{r.x - Floats(offset[0]), r.y - Floats(offset[1]), r.z - Floats(offset[2])};
        const V3 d = from - load(block, NeedleBlock::x, lane);
        // No cheaper test goes before: of many needles one would pass it nearly always.
        const V3 a = load(block, NeedleBlock::a_x, lane), x = cross(u, a);
        return segment_distance_squared(d, u, a, x, dot(x, x)) <= near_squared;
      });
}

Scan approaching(const Surroundings& around, const Seeker& seeker, const Found& found) {
  const V3 r = broadcast(seeker.motion.r), v = broadcast(seeker.motion.v);
  const Floats now(seeker.now), ahead(seeker.ahead), zero(0.0f);
  const Floats reach_at_rest = Floats(1 + seeker.margin + 0x1p-10f) + norm_1(v) * Floats(0x1p-18f);
  return scan(
      around, seeker, found,
      [&](const NeedleBlock& block, std::size_t lane, const float* offset) NEEDLEWORK_TARGET {
        const V3 from{r.x - Floats(offset[0]), r.y - Floats(offset[1]), r.z - Floats(offset[2])};
        const V3 other_v = load(block, NeedleBlock::a_x, lane);
        const Floats age = now - load_floats(block.column[NeedleBlock::time] + lane);
        const V3 d = (from - load(block, NeedleBlock::x, lane)) - other_v * age, w = v - other_v;
        const Floats dd = dot(d, d), b = dot(d, w), a = dot(w, w);
        const Floats reach = reach_at_rest + norm_1(other_v) * Floats(0x1p-18f);
        const Floats c = dd - (reach * reach + dd * Floats(0x1p-18f));
        // Nearest at -b / a, or at the end of the time ahead when that comes first.
        const Mask later = -b < a * ahead;
        const Mask apart = select(later, c * a > b * b, c + (b + b + a * ahead) * ahead > zero);
        return !((c > zero) & ((b >= zero) | apart));
      });
}

/// The contact function of pairs at one time each, with three derivatives; and what tells how far
/// the needles stay apart along the gap between them: projected on it, centre, velocity, directors
/// and their rates.
struct SimdSample {
  Floats f, df, ddf, dddf;
  Floats gap;  // its length
  Floats centre, velocity, director[2], turning[2];
};

/// The seeker's and the others' rotation and the relative centres, from now on.
struct SimdPairs {
  V3 r, v, u[2], p[2];
  Floats omega[2], age[2];
};

NEEDLEWORK_INLINE SimdSample sample(const SimdPairs& pair, Floats s) {
  V3 n[2], d[2];
  for (int i = 0; i < 2; ++i) {
    const Turned t = sine_cosine(pair.omega[i] * (s + pair.age[i]));
    n[i] = pair.u[i] * t.cosine + pair.p[i] * t.sine;
    d[i] = (pair.p[i] * t.cosine - pair.u[i] * t.sine) * pair.omega[i];
  }
  const V3 c = pair.r + pair.v * s, x = cross(n[0], n[1]);
  const V3 dx[2] = {cross(d[0], n[1]), cross(n[0], d[1])}, dd = cross(d[0], d[1]);
  const Floats square[2] = {pair.omega[0] * pair.omega[0], pair.omega[1] * pair.omega[1]};
  const Floats squares = square[0] + square[1];
  const Floats vx = dot(pair.v, x), vdx = dot(pair.v, dx[0] + dx[1]), vdd = dot(pair.v, dd);
  const Floats cdx[2] = {dot(c, dx[0]), dot(c, dx[1])}, cdd = dot(c, dd);
  SimdSample out;
  out.f = dot(c, x);
  out.df = vx + (cdx[0] + cdx[1]);
  out.ddf = (vdx + vdx) + ((cdd + cdd) - squares * out.f);
  out.dddf =
      Floats(3.0f) * ((vdd + vdd) - squares * vx) -
      ((squares + (square[1] + square[1])) * cdx[0] + (squares + (square[0] + square[0])) * cdx[1]);
  const V3 gap = segment_gap(c, n[0], n[1], x, dot(x, x));
  out.gap = square_root(dot(gap, gap));
  out.centre = dot(gap, c);
  out.velocity = dot(gap, pair.v);
  for (int i = 0; i < 2; ++i) {
    out.director[i] = dot(gap, n[i]);
    out.turning[i] = dot(gap, d[i]);
  }
  return out;
}

/// Those of the lanes from k on.
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
  pair.u[1] = {column(C::u_x), column(C::u_y), column(C::u_z)};
  pair.p[1] = {column(C::p_x), column(C::p_y), column(C::p_z)};
  pair.omega[1] = column(C::omega);
  pair.age[1] = column(C::age);
  return pair;
}

/// What bounds the contact function of pairs up to a time, and what rounding does to it.
struct SimdBounds {
  Floats speed, margin;
  Floats reach_squared;  // of the centres, where needles may touch
  // While the bounding spheres overlap f'' is at most `bend`, and the fourth derivative 4! `coil`:
  // derivative n of u1 x u2 is at most (|w1| + |w2|)^n, and the second of the centres is 0.
  Floats bend, coil;
  Floats error_f, error_df, error_ddf, error_dddf;
  Mask trusted;  // the phases are not too large for these
};

NEEDLEWORK_INLINE SimdBounds bounds_of(const Seeker& seeker, const SimdPairs& pair, Floats until) {
  SimdBounds out;
  const Floats half(0.5f), w = pair.omega[0] + pair.omega[1];
  const Floats v = square_root(dot(pair.v, pair.v));
  out.speed = v + half * w;
  // What times off by 2^-20 and phases off by 2^-23 of themselves do, and the caller's margin.
  const Floats swift = norm_1(broadcast(seeker.motion.v)) + (norm_1(pair.v) + w);
  const Floats phase = pair.omega[0] * until + pair.omega[1] * (pair.age[1] + until);
  out.margin = Floats(seeker.margin) + swift * Floats(0x1p-18f) + phase * Floats(0x1p-20f);
  out.trusted = phase < Floats(0x1p12f);
  const Floats reach = Floats(1 + 0x1p-10f) + out.margin;
  out.reach_squared = reach * reach + dot(pair.r, pair.r) * Floats(0x1p-18f);
  const Floats arm = Floats(1 + 0x1p-8f) * square_root(out.reach_squared);
  const Floats turn = arm * w;
  out.bend = ((v + v) + turn) * w;
  const Floats twist = ((v + v + v) + turn) * (w * w);  // at most the third derivative
  out.coil = (Floats(4.0f) * v + turn) * (w * w * w) * Floats(1.0f / 24);
  out.error_f = out.margin + out.margin;
  out.error_df = out.margin * (out.speed + out.speed);
  out.error_ddf = out.margin * (out.bend + out.bend);
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

/// bracket() for the lanes from k to end - 1. Lane k is part (k - first) / pair_count of `parts` of
/// its pair's time.
inline std::size_t bracket_vector(const Seeker& seeker, const PairColumns& pairs, std::size_t k,
                                  std::size_t end, const float* part, std::size_t parts) {
  using C = PairColumns;
  constexpr float infinity = std::numeric_limits<float>::infinity();
  const Floats zero(0.0f), one(1.0f), half(0.5f);
  std::size_t evaluations = 0;
  const auto column = [&](int c) NEEDLEWORK_TARGET { return load_floats(pairs.column[c] + k); };
  const SimdPairs pair = load_pairs(seeker, pairs, k);
  Floats until = column(C::until);

  const SimdBounds bounds = bounds_of(seeker, pair, until);
  const Floats speed = bounds.speed;
  const Floats a = dot(pair.v, pair.v), b = dot(pair.r, pair.v), rr = dot(pair.r, pair.r);

  // Time in which the bounding spheres overlap.
  const Floats reach_squared = bounds.reach_squared;
  const Floats c = rr - reach_squared;
  const Floats discriminant = b * b - a * c;
  const Floats root = square_root(maximum(discriminant, zero));
  const Mask outside = c > zero;
  const Mask apart = outside & ((b >= zero) | (discriminant < zero));
  const Floats q = select(b > zero, -(b + root), root - b);
  const Floats entry = select(outside, c / q, zero);
  const Floats exit = select(b > zero, c / q, q / a);
  until = minimum(exit + Floats(0x1p-18f), until);
  Floats low = maximum(maximum(entry, column(C::from)) - Floats(0x1p-18f), zero);
  if (parts > 1) {
    const Floats span = (until - low) * Floats(1.0f / static_cast<float>(parts)),
                 begin = load_floats(part);
    const Mask last = begin >= Floats(static_cast<float>(parts - 1));
    until = select(last, until, low + span * (begin + one));
    low = low + span * begin;
  }

  const Floats squares = pair.omega[0] * pair.omega[0] + pair.omega[1] * pair.omega[1];
  const Floats sixth(1.0f / 6);
  const Floats least = Floats(0x1p-9f) / speed;
  // Over half a step f'' changes f by no more than this: longer ones are seldom free, and what a
  // step leaves is looked at again.
  constexpr float most_bend = 3;
  const Floats step = square_root(Floats(8 * most_bend) / bounds.bend);
  // Still to be looked at: from low to high, and from next on.
  Floats high = minimum(low + step, until), next = high;
  Mask searching = (counting() < Floats(static_cast<float>(end - k))) & (!apart) & (low <= until);
  Floats from(infinity);
  for (int round = 0; round < 40 && any(searching); ++round) {
    ++evaluations;
    const Floats middle = half * (low + high), h = half * (high - low);
    const SimdSample e = sample(pair, middle);
    const Mask known = bounds.trusted & (e.gap < Floats(0x1p10f));

    // Two bounds, from below, on how far the needles are from a contact up to h before and after
    // the middle: f with its sign, and along the gap that they have now. Either is a value less
    // what it falls by with time and with the square of time.
    const Mask negative = e.f < zero;
    const Floats f_now = absolute(e.f) - bounds.error_f - h * bounds.error_df;
    const Floats f_rises = h * select(negative, -e.df, e.df);
    const Floats f_bends = half * (bounds.error_ddf - select(negative, -e.ddf, e.ddf)) +
                           h * (sixth * (absolute(e.dddf) + bounds.error_dddf) + h * bounds.coil);
    const Floats f_bent = h * h * maximum(f_bends, zero);

    const auto along_gap = [&](Floats centre, Floats a, Floats b) NEEDLEWORK_TARGET {
      return centre - half * (absolute(a) + absolute(b));
    };
    const Floats moved = h * e.velocity, turned[2] = {h * e.turning[0], h * e.turning[1]};
    const Floats g = along_gap(e.centre, e.director[0], e.director[1]);
    const Floats g_now = g - bounds.error_f * e.gap;
    const Floats g_before =
        along_gap(e.centre - moved, e.director[0] - turned[0], e.director[1] - turned[1]) - g;
    const Floats g_after =
        along_gap(e.centre + moved, e.director[0] + turned[0], e.director[1] + turned[1]) - g;
    const Floats g_bent = Floats(0.25f) * squares * (h * h) * e.gap;

    // The share of h in which a bound stays above 0: the root of now + rises x - bent x^2, rounded
    // towards 0. What is not a number is not free.
    const auto spread = [&](Floats now, Floats rises, Floats bent) NEEDLEWORK_TARGET {
      const Floats twice = now + now;
      return square_root(rises * rises + (twice + twice) * bent) * Floats(1 + 0x1p-20f);
    };
    const auto share = [&](Floats now, Floats falls) NEEDLEWORK_TARGET {
      const Floats twice = now + now;
      return select(now > zero, select(falls <= twice, one, twice / falls), zero);
    };
    const Floats f_spread = spread(f_now, f_rises, f_bent);
    const Floats before = select(known,
                                 maximum(share(f_now, f_spread + f_rises),
                                         share(g_now, spread(g_now, g_before, g_bent) - g_before)),
                                 zero);
    const Floats after = select(known,
                                maximum(share(f_now, f_spread - f_rises),
                                        share(g_now, spread(g_now, g_after, g_bent) - g_after)),
                                zero);
    const Mask left = before >= one, right = after >= one, both = left & right;

    // With nothing of the first half left, the search goes on in the second, or after it; else in
    // what is left of the first half, and then in what is left of the second.
    const Floats freed = middle + h * after;
    low = select(left, select(right, next, freed), low);
    high = select(both, minimum(next + step, until), select(left, high, middle - h * before));
    next = select(both, high, select(left | right, next, freed));

    const Mask done = both & (low >= until);
    const Mask found = searching & (!both) & (high - low <= least);
    from = select(found, low, from);
    searching = searching & (!found) & !done;
  }
  from = select(searching, low, from);
  store_floats(maximum(from - Floats(0x1p-18f), zero), pairs.column[C::from] + k);
  return evaluations;
}

std::size_t bracket(const Seeker& seeker, const PairColumns& pairs, std::size_t n) {
  using C = PairColumns;
  if (n == 0) return 0;
  // Few pairs leave lanes idle: each is searched in several parts of its time at once. How many
  // depends on nothing but n, so that no result depends on where its pair stands.
  const std::size_t parts = std::clamp<std::size_t>(block_size / n, 1, 4);
  std::size_t evaluations = 0;
  for (std::size_t k = 0; k < n; k += block_size) {
    const std::size_t count = std::min(n - k, block_size);
    float part[2 * block_size] = {};
    for (std::size_t p = 1; p < parts; ++p) {
      for (std::size_t lane = 0; lane < count; lane += floats_at_once) {
        for (float* column : pairs.column) {
          store_floats(load_floats(column + k + lane), column + k + p * count + lane);
        }
        store_floats(Floats(static_cast<float>(p)), part + p * count + lane);
      }
    }
    const std::size_t end = k + parts * count;
    for (std::size_t at = k; at < end; at += floats_at_once) {
      evaluations += bracket_vector(seeker, pairs, at, end, part + (at - k), parts);
    }
    float* from = pairs.column[C::from] + k;
    for (std::size_t i = count; i < parts * count; ++i) {
      if (from[i] < from[i % count]) from[i % count] = from[i];
    }
  }
  return evaluations;
}
