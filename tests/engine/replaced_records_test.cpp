#include "src/engine/replaced_records.h"

#include <gtest/gtest.h>

namespace needlework {
namespace {

Record numbered(std::uint32_t serial) {
  Record record;
  record.serial = serial;
  return record;
}

TEST(ReplacedRecords, FindsTheTwoOfACollisionInAnyOrder) {
  ReplacedRecords replaced;
  EXPECT_TRUE(replaced.empty());
  EXPECT_EQ(replaced.find(Needle(0)), nullptr);
  replaced.add(Needle(9), numbered(3)).wraps = {1, 0, -1};
  EXPECT_FALSE(replaced.empty());
  ASSERT_NE(replaced.find(Needle(9)), nullptr);
  EXPECT_EQ(replaced.find(Needle(4)), nullptr);
  replaced.add(Needle(4), numbered(8));
  EXPECT_EQ(replaced.find(Needle(9))->record.serial, 3u);
  EXPECT_EQ(replaced.find(Needle(9))->wraps, (Shift{1, 0, -1}));
  EXPECT_EQ(replaced.find(Needle(4))->record.serial, 8u);
  EXPECT_EQ(replaced.find(Needle(4))->wraps, Shift{});
  EXPECT_EQ(replaced.find(no_needle), nullptr);
  replaced.clear();
  EXPECT_TRUE(replaced.empty());
  EXPECT_EQ(replaced.find(Needle(9)), nullptr);
}

TEST(ReplacedRecords, FindsEachOfMany) {
  for (const std::uint32_t count : {3u, 4u, 100u}) {
    ReplacedRecords replaced;
    // Every other needle, from 1 on.
    for (std::uint32_t n = 0; n < count; ++n) replaced.add(Needle(2 * n + 1), numbered(n));
    for (std::uint32_t n = 0; n < count; ++n) {
      ASSERT_NE(replaced.find(Needle(2 * n + 1)), nullptr) << n << " of " << count;
      EXPECT_EQ(replaced.find(Needle(2 * n + 1))->needle, Needle(2 * n + 1));
      EXPECT_EQ(replaced.find(Needle(2 * n + 1))->record.serial, n);
      EXPECT_EQ(replaced.find(Needle(2 * n)), nullptr);
    }
    EXPECT_EQ(replaced.find(Needle(2 * count)), nullptr);
    EXPECT_EQ(replaced.find(Needle(2 * count + 1)), nullptr);
    EXPECT_EQ(replaced.find(no_needle), nullptr);
  }
}

}  // namespace
}  // namespace needlework
