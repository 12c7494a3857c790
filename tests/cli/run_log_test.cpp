// `run --log`: a line of JSON for each step of a run, appended whole.
#include <sys/stat.h>

#include <set>
#include <sstream>

#include "tests/cli/described_keys.h"
#include "tests/cli/program.h"

namespace needlework {
namespace {

using nlohmann::json;

class RunLog : public ProgramTest {
 protected:
  std::vector<json> lines(const std::string& name = "log") const {
    std::vector<json> out;
    std::istringstream text(read(name));
    for (std::string line; std::getline(text, line);) out.push_back(json::parse(line));
    return out;
  }
  std::vector<json> of(const std::string& event) const {
    std::vector<json> out;
    for (const json& line : lines()) {
      if (line["event"] == event) out.push_back(line);
    }
    return out;
  }
};

// In one needle nothing can ever happen.
constexpr const char* sweep_with_a_failure = R"(
out = "runs"
seeds = [1]
needles.box = 5
initial.t_rot = 0
until.collisions_per_needle = 1
parameters = { "needles.count" = [1, 50] }
)";

TEST_F(RunLog, HasStartProgressCheckpointsAndEnd) {
  const Outcome done = run("run small.toml --json --quiet --out a.h5 --log log --progress-every 0");
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_EQ(done.err, "");
  const auto all = lines();
  const json &start = all.front(), &end = all.back();
  EXPECT_EQ(start["event"], "start");
  EXPECT_EQ(start["command"], "run");
  EXPECT_EQ(start["scene"], "small.toml");
  EXPECT_EQ(start["file"], "a.h5");
  EXPECT_EQ(start["needles"], 50);
  EXPECT_EQ(start["version"], done.json()["version"]);
  EXPECT_EQ(start["isa"], done.json()["isa"]);
  EXPECT_EQ(start["until"]["collisions_per_needle"], 10);
  EXPECT_EQ(start["until"]["time"], nullptr);
  EXPECT_EQ(end["event"], "end");
  EXPECT_EQ(end["reason"], "collisions");
  EXPECT_EQ(end["exit_code"], 0);
  EXPECT_EQ(end["message"], nullptr);
  EXPECT_EQ(end["collisions"], 250);
  EXPECT_EQ(end["trajectory_hash"], done.json()["trajectory_hash"]);
  EXPECT_EQ(of("checkpoint").size(), 2u) << "before the first collision and at the end";
  EXPECT_EQ(of("checkpoint")[1]["collisions"], 250);
  const auto progress = of("progress");
  ASSERT_GT(progress.size(), 3u);
  for (const json& line : progress) {
    EXPECT_TRUE(line["fraction"] >= 0 && line["fraction"] <= 1) << line;
    EXPECT_LT(std::abs(line["energy_drift"].get<double>()), 1e-12) << line;
    EXPECT_LT(line["momentum_drift"], 1e-12) << line;
    EXPECT_GE(line["checkpoint_age_s"], 0) << line;
  }
  EXPECT_GT(progress.back()["collisions"], progress.front()["collisions"]);
}

// The same scene has the same checksum.
TEST_F(RunLog, IsAppendedTo) {
  run("run small.toml --quiet --out a.h5 --log log");
  const Outcome on = run("resume a.h5 --quiet --log log --set until.collisions_per_needle=20");
  EXPECT_EQ(on.exit_code, 0) << on.err;
  const auto starts = of("start"), ends = of("end");
  ASSERT_EQ(starts.size(), 2u);
  EXPECT_EQ(starts[1]["command"], "resume");
  EXPECT_EQ(starts[1]["collisions"], 250);
  EXPECT_EQ(starts[1]["scene_checksum"], starts[0]["scene_checksum"]);
  EXPECT_EQ(ends[1]["collisions"], 500);
}

TEST_F(RunLog, SaysHowARunWasStopped) {
  const Outcome stopped = run("run small.toml --quiet --out a.h5 --log log --set until.wall_s=0");
  ASSERT_EQ(stopped.exit_code, 75);
  const json end = lines().back();
  EXPECT_EQ(end["reason"], "wall_time");
  EXPECT_EQ(end["exit_code"], 75);
  EXPECT_EQ("needlework: " + end["message"].get<std::string>() + "\n", stopped.err);
}

TEST_F(RunLog, NamesTheBundleOfAFailure) {
  const Outcome failed =
      run("run small.toml --quiet --out a.h5 --log log --set until.collisions_per_needle=1000 "
          "--set collisions.epsilon=0.3 --set collisions.tc=1e-300");
  ASSERT_EQ(failed.exit_code, 4) << failed.err;
  const json end = lines().back();
  EXPECT_EQ(end["reason"], "invalid_state");
  EXPECT_EQ(end["bundle"], "a.h5.failure");
}

TEST_F(RunLog, HoldsErrors) {
  write("more.toml", read(small) + "[output]\nevents = true\n");
  const Outcome full = shell("trap '' XFSZ; ulimit -f 200; exec \"" NEEDLEWORK_PROGRAM
                             "\" run more.toml --set until.collisions_per_needle=1000 --quiet "
                             "--out a.h5 --log log");
  ASSERT_EQ(full.exit_code, 5) << full.err;
  const json end = lines().back();
  EXPECT_EQ(end["reason"], "error");
  EXPECT_EQ(end["exit_code"], 5);
  EXPECT_EQ("needlework: " + end["message"].get<std::string>() + "\n", full.err);
}

TEST_F(RunLog, HoldsWarnings) {
  run("run small.toml --quiet --out a.dat --log log");
  ASSERT_EQ(of("warning").size(), 1u);
  EXPECT_TRUE(contains(of("warning")[0]["message"].get<std::string>(), "will be an HDF5 file"));
}

TEST_F(RunLog, ThatCannotBeWrittenIsAnErrorBeforeTheRun) {
  std::filesystem::create_directory(path("folder"));
  ASSERT_EQ(mkfifo(path("pipe").c_str(), 0600), 0);
  const std::string scene = read(small);
  for (const std::string name : {"none/log", "folder", "pipe", small, "a.h5", "./a.h5"}) {
    EXPECT_TRUE(
        run("run small.toml --quiet --out a.h5 --log " + name).fails(5, "--log " + name + ": "))
        << name;
    EXPECT_FALSE(exists("a.h5")) << name;
  }
  EXPECT_EQ(read(small), scene);
}

TEST_F(RunLog, BeginsANewLineAfterABrokenOne) {
  write("log", "{\"event\": \"sta");
  run("run small.toml --quiet --log log");
  EXPECT_TRUE(read("log").starts_with("{\"event\": \"sta\n{\"event\":\"start\",")) << read("log");
}

TEST_F(RunLog, OnAFullDiskTheRunGoesOn) {
  EXPECT_TRUE(run("run small.toml --quiet --log /dev/full --progress-every 0")
                  .fails(0, "warning: --log /dev/full: lines are missing: No space left"));
}

TEST_F(RunLog, OfASweepHasTheEndsOfItsMembers) {
  write("grid.toml", sweep_with_a_failure);
  const Outcome sweep = run("sweep grid.toml --quiet --log log");
  EXPECT_EQ(sweep.exit_code, 3);
  const auto all = lines();
  EXPECT_EQ(all.front()["event"], "start");
  EXPECT_EQ(all.front()["command"], "sweep");
  EXPECT_EQ(all.front()["members"], 2);
  ASSERT_EQ(of("member_failed").size(), 1u);
  EXPECT_EQ(of("member_failed")[0]["member"], "count=1,seed=1");
  EXPECT_EQ(of("member_failed")[0]["exit_code"], 3);
  ASSERT_EQ(of("member_finished").size(), 1u);
  EXPECT_EQ(of("member_finished")[0]["member"], "count=50,seed=1");
  EXPECT_EQ(all.back()["event"], "end");
  EXPECT_EQ(all.back()["exit_code"], 3);
}

// docs/json.md describes each key of each line, and no other.
TEST_F(RunLog, IsDescribedByItsDocument) {
  auto described = described_keys("json.md");
  std::set<std::string> seen;
  const auto expect_described = [&](const json& line, const std::string& under) {
    seen.insert(under);
    std::vector<std::string> keys = described["Log"];
    keys.insert(keys.end(), described[under].begin(), described[under].end());
    EXPECT_EQ(keys_of(line), sorted(keys)) << under;
  };
  run("run small.toml --quiet --out a.dat --log log --progress-every 0");
  for (const json& line : lines()) expect_described(line, line["event"]);
  write("grid.toml", sweep_with_a_failure);
  run("sweep grid.toml --quiet --log sweep --progress-every 0");
  for (const json& line : lines("sweep")) {
    const std::string event = line["event"];
    expect_described(line, event.starts_with("member_") ? event : event + " of a sweep");
  }
  EXPECT_EQ(seen.size(), 10u);
}

// On stderr, which is no terminal here.
TEST_F(RunLog, ProgressIsOneLineWithRateCheckpointAndDrift) {
  const Outcome done = run("run small.toml --json --out a.h5 --progress-every 0");
  EXPECT_EQ(done.exit_code, 0);
  const std::string first = done.err.substr(0, done.err.find('\n'));
  for (const char* part :
       {" % done, ", " left: ", " collisions, drift E ", ", P ", ", time ", "/s, saved ", " ago"}) {
    EXPECT_TRUE(contains(first, part)) << " in ";
  }
}

}  // namespace
}  // namespace needlework
