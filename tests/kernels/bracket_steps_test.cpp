// What a step of the SIMD bracket relies on, on every instruction set: rough operations that are
// good enough, bounds on how the contact function and the tips curve, and shares of a span in which
// needles surely do not meet.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "tests/kernels/drawn_simd_pairs.h"
#include "tests/kernels/exposed_kernels.h"
#include "tests/support/pairs_csv.h"

namespace needlework::kernels {
namespace {

ExposedStep step_of(Isa isa, const SimdPair& pair, float s, float h) {
  test::PairTable table({pair.row});
  return exposed_step(isa, pair.seeker, table.view(), s, h);
}

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
  Seen out;
  for (const Isa isa : available()) {
    const ExposedStep bounds = step_of(isa, pair, 0, 0);
    out.take({.bend = share(std::abs(to_double(now.ddf)), bounds.bend),
              .coil = share(std::abs(to_double(ddf)) / (step * step), 24.0 * bounds.coil),
              .tips = share(departure, bounds.tips_bend * (step * step))});
  }
  return out;
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
                         test::family_name);

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

// What margins assume of the processor, and that what must not be a number for infinite ones is
// none.
TEST(RoughOperations, AreWithinTheirErrors) {
  Random random(seed + 8);
  constexpr double roundings = 0x1p-23;
  constexpr float infinity = std::numeric_limits<float>::infinity();
  for (const Isa isa : available()) {
    double worst = 0;
    for (int n = 0; n < 50000; ++n) {
      const auto a = static_cast<float>(random.log_uniform(0x1p-80, 0x1p80)),
                 b = static_cast<float>(random.log_uniform(0x1p-40, 0x1p40));
      const RoughResults got = rough_results(isa, a, b);
      const double root = std::sqrt(double{a});
      const double errors[] = {got.quotient / (double{a} / b) - 1, got.root / root - 1,
                               got.inverse_root * root - 1};
      for (const double error : errors) worst = std::max(worst, std::abs(error));
      ASSERT_LE(worst, got.error + roundings) << name_of(isa) << ", " << a << ", " << b;
      const auto c = static_cast<float>(random.log_uniform(0x1p-60, 0x1p60));
      const double length = std::hypot(double{b}, double{c}),
                   measured = rough_results(isa, b, c).length;
      ASSERT_GE(measured, length * (1 - roundings)) << name_of(isa) << ", " << b << ", " << c;
      ASSERT_LE(measured, length * (1 + 3 * (got.error + roundings)) + 0x1p-49) << name_of(isa);
    }
    std::printf("%s: off by %.3f * 2^-12\n", std::string(name_of(isa)).c_str(), worst * 0x1p12);
    // Nothing has no length, or next to none, and rules no pair out.
    for (const float a : {0.0f, 0x1p-149f, 0x1p-127f, 0x1p-75f}) {
      const float length = rough_results(isa, a, a).length;
      EXPECT_GE(length, isa == Isa::scalar ? 0 : a) << name_of(isa);
      EXPECT_LE(length, 0x1p-49) << name_of(isa);
    }
    EXPECT_EQ(rough_results(isa, 0, 1).inverse_root, infinity) << name_of(isa);
    EXPECT_FALSE(rough_results(isa, infinity, 1).length < infinity) << name_of(isa);
    EXPECT_FALSE(rough_results(isa, 0x1p100f, 1).length < infinity) << name_of(isa);
    EXPECT_EQ(rough_results(isa, 1, infinity).quotient, 0) << name_of(isa);
    const float none = std::numeric_limits<float>::quiet_NaN();
    const RoughResults of_none = rough_results(isa, none, 1);
    for (const float each : {of_none.quotient, of_none.root, of_none.inverse_root, of_none.length,
                             rough_results(isa, 1, none).quotient}) {
      EXPECT_TRUE(std::isnan(each)) << name_of(isa);
    }
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
    for (int n = 0; n < 4; ++n) {
      // A sample before or after the contact, which is as often near an end of the span as not.
      const double h = contact * random.log_uniform(1e-4, 1),
                   share = random.coin() ? random.uniform() : 1 - random.log_uniform(1e-6, 1);
      const bool later = random.coin() && contact + share * h <= pair.row[PairColumns::until];
      const auto s = static_cast<float>(later ? contact + share * h : contact - share * h);
      const double distance = std::abs(contact - s);
      for (const Isa isa : available()) {
        const ExposedStep free = step_of(isa, pair, s, static_cast<float>(h));
        const double claimed = later ? free.before : free.after;
        ++contacts;
        near += claimed * h > 0.9 * distance;
        ASSERT_LE(claimed * h, distance)
            << (later ? "before" : "after") << " a sample, of a span of " << h << ", "
            << name_of(isa) << "\n"
            << test::csv_line(0, drawn);
      }
    }
  }
  std::printf("of %zu shares %zu end just before the contact\n", contacts, near);
}

INSTANTIATE_TEST_SUITE_P(Families, FreeShares, testing::ValuesIn(test::pair_families()),
                         test::family_name);

}  // namespace
}  // namespace needlework::kernels
