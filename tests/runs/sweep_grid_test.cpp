// Grid files, right and wrong.
#include "src/runs/sweep_grid.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "needlework/error.h"
#include "tests/support/contains.h"
#include "tests/support/message_of.h"
#include "tests/support/temporary_folder.h"

namespace needlework::runs::sweep {
namespace {

namespace fs = std::filesystem;

class GridFile : public testing::Test {
 protected:
  GridFile() { write("base.toml", "[needles]\ncount = 50\nbox = 5\n[until]\ntime = 1\n"); }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }
  Grid read(const std::string& text) const {
    write("grid.toml", text);
    return read_grid((folder_ / "grid.toml").string());
  }
  // The message of the error without the folder.
  std::string error(const std::string& text) const {
    std::string message = test::message_of<InputError>([&] { read(text); });
    const std::string prefix = folder_.string() + "/";
    for (auto at = message.find(prefix); at != message.npos; at = message.find(prefix))
      message.erase(at, prefix.size());
    return message;
  }

 private:
  test::TemporaryFolder temporary_;
  fs::path folder_ = temporary_.path();
};

TEST_F(GridFile, MembersAreAllPointsWithAllSeeds) {
  const Grid grid = read(R"(
scene = "base.toml"
seeds = [3, 5]
out = "there"
[parameters]
"collisions.epsilon" = [0.9, 1]
"needles.k" = 2
"needles.count" = [10, 20, 30]
)");
  EXPECT_EQ(grid.out, "there");
  EXPECT_EQ(grid.points(), 6u);
  ASSERT_EQ(grid.members.size(), 12u);
  ASSERT_EQ(grid.parameters.size(), 2u);
  const Member& first = grid.members[0];
  EXPECT_EQ(first.name, "epsilon=0.9,count=10,seed=3");
  const Member& one = grid.members[2 * 4 + 1];
  EXPECT_EQ(one.name, "epsilon=1,count=20,seed=5");
  EXPECT_EQ(one.point, 4u);
  EXPECT_EQ(one.scene.needles.count, 20u);
  EXPECT_EQ(one.scene.needles.k, 2);
  EXPECT_EQ(one.scene.needles.seed, 5u);
  EXPECT_EQ(one.scene.collisions.epsilon, 1);
  EXPECT_EQ(*grid.value(0, 4).as<std::int64_t>(), 1);
  EXPECT_EQ(*grid.value(1, 4).as<std::int64_t>(), 20);
  EXPECT_TRUE(test::contains(one.scene.text, "# --set needles.count=20\n"));
}

TEST_F(GridFile, MayHoldItsSceneItself) {
  const Grid grid = read(R"(title = "both"
seeds = { first = 8, count = 3 }
needles = { count = 7, box = [5, 6, 7] }
until.time = 2
[parameters]
"output.frames" = [[1, 2], 3]
)");
  ASSERT_EQ(grid.members.size(), 6u);
  EXPECT_EQ(grid.members[5].name, "frames=3,seed=10");
  const Scene& scene = grid.members[1].scene;
  EXPECT_EQ(scene.title, "both");
  EXPECT_EQ(scene.needles.box[2], 7);
  EXPECT_EQ(scene.output.frame_times, (std::vector<double>{1, 2}));
  EXPECT_EQ(scene.places.at("until.time").substr(scene.places.at("until.time").find(": ")),
            ": line 4: until.time = 2");
}

TEST_F(GridFile, VariesKeysOfTablesAndOfEntries) {
  const Grid grid = read(R"(seeds = [8]
needles = { count = 7, box = [5, 6, 7] }
until.time = 2
driving.kicks.every = 1
walls = [{ axis = "z", side = "low", motion = { amplitude = 1, frequency = 3 } },
         { axis = "z", side = "high" }]
[parameters]
"driving.kicks.every" = [0.5, 2]
"walls.z-low.motion.amplitude" = [0.25, 0.5]
)");
  ASSERT_EQ(grid.members.size(), 4u);
  EXPECT_EQ(grid.members[3].name, "kicks.every=2,z-low.motion.amplitude=0.5,seed=8");
  EXPECT_EQ(grid.members[3].scene.driving.kicks->every, 2);
  EXPECT_EQ(grid.members[3].scene.walls.at(0).motion->amplitude, 0.5);
}

TEST_F(GridFile, WithoutParametersHasOnePoint) {
  const Grid grid = read("scene = 'base.toml'\nseeds = [1]\n");
  ASSERT_EQ(grid.members.size(), 1u);
  EXPECT_EQ(grid.members[0].name, "seed=1");
  EXPECT_EQ(grid.name_of_point(0), "");
}

TEST_F(GridFile, NamesLineKeyAndValueOfAnError) {
  const std::string head = "scene = 'base.toml'\nseeds = [1, 2]\n";
  const std::pair<std::string, std::string> cases[] = {
      {head + "[parameters]\n'collisions.epsilon' = [0.9, 1.5]",
       "grid.toml: line 4: collisions.epsilon = 1.5: expected a number from 0 to 1"},
      {head + "[parameters]\n'collisions.epsilon' = [0.9, 0.90]",
       "grid.toml: line 4: collisions.epsilon = 0.9: expected a value unlike those before"},
      {head + "[parameters]\n'collisions.epsilom' = [0.9]",
       "grid.toml: line 4: parameters.collisions.epsilom = [0.9]: expected one of "},
      {head + "[parameters]\nepsilon = [0.9]",
       "grid.toml: line 4: parameters.epsilon = [0.9]: expected \"section.key\" = [VALUES]"},
      {head + "[parameters]\n'needles.k' = []",
       "grid.toml: line 4: parameters.needles.k = []: expected some values"},
      {head + "[parameters]\n'needles.seed' = [4]",
       "grid.toml: line 4: parameters.needles.seed = [4]: expected seeds = "},
      {head + "[parameters]\n'until.wall_s' = [4]",
       "grid.toml: line 4: until.wall_s = 4: expected no limit of wall time"},
      {head + "[needles]\nk = 2", "grid.toml: line 3: [needles]: expected none beside scene"},
      {head + "ouut = 'a'",
       "grid.toml: line 3: ouut = 'a': expected one of scene, seeds, out, "
       "parameters, did you mean out?"},
      {"seeds = [1]\n[neddles]\ncount = 2", "grid.toml: line 2: [neddles]: expected one of "},
      {"seeds = [1]\n[needles]\ncount = -2",
       "grid.toml: line 3: needles.count = -2: expected a whole number"},
      {"seeds = [1]\n[needles]\ncount = 2", "grid.toml: needles.box is missing"},
      {"scene = 'base.toml'", "grid.toml: seeds is missing: expected a list, or {first"},
      {"scene = 'base.toml'\nseeds = 3", "grid.toml: line 2: seeds = 3: expected a list"},
      {"scene = 'base.toml'\nseeds = [3, 3]", "grid.toml: line 2: seeds = [3, 3]: expected a list"},
      {"scene = 'base.toml'\nseeds = [3, -3]",
       "grid.toml: line 2: seeds = [3, -3]: -3: expected a whole number"},
      {"scene = 'base.toml'\nseeds = {first = 3}", "grid.toml: line 2: [seeds]: expected both"},
      {"scene = 'base.toml'\nseeds = {first = 3, count = 0}",
       "grid.toml: line 2: seeds.count = 0: expected a number from 1 to 100000"},
      {"scene = 'base.toml'\nseeds = {first = 1, count = 100000}\n[parameters]\n"
       "'needles.k' = [1, 2]",
       "grid.toml: too many members: expected at most 100000"},
      {head + "[parameters]\n'initial.file' = 'a.h5'",
       "grid.toml: line 4: initial.file = \"a.h5\": expected a single seed"},
      {head + "[parameters]\n'collisions.tc' = 1\n'collisions.tc_relative' = 1",
       "grid.toml: line 5: collisions.tc_relative = 1: expected either"},
      {"scene = 'base.toml'\nseeds = [", "grid.toml: line 2: "}};
  for (const auto& [text, message] : cases) {
    EXPECT_EQ(error(text).substr(0, message.size()), message) << text;
  }
  EXPECT_THROW(read("scene = 'none.toml'\nseeds = [1]"), IoError);
}

TEST(TomlOf, WritesWhatReadsTheSame) {
  const std::pair<Value, std::string> cases[] = {
      {{0.1}, "0.1"},    {{std::int64_t{-3}}, "-3"},
      {{1e22}, "1e+22"}, {{std::string("a\"b\\")}, R"("a\"b\\")"},
      {{true}, "true"},  {{Value::Array{{1.5}, {std::int64_t{2}}}}, "[1.5, 2]"},
  };
  for (const auto& [value, text] : cases) EXPECT_EQ(toml_of(value), text);
}

}  // namespace
}  // namespace needlework::runs::sweep
