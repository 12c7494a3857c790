// Intervals of time in which pairs may meet, and the lanes of a vector that search them. Part of
// bracket_body.h.
//
// A lane holds an interval and the number of its pair; what is known of pairs stays where it is,
// and each lane looks up that of its own. So a pair may have as many lanes as it has intervals, and
// takes none once it is settled.

/// One in each lane that is taken.
struct Intervals {
  Floats low, high;
  Floats pair;  ///< its number among those of a vector
  Mask taken;
};

/// Cuts each of `count` into as many parts as there are lanes for. How many is decided by nothing
/// but their number, so that no result depends on the order of pairs. Where one part ends, the next
/// begins, in the same bits.
NEEDLEWORK_INLINE void spread(Intervals& all, std::size_t count) {
  const std::size_t parts = floats_at_once / count;
  if (parts == 1) return;
  const Packing packing = packing_of(all.taken);
  const Floats thing = load_numbers(lane_shares.thing[count]);
  const auto taken = [&](Floats a)
                         NEEDLEWORK_TARGET { return permuted(packed(a, packing), thing); };
  const Floats low = taken(all.low), high = taken(all.high),
               part = load_floats(lane_shares.part[count]);
  const Floats length = Floats(1.0f / static_cast<float>(parts)) * (high - low);
  const Mask last = part >= Floats(static_cast<float>(parts - 1));
  all.low = multiply_add(length, part, low);
  all.high = select(last, high, multiply_add(length, part + Floats(1.0f), low));
  all.pair = taken(all.pair);
  all.taken = first_lanes(parts * count);
}

/// Moves intervals into lanes that are not taken, of which there must be enough.
NEEDLEWORK_INLINE void add(Intervals& all, const Intervals& more) {
  const Filling filling = filling_of(more.taken, !all.taken);
  all.low = filled(more.low, filling, all.low);
  all.high = filled(more.high, filling, all.high);
  all.pair = filled(more.pair, filling, all.pair);
  all.taken = all.taken | filling.filled;
}

/// Those for which there is no lane. The last to come is the first to go, so that there are never
/// many of one pair.
struct Waiting {
  static constexpr std::size_t most = 32 * floats_at_once;
  float low[most + floats_at_once], high[most + floats_at_once];
  std::uint32_t pair[most + floats_at_once];
  std::size_t count = 0;
};

/// Sets the times of these pairs to where the intervals begin, unless they are earlier.
NEEDLEWORK_INLINE void lower(float* from, const float* low, const std::uint32_t* pair,
                             std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) from[pair[i]] = std::min(from[pair[i]], low[i]);
}

/// Intervals that pairs are not searched in any more: they may meet there.
NEEDLEWORK_INLINE void settle(float* from, Floats begins, Floats pairs, Mask which) {
  float low[floats_at_once];
  std::uint32_t pair[floats_at_once];
  const Packing packing = packing_of(which);
  store_floats(packed(begins, packing), low);
  store_numbers(packed(pairs, packing), pair);
  lower(from, low, pair, packing.count);
}

NEEDLEWORK_INLINE void push(Waiting& waiting, const Intervals& some, float* from) {
  // So many wait of no pairs but those made up for it; they are settled.
  if (waiting.count > waiting.most - floats_at_once) {
    settle(from, some.low, some.pair, some.taken);
    return;
  }
  const Packing packing = packing_of(some.taken);
  store_floats(packed(some.low, packing), waiting.low + waiting.count);
  store_floats(packed(some.high, packing), waiting.high + waiting.count);
  store_numbers(packed(some.pair, packing), waiting.pair + waiting.count);
  waiting.count += packing.count;
}

/// Fills lanes that are free, of which there are so many, with what has waited.
NEEDLEWORK_INLINE void pop(Waiting& waiting, Intervals& all, std::size_t free) {
  const std::size_t count = std::min(waiting.count, free);
  const std::size_t k = waiting.count -= count;
  add(all, {load_floats(waiting.low + k), load_floats(waiting.high + k),
            load_numbers(waiting.pair + k), first_lanes(count)});
}
