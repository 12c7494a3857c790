#include "src/engine/claims.h"

#include <gtest/gtest.h>

namespace needlework {
namespace {

TEST(Claims, GiveWayToThreadsOfLowerNumber) {
  Claims claims({20, 20, 20}, {1, 1, 1}, 3);
  EXPECT_TRUE(claims.claim(1, Claims::owner, {{5, 5, 5}, {1, 0, 0}}));
  EXPECT_FALSE(claims.claim(2, Claims::owner, {{7, 6, 4}, {}}));
  EXPECT_TRUE(claims.claim(2, Claims::owner, {{8, 5, 5}, {}}));
  EXPECT_FALSE(claims.claim(2, Claims::partner, {{4, 5, 5}, {}}));  // gives up all
  EXPECT_TRUE(claims.claim(0, Claims::owner, {{8, 5, 5}, {}}));
  claims.drop(0);
  claims.drop(1);
  EXPECT_TRUE(claims.claim(2, Claims::owner, {{5, 5, 5}, {19, 0, 0}}));
}

}  // namespace
}  // namespace needlework
