// A calendar that was added as src/calendar/README.md says is there everywhere. The tests of all
// calendars are part of this program, too.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "bench/strategies/cases.h"
#include "needlework/parse.h"
#include "src/calendar/all.h"
#include "tests/support/runs.h"

namespace needlework {
namespace {

TEST(AddedCalendar, IsAChoiceOfScenes) {
  const std::vector<std::string> overrides{std::string("engine.queue=") + Scan::name};
  const Scene scene =
      parse_scene("needles = { count = 1, box = 5 }\nuntil.time = 1", "s.toml", overrides);
  EXPECT_EQ(scene.engine.queue, Scan::name);
  EXPECT_EQ(Simulation(scene).queue(), Scan::name);
}

TEST(AddedCalendar, IsMeasuredBesideTheOthers) {
  for (const char* subset : {"queues", "matrix"}) {
    const auto cases = bench::subset_of(subset).cases();
    EXPECT_GT(
        std::count_if(cases.begin(), cases.end(),
                      [](const bench::Case& one) { return one.scene.engine.queue == Scan::name; }),
        0)
        << subset;
  }
}

}  // namespace
}  // namespace needlework
