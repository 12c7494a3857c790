// What messages advise where needles collapse.
#include "src/engine/collapse.h"

#include <gtest/gtest.h>

namespace needlework {
namespace {

std::string advice(const GroupCollapse& collapse) {
  const std::string message = message_of(collapse);
  return message.substr(message.rfind("; ") + 2);
}

TEST(CollapseOfAGroup, IsAdvisedByWhatTheSceneHas) {
  GroupCollapse group{.first = {3}, .second = {5}, .time = 2, .collisions = 10007};
  EXPECT_EQ(message_of(group),
            "needles 3 and 5 and others collapse at time 2: 10007 collisions at one instant; set "
            "collisions.tc_relative, to 1e-3 say, or collisions.sliding");
  group.contact_time = true;
  EXPECT_EQ(advice(group), "a longer contact time may help");
  group.contact_time = false;
  group.sliding = true;
  EXPECT_EQ(advice(group), "a longer collisions.sliding_below may help");
}

TEST(CollapseOfAGroup, OfOneNeedleIsWithWalls) {
  GroupCollapse alone{.first = {3}, .second = {3}, .time = 2, .collisions = 10007};
  EXPECT_EQ(message_of(alone),
            "needle 3 collapses at time 2: 10007 events at one instant, with walls or others; set "
            "collisions.tc_relative, to 1e-3 say, unless it rests on a wall");
  const std::string rest =
      " cannot help where a wall moves or draws velocities, nor a needle that lies on a wall; of a "
      "tip in the corner of two such walls, less motion or a higher temperature may";
  alone.contact_time = true;
  EXPECT_TRUE(message_of(alone).ends_with("; a contact time" + rest)) << message_of(alone);
  alone.contact_time = false;
  alone.sliding = true;
  EXPECT_TRUE(message_of(alone).ends_with("; collisions.sliding_below" + rest));
}

}  // namespace
}  // namespace needlework
