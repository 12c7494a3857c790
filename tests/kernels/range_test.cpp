// Interval arithmetic against many digits: its results enclose the exact ones.
#include "kernels/range.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kernels/contact_function.h"
#include "tests/kernels/precise_contact.h"
#include "tests/support/by_build.h"
#include "tests/support/kernel_pair.h"
#include "tests/support/random.h"

namespace needlework {
namespace {

using test::Quad;

constexpr int range_count = test::by_build(200000, 5000);

bool encloses(const Range& range, const Quad& value) {
  return Quad(range.lo) <= value && value <= Quad(range.hi);
}

double number(test::Random& random) {
  const double size = std::ldexp(random.uniform(1, 2), random.below(60) - 30);
  return random.coin() ? size : -size;
}

Range range(test::Random& random) {
  const double a = number(random);
  const double b = random.coin() ? a + std::abs(a) * 0x1p-40 * random.uniform() : number(random);
  return {std::min(a, b), std::max(a, b)};
}

Quad inside(const Range& a, test::Random& random) {
  const int which = random.below(4);
  if (which == 0) return a.lo;
  if (which == 1) return a.hi;
  const Quad lo = a.lo, hi = a.hi;
  return lo + (hi - lo) * Quad(random.uniform());
}

TEST(Range, OperationsEncloseTheResultOfAllNumbersInTheOperands) {
  test::Random random(31);
  for (int i = 0; i < range_count; ++i) {
    const Range a = range(random), b = range(random);
    const Quad x = inside(a, random), y = inside(b, random);
    ASSERT_TRUE(encloses(a + b, x + y)) << a.lo << ' ' << a.hi << ' ' << b.lo << ' ' << b.hi;
    ASSERT_TRUE(encloses(a - b, x - y)) << a.lo << ' ' << a.hi << ' ' << b.lo << ' ' << b.hi;
    ASSERT_TRUE(encloses(a * b, x * y)) << a.lo << ' ' << a.hi << ' ' << b.lo << ' ' << b.hi;
    ASSERT_TRUE(encloses(-a, -x));
    ASSERT_LE(a.least(), abs(x));
    ASSERT_GE(a.most(), abs(x));
  }
}

// Nor is it needlessly wide: a few units in the last place.
TEST(Range, OperationsOnNumbersAreTight) {
  test::Random random(32);
  for (int i = 0; i < range_count; ++i) {
    const double a = number(random), b = number(random);
    const Range sum = Range(a) + Range(b), product = Range(a) * Range(b);
    EXPECT_LE(sum.hi - sum.lo, 4 * 0x1p-52 * std::abs(a + b));
    EXPECT_LE(product.hi - product.lo, 4 * 0x1p-52 * std::abs(a * b));
  }
}

TEST(Range, SineAndCosineEncloseThoseOfAllAngles_long) {
  test::Random random(33);
  for (int i = 0; i < range_count; ++i) {
    const double middle = random.uniform(-20, 20) * (random.coin() ? 1 : 100);
    const double half = random.coin() ? random.uniform(0, 2) : std::ldexp(1, -random.below(52));
    // Now and then centred on an extremum.
    const double at = random.coin() ? middle : std::round(middle / (M_PI / 2)) * (M_PI / 2);
    const Range angle{at - half, at + half};
    const SineCosine<Range> both = sine_cosine(angle);
    for (int k = 0; k < 8; ++k) {
      const Quad x = k == 0 ? Quad(at) : inside(angle, random);
      ASSERT_TRUE(encloses(both.sine, sin(x))) << angle.lo << ' ' << angle.hi;
      ASSERT_TRUE(encloses(both.cosine, cos(x))) << angle.lo << ' ' << angle.hi;
    }
    ASSERT_LE(both.sine.hi - both.sine.lo, 2 * half * (1 + 0x1p-40) + 0x1p-38);
  }
}

// Over a stretch of time, of every family: f and its derivatives, all roundings included.
TEST(Range, ContactFunctionsAreEnclosed) {
  test::Random random(34);
  for (const test::PairFamily& family : test::pair_families()) {
    for (const test::NeedlePair& drawn : test::draw_pairs(family.name, range_count / 2000, 35)) {
      test::KernelPair held = test::kernel_pair(drawn);
      // Records made some time before, and a partner seen through the border of the box.
      if (random.coin()) {
        DoubleDouble& elapsed = random.coin() ? held.elapsed_first : held.elapsed_second;
        elapsed = two_prod(drawn.horizon, random.log_uniform(1e-12, 10));
      }
      if (random.coin()) {
        const auto boxes = [&] { return two_prod(random.below(3) - 1, random.uniform(2, 9)); };
        held.shift = {boxes(), boxes(), boxes()};
      }
      held = resized(held, random.below(9) - 4);
      const kernels::Pair pair = held.view();
      const kernels::PairScale scale = kernels::scale_of(pair);
      const auto frame =
          kernels::enclose(kernels::make_frame<DoubleDouble>(pair, scale), pair, scale);
      const double end = drawn.horizon * scale.per_time;
      for (int k = 0; k < 4; ++k) {
        const double begin = end * random.uniform();
        const Range time{begin, begin + std::ldexp(end, -random.below(50))};
        const auto sample = kernels::evaluate(frame, time);
        const auto truth = test::precise_contact(pair, scale, inside(time, random));
        ASSERT_TRUE(encloses(sample.f, truth.f)) << family.name;
        ASSERT_TRUE(encloses(sample.df, truth.df)) << family.name;
        ASSERT_TRUE(encloses(sample.ddf, truth.ddf)) << family.name;
      }
    }
  }
}

// A contact function that continues from a touch is f with another start; what it starts from is
// enclosed too.
TEST(Range, ContinuationsFromATouchAreEnclosed) {
  test::Random random(36);
  for (const test::PairFamily& family : test::pair_families()) {
    for (const test::NeedlePair& drawn : test::draw_pairs(family.name, range_count / 2000, 37)) {
      test::KernelPair held = test::kernel_pair(drawn);
      const kernels::Pair pair = held.view();
      const kernels::PairScale scale = kernels::scale_of(pair);
      auto frame = kernels::make_frame<DoubleDouble>(pair, scale);
      const auto start = test::precise_contact(pair, scale, Quad(0));
      const double gap = 1e-13 * random.normal(), bend = 1e-12 * random.normal();
      frame.offset = DoubleDouble(gap) - kernels::evaluate(frame, DoubleDouble(0.0)).f;
      frame.slope = DoubleDouble(bend);
      const auto wide = kernels::enclose(frame, pair, scale);
      const double end = drawn.horizon * scale.per_time;
      const double begin = end * random.uniform();
      const Range time{begin, begin + std::ldexp(end, -random.below(50))};
      const auto sample = kernels::evaluate(wide, time);
      const Quad at = inside(time, random);
      const auto truth = test::precise_contact(pair, scale, at);
      ASSERT_TRUE(encloses(sample.f, truth.f - start.f + Quad(gap) + Quad(bend) * at))
          << family.name;
      ASSERT_TRUE(encloses(sample.df, truth.df + Quad(bend))) << family.name;
    }
  }
}

}  // namespace
}  // namespace needlework
