// Words of blocks: what they hold is as near as the kernels rely on, at every scale.
#include "kernels/needle_block.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/random.h"

namespace needlework::kernels {
namespace {

using test::Random;

constexpr std::uint64_t block_seed = 41;

struct DrawnBlock {
  WordFormat format;
  double from, to, coordinate;
};

// Ranges of all sizes, and coordinates within, at and beyond their ends.
DrawnBlock draw_drawn(Random& random) {
  DrawnBlock out;
  const double size = random.log_uniform(1e-2, 1e4);
  out.from = -size * random.uniform();
  out.to = out.from + size;
  out.format = WordFormat::holding(out.from, out.to);
  const int kind = random.below(4);
  const double beyond = kind == 0 ? 0.1 : 0;
  out.coordinate = kind == 1 ? (random.coin() ? out.from : out.to)
                             : random.uniform(out.from - beyond * size, out.to + beyond * size);
  return out;
}

TEST(WordFormat, HasTheFinestStepForItsRange) {
  Random random(block_seed);
  for (int n = 0; n < 10000; ++n) {
    const DrawnBlock drawn = draw_drawn(random);
    const double size = drawn.to - drawn.from, range = WordFormat::places * drawn.format.step();
    EXPECT_GE(range, 1.25 * size);
    EXPECT_LE(range, 2.5 * size);
    EXPECT_EQ(std::fmod(drawn.format.low, drawn.format.step()), 0);
    EXPECT_EQ(drawn.format.base, 0x1p23 * drawn.format.step());
  }
}

TEST(WordFormat, HoldsAPlaceAndAVelocity) {
  Random random(block_seed);
  double worst = 0;
  for (int n = 0; n < 100000; ++n) {
    const DrawnBlock drawn = draw_drawn(random);
    const int kind = random.below(8);
    const double v = kind == 0   ? 0.0
                     : kind == 1 ? -0.0
                     : kind == 2 ? random.normal() * 1e-30
                                 : random.normal() * random.log_uniform(1e-9, 1e9);
    const std::uint32_t word = drawn.format.with_velocity(drawn.coordinate, v);
    ASSERT_LE(std::abs(drawn.format.coordinate(word) - drawn.coordinate),
              0.500001 * drawn.format.step());
    const double off = std::abs(WordFormat::velocity(word) - v);
    ASSERT_LE(off, 0x1.00001p-11 * std::abs(v) + 0x1p-49) << v;
    ASSERT_TRUE(std::isnormal(WordFormat::velocity(word)));
    if (std::abs(v) > 1e-9) worst = std::max(worst, off / std::abs(v));
  }
  EXPECT_GT(worst, 0x1p-12);
}

TEST(WordFormat, KnowsWhatItHolds) {
  const WordFormat format = WordFormat::holding(0, 1);
  const double step = format.step(), range = WordFormat::places * step;
  EXPECT_TRUE(format.holds(format.low));
  EXPECT_TRUE(format.holds(format.low + range - step));
  EXPECT_FALSE(format.holds(format.low - step));
  EXPECT_FALSE(format.holds(format.low + range));
  // The nearest.
  EXPECT_EQ(format.coordinate(format.with_velocity(-1e9, 1)), format.low);
  EXPECT_EQ(format.coordinate(format.with_director(1e9, 1)), format.low + range - step);
}

TEST(WordFormat, HoldsAPlaceAndADirector) {
  Random random(block_seed);
  for (int n = 0; n < 100000; ++n) {
    const DrawnBlock drawn = draw_drawn(random);
    const int kind = random.below(8);
    const double u = kind == 0 ? 1 : kind == 1 ? -1 : kind == 2 ? 0 : random.uniform(-1, 1);
    const std::uint32_t word = drawn.format.with_director(drawn.coordinate, u);
    ASSERT_LE(std::abs(drawn.format.coordinate(word) - drawn.coordinate),
              0.500001 * drawn.format.step());
    ASSERT_LE(std::abs(WordFormat::director(word) - u), 0x1.02p-18) << u;
    if (std::abs(u) < 1 - 0x1p-18) {
      ASSERT_LE(std::abs(WordFormat::director(word) - u), 0x1.04p-19) << u;
    }
  }
}

}  // namespace
}  // namespace needlework::kernels
