// How far threads are in simulated time.
#include "src/engine/fronts.h"

#include <gtest/gtest.h>

#include <bit>
#include <limits>

namespace needlework {
namespace {

TimeKey key(double time) { return std::bit_cast<TimeKey>(time); }

TEST(Fronts, KnowTheNextEventOfOthers) {
  Fronts fronts(3, 1.2);
  fronts.begin(0.5);
  EXPECT_EQ(fronts.next_of_others(0), 0u);  // no thread has published its next event
  fronts.publish_next(0, key(7));
  fronts.publish_next(1, key(9));
  fronts.publish_next(2, key(8));
  EXPECT_EQ(fronts.next_of_others(0), key(8));
  EXPECT_EQ(fronts.next_of_others(1), key(7));
  EXPECT_EQ(fronts.next_of_others(2), key(7));
  fronts.publish_next(2, key(6));
  EXPECT_EQ(fronts.next_of_others(0), key(6));
  fronts.begin(0.5);
  EXPECT_EQ(fronts.next_of_others(0), 0u);
}

// Needles have speeds up to 0.5 and are seen up to 1.2. Centres of touching needles are within 1,
// which leaves a margin of 0.2, half of it for what has not been seen yet.
TEST(Fronts, AreTooFarAheadWhereOthersCouldComeNear) {
  Fronts fronts(2, 1.2);
  fronts.begin(0.5);
  EXPECT_FALSE(fronts.is_too_far_ahead(key(7.09), key(7)));
  EXPECT_TRUE(fronts.is_too_far_ahead(key(7.11), key(7)));
  EXPECT_FALSE(fronts.is_too_far_ahead(key(9.09), key(9)));
  EXPECT_TRUE(fronts.is_too_far_ahead(key(9.11), key(9)));
}

TEST(Fronts, GoByTheFastestNeedleThereIs) {
  Fronts fronts(3, 1.2);
  fronts.begin(0.5);
  EXPECT_EQ(fronts.fastest(), 0);
  EXPECT_FALSE(fronts.is_too_far_ahead(key(7.09), key(7)));
  fronts.publish_event(2, key(7), 5);
  fronts.publish_event(2, key(7), 1);
  EXPECT_EQ(fronts.fastest(), 5);
  EXPECT_FALSE(fronts.is_too_far_ahead(key(7.009), key(7)));
  EXPECT_TRUE(fronts.is_too_far_ahead(key(7.011), key(7)));
  fronts.begin(0.5);
  EXPECT_EQ(fronts.fastest(), 0);
}

// Otherwise all threads would wait for ever. Also if the resolution of time is coarser than the
// motion of needles.
TEST(Fronts, TheLastIsNeverAhead) {
  for (const double time : {0.0, 1e-300, 7.0, 1e20, 1e300}) {
    for (const double speed : {0.0, 1e-300, 1.0, 1e300, std::numeric_limits<double>::infinity(),
                               std::numeric_limits<double>::quiet_NaN()}) {
      Fronts fronts(2, 1.2);
      fronts.begin(speed);
      fronts.publish_event(0, key(time), speed);
      EXPECT_FALSE(fronts.is_too_far_ahead(key(time), key(time))) << time << ", " << speed;
    }
  }
}

TEST(Fronts, BoundTheReachOfLaterEvents) {
  Fronts fronts(2, 1.2);
  fronts.begin(0);
  EXPECT_TRUE(fronts.publish_event(0, key(7), 0.5));
  EXPECT_EQ(fronts.reach_of_later(0, key(7), 1, true), 0);
  EXPECT_TRUE(fronts.publish_event(1, key(7.1), 3));
  EXPECT_NEAR(fronts.reach_of_later(0, key(7), 1, true), 1 + 0.1 * 4, 1e-5);
  EXPECT_NEAR(fronts.reach_of_later(0, key(7), 4, true), 1 + 0.1 * 8, 1e-5);
  EXPECT_EQ(fronts.reach_of_later(1, key(7.1), 3, true), 0);
  // A thread's own later events matter if it processes an earlier one out of order.
  EXPECT_FALSE(fronts.publish_event(1, key(6.9), 0.5));
  EXPECT_NEAR(fronts.reach_of_later(1, key(6.9), 1, false), 1 + 0.2 * 4, 1e-5);
  EXPECT_NEAR(fronts.reach_of_later(1, key(6.9), 1, true), 1 + 0.1 * 2, 1e-5);
}

TEST(Fronts, SeeNotFartherThanTheirSight) {
  const Fronts fronts(2, 1.2);
  EXPECT_FALSE(fronts.is_out_of_sight(1.19));
  EXPECT_TRUE(fronts.is_out_of_sight(1.2));
  EXPECT_TRUE(fronts.is_out_of_sight(std::numeric_limits<double>::quiet_NaN()));
}

}  // namespace
}  // namespace needlework
