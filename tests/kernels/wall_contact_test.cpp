// First contacts of tips with walls, against an oracle with 33 digits.
#include "kernels/wall_contact.h"

#include <gtest/gtest.h>

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <numbers>

#include "src/physics/clock.h"
#include "tests/support/wall_oracle.h"

namespace needlework::kernels {
namespace {

using test::DrawnWalls;
using test::WallCase;
using test::WallComparison;
using test::WallFamily;

// bench_wall_accuracy counts the same over millions of cases.
TEST(WallContact, IsThatOfTheOracleInEveryFamily) {
  for (int n = 0; n < test::wall_families; ++n) {
    const auto family = static_cast<WallFamily>(n);
    DrawnWalls drawn(17 + static_cast<std::uint64_t>(n));
    WallComparison found;
    for (int i = 0; i < 2000; ++i) found.add(drawn.draw(family), 3);
    EXPECT_GT(found.contacts, 300u) << name_of(family);
    EXPECT_EQ(found.missed, 0u) << name_of(family);
    EXPECT_EQ(found.invented, 0u) << name_of(family);
    EXPECT_EQ(found.wrong_tip, 0u) << name_of(family);
    EXPECT_EQ(found.off, 0u) << name_of(family);
  }
}

TEST(WallContact, DoesNotDependOnWhenItIsAskedFor) {
  DrawnWalls drawn(2);
  for (int n = 0; n < 2000; ++n) {
    const WallCase a = drawn.draw(static_cast<WallFamily>(n % 6));
    const double to = 6;
    const WallContact found = first_wall_contact(a.approach, 0, to);
    const double latest = found.found ? found.elapsed : to;
    for (const double share : {0.1, 0.5, 0.99, 1.0}) {
      const WallContact again = first_wall_contact(a.approach, share * latest, to);
      ASSERT_EQ(again.found, found.found) << n;
      ASSERT_EQ(again.elapsed, found.elapsed) << n << ", from " << share;
      ASSERT_EQ(again.tip, found.tip) << n;
    }
    if (!found.found) continue;
    const WallContact shorter = first_wall_contact(a.approach, 0, found.elapsed);
    EXPECT_TRUE(shorter.found);
    EXPECT_EQ(shorter.elapsed, found.elapsed);
    EXPECT_FALSE(first_wall_contact(a.approach, 0, found.elapsed * (1 - 1e-9)).found);
  }
}

// A tip whose lowest point is so little above the wall, or beyond it.
TEST(WallContact, DecidesWhetherATipGrazes) {
  for (const double depth : {1e-3, 1e-9, 1e-15, 1e-20, 1e-25}) {
    for (const double side : {1.0, -1.0}) {
      WallCase a;
      a.approach.resolution = 0x1p-80;
      a.approach.half = 0.5;
      // The tip at -u points down after a quarter turn: h = z - sin(t) / 2.
      a.flight.u = {1, 0, 0};
      a.flight.w = {0, 1, 0};
      set_rotation(a.flight);
      a.flight.r = {0, 0, 0.5};
      a.approach.wall.axis = 2;
      // The height of the middle is exact: 0.5 less the place of the wall.
      a.approach.wall.place = -side * depth;
      const WallContact found = first_wall_contact(a.approach, 0, 3);
      EXPECT_EQ(found.found, side < 0) << depth;
      if (!found.found) continue;
      // 1 - cos(x) = 2 depth, before the quarter turn.
      EXPECT_NEAR(found.elapsed, std::numbers::pi / 2 - std::sqrt(4 * depth),
                  1e-6 * std::sqrt(4 * depth) + depth + 1e-15);
    }
  }
}

// Just after a hit, however slow, the tip does not hit at once, but when it has come back.
TEST(WallContact, ComesBackAfterABounce) {
  for (const double speed : {1.0, 1e-4, 1e-8, 1e-12}) {
    WallCase a;
    a.approach.resolution = 0x1p-90;
    a.approach.wall.axis = 2;
    a.approach.gravity = -2;
    a.approach.touching = 2;  // the tip at -u
    a.flight.u = {0, 0, 1};
    // Rounding has taken the tip beyond the wall, or not quite to it.
    for (const double off : {0.0, 1e-16, -1e-16}) {
      a.approach.tolerance = 1e-14;
      a.flight.r = {0, 0, 0.5 + off};
      a.flight.v = {0, 0, speed};
      const WallContact found = first_wall_contact(a.approach, 0, 10);
      ASSERT_TRUE(found.found);
      EXPECT_EQ(found.tip, 1);
      // Heights are good to 1e-31.
      EXPECT_NEAR(found.elapsed, speed, 1e-14 * speed + 1e-29 / speed) << off;
      EXPECT_FALSE(found.unresolvable);
    }
  }
  WallCase a;
  a.approach.resolution = 0x1p-52;
  a.approach.wall.axis = 2;
  a.approach.gravity = -2;
  a.approach.touching = 2;
  a.flight.u = {0, 0, 1};
  a.flight.r = {0, 0, 0.5};
  a.flight.v = {0, 0, 1e-16};
  EXPECT_TRUE(first_wall_contact(a.approach, 0, 10).unresolvable);
}

// The wall moves up with 1 / 2 until 1, and the tip that it has hit falls back with 2. What is
// called height 0 stays so where the wall halts: the tip begins a little off the surface, and is
// back when it is as far off the halted one.
TEST(WallContact, ComesBackToAWallThatHasHaltedMeanwhile) {
  for (const double off : {0.0, 5e-13, -5e-13}) {
    for (const double speed : {0.75, 1.0, 1.25, 3.0}) {  // beside the wall's
      WallCase a;
      a.approach.resolution = 0x1p-70;
      a.approach.tolerance = 1e-12;
      a.approach.gravity = -2;
      a.approach.touching = 2;  // the tip at -u
      a.approach.wall.axis = 2;
      a.approach.wall.velocity = 0.5;
      a.approach.wall.halt = 1;
      a.approach.wall.halt_place = 0.5;
      a.flight.u = {0, 0, 1};
      a.flight.r = {0, 0, 0.5 + off};
      a.flight.v = {0, 0, speed + 0.5};
      const WallContact found = first_wall_contact(a.approach, 0, 10);
      ASSERT_TRUE(found.found);
      EXPECT_EQ(found.tip, 1);
      const double b = 0.5 * (speed + 0.5);
      EXPECT_NEAR(found.elapsed, speed <= 1 ? speed : b + std::sqrt(b * b - 0.5), 1e-15)
          << speed << ", " << off;
    }
  }
}

TEST(WallContact, TellsANeedleAcrossTheWall) {
  WallCase a;
  a.approach.resolution = 0x1p-52;
  a.approach.tolerance = 0x1p-44;
  a.approach.wall.axis = 1;
  a.flight.u = {0, 1, 0};
  a.flight.r = {0, 0.4, 0};
  EXPECT_TRUE(first_wall_contact(a.approach, 0, 1).across);
}

// The same phase, by numbers of 100 bits.
TEST(ClockTurns, LoseNoDigitsAtAnyAge) {
  for (const double near : {1e-3, 0.7, 50.0}) {
    const Clock clock(near);
    for (const double frequency : {0.01, 1.0, 7.77, 1e3}) {
      for (const std::int64_t epoch :
           {std::int64_t{0}, std::int64_t{12345}, (std::int64_t{1} << 50) + 77}) {
        const Time time{epoch, 0.3 * clock.epoch_length()};
        const DoubleDouble turns = clock.turns(time, frequency);
        using Wide = boost::multiprecision::number<
            boost::multiprecision::cpp_bin_float<300, boost::multiprecision::digit_base_2>>;
        const Wide exact = Wide(frequency) * (Wide(epoch) * clock.epoch_length() + time.offset);
        const Wide off = exact - floor(exact) - (Wide(turns.hi) + Wide(turns.lo));
        EXPECT_LT(static_cast<double>(abs(off - round(off))), 1e-28) << near << " " << epoch;
      }
    }
  }
}

}  // namespace
}  // namespace needlework::kernels
