// Touches that records keep of other needles.
#include "src/physics/record.h"

#include <gtest/gtest.h>

#include <array>
#include <thread>
#include <vector>

namespace needlework {
namespace {

RecordedTouch touch_with(std::uint32_t partner, double gap = 0) {
  return RecordedTouch::of(Id{partner}, 7, {1, -2, 3},
                           {.touching = true, .collided = false, .side = -1, .gap = gap});
}

std::vector<std::uint32_t> partners(const std::vector<RecordedTouch>& touches) {
  std::vector<std::uint32_t> out;
  for (const RecordedTouch& touch : touches) out.push_back(touch.partner.value);
  return out;
}

using Ids = std::vector<std::uint32_t>;

TEST(RecordedTouch, GivesBackWhatItWasMadeOf) {
  for (const int side : {-1, 0, 1}) {
    for (const bool collided : {false, true}) {
      const kernels::Touch given{
          .touching = true, .collided = collided, .side = side, .gap = -1.25e-16};
      const Shift shift{-2049, 0, 2049};  // boxes of 2.01 that 2^11 lengths of flight may cross
      const RecordedTouch recorded = RecordedTouch::of(Id{0xfffffffe}, 0xffffffff, shift, given);
      const kernels::Touch touch = recorded.touch();
      EXPECT_TRUE(touch.touching);
      EXPECT_EQ(touch.collided, collided);
      EXPECT_EQ(touch.side, side);
      EXPECT_EQ(touch.gap, -1.25e-16);
      EXPECT_TRUE(recorded.is_with(Id{0xfffffffe}, 0xffffffff, shift));
    }
  }
}

TEST(RecordedTouch, IsWithOneRecordOfOneImage) {
  const RecordedTouch touch = touch_with(5);
  EXPECT_TRUE(touch.is_with(Id{5}, 7, {1, -2, 3}));
  EXPECT_FALSE(touch.is_with(Id{6}, 7, {1, -2, 3}));
  EXPECT_FALSE(touch.is_with(Id{5}, 8, {1, -2, 3}));
  EXPECT_FALSE(touch.is_with(Id{5}, 7, {0, -2, 3}));
  EXPECT_FALSE(touch.is_with(Id{5}, 7, {1, 2, 3}));
  EXPECT_FALSE(touch.is_with(Id{5}, 7, {1, -2, 65536 + 3}));
}

TEST(FurtherTouches, AreOfOneRecordEach) {
  FurtherTouches touches;
  EXPECT_TRUE(touches.of(Id{1}, 0).empty());
  touches.add(Id{1}, 10, 0, touch_with(2, 1e-16));
  touches.add(Id{1}, 10, 1, touch_with(3, 2e-16));
  touches.add(Id{1}, 10, 2, touch_with(4, 3e-16));
  touches.add(Id{1}, 11, 0, touch_with(5));
  touches.add(Id{10}, 1, 0, touch_with(6));
  EXPECT_EQ(partners(touches.of(Id{1}, 10)), (Ids{2, 3, 4}));
  EXPECT_EQ(touches.of(Id{1}, 10)[1].gap, 2e-16);
  EXPECT_EQ(partners(touches.of(Id{1}, 11)), (Ids{5}));
  EXPECT_EQ(partners(touches.of(Id{10}, 1)), (Ids{6}));
  EXPECT_TRUE(touches.of(Id{11}, 1).empty());
  EXPECT_EQ(touches.records(), 3u);
}

// A record may be made, undone with its touches, and made again with others and fewer.
TEST(FurtherTouches, OfAnUndoneRecordAreOverwritten) {
  FurtherTouches touches;
  for (std::size_t n = 0; n < 3; ++n) {
    touches.add(Id{1}, 10, n, touch_with(static_cast<std::uint32_t>(2 + n)));
  }
  touches.add(Id{1}, 10, 0, touch_with(8));
  EXPECT_EQ(partners(touches.of(Id{1}, 10)), (Ids{8}));
  touches.add(Id{1}, 10, 1, touch_with(9));
  EXPECT_EQ(partners(touches.of(Id{1}, 10)), (Ids{8, 9}));
}

TEST(FurtherTouches, KeepThoseOfTheRecordsAsked) {
  FurtherTouches touches;
  std::vector<Record> records(4);
  const std::vector<Id> ids = {{30}, {20}, {10}, {0}};
  for (std::size_t i = 0; i < records.size(); ++i) {
    records[i].serial = static_cast<std::uint32_t>(5 + i);
    for (const std::uint32_t serial : {records[i].serial - 1, records[i].serial}) {
      touches.add(ids[i], serial, 0, touch_with(ids[i].value + serial));
      touches.add(ids[i], serial, 1, touch_with(99));
    }
  }
  EXPECT_EQ(touches.records(), 8u);
  records[0].touch_count = 3;
  records[1].touch_count = 3;
  records[2].touch_count = 1;  // was undone, and made again with fewer
  records[3].touch_count = 0;
  touches.keep_only(records, ids);
  EXPECT_EQ(touches.records(), 2u);
  EXPECT_EQ(partners(touches.of(Id{30}, 5)), (Ids{35, 99}));
  EXPECT_EQ(partners(touches.of(Id{20}, 6)), (Ids{26, 99}));
  EXPECT_TRUE(touches.of(Id{30}, 4).empty());
  EXPECT_TRUE(touches.of(Id{10}, 7).empty());
  EXPECT_TRUE(touches.of(Id{0}, 8).empty());
  // Those left can be added to.
  touches.add(Id{20}, 6, 2, touch_with(4));
  EXPECT_EQ(partners(touches.of(Id{20}, 6)), (Ids{26, 99, 4}));
  touches.keep_only(std::vector<Record>(), ids);
  EXPECT_EQ(touches.records(), 0u);
}

TEST(FurtherTouches, MayBeUsedByThreads) {
  FurtherTouches touches;
  constexpr std::uint32_t records = 500;
  std::array<std::size_t, 4> found{};
  std::vector<std::thread> threads;
  for (std::uint32_t me = 0; me < 4; ++me) {
    threads.emplace_back([&, me] {
      for (std::uint32_t serial = 0; serial < records; ++serial) {
        touches.add(Id{me}, serial, 0, touch_with(serial));
        touches.add(Id{me}, serial, 1, touch_with(serial + 1));
        found[me] += partners(touches.of(Id{me}, serial)) == Ids{serial, serial + 1};
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(found, (std::array<std::size_t, 4>{records, records, records, records}));
  EXPECT_EQ(touches.records(), 4u * records);
}

}  // namespace
}  // namespace needlework
