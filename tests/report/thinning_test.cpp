#include "src/report/thinning.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace needlework::report {
namespace {

using Numbers = std::vector<std::size_t>;

TEST(Evenly, TakesAllIfThereAreNotMore) {
  EXPECT_EQ(evenly(0, 5), Numbers{});
  EXPECT_EQ(evenly(1, 5), Numbers{0});
  EXPECT_EQ(evenly(3, 3), (Numbers{0, 1, 2}));
}

TEST(Evenly, KeepsTheFirstAndTheLast) {
  EXPECT_EQ(evenly(10, 2), (Numbers{0, 9}));
  EXPECT_EQ(evenly(10, 4), (Numbers{0, 3, 6, 9}));
  for (std::size_t most = 2; most < 50; ++most) {
    const Numbers chosen = evenly(50, most);
    EXPECT_EQ(chosen.size(), most);
    EXPECT_EQ(chosen.front(), 0);
    EXPECT_EQ(chosen.back(), 49);
    EXPECT_TRUE(std::is_sorted(chosen.begin(), chosen.end()));
    EXPECT_EQ(std::adjacent_find(chosen.begin(), chosen.end()), chosen.end());
  }
}

TEST(Evenly, TakesTheLastAloneIfThereIsRoomForOne) {
  EXPECT_EQ(evenly(10, 1), Numbers{9});
  EXPECT_EQ(evenly(10, 0), Numbers{9});
}

}  // namespace
}  // namespace needlework::report
