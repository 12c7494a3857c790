// First contacts of needles of which no more is known than where they are and how fast they are.
#include "kernels/trajectory_contact.h"

#include <gtest/gtest.h>

#include <cmath>

namespace needlework::kernels {
namespace {

/// A needle that moves in a straight line.
class StraightCourse final : public Trajectory {
 public:
  explicit StraightCourse(const BodyState& begin) : begin_(begin) {
    lasts = 1;
    speed = std::sqrt(dot(begin.v, begin.v));
  }
  BodyState at(double s) const override {
    return {begin_.r + begin_.v * s, begin_.v, begin_.u, begin_.w};
  }

 private:
  BodyState begin_;
};

/// Two crossed needles, the first of which moves down on the second, with f = z.
Contact fall(double height, double velocity, const Touch& touch) {
  const StraightCourse first({{0, 0, height}, {0, 0, -velocity}, {1, 0, 0}, {}});
  const StraightCourse second({{0.1, 0.2, 0}, {}, {0, 1, 0}, {}});
  EvaluationCounters counters;
  return trajectory_contact({first, second, {}, 0.5, 0.5, touch, 1e-12}, 0, 1, counters);
}

// Needles so near that their side is carried from older records are not yet in contact.
TEST(CourseContact, OfNeedlesThatNearlyTouchIsWhereTheirGapCloses) {
  for (const double gap : {1e-18, 4.6e-14, 1e-9}) {
    for (const double velocity : {1e-4, 1.0, 300.0}) {
      const Contact found = fall(3e-17, velocity, {.touching = true, .side = 1, .gap = gap});
      ASSERT_TRUE(found.found) << gap;
      EXPECT_EQ(found.side, 1);
      EXPECT_NEAR(found.elapsed.hi * velocity / gap, 1, 1e-2) << gap << ' ' << velocity;
    }
  }
}

TEST(CourseContact, OfNeedlesInContactThatApproachIsAtOnce) {
  for (const bool collided : {false, true}) {
    const Contact found = fall(3e-17, 1, {.touching = true, .collided = collided, .side = 1});
    ASSERT_TRUE(found.found);
    EXPECT_EQ(found.elapsed.hi, 0);
    EXPECT_FALSE(fall(3e-17, -1, {.touching = true, .collided = collided, .side = 1}).found);
  }
}

}  // namespace
}  // namespace needlework::kernels
