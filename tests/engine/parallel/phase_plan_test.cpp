// How phases are planned.
#include "src/engine/phase_plan.h"

#include <gtest/gtest.h>

#include <limits>

namespace needlework {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Epochs of 1, so that times are easy to read.
const Clock clock(1);
Time at(double time) { return clock.add({}, time); }

class PhasePlanTest : public testing::Test {
 protected:
  // A run without a limit on collisions, with this number of collisions per time.
  PhasePlan::Outlook outlook(double next, double rate, double left = infinity) const {
    return {.next = at(next), .end = at(1e6), .ready = at(1e6), .left = left, .rate = rate};
  }
  void expect_together(const PhasePlan::Outlook& outlook, double until) {
    const PhasePlan::Stretch stretch = plan.next(outlook);
    EXPECT_TRUE(stretch.together);
    EXPECT_DOUBLE_EQ(clock.since_start(stretch.end), until);
  }
  void expect_alone(const PhasePlan::Outlook& outlook, double until) {
    const PhasePlan::Stretch stretch = plan.next(outlook);
    EXPECT_FALSE(stretch.together);
    EXPECT_DOUBLE_EQ(clock.since_start(stretch.end), until);
  }

  PhasePlan plan{clock, 0x1p15, 64};
};

TEST_F(PhasePlanTest, HasPhasesOfSoManyCollisions) {
  expect_together(outlook(3, 0x1p15), 4);
  expect_together(outlook(3, 0x1p13), 7);
}

TEST_F(PhasePlanTest, EndsWhereItIsAskedTo) {
  PhasePlan::Outlook before_end = outlook(3, 0x1p13);
  before_end.end = at(5);
  expect_together(before_end, 5);
  PhasePlan::Outlook before_ready = outlook(3, 0x1p13);
  before_ready.ready = at(4);
  expect_together(before_ready, 4);
}

// One thread does not end earlier than asked: it needs no meetings.
TEST_F(PhasePlanTest, LeavesShortStretchesToOneThread) {
  PhasePlan::Outlook few = outlook(3, 100);
  few.end = at(3.6);
  expect_alone(few, 3.6);
  few.end = at(3.7);
  expect_together(few, 3.7);
  PhasePlan::Outlook soon = outlook(3, 100);
  soon.ready = at(3.6);
  expect_alone(soon, 1e6);
  soon.ready = at(3);
  expect_alone(soon, 1e6);
  soon.ready = at(2);
  expect_alone(soon, 1e6);
  // With so many collisions a phase is shorter than the resolution of time.
  expect_alone(outlook(3.5, 1e300), 1e6);
}

TEST_F(PhasePlanTest, ComesToAnEndByCollisionsInSmallerAndSmallerPhases) {
  expect_together(outlook(0, 100, 3200), 16);
  expect_together(outlook(16, 100, 1600), 24);
  expect_together(outlook(24, 100, 128), 24.64);
  expect_alone(outlook(24, 100, 127), 1e6);
  expect_alone(outlook(24, 100, -5), 1e6);
}

TEST_F(PhasePlanTest, LeavesRolledBackPhasesToOneThread) {
  plan.rolled_back(at(2), at(4));
  expect_alone(outlook(2, 0x1p13), 4);
  expect_alone(outlook(3.5, 0x1p13), 4);
  // The next one is a quarter as long.
  expect_together(outlook(4, 0x1p13), 5);
  plan.kept();
  expect_together(outlook(5, 0x1p13), 7);
  plan.kept();
  expect_together(outlook(7, 0x1p13), 11);
  plan.kept();
  expect_together(outlook(11, 0x1p13), 15);
}

TEST_F(PhasePlanTest, TriesMoreRarelyAfterRepeatedFailure) {
  plan.rolled_back(at(0), at(1));
  expect_alone(outlook(0, 0x1p13), 1);
  plan.rolled_back(at(1), at(2));
  expect_alone(outlook(1, 0x1p13), 3);
  plan.rolled_back(at(3), at(4));
  expect_alone(outlook(3, 0x1p13), 7);
  for (int n = 0; n < 20; ++n) plan.rolled_back(at(0), at(1));
  expect_alone(outlook(0, 0x1p13), 1001);
  // Not shorter than what is worth sharing.
  expect_together(outlook(1001, 64), 1002);
  plan.kept();
  plan.rolled_back(at(1002), at(1003));
  expect_alone(outlook(1002, 0x1p13), 1003);
}

TEST_F(PhasePlanTest, GoesByTheCollisionsThatThereAre) {
  plan.counted(3000, 1000);
  expect_together(outlook(0, 0x1p15 / 3), 1);
  plan.counted(500, 1000);
  expect_together(outlook(0, 0x1p15), 2);
  // Too few collisions for an estimate.
  plan.counted(63, 1e6);
  expect_together(outlook(0, 0x1p15), 2);
}

// A phase is abandoned at twice the expected collisions, which does not indicate a problem of the
// threads.
TEST_F(PhasePlanTest, TriesLessAtOnceAfterTooManyCollisions) {
  EXPECT_GT(plan.most_of_a_thread(), 0x1p16);
  EXPECT_LT(plan.most_of_a_thread(), 0x1p17);
  plan.had_too_many(at(0), at(1));
  expect_together(outlook(0, 0x1p13), 1);
  for (int n = 0; n < 14; ++n) plan.had_too_many(at(0), at(1));
  expect_together(outlook(0, 0x1p15 * 1e-9), 1);
  plan.rolled_back(at(0), at(1));
  EXPECT_LT(plan.most_of_a_thread(), 0x1p15);
}

// All at one instant: no phase is short enough.
TEST_F(PhasePlanTest, LeavesACollapseToOneThread) {
  for (int n = 0; n < 15; ++n) plan.had_too_many(at(0), at(1));
  EXPECT_TRUE(plan.next(outlook(0, 1)).together);
  plan.had_too_many(at(0), at(1));
  EXPECT_FALSE(plan.next(outlook(0, 1)).together);
}

}  // namespace
}  // namespace needlework
