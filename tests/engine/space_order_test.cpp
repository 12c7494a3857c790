// The order of storage in space.
#include "src/engine/space_order.h"

#include <gtest/gtest.h>

namespace needlework {
namespace {

// More needles than are sorted in one piece: in each of two places they keep their order.
TEST(SpaceOrder, IsStableAlsoInSeveralPieces) {
  constexpr std::size_t count = 1300000;
  Gas gas;
  gas.box = Box({10, 10, 10});
  gas.records.resize(count);
  gas.ids.resize(count);
  const auto is_far = [](std::size_t i) { return i * 2654435761u % 7 < 3; };
  for (std::size_t i = 0; i < count; ++i) {
    gas.records[i].flight.r = is_far(i) ? Vec3d{9, 9, 9} : Vec3d{1, 1, 1};
  }
  std::vector<Needle> expected;
  for (const bool far : {false, true}) {
    for (std::size_t i = 0; i < count; ++i) {
      if (is_far(i) == far) expected.push_back(Needle(i));
    }
  }
  EXPECT_TRUE(order_in_space(gas, {}) == expected);
}

}  // namespace
}  // namespace needlework
