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
