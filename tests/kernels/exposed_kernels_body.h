// Included once for each instruction set, after near_needles_body.h.

inline ExposedStep step_of(const Seeker& seeker, const PairColumns& pairs, float s, float h) {
  float lanes[5][floats_at_once];
  const SimdPairs pair = load_pairs(seeker, pairs, 0);
  const SimdBounds bounds = bounds_of(seeker, pair, load_floats(pairs.column[PairColumns::until]));
  const SimdShares free =
      free_around<false>(sample(pair, Floats(s)), bounds, Floats(h), Floats(0.0f));
  const Floats values[5] = {bounds.bend, bounds.coil, bounds.tips_bend, free.before, free.after};
  for (int n = 0; n < 5; ++n) store_floats(values[n], lanes[n]);
  return {lanes[0][0], lanes[1][0], lanes[2][0], lanes[3][0], lanes[4][0]};
}

inline RoughResults rough_of(float a, float b) {
  float lanes[4][floats_at_once];
  const Floats values[4] = {rough_quotient(Floats(a), Floats(b)), rough_root(Floats(a)),
                            rough_inverse_root(Floats(a)),
                            rough_length(V3{Floats(a), Floats(b), Floats(0.0f)})};
  for (int n = 0; n < 4; ++n) store_floats(values[n], lanes[n]);
  return {rough_error, lanes[0][0], lanes[1][0], lanes[2][0], lanes[3][0]};
}

inline Intervals in_lanes(const ExposedIntervals& all) {
  return {load_floats(all.low), load_floats(all.high), load_numbers(all.pair),
          load_floats(all.taken) > Floats(0.0f)};
}

inline ExposedIntervals out_of_lanes(const Intervals& all) {
  ExposedIntervals out{};
  store_floats(all.low, out.low);
  store_floats(all.high, out.high);
  store_numbers(all.pair, out.pair);
  store_floats(select(all.taken, Floats(1.0f), Floats(0.0f)), out.taken);
  return out;
}

inline ExposedIntervals spread_of(const ExposedIntervals& all) {
  Intervals lanes = in_lanes(all);
  spread(lanes, count_of(lanes.taken));
  return out_of_lanes(lanes);
}

inline ExposedIntervals added(const ExposedIntervals& all, const ExposedIntervals& more) {
  Intervals lanes = in_lanes(all);
  add(lanes, in_lanes(more));
  return out_of_lanes(lanes);
}
