// What a step of the SIMD bracket relies on: bounds on how the contact function and the tips curve,
// and shares of a span in which needles surely do not meet.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/kernels/drawn_simd_pairs.h"
#include "tests/kernels/exposed_simd.h"
#include "tests/support/pairs_csv.h"

namespace needlework::kernels {
namespace {

using scalar::Floats;
namespace exposed = scalar::exposed;

struct Loaded {
  explicit Loaded(const SimdPair& pair)
      : table({pair.row}),
        simd(exposed::load_pairs(pair.seeker, table.view(), 0)),
        bounds(exposed::bounds_of(pair.seeker, simd, pair.row[PairColumns::until])) {}

  test::PairTable table;
  exposed::SimdPairs simd;
  exposed::SimdBounds bounds;
};

// In units of the pair's length and time.
Frame<DoubleDouble> frame_of(const SimdPair& pair) {
  return make_frame<DoubleDouble>(pair.pair.view(), {true, 1 / pair.unit, pair.unit});
}

// The largest shares of the bounds that have been seen.
struct Seen {
  double bend = 0, coil = 0, tips = 0;

  void take(const Seen& other) {
    bend = std::max(bend, other.bend);
    coil = std::max(coil, other.coil);
    tips = std::max(tips, other.tips);
  }
};

Seen shares_of_bounds(const SimdPair& pair, double s) {
  const Loaded loaded(pair);
  const Frame<DoubleDouble> frame = frame_of(pair);
  const auto at = [&](double time) { return evaluate(frame, DoubleDouble(time)); };
  const Sample<DoubleDouble> now = at(s);
  const Vec3d r = to_double(now.r);
  if (std::sqrt(dot(r, r)) > pair.halves().first + pair.halves().second) return {};
  const double scale = frame.v_norm + frame.w_sum;
  if (!(scale > 0)) return {};
  // As quotients of differences, whose own error is far below 1e-3 of the bound.
  const double step = 1e-4 / scale;
  const DoubleDouble ddf = at(s + step).ddf + at(s - step).ddf - (now.ddf + now.ddf);
  double departure = 0;
  const Sample<DoubleDouble> later = at(s + step), before = at(s - step);
  for (int i = 0; i < 2; ++i) {
    const Vec3d d = to_double(later.u[i] + before.u[i] - now.u[i] * DoubleDouble(2.0));
    departure += 0.5 * std::sqrt(dot(d, d)) * (i == 0 ? pair.halves().first : pair.halves().second);
  }
  const auto share = [](double value, double bound) { return value == 0 ? 0 : value / bound; };
  return {.bend = share(std::abs(to_double(now.ddf)), loaded.bounds.bend.v),
          .coil = share(std::abs(to_double(ddf)) / (step * step), 24.0 * loaded.bounds.coil.v),
          .tips = share(departure, loaded.bounds.tips_bend.v * (step * step))};
}

class Curvature : public testing::TestWithParam<test::PairFamily> {};

TEST_P(Curvature, IsWithinBounds) {
  Random random(seed + 4);
  Seen seen;
  for (const test::NeedlePair& drawn : draw_pairs(GetParam().name, 4000 / thin, seed + 4)) {
    const SimdPair pair = simd_pair(random, drawn, any_halves(random));
    const double s = random.uniform() * pair.row[PairColumns::until];
    if (pair.pair.first.omega * s / pair.unit > 0x1p10 ||
        pair.pair.second.omega * s / pair.unit > 0x1p10)
      continue;
    const Seen now = shares_of_bounds(pair, s);
    const double most = std::max({now.bend, now.coil, now.tips});
    ASSERT_LE(most, 1.001) << "bend " << now.bend << ", coil " << now.coil << ", tips " << now.tips
                           << "\n"
                           << test::csv_line(0, drawn);
    seen.take(now);
  }
  std::printf("up to %.3f, %.3f, %.3f of the bounds\n", seen.bend, seen.coil, seen.tips);
}

INSTANTIATE_TEST_SUITE_P(Families, Curvature, testing::ValuesIn(test::pair_families()),
                         [](const auto& info) { return family_id(info.param); });

// Two needles that turn against each other in parallel planes, whose directors' product turns with
// both angular velocities: far from each other, where the arm counts, or fast through each other's
// plane, where the velocity does. Smaller bounds would be wrong.
TEST(CurvatureOfTurningNeedles, ReachesItsBounds) {
  Random random(seed + 5);
  for (const bool fast : {false, true}) {
    Seen seen;
    for (int n = 0; n < 2000; ++n) {
      const double angle = random.uniform(0, 2 * std::numbers::pi);
      test::NeedlePair drawn;
      drawn.first = {.position = {0, 0, fast ? 0 : 0.999},
                     .orientation = {std::cos(angle), std::sin(angle), 0},
                     .velocity = {0, 0, fast ? 100.0 : 0},
                     .angular_velocity = {0, 0, random.uniform(0.5, 1)}};
      drawn.second = {.position = {0, 0, 0},
                      .orientation = {1, 0, 0},
                      .velocity = {0, 0, 0},
                      .angular_velocity = {0, 0, -random.uniform(0.5, 1)}};
      drawn.horizon = 1e-3;
      seen.take(shares_of_bounds(simd_pair(random, drawn), 0));
    }
    EXPECT_GT(seen.bend, 0.97) << fast;
    EXPECT_GT(seen.coil, 0.97) << fast;
    EXPECT_GT(seen.tips, 0.97) << fast;
    EXPECT_LT(std::max({seen.bend, seen.coil, seen.tips}), 1.001) << fast;
  }
}

class FreeShares : public testing::TestWithParam<test::PairFamily> {};

// However long the span, and wherever in it the contact is.
TEST_P(FreeShares, EndBeforeTheContact) {
  Random random(seed + 6);
  std::size_t contacts = 0, near = 0;
  for (const test::NeedlePair& drawn : draw_pairs(GetParam().name, 10000 / thin, seed + 6)) {
    const SimdPair pair = simd_pair(random, drawn, random.coin() ? any_halves(random) : Halves{});
    if (!pair.truth.found) continue;
    const double contact = pair.truth.elapsed.hi * pair.unit;
    Loaded loaded(pair);
    for (int n = 0; n < 4; ++n) {
      // A sample before or after the contact, which is as often near an end of the span as not.
      const double h = contact * random.log_uniform(1e-4, 1),
                   share = random.coin() ? random.uniform() : 1 - random.log_uniform(1e-6, 1);
      const bool later = random.coin() && contact + share * h <= pair.row[PairColumns::until];
      const auto s = static_cast<float>(later ? contact + share * h : contact - share * h);
      const exposed::SimdSample e = exposed::sample(loaded.simd, Floats(s));
      const exposed::SimdShares free = exposed::free_around<false>(
          e, loaded.bounds, Floats(static_cast<float>(h)), Floats(0.0f));
      const double distance = std::abs(contact - s), claimed = (later ? free.before : free.after).v;
      ++contacts;
      near += claimed * h > 0.9 * distance;
      ASSERT_LE(claimed * h, distance)
          << (later ? "before" : "after") << " a sample, of a span of " << h << "\n"
          << test::csv_line(0, drawn);
    }
  }
  std::printf("of %zu shares %zu end just before the contact\n", contacts, near);
}

INSTANTIATE_TEST_SUITE_P(Families, FreeShares, testing::ValuesIn(test::pair_families()),
                         [](const auto& info) { return family_id(info.param); });

}  // namespace
}  // namespace needlework::kernels
