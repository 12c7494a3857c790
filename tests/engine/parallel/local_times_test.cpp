// How far threads are in simulated time.
#include "src/engine/local_times.h"

#include <gtest/gtest.h>

#include <bit>
#include <limits>

namespace needlework {
namespace {

TimeKey key(double time) { return std::bit_cast<TimeKey>(time); }

TEST(LocalTimes, KnowTheNextEventOfOthers) {
  LocalTimes local_times(3, 1.2);
  local_times.begin(0.5);
  EXPECT_EQ(local_times.next_of_others(0), 0u);  // no thread has published its next event
  local_times.publish_next(0, key(7));
  local_times.publish_next(1, key(9));
  local_times.publish_next(2, key(8));
  EXPECT_EQ(local_times.next_of_others(0), key(8));
  EXPECT_EQ(local_times.next_of_others(1), key(7));
  EXPECT_EQ(local_times.next_of_others(2), key(7));
  local_times.publish_next(2, key(6));
  EXPECT_EQ(local_times.next_of_others(0), key(6));
  local_times.begin(0.5);
  EXPECT_EQ(local_times.next_of_others(0), 0u);
}

// Needles have speeds up to 0.5 and are seen up to 1.2. Centres of touching needles are within 1,
// which leaves a margin of 0.2, half of it for what has not been seen yet.
TEST(LocalTimes, AreTooFarAheadWhereOthersCouldComeNear) {
  LocalTimes local_times(2, 1.2);
  local_times.begin(0.5);
  EXPECT_FALSE(local_times.is_too_far_ahead(key(7.09), key(7)));
  EXPECT_TRUE(local_times.is_too_far_ahead(key(7.11), key(7)));
  EXPECT_FALSE(local_times.is_too_far_ahead(key(9.09), key(9)));
  EXPECT_TRUE(local_times.is_too_far_ahead(key(9.11), key(9)));
}

TEST(LocalTimes, GoByTheFastestNeedleThereIs) {
  LocalTimes local_times(3, 1.2);
  local_times.begin(0.5);
  EXPECT_EQ(local_times.fastest(), 0);
  EXPECT_FALSE(local_times.is_too_far_ahead(key(7.09), key(7)));
  local_times.publish_event(2, key(7), 5);
  local_times.publish_event(2, key(7), 1);
  EXPECT_EQ(local_times.fastest(), 5);
  EXPECT_FALSE(local_times.is_too_far_ahead(key(7.009), key(7)));
  EXPECT_TRUE(local_times.is_too_far_ahead(key(7.011), key(7)));
  local_times.begin(0.5);
  EXPECT_EQ(local_times.fastest(), 0);
}

// Otherwise all threads would wait for ever. Also if the resolution of time is coarser than the
// motion of needles.
TEST(LocalTimes, TheLastIsNeverAhead) {
  for (const double time : {0.0, 1e-300, 7.0, 1e20, 1e300}) {
    for (const double speed : {0.0, 1e-300, 1.0, 1e300, std::numeric_limits<double>::infinity(),
                               std::numeric_limits<double>::quiet_NaN()}) {
      LocalTimes local_times(2, 1.2);
      local_times.begin(speed);
      local_times.publish_event(0, key(time), speed);
      EXPECT_FALSE(local_times.is_too_far_ahead(key(time), key(time))) << time << ", " << speed;
    }
  }
}

TEST(LocalTimes, BoundTheReachOfLaterEvents) {
  LocalTimes local_times(2, 1.2);
  local_times.begin(0);
  const LocalTimes::Seen first = local_times.publish_event(0, key(7), 0.5);
  EXPECT_TRUE(first.in_order);
  EXPECT_EQ(local_times.reach_of_later(first, key(7), 1), 0);
  const LocalTimes::Seen other = local_times.publish_event(1, key(7.1), 3);
  EXPECT_TRUE(other.in_order);
  EXPECT_EQ(local_times.reach_of_later(other, key(7.1), 3), 0);
  const LocalTimes::Seen second = local_times.publish_event(0, key(7.05), 0.5);
  EXPECT_TRUE(second.in_order);
  EXPECT_NEAR(local_times.reach_of_later(second, key(7.05), 1), 1 + 0.05 * 4, 1e-5);
  EXPECT_NEAR(local_times.reach_of_later(second, key(7.05), 4), 1 + 0.05 * 8, 1e-5);
  // A thread's own later events matter if it processes an earlier one out of order.
  const LocalTimes::Seen late = local_times.publish_event(1, key(6.9), 0.5);
  EXPECT_FALSE(late.in_order);
  EXPECT_NEAR(local_times.reach_of_later(late, key(6.9), 1), 1 + 0.2 * 4, 1e-5);
  // Those of a thread in order do not.
  const LocalTimes::Seen next = local_times.publish_event(1, key(7.2), 9);
  EXPECT_EQ(next.latest, key(7.05));
  EXPECT_EQ(next.fastest, 0.5);
}

TEST(LocalTimes, SeeNotFartherThanTheirSight) {
  const LocalTimes local_times(2, 1.2);
  EXPECT_FALSE(local_times.is_out_of_sight(1.19));
  EXPECT_TRUE(local_times.is_out_of_sight(1.2));
  EXPECT_TRUE(local_times.is_out_of_sight(std::numeric_limits<double>::quiet_NaN()));
}

}  // namespace
}  // namespace needlework
