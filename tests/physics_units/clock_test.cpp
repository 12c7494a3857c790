// Time as epoch and offset, against many digits.
#include "src/physics/clock.h"

#include <gtest/gtest.h>

#include <cfloat>
#include <cmath>
#include <limits>

#include "tests/support/random.h"
#include "tests/support/real.h"

namespace needlework {
namespace {

using test::Random;
using test::Wide;

constexpr std::uint64_t clock_seed = 1010;
constexpr int draws = 5000;
constexpr double infinity = std::numeric_limits<double>::infinity();

Wide exact(const Clock& clock, const Time& t) {
  return Wide(t.epoch) * clock.epoch_length() + t.offset;
}

/// Up to 2^60 epochs old; offsets on the grid of the resolution, finer ones, and both ends.
Time draw_time(Random& random, const Clock& clock) {
  Time t;
  t.epoch = static_cast<std::int64_t>(random.bits() >> (4 + random.below(60)));
  const double length = clock.epoch_length();
  switch (random.below(4)) {
    case 0:
      t.offset = length * (random.coin() ? 0 : 1 - 0x1p-53);
      break;
    case 1:
      t.offset = length * std::ldexp(random.uniform(), -random.below(100));
      break;
    default:
      t.offset = length * static_cast<double>(random.bits() >> 12) * 0x1p-52;
  }
  return t;
}

void expect_normal(const Clock& clock, const Time& t) {
  EXPECT_GE(t.offset, 0);
  EXPECT_LT(t.offset, clock.epoch_length());
}

TEST(Clock, HasAPowerOfTwoNearWhatItIsGivenForItsEpoch) {
  for (const double near : {1.0, 1.9, 3.7, 0.3, 1e-200, 1e200}) {
    const double length = Clock(near).epoch_length();
    EXPECT_EQ(length, std::ldexp(1.0, std::ilogb(length)));
    EXPECT_LE(length, near);
    EXPECT_GT(2 * length, near);
    EXPECT_EQ(Clock(near).resolution(), length * 0x1p-52);
  }
  for (const double none : {0.0, infinity, -1.0, std::nan("")}) {
    EXPECT_EQ(Clock(none).epoch_length(), 1);
  }
}

TEST(Clock, OrdersTimesAsTheirValues) {
  Random random(clock_seed);
  const Clock clock(0.3);
  for (int n = 0; n < draws; ++n) {
    const Time a = draw_time(random, clock);
    Time b = draw_time(random, clock);
    if (random.coin()) b.epoch = a.epoch + random.below(3) - 1;
    ASSERT_EQ(a < b, exact(clock, a) < exact(clock, b)) << "seed " << clock_seed << ", " << n;
    ASSERT_EQ(a == b, exact(clock, a) == exact(clock, b)) << "seed " << clock_seed << ", " << n;
    ASSERT_LT(a, Time::never());
  }
}

TEST(Clock, AddsWithinHalfItsResolutionAtAnyAge) {
  Random random(clock_seed);
  const Clock clock(5);
  const double half = 0.5 * clock.resolution();
  for (int n = 0; n < draws; ++n) {
    const Time t = draw_time(random, clock);
    double dt = clock.epoch_length() * std::ldexp(random.uniform(), random.below(160) - 100);
    if (random.below(10) == 0) dt = 0;
    const Time sum = clock.add(t, dt);
    expect_normal(clock, sum);
    const Wide error = exact(clock, sum) - (exact(clock, t) + dt);
    ASSERT_LE(abs(error), half) << "dt " << dt << ", seed " << clock_seed << ", " << n;
    ASSERT_GE(sum, t);
    if (dt == 0) {
      ASSERT_EQ(sum, t);
    }
    ASSERT_GE(clock.add(t, std::nextafter(dt, infinity)), sum);
  }
}

TEST(Clock, CarriesAtTheEndOfTheEpoch) {
  const Clock clock(1);
  EXPECT_EQ(clock.add({7, 0.75}, 0.25), (Time{8, 0}));
  EXPECT_EQ(clock.add({7, 0.75}, 0.5), (Time{8, 0.25}));
  EXPECT_EQ(clock.add({7, 0.75}, 3.5), (Time{11, 0.25}));
  EXPECT_EQ(clock.add({7, 0.75}, 3.0), (Time{10, 0.75}));
  // The sum of the offsets rounds up to a whole epoch.
  const double last = 1 - 0x1p-53;
  EXPECT_EQ(clock.add({7, last}, 0x1p-53), (Time{8, 0}));
  EXPECT_EQ(clock.add({7, last}, 0x1.8p-54), (Time{8, 0}));
  EXPECT_EQ(clock.add({7, last}, 0x1p-60), (Time{7, last}));
  EXPECT_EQ(clock.add({7, last}, last), (Time{8, 1 - 0x1p-52}));
  EXPECT_EQ(clock.add({(std::int64_t{1} << 60) - 1, last}, 0x1p-53),
            (Time{std::int64_t{1} << 60, 0}));
}

TEST(Clock, NeverIsAfterEverything) {
  const Clock clock(2);
  const Time old{std::int64_t{1} << 60, 1.5};
  EXPECT_EQ(clock.add({}, infinity), Time::never());
  EXPECT_EQ(clock.add(old, infinity), Time::never());
  EXPECT_EQ(clock.add({}, 0x1p62 * 2), Time::never());
  EXPECT_EQ(clock.add({}, 1e300), Time::never());
  EXPECT_EQ(clock.add(Time::never(), 1), Time::never());
  EXPECT_EQ(clock.difference(Time::never(), {}), 0x1p63);
  EXPECT_LT(old, Time::never());
  EXPECT_LT(clock.add({}, 0x1p61), Time::never());
  // Nor may many steps lead past the last epoch.
  const Time half = clock.add({}, 0x1p62);
  EXPECT_LT(half, Time::never());
  EXPECT_EQ(clock.add(half, 0x1p62), Time::never());
}

TEST(Clock, DifferencesAreWithinTheResolution) {
  Random random(clock_seed);
  const Clock clock(1.5);
  for (int n = 0; n < draws; ++n) {
    const Time a = draw_time(random, clock);
    Time b = draw_time(random, clock);
    if (random.coin()) b.epoch = a.epoch + random.below(5) - 2;
    const Wide truth = exact(clock, a) - exact(clock, b);
    const double allowed = clock.resolution() + 0x1p-51 * static_cast<double>(Wide(abs(truth)));
    ASSERT_LE(abs(clock.difference(a, b) - truth), allowed) << "seed " << clock_seed << ", " << n;
    ASSERT_EQ(clock.difference(a, b), -clock.difference(b, a));
    ASSERT_EQ(clock.difference(a, a), 0);
    ASSERT_EQ(clock.since_start(a), clock.difference(a, {}));
    // A short interval does not feel the age.
    const double dt = clock.epoch_length() * random.uniform();
    ASSERT_LE(std::abs(clock.difference(clock.add(a, dt), a) - dt), clock.resolution());
  }
}

TEST(Clock, ExactDifferencesAreExact) {
  Random random(clock_seed);
  const Clock clock(0.01);
  for (int n = 0; n < draws; ++n) {
    Time a = draw_time(random, clock), b = draw_time(random, clock);
    if (random.coin()) b.epoch = a.epoch + random.below(5) - 2;
    if (std::abs(static_cast<double>(a.epoch - b.epoch)) >= 0x1p53) continue;
    const Wide truth = exact(clock, a) - exact(clock, b);
    const auto difference = [&] {
      const DoubleDouble d = clock.exact_difference(a, b);
      return Wide(Wide(d.hi) + d.lo);
    };
    // Offsets finer than the resolution, next to 0, may need more than two doubles.
    ASSERT_LE(abs(difference() - truth), 0x1p-104 * abs(truth))
        << "seed " << clock_seed << ", " << n;
    const double grid = clock.resolution();
    a.offset = std::floor(a.offset / grid) * grid;
    b.offset = std::floor(b.offset / grid) * grid;
    ASSERT_TRUE(difference() == exact(clock, a) - exact(clock, b))
        << "seed " << clock_seed << ", " << n;
    b.epoch = a.epoch;
    ASSERT_TRUE(difference() == exact(clock, a) - exact(clock, b))
        << "seed " << clock_seed << ", " << n;
  }
}

TEST(Clock, PowersOfTwoScaleEveryTimeExactly) {
  Random random(clock_seed);
  const Clock clock(1.3);
  for (const int power : {-60, 60, -300, 500}) {
    const Clock scaled(std::ldexp(1.3, power));
    const auto later = [&](Time t) { return Time{t.epoch, std::ldexp(t.offset, power)}; };
    for (int n = 0; n < draws / 10; ++n) {
      const Time a = draw_time(random, clock), b = draw_time(random, clock);
      const double dt = std::ldexp(random.uniform(), random.below(100) - 60);
      ASSERT_EQ(scaled.add(later(a), std::ldexp(dt, power)), later(clock.add(a, dt)));
      ASSERT_EQ(scaled.difference(later(a), later(b)), std::ldexp(clock.difference(a, b), power));
      ASSERT_EQ(scaled.exact_difference(later(a), later(b)).lo,
                std::ldexp(clock.exact_difference(a, b).lo, power));
    }
  }
}

}  // namespace
}  // namespace needlework
