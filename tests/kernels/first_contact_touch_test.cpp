// The first contact of needles that touch at s = 0: just collided, or near by rounding only.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "kernels/first_contact.h"
#include "tests/kernels/precise_contact.h"
#include "tests/kernels/sampled_contact.h"
#include "tests/support/by_build.h"
#include "tests/support/kernel_pair.h"
#include "tests/support/random.h"

namespace needlework::kernels {
namespace {

using test::flight;
using test::KernelPair;
using test::precise_contact;
using test::Random;
using test::real;
using test::vec3;
// 168 bits: 60 more than the double-doubles compared with.
using Precise = boost::multiprecision::cpp_bin_float_50;

constexpr std::uint64_t touch_seed = 505;
constexpr int touch_count = test::by_build(300, 60);

Contact find_after_touch(const KernelPair& pair, double until) {
  EvaluationCounters counters;
  const Contact contact = first_contact(pair.view(), 0, until, counters);
  EXPECT_LT(counters.evaluated + counters.escalated, 3000u);
  return contact;
}

// f, f' and f'' at s = 0 in the pair's own time.
test::PreciseContact<Precise> at_start(const KernelPair& pair) {
  return precise_contact(pair.view(), PairScale{}, Precise(0));
}

// Two needles on a contact at s = 0, arms inside, |u1 x u2| not small; the relative velocity along
// the normal is such that f'(0) = slope up to rounding.
KernelPair on_contact(Random& random, double slope) {
  KernelPair pair;
  const Vec3d u1 = vec3(random.direction());
  Vec3d u2 = vec3(random.direction());
  if (dot(cross(u1, u2), cross(u1, u2)) < 0.1) u2 = cross(u1, u2);
  const double s12 = random.uniform(-0.4, 0.4), s21 = random.uniform(-0.4, 0.4);
  pair.first = flight({}, u1, vec3(random.normal_vector(1)), vec3(random.normal_vector(2)));
  pair.second = flight({}, u2, vec3(random.normal_vector(1)), vec3(random.normal_vector(2)));
  pair.first.r = pair.first.u * -s12;
  pair.second.r = pair.second.u * -s21;
  for (int i = 0; i < 2; ++i) {
    const auto exact = at_start(pair);
    const Vec3d x{static_cast<double>(exact.x[0]), static_cast<double>(exact.x[1]),
                  static_cast<double>(exact.x[2])};
    pair.first.v += x * ((slope - static_cast<double>(exact.df)) / dot(x, x));
  }
  return pair;
}

void collided(KernelPair& pair) {
  const auto exact = at_start(pair);
  pair.touch = {.touching = true, .collided = true, .side = exact.df > 0 ? 1 : -1, .gap = 0};
}

// The time of the root of f(s) - f(0) + gap near `guess`, by Newton's iteration.
Precise root_near(const KernelPair& pair, const Precise& guess) {
  const Precise offset = Precise(pair.touch.gap) - at_start(pair).f;
  Precise s = guess;
  for (int i = 0; i < 8; ++i) {
    const auto exact = precise_contact(pair.view(), PairScale{}, s);
    s -= (exact.f + offset) / exact.df;
  }
  return s;
}

// Draws until f'' has the sign of `towards` times that of f'.
KernelPair draw_bounce(Random& random, double slope, int towards) {
  for (;;) {
    const double side = random.coin() ? 1 : -1;
    KernelPair pair = on_contact(random, side * slope);
    const auto exact = at_start(pair);
    const double bend = static_cast<double>(exact.ddf) * side * towards;
    if (bend < 0.3 || exact.df * side <= 0) continue;
    collided(pair);
    return pair;
  }
}

TEST(FirstContactAfterCollision, ReturnsWhereTheParabolaDoes) {
  Random random(touch_seed);
  // Excursions f'^2 / (2 |f''|) down to 1e-25.
  for (const double slope : {1e-4, 1e-6, 1e-8, 1e-10, 1e-12}) {
    // Rounding of f in double-double over f' t.
    const double noise = 1e-31 / (slope * slope);
    for (int n = 0; n < touch_count; ++n) {
      const KernelPair pair = draw_bounce(random, slope, -1);
      const auto exact = at_start(pair);
      const double parabola = static_cast<double>(Precise(-2 * exact.df / exact.ddf));
      const Contact contact = find_after_touch(pair, 2 * parabola);
      ASSERT_TRUE(contact.found) << "slope " << slope << ", seed " << touch_seed << ", pair " << n;
      EXPECT_FALSE(contact.unresolvable);
      EXPECT_EQ(contact.side, pair.touch.side);
      EXPECT_NEAR(contact.elapsed.hi / parabola, 1, 1e3 * slope + noise);
      const Precise truth = root_near(pair, contact.elapsed.hi);
      EXPECT_LT(abs(real<Precise>(contact.elapsed) / truth - 1), 1e-12 + noise)
          << "slope " << slope << ", seed " << touch_seed << ", pair " << n;
    }
  }
}

TEST(FirstContactAfterCollision, DoesNotReturnWhileItAcceleratesAway) {
  Random random(touch_seed);
  for (const double slope : {1e-1, 1e-3, 1e-6, 1e-9, 1e-12}) {
    for (int n = 0; n < touch_count; ++n) {
      const KernelPair pair = draw_bounce(random, slope, 1);
      // f - f(0) > slope s + 0.15 s^2 - |f'''| s^3 / 6 is positive for a while.
      const double rate = 1 / scale_of(pair.view()).per_rate;
      EXPECT_FALSE(find_after_touch(pair, 0.01 / rate).found)
          << "slope " << slope << ", seed " << touch_seed << ", pair " << n;
    }
  }
}

TEST(FirstContactAfterCollision, DoesNotMissTheFirstReturn) {
  Random random(touch_seed);
  int contacts = 0, sampled = 0;
  for (int n = 0; n < touch_count; ++n) {
    KernelPair pair = on_contact(random, random.coin() ? 0.3 : -0.3);
    collided(pair);
    const Contact contact = find_after_touch(pair, 1);
    contacts += contact.found;
    const auto seen = test::sampled_contact(pair.view(), 1, 100);
    if (!seen) continue;
    ++sampled;
    ASSERT_TRUE(contact.found) << "seen at " << *seen << ", seed " << touch_seed << ", pair " << n;
    EXPECT_LT(contact.elapsed.hi, *seen * (1 + 1e-12)) << "seed " << touch_seed << ", pair " << n;
  }
  EXPECT_GT(contacts, touch_count / 20);
  EXPECT_GT(sampled, contacts / 2);
}

// From slopes at which nothing is claimed to needles that part faster than they rotate.
TEST(TimeApart, EndsBeforeTheNextContactAndWhereTheGapIsWide) {
  Random random(touch_seed);
  int contacts = 0, known = 0;
  for (const double slope : {1e-9, 1e-4, 0.01, 0.1, 0.3, 3.0}) {
    for (int n = 0; n < touch_count; ++n) {
      KernelPair pair = on_contact(random, random.coin() ? slope : -slope);
      collided(pair);
      const double apart = time_apart(pair.view());
      ASSERT_GE(apart, 0);
      if (slope < 1e-7 || slope > 0.2) {
        EXPECT_EQ(apart > 0, slope > 0.2) << "slope " << slope << ", seed " << touch_seed;
      }
      known += apart > 0;
      const Contact contact = find_after_touch(pair, 3);
      EvaluationCounters counters;
      const Contact later = first_contact(pair.view(), apart, 3, counters);
      const auto at = [&](double s) {
        return static_cast<double>(precise_contact(pair.view(), PairScale{}, Precise(s)).f -
                                   at_start(pair).f) *
               pair.touch.side;
      };
      for (const double share : {0.1, 0.4, 0.7, 1.0}) {
        // f / s is above a line from the slope to 0 at four thirds of that time.
        EXPECT_GE(at(share * apart), 0.2 * slope * share * apart)
            << "slope " << slope << ", seed " << touch_seed << ", pair " << n;
      }
      ASSERT_EQ(later.found, contact.found) << "seed " << touch_seed << ", pair " << n;
      if (!contact.found) continue;
      ++contacts;
      EXPECT_EQ(later.elapsed.hi, contact.elapsed.hi);
      EXPECT_EQ(later.elapsed.lo, contact.elapsed.lo);
      EXPECT_EQ(later.side, contact.side);
      EXPECT_LE(apart, contact.elapsed.hi) << "seed " << touch_seed << ", pair " << n;
    }
  }
  EXPECT_GT(known, 2 * touch_count);
  EXPECT_GT(contacts, touch_count);
}

TEST(TimeApart, IsEndlessWithoutRotationAndZeroAtRest) {
  Random random(touch_seed);
  KernelPair pair = on_contact(random, 0.5);
  for (Flight* needle : {&pair.first, &pair.second}) {
    needle->w = {};
    set_rotation(*needle);
  }
  collided(pair);
  EXPECT_EQ(time_apart(pair.view()), std::numeric_limits<double>::infinity());
  pair.second.v = pair.first.v;
  EXPECT_EQ(time_apart(pair.view()), 0);
}

TEST(TimeApart, ScalesWithTheTime) {
  Random random(touch_seed);
  KernelPair pair = on_contact(random, 0.3);
  collided(pair);
  const double apart = time_apart(pair.view());
  for (const int power : {-300, -1, 300})
    EXPECT_EQ(time_apart(test::slowed(pair, power).view()), std::ldexp(apart, power));
}

TEST(FirstContactAfterCollision, WithoutRotationNeverReturns) {
  Random random(touch_seed);
  for (int n = 0; n < touch_count; ++n) {
    KernelPair pair = on_contact(random, random.coin() ? 1e-3 : -0.5);
    for (Flight* needle : {&pair.first, &pair.second}) {
      needle->w = {};
      set_rotation(*needle);
    }
    collided(pair);
    EXPECT_FALSE(find_after_touch(pair, 1e3).found) << "seed " << touch_seed << ", pair " << n;
  }
}

// The rule sets V_n = 0 for epsilon = 0; with f'' towards contact there is no flight at all.
TEST(FirstContactAfterCollision, AReturnBelowRoundingIsUnresolvable) {
  Random random(touch_seed);
  int unresolvable = 0;
  for (int n = 0; n < touch_count; ++n) {
    KernelPair pair = on_contact(random, 0);
    const auto exact = at_start(pair);
    const double bend = static_cast<double>(exact.ddf);
    if (std::abs(bend) < 0.3) continue;
    pair.touch = {.touching = true, .collided = true, .side = bend > 0 ? -1 : 1, .gap = 0};
    const Contact contact = find_after_touch(pair, 1);
    ASSERT_TRUE(contact.found) << "seed " << touch_seed << ", pair " << n;
    EXPECT_TRUE(contact.unresolvable) << "seed " << touch_seed << ", pair " << n;
    EXPECT_EQ(contact.elapsed, DoubleDouble());
    EXPECT_EQ(contact.side, pair.touch.side);
    ++unresolvable;
    // On the other side f'' leads away.
    pair.touch.side = -pair.touch.side;
    const double rate = 1 / scale_of(pair.view()).per_rate;
    EXPECT_FALSE(find_after_touch(pair, 0.01 / rate).found)
        << "seed " << touch_seed << ", pair " << n;
  }
  EXPECT_GT(unresolvable, touch_count / 2);
}

// Contact points at rest relative to each other, as of rough needles after many bounces: f, f' and
// f'' are 0, and the third derivative decides. Whatever the search cannot resolve near 0, the side
// must not be lost.
TEST(FirstContactAfterCollision, ACubicReturnIsUnresolvableAndNotMissed) {
  for (const double turn : {0.5, -0.5}) {
    KernelPair pair;
    pair.first = flight({-0.25, 0.125, 0}, {1, 0, 0}, {0, -0.0625, turn / 4}, {0, turn, 0.25});
    pair.second = flight({}, {0, 1, 0}, {}, {});
    const auto exact = at_start(pair);
    ASSERT_EQ(exact.f, 0);
    ASSERT_LT(abs(exact.df), 1e-40);
    ASSERT_LT(abs(exact.ddf), 1e-40);
    const int away = turn > 0 ? -1 : 1;  // the sign of the third derivative
    pair.touch = {.touching = true, .collided = true, .side = -away, .gap = 0};
    const Contact contact = find_after_touch(pair, 1);
    ASSERT_TRUE(contact.found) << turn;
    EXPECT_TRUE(contact.unresolvable);
    EXPECT_EQ(contact.elapsed, DoubleDouble());
    EXPECT_EQ(contact.side, -away);
    pair.touch.side = away;
    EXPECT_FALSE(find_after_touch(pair, 1).found) << turn;
  }
}

// A third needle was renewed while it touched: the gap is known from the records before, f(0) of
// the new records is not to be trusted.
TEST(FirstContactFromACarriedGap, ClosesOnlyWhenItApproaches) {
  Random random(touch_seed);
  for (const double gap : {1e-13, 1e-15, 1e-17, 1e-22}) {
    for (int n = 0; n < touch_count; ++n) {
      KernelPair pair = on_contact(random, random.coin() ? 0.5 : -0.5);
      const int moves = at_start(pair).df > 0 ? 1 : -1;
      const double rate = 1 / scale_of(pair.view()).per_rate;
      const double soon = 0.01 / rate;
      for (const int side : {1, -1}) {
        pair.touch = {.touching = true, .collided = false, .side = side, .gap = side * gap};
        const Contact contact = find_after_touch(pair, soon);
        ASSERT_EQ(contact.found, moves == -side)
            << "gap " << side * gap << ", seed " << touch_seed << ", pair " << n;
        if (!contact.found) continue;
        EXPECT_EQ(contact.side, side);
        EXPECT_FALSE(contact.unresolvable);
        const Precise truth = root_near(pair, 0);
        EXPECT_LT(abs(real<Precise>(contact.elapsed) - truth), 1e-25 + 1e-12 * truth)
            << "gap " << side * gap << ", seed " << touch_seed << ", pair " << n;
      }
    }
  }
}

TEST(FirstContactFromACarriedGap, AContactThatIsDueComesAtOnce) {
  Random random(touch_seed);
  for (int n = 0; n < touch_count; ++n) {
    KernelPair pair = on_contact(random, random.coin() ? 0.5 : -0.5);
    const int moves = at_start(pair).df > 0 ? 1 : -1;
    pair.touch = {.touching = true, .collided = false, .side = -moves, .gap = 0};
    const Contact contact = find_after_touch(pair, 1);
    ASSERT_TRUE(contact.found) << "seed " << touch_seed << ", pair " << n;
    EXPECT_NEAR(contact.elapsed.hi, 0, 1e-25);
    EXPECT_EQ(contact.side, -moves);
  }
}

TEST(FirstContactNearATouch, IsLeftOpenUnlessTheSideIsKnown) {
  Random random(touch_seed);
  for (int n = 0; n < touch_count; ++n) {
    KernelPair pair = on_contact(random, random.coin() ? 0.5 : -0.5);
    pair.touch_within = 1e-12;
    EXPECT_TRUE(find_after_touch(pair, 1).side_unknown) << "seed " << touch_seed << ", pair " << n;
    EXPECT_FALSE(find_after_touch(pair, 1).found);
    // Later searches of the same pair are past the touch.
    EvaluationCounters counters;
    EXPECT_FALSE(first_contact(pair.view(), 1e-3, 1, counters).side_unknown);
    KernelPair known = pair;
    collided(known);
    EXPECT_FALSE(find_after_touch(known, 1).side_unknown);
    KernelPair apart = pair;
    const auto x = at_start(pair).x;
    apart.first.r +=
        Vec3d{static_cast<double>(x[0]), static_cast<double>(x[1]), static_cast<double>(x[2])} *
        1e-10;
    EXPECT_FALSE(find_after_touch(apart, 1).side_unknown)
        << "seed " << touch_seed << ", pair " << n;
    // |f| is small, but the centres are too far apart to touch.
    KernelPair far = pair;
    far.first.r += far.first.u * 2;
    EXPECT_FALSE(find_after_touch(far, 1).side_unknown) << "seed " << touch_seed << ", pair " << n;
  }
}

TEST(SideAfter, IsTheSignOfTheFirstDerivativeThatDoesNotVanish) {
  Random random(touch_seed);
  for (int n = 0; n < touch_count; ++n) {
    const KernelPair moving = on_contact(random, random.coin() ? 1e-10 : -1e-10);
    EXPECT_EQ(side_after(moving.view()), at_start(moving).df > 0 ? 1 : -1);
  }
  // f = c sin wt + (vz t) cos wt with vz = -c w, and vx to bend it: f' = 0, f'' = 2 vx w.
  for (const double vx : {0.25, -0.25}) {
    KernelPair bent;
    bent.first = flight({0.25, 0, 0}, {1, 0, 0}, {vx, 0, -0.125}, {0, 0.5, 0});
    bent.second = flight({0, 0, 0}, {0, 1, 0}, {}, {});
    EXPECT_EQ(side_after(bent.view()), vx > 0 ? 1 : -1);
  }
  KernelPair still;
  still.first = flight({0, 0, 0}, {1, 0, 0}, {}, {});
  still.second = flight({0, 0, 0}, {0, 1, 0}, {}, {});
  EXPECT_EQ(side_after(still.view()), 0);
}

TEST(GapAt, ContinuesTheGapOfATouch) {
  Random random(touch_seed);
  for (int n = 0; n < touch_count; ++n) {
    KernelPair pair = on_contact(random, 0.3);
    const double s = random.uniform(0, 2);
    const Precise f0 = at_start(pair).f,
                  f = precise_contact(pair.view(), PairScale{}, Precise(s)).f;
    const double free = gap_at(pair.view(), s);
    EXPECT_LT(abs(free - f), 1e-16 * (1 + abs(f))) << "seed " << touch_seed << ", pair " << n;
    pair.touch = {.touching = true, .collided = false, .side = 1, .gap = 1e-14};
    const double continued = gap_at(pair.view(), s);
    EXPECT_LT(abs(continued - (f - f0 + Precise(1e-14))), 1e-16 * (1 + abs(f)));
    EXPECT_EQ(gap_at(pair.view(), DoubleDouble()), 1e-14);
  }
}

TEST(ContactGeometryOfAPair, IsExactEvenNearlyParallel) {
  Random random(touch_seed);
  for (int n = 0; n < touch_count; ++n) {
    KernelPair pair = on_contact(random, 0.3);
    // Turn the second director towards the first about the point of contact.
    const double tilt = std::ldexp(1.0, -random.below(30)),
                 arm = -dot(pair.second.r, pair.second.u);
    const Vec3d u2 = pair.first.u * (random.coin() ? 1 : -1) + pair.second.u * tilt;
    pair.second = flight({}, u2, pair.second.v, pair.second.w);
    pair.second.r = pair.second.u * -arm;
    const ContactGeometry at = contact_geometry(pair.view(), DoubleDouble());
    const auto exact = at_start(pair);
    const Precise xx = test::dot(exact.x, exact.x), x = sqrt(xx);
    const double s12 =
        static_cast<double>(Precise(test::dot(test::cross(exact.u[1], exact.r), exact.x) / xx));
    const double s21 =
        static_cast<double>(Precise(test::dot(test::cross(exact.u[0], exact.r), exact.x) / xx));
    EXPECT_NEAR(at.arm_first, s12, 1e-12) << "tilt " << tilt << ", seed " << touch_seed;
    EXPECT_NEAR(at.arm_second, s21, 1e-12) << "tilt " << tilt << ", seed " << touch_seed;
    EXPECT_LT(abs(at.sin_angle / x - 1), 1e-11) << "tilt " << tilt << ", seed " << touch_seed;
    EXPECT_LT(abs(at.normal.x - exact.x[0] / x), 1e-11)
        << "tilt " << tilt << ", seed " << touch_seed;
    EXPECT_LT(abs(at.normal.z - exact.x[2] / x), 1e-11)
        << "tilt " << tilt << ", seed " << touch_seed;
  }
}

}  // namespace
}  // namespace needlework::kernels
