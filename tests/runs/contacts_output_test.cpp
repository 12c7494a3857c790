// What files, totals and reports say of contacts of needles that slide on each other.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <vector>

#include "src/io/contents.h"
#include "src/runs/prepared_run.h"
#include "tests/runs/silent.h"
#include "tests/support/contains.h"
#include "tests/support/runs.h"

namespace needlework::runs {
namespace {

using ContactsOutput = InRunFolder;

TEST_F(ContactsOutput, RowsAndSeriesAreThoseOfTheCounts) {
  Scene scene = test::scene_of(150, 5, 4);
  scene.collisions.epsilon = 0.3;
  scene.collisions.sliding = true;
  scene.output.file = file;
  scene.output.events = true;
  scene.output.series_every = 0.5;
  scene.until.time = 3;
  PreparedRun run(complete_scene(scene), false);
  finish(run);

  const SlidingContacts counted = *run.simulation().sliding_contacts();
  const io::Contents contents(scene.output.file);
  std::map<double, std::uint64_t> rows;
  for (const double kind : contents.numbers("/events/kind")) ++rows[kind];
  EXPECT_EQ(rows[Happening::contact_entered], counted.entered);
  EXPECT_EQ(rows[Happening::contact_ended],
            counted.ended_by_force + counted.ended_by_tip + counted.ended_by_strike);
  EXPECT_EQ(rows[Happening::pair] + rows[Happening::contact_entered],
            run.simulation().collisions());
  EXPECT_GT(counted.ended_by_strike, 5u);
  // The last row of the series is of the end.
  const auto last = [&](const std::string& name) {
    return contents.numbers("/series/contacts/" + name + "/value").back();
  };
  counted.for_each([&](const Described& number, const auto& value) {
    EXPECT_EQ(last(number.name), static_cast<double>(value)) << number.name;
  });
  EXPECT_EQ(last("share"), 2 * counted.time / (150 * 3.0));
  EXPECT_TRUE(std::isnan(contents.numbers("/series/contacts/share/value").front()));
  // A dataset of that name is not the time of the samples.
  EXPECT_TRUE(test::contains(io::describe(scene.output.file), "    time/value"));
}

}  // namespace
}  // namespace needlework::runs
