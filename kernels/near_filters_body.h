// The filters of neighbours: which needles of these cells may come near the seeker. Part of
// near_needles_body.h, which says what rounding does.

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

/// `seeker.longest_half` of the needles in these lanes.
NEEDLEWORK_INLINE Floats reach_of(const Surroundings& around, const NeedleBlock& block,
                                  std::size_t lane, Floats longest_half) {
  const auto b = static_cast<std::size_t>(&block - around.blocks);
  return longest_half + load_floats(around.reaches[b].reach + lane);
}

template <bool differ>
Scan overlapping_as(const Surroundings& around, const Seeker& seeker, float radius,
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
  const Floats own_half(seeker.motion.half), longest_half(seeker.longest_half);
  const HalfLengths<Floats> half_of_longest = half_lengths(own_half, longest_half);
  const auto test = [&](const NeedleBlock& block, std::size_t lane,
                        const float* offset) NEEDLEWORK_TARGET {
    const V3 from{r.x - Floats(offset[0]), r.y - Floats(offset[1]), r.z - Floats(offset[2])};
    const V3 words = load_words(block, lane);
    const V3 d = from - places_of(words, base);
    const V3 a = V3{signed_numbers(words.x), signed_numbers(words.y), signed_numbers(words.z)} *
                 Floats(0x1p-31f);
    HalfLengths<Floats> half = half_of_longest;
    if constexpr (differ)
      half = half_lengths(own_half, reach_of(around, block, lane, longest_half));
    // A cheaper test before this one does not pay: of many needles one would nearly always pass it.
    const V3 gap = rough_segment_gap(d, u, a, half);
    return dot(gap, gap) <= near_squared;
  };
  return scan(around, seeker, found, test);
}

Scan overlapping(const Surroundings& around, const Seeker& seeker, float radius,
                 const Found& found) {
  return around.reaches ? overlapping_as<true>(around, seeker, radius, found)
                        : overlapping_as<false>(around, seeker, radius, found);
}

template <bool differ>
Scan approaching_as(const Surroundings& around, const Seeker& seeker, const Found& found) {
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
  const Floats reach_of_longest = reach * reach * Floats(1 + 0x1p-10f);
  const auto test = [&](const NeedleBlock& block, std::size_t lane,
                        const float* offset) NEEDLEWORK_TARGET {
    Floats reach_squared = reach_of_longest;
    if constexpr (differ) {
      const Floats its = reach_of(around, block, lane, reach);
      reach_squared = its * its * Floats(1 + 0x1p-10f);
    }
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

Scan approaching(const Surroundings& around, const Seeker& seeker, const Found& found) {
  return around.reaches ? approaching_as<true>(around, seeker, found)
                        : approaching_as<false>(around, seeker, found);
}

/// How much segment_gap() may be too large for the rough quotient of its first guess, squared:
/// within the first segment the guess is off by rough_error times half its length, and this is
/// seven times its square. So it leaves room for the products with the other errors of the guess.
inline float rough_guess_adds(float half) {
  return (4 * rough_spare * rough_spare) * (half * half);
}

template <bool differ>
Scan near_capsules_as(const Surroundings& around, const Seeker& seeker, float distance,
                      const Found& found) {
  const Floats base(around.format.base);
  const V3 r = on_scale_of_words(seeker.r, around.format), u = broadcast(seeker.u);
  // As for overlapping(), but what rounding does to the gap grows with the seeker's segment.
  const float near = distance + seeker.margin + 4 * static_cast<float>(around.format.step()) +
                     (1 + seeker.axis_half) * 0x1p-17f;
  const Floats near_squared(near * near + rough_guess_adds(seeker.axis_half));
  const Floats own_half(seeker.axis_half), longest_half(seeker.longest_half);
  const HalfLengths<Floats> half_of_longest = half_lengths(own_half, longest_half);
  const auto test = [&](const NeedleBlock& block, std::size_t lane,
                        const float* offset) NEEDLEWORK_TARGET {
    const V3 from{r.x - Floats(offset[0]), r.y - Floats(offset[1]), r.z - Floats(offset[2])};
    const V3 words = load_words(block, lane);
    const V3 d = from - places_of(words, base);
    const V3 a = V3{signed_numbers(words.x), signed_numbers(words.y), signed_numbers(words.z)} *
                 Floats(0x1p-31f);
    HalfLengths<Floats> half = half_of_longest;
    if constexpr (differ)
      half = half_lengths(own_half, reach_of(around, block, lane, longest_half));
    const V3 x = cross(u, a);
    return segment_distance_squared(d, u, a, x, dot(x, x), half) <= near_squared;
  };
  return scan(around, seeker, found, test);
}

Scan near_capsules(const Surroundings& around, const Seeker& seeker, float distance,
                   const Found& found) {
  return around.reaches ? near_capsules_as<true>(around, seeker, distance, found)
                        : near_capsules_as<false>(around, seeker, distance, found);
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
