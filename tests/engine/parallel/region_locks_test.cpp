#include "src/engine/region_locks.h"

#include <gtest/gtest.h>

namespace needlework {
namespace {

TEST(RegionLocks, GiveWayToThreadsOfLowerNumber) {
  RegionLocks region_locks({20, 20, 20}, {1, 1, 1}, 3);
  EXPECT_FALSE(region_locks.acquire(1, RegionLocks::owner, {{5, 5, 5}, {1, 0, 0}}));
  EXPECT_TRUE(region_locks.acquire(2, RegionLocks::owner, {{7, 6, 4}, {}}));
  EXPECT_FALSE(region_locks.acquire(2, RegionLocks::owner, {{8, 5, 5}, {}}));
  EXPECT_TRUE(region_locks.acquire(2, RegionLocks::partner, {{4, 5, 5}, {}}));  // gives up all
  EXPECT_FALSE(region_locks.acquire(0, RegionLocks::owner, {{8, 5, 5}, {}}));
  region_locks.release(0);
  region_locks.release(1);
  EXPECT_FALSE(region_locks.acquire(2, RegionLocks::owner, {{5, 5, 5}, {19, 0, 0}}));
}

TEST(RegionLocks, TellWhichLockIsInTheWayAndHowLong) {
  RegionLocks region_locks({20, 20, 20}, {1, 1, 1}, 3);
  EXPECT_FALSE(region_locks.acquire(0, RegionLocks::owner, {{15, 5, 5}, {}}));
  EXPECT_FALSE(region_locks.acquire(1, RegionLocks::owner, {{12, 5, 5}, {}}));
  EXPECT_FALSE(region_locks.acquire(1, RegionLocks::partner, {{5, 5, 5}, {}}));
  const auto conflict = region_locks.acquire(2, RegionLocks::owner, {{6, 5, 5}, {}});
  ASSERT_TRUE(conflict);
  EXPECT_EQ(conflict->thread, 1);
  EXPECT_EQ(conflict->part, RegionLocks::partner);
  EXPECT_TRUE(region_locks.lasts(*conflict));
  region_locks.release(0);
  EXPECT_TRUE(region_locks.lasts(*conflict));
  EXPECT_FALSE(region_locks.acquire(1, RegionLocks::partner, {{5, 5, 5}, {1, 0, 0}}));
  EXPECT_FALSE(region_locks.lasts(*conflict));
}

}  // namespace
}  // namespace needlework
