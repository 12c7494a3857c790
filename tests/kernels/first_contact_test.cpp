// The first contact: what it does not depend on, and contacts known by hand.
#include "kernels/first_contact.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "tests/kernels/precise_contact.h"
#include "tests/support/by_build.h"
#include "tests/support/collided_pair.h"
#include "tests/support/family_name.h"
#include "tests/support/random.h"

namespace needlework::kernels {
namespace {

using test::axes_swapped;
using test::exchanged;
using test::flight;
using test::KernelPair;
using test::Random;
using test::real;
using test::vec3;
using test::Wide;

constexpr std::uint64_t first_seed = 404;
constexpr int first_thin = test::by_build(1, 10);

Contact find(const KernelPair& pair, double from, double until) {
  EvaluationCounters counters;
  return first_contact(pair.view(), from, until, counters);
}
Contact find(const KernelPair& pair, double until) { return find(pair, 0, until); }

bool same(const Contact& a, const Contact& b) {
  return a.found == b.found && a.unresolvable == b.unresolvable && a.elapsed == b.elapsed &&
         a.side == b.side && a.side_unknown == b.side_unknown;
}

std::string describe(const Contact& a) {
  char text[100];
  std::snprintf(text, sizeof text, "%s at %.17g + %.17g, side %d", a.found ? "found" : "none",
                a.elapsed.hi, a.elapsed.lo, a.side);
  return text;
}

struct Case {
  KernelPair pair;
  double until;
};

// A pair of one of the families, as it is or with its records of different ages.
Case as_kernel_pair(const test::NeedlePair& drawn, Random& random) {
  Case out{test::collided_pair(drawn), drawn.horizon};
  if (!drawn.just_collided && random.coin()) {
    Flight& older = random.coin() ? out.pair.first : out.pair.second;
    const double age = drawn.horizon * random.uniform();
    older.r -= older.v * age;
    older.u = normalised(director_after(older, -age));
    older.w = project_out(older.w, older.u);
    set_rotation(older);
    (&older == &out.pair.first ? out.pair.elapsed_first : out.pair.elapsed_second) = age;
  }
  return out;
}

class FirstContact : public testing::TestWithParam<test::PairFamily> {
 protected:
  template <class Check>
  void for_each_pair(Check check) {
    const auto pairs = test::draw_pairs(GetParam().name, 1000 / first_thin, first_seed);
    Random random(first_seed);
    int contacts = 0;
    for (std::size_t n = 0; n < pairs.size() && !HasFatalFailure(); ++n) {
      SCOPED_TRACE("seed " + std::to_string(first_seed) + ", pair " + std::to_string(n));
      const Case drawn = as_kernel_pair(pairs[n], random);
      const Contact contact = find(drawn.pair, drawn.until);
      contacts += contact.found;
      check(drawn, contact, random);
    }
    EXPECT_GT(contacts, 40 / first_thin);
  }
};

class FirstContactFromAnywhere : public FirstContact {};

TEST_P(FirstContactFromAnywhere, IsTheSame) {
  for_each_pair([](const Case& drawn, const Contact& contact, Random& random) {
    if (!contact.found) return;
    const double t = contact.elapsed.hi;
    for (int i = 0; i < 6; ++i) {
      const double from = i == 0 ? t : random.uniform(0, t);
      const double until = i == 1 ? t : t * random.log_uniform(1, 100);
      const Contact again = find(drawn.pair, from, until);
      ASSERT_TRUE(same(contact, again)) << "from " << from << " until " << until << ": "
                                        << describe(again) << " instead of " << describe(contact);
    }
    const double earlier = std::nextafter(t, 0);
    ASSERT_FALSE(find(drawn.pair, earlier).found) << describe(contact);
    ASSERT_FALSE(find(drawn.pair, earlier / 2, earlier).found) << describe(contact);
  });
}

TEST_P(FirstContact, IsInTimeAndHasItsSide) {
  for_each_pair([](const Case& drawn, const Contact& contact, Random&) {
    if (!contact.found) return;
    ASSERT_GT(contact.elapsed.hi, 0);
    ASSERT_LE(contact.elapsed.hi, drawn.until);
    ASSERT_EQ(std::abs(contact.side), 1);
    const ContactGeometry at = contact_geometry(drawn.pair.view(), contact.elapsed);
    ASSERT_LE(std::abs(at.arm_first), 0.5);
    ASSERT_LE(std::abs(at.arm_second), 0.5);
    // The contact points approach each other.
    const Flight &a = drawn.pair.first, &b = drawn.pair.second;
    const Vec3d v = (a.v - b.v) + (cross(a.w, at.u_first) * at.arm_first -
                                   cross(b.w, at.u_second) * at.arm_second);
    const double size = std::sqrt(dot(a.v - b.v, a.v - b.v)) + a.omega + b.omega;
    ASSERT_LT(dot(v, at.normal) * contact.side, 1e-13 * size);
  });
}

TEST_P(FirstContact, SwapsWithItsNeedles) {
  for_each_pair([](const Case& drawn, const Contact& contact, Random&) {
    const Contact other = find(exchanged(drawn.pair), drawn.until);
    ASSERT_TRUE(same(contact, other)) << describe(contact) << ", " << describe(other);
  });
}

TEST_P(FirstContact, OfSwappedAxesIsTheSame) {
  for_each_pair([](const Case& drawn, const Contact& contact, Random&) {
    Contact other = find(axes_swapped(drawn.pair), drawn.until);
    other.side = -other.side;
    ASSERT_TRUE(same(contact, other)) << describe(contact) << ", " << describe(other);
  });
}

INSTANTIATE_TEST_SUITE_P(Families, FirstContact, testing::ValuesIn(test::pair_families()),
                         test::family_name);

INSTANTIATE_TEST_SUITE_P(Families, FirstContactFromAnywhere,
                         testing::ValuesIn(test::pair_families()), test::family_name);

// Without rotation f is linear: the only root and the arms are rational functions of the records.
TEST(FirstContactWithoutRotation, IsWhereTheLinesMeet) {
  Random random(first_seed);
  int contacts = 0, tips = 0;
  for (int n = 0; n < 5000 / first_thin; ++n) {
    KernelPair held;
    held.first = flight(vec3(random.normal_vector(0.5)), vec3(random.direction()),
                        vec3(random.normal_vector(1)), {});
    held.second = flight(vec3(random.normal_vector(0.5)), vec3(random.direction()),
                         vec3(random.normal_vector(1)), {});
    const auto u1 = real<Wide>(held.first.u), u2 = real<Wide>(held.second.u);
    const test::Vec<Wide> x = test::cross(u1, u2);
    const test::Vec<Wide> r = test::operator-(real<Wide>(held.first.r), real<Wide>(held.second.r));
    const test::Vec<Wide> v = test::operator-(real<Wide>(held.first.v), real<Wide>(held.second.v));
    const Wide time = -test::dot(r, x) / test::dot(v, x);
    const test::Vec<Wide> there = test::operator+(r, test::operator*(time, v));
    const Wide xx = test::dot(x, x);
    const double s12 = static_cast<double>(Wide(test::dot(test::cross(u2, there), x) / xx));
    const double s21 = static_cast<double>(Wide(test::dot(test::cross(u1, there), x) / xx));
    const bool meet = time > 0 && std::abs(s12) < 0.5 && std::abs(s21) < 0.5;
    const Contact contact = find(held, 100);
    ASSERT_EQ(contact.found, meet && time <= 100) << "seed " << first_seed << ", pair " << n;
    tips += time > 0 && !meet;
    if (!contact.found) continue;
    ++contacts;
    const Wide found = real<Wide>(contact.elapsed);
    ASSERT_LT(abs(found / time - 1), 1e-12) << "seed " << first_seed << ", pair " << n;
    ASSERT_EQ(contact.side, test::dot(r, x) > 0 ? 1 : -1);
    const ContactGeometry at = contact_geometry(held.view(), contact.elapsed);
    ASSERT_NEAR(at.arm_first, s12, 1e-9) << "seed " << first_seed << ", pair " << n;
    ASSERT_NEAR(at.arm_second, s21, 1e-9) << "seed " << first_seed << ", pair " << n;
  }
  EXPECT_GT(contacts, 200 / first_thin);
  EXPECT_GT(tips, 200 / first_thin);
}

// Needle 1 turns about the y axis, its centre at (c, 0, h); needle 2 lies on the y axis:
// f = c sin wt + h cos wt.
TEST(FirstContactByHand, ANeedleRocksOntoAnother) {
  const double c = 0.3, h = -0.25, w = 1.5;
  KernelPair held;
  held.first = flight({c, 0, h}, {1, 0, 0}, {}, {0, w, 0});
  held.second = flight({0, 0.25, 0}, {0, 1, 0}, {}, {});
  const Contact contact = find(held, 10);
  ASSERT_TRUE(contact.found);
  EXPECT_NEAR(contact.elapsed.hi, std::atan2(-h, c) / w, 1e-15);
  EXPECT_EQ(contact.side, -1);
  const ContactGeometry at = contact_geometry(held.view(), contact.elapsed);
  EXPECT_NEAR(at.arm_first, -std::hypot(c, h), 1e-15);
  EXPECT_NEAR(at.arm_second, -0.25, 1e-15);
  EXPECT_NEAR(at.sin_angle, 1, 1e-15);
  EXPECT_NEAR(dot(at.normal, at.u_first), 0, 1e-15);
}

// Both turn about z, and the first falls through the plane of the second: f = z sin(angle).
KernelPair falling(double z, double vz, double w1, double w2, double angle) {
  KernelPair held;
  held.first = flight({0.1, 0.05, z}, {1, 0, 0}, {0, 0, vz}, {0, 0, w1});
  held.second = flight({0, 0, 0}, {std::cos(angle), std::sin(angle), 0}, {}, {0, 0, w2});
  return held;
}

TEST(FirstContactByHand, PassingThroughParallelIsNoContact) {
  // The directors are parallel at 0.25, 1.82, 3.39 .., the planes meet at 4.
  const KernelPair held = falling(0.5, -0.125, 3, 1, 0.5);
  const Contact contact = find(held, 10);
  ASSERT_TRUE(contact.found);
  EXPECT_NEAR(contact.elapsed.hi, 4, 1e-14);
  EXPECT_FALSE(find(held, 3.9).found);
  EXPECT_FALSE(find(falling(0.5, 0.125, 3, 1, 0.5), 10).found);
}

TEST(FirstContactByHand, NeedlesOfOnePlaneNeverMeet) {
  Random random(first_seed);
  for (int n = 0; n < 200; ++n) {
    KernelPair held =
        falling(0, 0, random.uniform(-3, 3), random.uniform(-3, 3), random.uniform(0, 6));
    held.first.v = {random.uniform(-1, 1), random.uniform(-1, 1), 0};
    EvaluationCounters counters;
    EXPECT_FALSE(first_contact(held.view(), 0, 20, counters).found) << "seed " << first_seed;
    EXPECT_LT(counters.evaluated + counters.escalated, 200u) << "seed " << first_seed;
  }
}

TEST(FirstContactByHand, AnExactTipIsNoContactAndOneBitInsideIs) {
  // Needle 1 falls along z; its tip is at x = 0, where needle 2 lies on the y axis.
  const auto at = [](double x, double y) {
    KernelPair held;
    held.first = flight({x, y, 0.5}, {1, 0, 0}, {0, 0, -1}, {});
    held.second = flight({0, 0, 0}, {0, 1, 0}, {}, {});
    return find(held, 2).found;
  };
  EXPECT_FALSE(at(-0.5, 0));
  EXPECT_FALSE(at(0.5, 0));
  EXPECT_FALSE(at(0, 0.5));
  EXPECT_FALSE(at(0, -0.5));
  EXPECT_FALSE(at(-0.5, 0.5));
  EXPECT_TRUE(at(-0.5 + 0x1p-54, 0));
  EXPECT_TRUE(at(0.5 - 0x1p-54, 0.5 - 0x1p-54));
  EXPECT_FALSE(at(-0.5 - 0x1p-53, 0));
  EXPECT_FALSE(at(0, 0.5 + 0x1p-53));
}

// Needle 1 turns about the y axis as above while its centre passes: f = (c + vx t) sin wt + (h + vz
// t) cos wt, at the height h over a double root at t = 0 when vz = -c w.
KernelPair swinging(double h) {
  const double c = 0.25, w = 0.5, vx = 0.25;
  KernelPair held;
  held.first = flight({c, 0, h}, {1, 0, 0}, {vx, 0, -c * w}, {0, w, 0});
  held.second = flight({0, 0, 0}, {0, 1, 0}, {}, {});
  return held;
}

TEST(FirstContactByHand, ATouchWithoutChangeOfSignIsNoContact) {
  EXPECT_FALSE(find(swinging(0), 1).found);
  // The same seen from 1 before the touch; roundings of the records move it by 1e-16.
  for (const double h : {1e-3, 1e-8, 1e-14, -1e-14, -1e-8, -1e-3}) {
    const KernelPair then = swinging(h);
    KernelPair before = then;
    before.first.r = centre_after(then.first, -1);
    before.first.u = director_after(then.first, -1);
    set_rotation(before.first);
    const Contact contact = find(before, 2);
    EXPECT_EQ(contact.found, h < 0) << h;
    if (!contact.found) continue;
    // f'' = 2 vx w - h w^2.
    const double ahead = std::sqrt(2 * -h / (0.25 - 0.25 * h));
    EXPECT_NEAR(contact.elapsed.hi, 1 - ahead, ahead * ahead + 1e-2 * ahead) << h;
    EXPECT_EQ(contact.side, 1);
  }
}

// Two roots close to time 1, and a tip that slides over the other needle just between them.
TEST(FirstContactByHand, OfTwoCloseRootsOnlyTheOneInsideTheNeedlesCounts) {
  for (const double h : {-1e-3, -1e-6, -1e-10}) {
    for (const double slide : {1.0, -1.0}) {
      const double way = std::sqrt(8 * -h), ahead = 1;
      KernelPair held = swinging(h);
      held.first.r = centre_after(held.first, -ahead);
      held.first.u = director_after(held.first, -ahead);
      set_rotation(held.first);
      held.second = flight({0, 0.5 + slide * ahead, 0}, {0, 1, 0}, {0, -slide, 0}, {});
      const Contact contact = find(held, 3);
      ASSERT_TRUE(contact.found) << h;
      // Inside is after the tip has passed, or before.
      EXPECT_NEAR(contact.elapsed.hi, ahead + slide * way, 0.1 * way) << h;
      EXPECT_EQ(contact.side, -slide);
    }
  }
}

TEST(FirstContactByHand, OnAPointOfTheDyadicGridIsFoundOnce) {
  for (const double t : {0.5, 1.0, 0.25, 0.375, 1.5}) {
    for (const double spin : {0.0, 0.5}) {
      // The pair's rate is 1, so scaled time is time.
      const double vz = spin > 0 ? 0.5 : 1;
      const KernelPair held = falling(-t * vz, vz, spin, 0, 1.2);
      ASSERT_EQ(scale_of(held.view()).per_time, 1);
      const Contact contact = find(held, 10);
      ASSERT_TRUE(contact.found) << t;
      EXPECT_NEAR(contact.elapsed.hi, t, 0x1p-52);
      const double hi = contact.elapsed.hi;
      for (const double from : {0.0, 0.9 * hi, std::nextafter(hi, 0), hi}) {
        for (const double until : {hi, std::nextafter(hi, 2), 2.0}) {
          EXPECT_TRUE(same(find(held, from, until), contact)) << t << " from " << from;
        }
      }
      EXPECT_FALSE(find(held, std::nextafter(hi, 0)).found);
      EXPECT_FALSE(find(held, t + 0.5, 10).found) << "found again";
    }
  }
}

TEST(FirstContactByHand, NeedlesThatMoveAlikeNeverMeet) {
  KernelPair held;
  held.first = flight({0, 0, 0}, {1, 0, 0}, {3, 2, 1}, {});
  held.second = flight({0, 0, 0}, {0, 1, 0}, {3, 2, 1}, {});
  EvaluationCounters counters;
  EXPECT_FALSE(first_contact(held.view(), 0, 1e300, counters).found);
  EXPECT_EQ(counters.evaluated, 0u);
}

TEST(FirstContactByHand, OfAPeriodicImageIsFoundThroughItsShift) {
  KernelPair held = falling(0.5, -1, 0.5, 0, 1.2);
  const Contact contact = find(held, 2);
  const double box = 12.7;
  held.second.r += Vec3d{box, 0, -box};
  held.shift = {two_prod(-1, box), DoubleDouble(), two_prod(1, box)};
  // The centre was rounded: half an ulp of the box moves the contact.
  const Contact shifted = find(held, 2);
  ASSERT_TRUE(contact.found && shifted.found);
  EXPECT_NEAR(shifted.elapsed.hi, contact.elapsed.hi, 4e-15);
  held.shift = {};
  EXPECT_FALSE(find(held, 2).found);
}

}  // namespace
}  // namespace needlework::kernels
