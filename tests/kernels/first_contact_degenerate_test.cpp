// First contacts of needles whose contact function is small or flat over long times: near to one
// plane, turning together, passing through each other's centres.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "kernels/first_contact.h"
#include "tests/kernels/planar_pair.h"
#include "tests/kernels/sampled_contact.h"
#include "tests/support/by_build.h"
#include "tests/support/kernel_pair.h"
#include "tests/support/random.h"

namespace needlework::kernels {
namespace {

using test::flight;
using test::KernelPair;
using test::nearly_planar;
using test::Random;
using test::vec3;

constexpr std::uint64_t degenerate_seed = 707;
constexpr int degenerate_count = test::by_build(600, 30);

struct Answer {
  Contact contact;
  std::uint64_t evaluations;
};

Answer answer_of(const KernelPair& pair, double from, double until) {
  EvaluationCounters counters;
  const Contact contact = first_contact(pair.view(), from, until, counters);
  return {contact, counters.evaluated + counters.escalated};
}

// Centres meet at s = 0 and leave each other slowly: f = s v . (u1 x u2) grows with time.
KernelPair concentric(Random& random, double speed) {
  KernelPair pair;
  pair.first = flight({}, vec3(random.direction()), vec3(random.normal_vector(speed)),
                      vec3(random.normal_vector(1)));
  pair.second = flight({}, vec3(random.direction()), {}, vec3(random.normal_vector(1)));
  return pair;
}

// Returns whether there is a contact.
bool expect_nothing_missed(const KernelPair& pair, double until, int n, double noise = 1e-14) {
  const Contact contact = answer_of(pair, 0, until).contact;
  const double end = contact.found ? contact.elapsed.hi : until;
  const auto seen = test::sampled_contact(pair.view(), end, 400, noise);
  // The last sample is next to the contact itself.
  if (seen && (!contact.found || *seen < end * (1 - 1e-9))) {
    ADD_FAILURE() << "missed at " << *seen << ", found " << contact.found << " at "
                  << contact.elapsed.hi << ", seed " << degenerate_seed << ", pair " << n;
  }
  return contact.found;
}

// Down to where f is nothing but rounding in double, and double-double decides.
TEST(FirstContactOfFlatFunctions, MissesNothingNearOnePlane) {
  Random random(degenerate_seed);
  for (const double tilt : {1e-1, 1e-3, 1e-6, 1e-12, 1e-15, 1e-18}) {
    int contacts = 0;
    for (int n = 0; n < degenerate_count / 3; ++n) {
      const KernelPair pair = nearly_planar(random, tilt, 0.01);
      contacts += expect_nothing_missed(pair, 10, n, std::min(1e-14, 1e-6 * tilt));
    }
    EXPECT_GT(contacts, degenerate_count / 30) << "tilt " << tilt;
  }
}

TEST(FirstContactOfFlatFunctions, IsNotMissedIfSlowAndConcentric) {
  Random random(degenerate_seed);
  for (int n = 0; n < degenerate_count; ++n) expect_nothing_missed(concentric(random, 0.02), 10, n);
}

// f is bounded by the magnitudes of its coefficients, which grow with time as the centres part: the
// only contact is at s = 7.98 in scaled time.
TEST(FirstContactOfFlatFunctions, IsFoundLongAfterTheCentresMet) {
  KernelPair pair;
  pair.first = flight({0, 0, 0}, {0.4, 0.8, 0.4}, {0.05, 0.08, 0.04}, {-0.1, 0, -0.9});
  pair.second = flight({0, 0, 0}, {-0.6, 0.8, 0.1}, {}, {0.9, 0.4, 0.4});
  const auto seen = test::sampled_contact(pair.view(), 8, 1000);
  ASSERT_TRUE(seen.has_value());
  ASSERT_NEAR(*seen, 3.98808299, 1e-8);
  const Contact contact = answer_of(pair, 0, 20).contact;
  ASSERT_TRUE(contact.found);
  EXPECT_NEAR(contact.elapsed.hi, *seen, 1e-12);
}

// An early start must not sharpen bounds that a later one lacks.
TEST(FirstContactOfFlatFunctions, DoesNotDependOnWhereTheSearchStarts) {
  Random random(degenerate_seed);
  int contacts = 0;
  for (int n = 0; n < 3 * degenerate_count; ++n) {
    const KernelPair pair = n % 3 == 0 ? concentric(random, 0.02)
                                       : nearly_planar(random, n % 3 == 1 ? 1e-2 : 1e-6, 0.01);
    const Contact contact = answer_of(pair, 0, 60).contact;
    contacts += contact.found;
    for (int i = 0; contact.found && i < 6; ++i) {
      const double from = contact.elapsed.hi * random.uniform();
      const Contact again = answer_of(pair, from, 60).contact;
      EXPECT_TRUE(again.found && again.elapsed == contact.elapsed && again.side == contact.side)
          << "from " << from << ": " << again.elapsed.hi << " + " << again.elapsed.lo
          << " instead of " << contact.elapsed.hi << " + " << contact.elapsed.lo << ", seed "
          << degenerate_seed << ", pair " << n;
    }
  }
  EXPECT_GT(contacts, degenerate_count);
}

// Beyond 1e8 the time span in which the centres are near must not drown in the rounding of |r|^2.
TEST(FirstContactOfFlatFunctions, IsFoundFromFarAway) {
  for (const double distance : {1e7, 1e8, 1e9, 1e10}) {
    KernelPair pair;
    pair.first = flight({0.25, 0, -distance}, {1, 0, 0}, {0, 0, 1}, {});
    pair.second = flight({0, 0.25, 0}, {0, 1, 0}, {}, {});
    const Contact contact = answer_of(pair, 0, 2 * distance).contact;
    EXPECT_TRUE(contact.found) << distance;
    EXPECT_EQ(contact.elapsed.hi, contact.found ? distance : 0);
  }
}

// Equal directors, equal angular velocities: f vanishes at all times, though none of its
// coefficients does.
TEST(FirstContactCostOfFlatFunctions, IsBoundedForParallel) {
  KernelPair pair;
  pair.first = flight({0, 0, 0}, {1, 0, 0}, {}, {0, 0, 1});
  pair.second = flight({0.1, 0.2, 0.3}, {1, 0, 0}, {0, 0.01, 0}, {0, 0, 1});
  const Answer answer = answer_of(pair, 0, 4);
  EXPECT_FALSE(answer.contact.found);
  EXPECT_LT(answer.evaluations, 3000u);
}

// As above, but at a small angle: it is all that f, f' and f'' are made of.
TEST(FirstContactCostOfFlatFunctions, IsBoundedForNearlyParallel) {
  for (const double angle : {1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-14, 1e-16}) {
    KernelPair pair;
    pair.first = flight({0, 0, 0}, {1, 0, 0}, {}, {0, 0, 1});
    pair.second = flight({0.1, 0.2, 0.3}, {1, 0, angle}, {0, 0.01, 0}, {0, 0, 1});
    EXPECT_LT(answer_of(pair, 0, 4).evaluations, 3000u) << angle;
  }
}

// Out of plane by less than double-double resolves beside the terms in the plane, whose phases are
// large.
TEST(FirstContactCostOfFlatFunctions, IsBoundedBelowDoubleDouble) {
  for (const int power : {-80, -84, -88, -92, -100}) {
    KernelPair pair;
    pair.first = flight({0, 0, 0}, {1, 0, 0}, {}, {0, 0, 1});
    pair.second =
        flight({0.1, 0.2, std::ldexp(1.0, power)}, {0.6, 0.8, 0}, {0, 0.01, 0}, {0, 0, 0.3});
    pair.elapsed_first = 1000;
    EXPECT_LT(answer_of(pair, 0, 4).evaluations, 3000u) << "2^" << power;
  }
}

}  // namespace
}  // namespace needlework::kernels
