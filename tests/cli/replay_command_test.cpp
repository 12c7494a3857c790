// `needlework replay`: a run that has failed leaves a bundle, from which it fails again.
#include <algorithm>

#include "src/runs/checkpoint.h"
#include "tests/cli/program.h"

namespace needlework {
namespace {

using nlohmann::json;

class ReplayCommand : public ProgramTest {
 protected:
  // Two of these needles collapse after 79 collisions.
  ReplayCommand() {
    write("collapse.toml", R"(
needles = { count = 300, box = 7 }
collisions = { epsilon = 0.3, tc = 1e-300 }
until = { collisions_per_needle = 1000 }
output = { events = true, observables = ["displacement", "collision_statistics"] }
)");
  }

  Outcome fail(const std::string& more = "") const {
    const Outcome failed = run("run collapse.toml --quiet --out a.h5 " + more);
    EXPECT_EQ(failed.exit_code, 4) << failed.err;
    return failed;
  }
  json replayed(const std::string& arguments, int exit_code) const {
    return json_of("replay --json --quiet " + arguments, "", exit_code);
  }
  // Changes what the bundle says of the failure.
  template <class Change>
  void forge(Change&& change) const {
    runs::CheckpointFiles files(path("a.h5"));
    runs::RunCheckpoint bundle = runs::CheckpointFiles::read(files.bundle());
    change(*bundle.failure);
    files.write_bundle(bundle);
  }
};

TEST_F(ReplayCommand, ShowsTheFailureOfARunAgain) {
  const Outcome failed = fail();
  EXPECT_TRUE(failed.complains("saved in a.h5; needlework replay a.h5.failure shows it again"));
  const auto before = files();
  const std::string output = read("a.h5"), checkpoint = read("a.h5.checkpoint");
  const Outcome replay = run("replay a.h5.failure --progress-every 1000");
  EXPECT_TRUE(replay.fails(4, "the failure came back at time "));
  const std::string message = failed.err.substr(0, failed.err.find(" (saved in"));
  EXPECT_TRUE(replay.complains(message.substr(message.find("collapse of needles"))));
  EXPECT_TRUE(contains(replay.out, "the last 10 of needles "));
  EXPECT_EQ(files(), before) << "a replay writes nothing";
  EXPECT_TRUE(read("a.h5") == output && read("a.h5.checkpoint") == checkpoint);
}

TEST_F(ReplayCommand, FailsAtTheSameCollisionOnOtherEngines) {
  fail();
  for (const char* engine : {"", "--threads 2", "--isa scalar"}) {
    const json replay = replayed(std::string("a.h5.failure ") + engine, 4);
    EXPECT_TRUE(replay["came_back"]) << engine;
    EXPECT_EQ(replay["collisions"], replay["failure"]["collisions"]) << engine;
    EXPECT_EQ(replay["trajectory_hash"], replay["failure"]["trajectory_hash"]) << engine;
    EXPECT_EQ(replay["start"]["collisions"], 0) << "the checkpoint before the first collision";
  }
}

TEST_F(ReplayCommand, PrintsTheLastCollisionsOfTheNeedlesThatFail) {
  fail();
  const json replay = replayed("a.h5.failure --last 3", 4);
  const json needles = replay["failure"]["needles"];
  ASSERT_EQ(replay["last_collisions"].size(), 3u);
  std::uint64_t number = 0;
  for (const json& collision : replay["last_collisions"]) {
    const json& pair = collision["needles"];
    EXPECT_TRUE(std::any_of(pair.begin(), pair.end(), [&](const json& id) {
      return std::find(needles.begin(), needles.end(), id) != needles.end();
    })) << pair;
    EXPECT_GT(collision["number"], number);
    EXPECT_LE(collision["time"], replay["failure"]["time"]);
    for (const json& x : collision["position"]) EXPECT_TRUE(x >= 0 && x <= 7) << x;
    number = collision["number"];
  }
  EXPECT_EQ(replay["last_collisions"][2]["needles"], needles) << "they bounce on each other";
  EXPECT_LE(number, replay["collisions"]);
  EXPECT_TRUE(replayed("a.h5.failure --last 0", 4)["last_collisions"].empty());
}

TEST_F(ReplayCommand, KeepsTheBundleWhenTheRunFailsAgain) {
  const Outcome failed = fail();
  const std::string bundle = read("a.h5.failure");
  EXPECT_EQ(run("resume a.h5 --quiet").err, failed.err);
  EXPECT_TRUE(read("a.h5.failure") == bundle) << "it begins before the failure";
  fail("--force --set needles.seed=3");
  EXPECT_FALSE(read("a.h5.failure") == bundle);
  EXPECT_EQ(run("run collapse.toml --quiet --out a.h5 --force --set until.time=0").exit_code, 0);
  EXPECT_FALSE(exists("a.h5.failure"));
}

TEST_F(ReplayCommand, StartsFromTheSceneWithoutCheckpoints) {
  fail("--set output.checkpoint_every=0");
  EXPECT_FALSE(exists("a.h5.checkpoint"));
  EXPECT_TRUE(replayed("a.h5.failure", 4)["came_back"]);
}

TEST_F(ReplayCommand, SaysThatAFailureDoesNotComeBack) {
  fail();
  forge([](runs::RunFailure& failure) { failure.collisions = 40; });
  const json early = replayed("a.h5.failure", 1);
  EXPECT_FALSE(early["came_back"]);
  EXPECT_EQ(early["message"], nullptr);
  EXPECT_EQ(early["collisions"], 41);
  EXPECT_TRUE(run("replay a.h5.failure --quiet").complains("the failure did not come back: at"));
}

TEST_F(ReplayCommand, SaysThatAnotherFailureCame) {
  fail();
  forge([](runs::RunFailure& failure) { failure.message = "something else"; });
  const json other = replayed("a.h5.failure", 1);
  EXPECT_FALSE(other["came_back"]);
  EXPECT_NE(other["message"], nullptr);
  EXPECT_TRUE(run("replay a.h5.failure --quiet").complains("another failure came at time"));
  fail("--force");
  forge([](runs::RunFailure& failure) { failure.trajectory_hash = "0"; });
  EXPECT_FALSE(replayed("a.h5.failure", 1)["came_back"]);
}

TEST_F(ReplayCommand, TakesACheckpoint) {
  fail();
  const json failed = replayed("a.h5.checkpoint", 4);
  EXPECT_EQ(failed["failure"], nullptr);
  EXPECT_EQ(failed["start"]["collisions"], failed["collisions"]);
  ASSERT_EQ(run("run small.toml --quiet --out b.h5").exit_code, 0);
  EXPECT_EQ(replayed("b.h5.checkpoint.old", 0)["collisions"], 250);
}

TEST_F(ReplayCommand, RefusesOtherFiles) {
  EXPECT_TRUE(run("replay small.toml").fails(3, "small.toml: damaged: expected a checkpoint"));
  EXPECT_EQ(run("replay none.failure").exit_code, 3);
  ASSERT_EQ(run("run small.toml --quiet --out a.h5").exit_code, 0);
  EXPECT_TRUE(
      run("replay a.h5")
          .fails(3, "a.h5: a file of HDF5, not a checkpoint: expected such as a.h5.checkpoint"));
}

TEST_F(ReplayCommand, WithoutOutputThereIsNoBundle) {
  const Outcome failed = run("run collapse.toml --quiet");
  EXPECT_EQ(failed.exit_code, 4);
  EXPECT_TRUE(failed.err.ends_with("(nothing is saved, as no output file is named)\n"));
  EXPECT_EQ(files(), (std::vector<std::string>{"collapse.toml", small}));
}

TEST_F(ReplayCommand, ABundleThatCannotBeWrittenDoesNotHideTheFailure) {
  std::filesystem::create_directories(path("a.h5.failure.part/folder"));
  const Outcome failed = fail();
  EXPECT_TRUE(failed.complains("collapse of needles"));
  EXPECT_TRUE(failed.complains("no bundle for needlework replay: "));
}

TEST_F(ReplayCommand, MembersOfSweepsLeaveBundlesToo) {
  write("grid.toml", "scene = \"collapse.toml\"\nout = \"runs\"\nseeds = [1]\n");
  const Outcome failed = run("sweep grid.toml --quiet");
  EXPECT_EQ(failed.exit_code, 4) << failed.err;
  const std::string bundle = "runs/seed=1.failed.h5.failure";
  EXPECT_TRUE(failed.complains("needlework replay " + bundle + " shows it again"));
  EXPECT_TRUE(replayed(bundle, 4)["came_back"]);
}

}  // namespace
}  // namespace needlework
