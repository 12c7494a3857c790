// `needlework sweep`: what it computes, and how it continues after it was stopped.
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <map>
#include <sstream>
#include <thread>

#include "tests/cli/program.h"

namespace needlework {
namespace {

using nlohmann::json;

class SweepCommand : public ProgramTest {
 protected:
  SweepCommand() {
    write("cooling.toml", R"(needles = { count = 60, box = 5 }
collisions.tc_relative = 1e-3
until.energy_ratio = 0.2
)");
    write("grid.toml", R"(scene = "cooling.toml"
seeds = [1, 2, 3]
[parameters]
"collisions.epsilon" = [0.9, 0.8]
)");
    write("long.toml", R"(scene = "cooling.toml"
seeds = [1, 2, 3, 4, 5, 6]
[parameters]
"needles.count" = 1000
"needles.box" = 12
"collisions.epsilon" = 0.8
"until.energy_ratio" = 1e-3
)");
  }

  json result(const std::string& arguments, const std::string& before = "") const {
    return json_of("sweep --json " + arguments, before);
  }
  std::size_t count_of_files(const std::string& folder, const std::string& ending) const {
    const std::filesystem::directory_iterator files(path(folder));
    return std::count_if(begin(files), end(files), [&](const auto& file) {
      return file.path().filename().string().ends_with(ending);
    });
  }
};

TEST_F(SweepCommand, DescribesNumbersOfBodiesThatGrowAsTheirRunsDo) {
  write("growing.toml", R"(needles = { count = 20, box = 4, diameter = 0.2 }
until.time = 0.2
driving.growth.rate = 0.1
output.observables = ["contact_network"]
)");
  write("growth.toml", "scene = \"growing.toml\"\nseeds = [1, 2]\n");
  ASSERT_EQ(run("sweep growth.toml --out all --quiet").exit_code, 0);
  const std::string text = run("info all/summary.h5").out;
  for (const char* part : {"  growth_scale\n", "Present sizes of bodies in those of the start.",
                           "What this scale gains in a unit of time, in units of 1/time.",
                           "  network_rattlers\n", "Number of bodies that fewer than 4"})
    EXPECT_TRUE(contains(text, part)) << part;
}

TEST_F(SweepCommand, PrintsAMeanAndAnErrorOfEachResultInALineOfEachPoint) {
  const json points = result("grid.toml --out all")["points"];
  std::istringstream lines(run("sweep grid.toml --out all --csv --quiet").out);
  std::string head, line;
  std::getline(lines, head);
  EXPECT_TRUE(head.starts_with("collisions.epsilon,members,time,time_error,collisions,")) << head;
  for (const json& point : points) {
    ASSERT_TRUE(std::getline(lines, line));
    const json& time = point["results"]["time"];
    const std::string expected =
        fmt::format("{},3,{},{},", point["parameters"]["collisions.epsilon"].get<double>(),
                    time["mean"].get<double>(), time["standard_error"].get<double>());
    EXPECT_TRUE(line.starts_with(expected)) << line << " instead of " << expected;
    EXPECT_EQ(std::count(line.begin(), line.end(), ','), std::count(head.begin(), head.end(), ','));
  }
  EXPECT_FALSE(std::getline(lines, line)) << line;
  EXPECT_EQ(run("sweep grid.toml --out all --csv --json").exit_code, 2);
}

TEST_F(SweepCommand, GivesMeansAndStandardErrorsOfItsRuns) {
  const json sweep = result("grid.toml --out all");
  EXPECT_EQ(sweep["members"], 6);
  EXPECT_EQ(sweep["computed"], 6);
  ASSERT_EQ(sweep["costs"].size(), 6u);
  for (const json& member : sweep["costs"]) {
    EXPECT_GT(member["collisions"], 0) << member;
    EXPECT_GT(member["us_per_collision"], 0) << member;
    EXPECT_GT(member["wall_s"], 0) << member;
  }
  ASSERT_EQ(sweep["points"].size(), 2u);
  const json& point = sweep["points"][1];
  EXPECT_EQ(point["parameters"]["collisions.epsilon"], 0.8);
  EXPECT_EQ(point["seeds"], json({1, 2, 3}));

  double sum = 0, squares = 0;
  for (const std::string seed : {"1", "2", "3"}) {
    const Outcome one =
        run("run cooling.toml --json --set collisions.epsilon=0.8 "
            "--set needles.seed=" +
            seed);
    const double collisions = one.json()["collisions"];
    sum += collisions;
    squares += collisions * collisions;
  }
  const json& collisions = point["results"]["collisions"];
  EXPECT_DOUBLE_EQ(collisions["mean"].get<double>(), sum / 3);
  EXPECT_NEAR(collisions["standard_error"].get<double>(), std::sqrt((squares - sum * sum / 3) / 6),
              1e-6);

  const json& series = point["series"];
  const std::size_t samples = series["time"].size();
  EXPECT_GT(samples, 10u);
  EXPECT_EQ(series["time"][0], 0);
  for (const char* name : {"energy", "t_tr", "t_rot", "momentum", "collisions", "tc_collisions"}) {
    EXPECT_EQ(series[name]["mean"].size(), samples) << name;
    EXPECT_EQ(series[name]["standard_error"].size(), samples) << name;
  }
  EXPECT_NEAR(series["energy"]["mean"][0].get<double>(), 2.5, 1e-12);
  EXPECT_EQ(series["momentum"]["mean"][1].size(), 3u);
}

// From the files of the members.
TEST_F(SweepCommand, SumsUpWhatWallsAndDrivingHaveDone) {
  write("driven.toml", R"(needles = { count = 40, box = [5, 4, 3] }
until.time = 3
driving.kicks = { every = 0.5, translational = 1, rotational = 1 }
driving.andersen = { rate = 0.5, temperature = 2 }
walls = [{ axis = "z", side = "both", epsilon = 0.7 }]
collisions.tc_relative = 1e-3
)");
  write("one.toml", "scene = \"driven.toml\"\nseeds = [4]\n");
  const json results = result("one.toml --out one")["points"][0]["results"];
  const json alone = json_of("run driven.toml --json --quiet --set needles.seed=4");
  const auto mean = [&](const char* name) { return results[name]["mean"].get<double>(); };
  for (const int n : {0, 1}) {
    const json& wall = alone["walls"][n];
    const std::string name = n == 0 ? "z_low" : "z_high";
    EXPECT_EQ(mean(("hits_" + name).c_str()), wall["hits"]);
    EXPECT_EQ(mean(("impulse_" + name).c_str()), wall["impulse"]);
    EXPECT_NEAR(mean(("pressure_" + name).c_str()), wall["pressure"].get<double>(), 1e-12);
    EXPECT_EQ(mean(("budget_" + name).c_str()), alone["energy_budget"]["walls"][n]);
  }
  for (const char* name : {"pairs", "thermostat", "kicks"}) {
    EXPECT_EQ(mean((std::string("budget_") + name).c_str()), alone["energy_budget"][name]) << name;
  }
}

TEST_F(SweepCommand, SummaryDoesNotDependOnThreadsOrShares_long) {
  const json one = result("grid.toml --out one --threads 1");
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));  // a time in the file would differ
  const json two = result("grid.toml --out two --threads 2");
  EXPECT_EQ(one["points"], two["points"]);
  for (const std::string share : {"2/3", "3/3"}) {
    const json part = result("grid.toml --out shares --member " + share);
    EXPECT_TRUE(part["file"].is_null());
    EXPECT_EQ(part["points"].size(), 0u);
  }
  EXPECT_FALSE(exists("shares/summary.h5"));
  const json last = result("grid.toml --out shares --member 1/3");
  EXPECT_EQ(last["missing"], 0);
  EXPECT_EQ(last["points"], one["points"]);
  const std::string bytes = read("one/summary.h5");
  EXPECT_FALSE(bytes.empty());
  EXPECT_TRUE(bytes == read("two/summary.h5"));
  EXPECT_TRUE(bytes == read("shares/summary.h5"));
}

TEST_F(SweepCommand, SummaryAloneSumsUpWhatIsThere) {
  result("grid.toml --out part --member 1/2");
  const Outcome partial = run("sweep --json --summary grid.toml --out part");
  EXPECT_TRUE(partial.fails(0, "warning: 3 of 6 members are missing"));
  EXPECT_EQ(partial.json()["computed"], 0);
  EXPECT_EQ(
      partial.json()["points"][0]["seeds"].size() + partial.json()["points"][1]["seeds"].size(),
      3u);
  const json rest = result("grid.toml --out part --member 2/2");
  EXPECT_EQ(rest["points"], result("--summary grid.toml --out part")["points"]);
}

TEST_F(SweepCommand, SummaryNeedsSomethingToSumUp) {
  const Outcome absent = run("sweep --summary grid.toml --out absent");
  EXPECT_TRUE(absent.fails(3, "--out absent: expected the folder of a sweep"));
  EXPECT_FALSE(exists("absent"));
  std::filesystem::create_directory(path("empty"));
  const Outcome empty = run("sweep --summary grid.toml --out empty");
  EXPECT_TRUE(empty.fails(3, "expected members to sum up: none is finished"));
  EXPECT_FALSE(exists("empty/summary.h5"));
}

TEST_F(SweepCommand, AnEmptyShareIsNoShare) {
  EXPECT_TRUE(run("sweep grid.toml --out share --member \"\"").fails(2, "--member : expected K/M"));
  EXPECT_FALSE(exists("share"));
}

TEST_F(SweepCommand, RunsNothingTwice) {
  const json first = result("grid.toml --out twice");
  const json again = result("grid.toml --out twice");
  EXPECT_EQ(again["computed"], 0);
  EXPECT_EQ(again["costs"].size(), 0u);
  EXPECT_EQ(again["points"], first["points"]);
  std::filesystem::remove(path("twice/epsilon=0.9,seed=2.h5"));
  write("twice/epsilon=0.9,seed=2.h5.part", "cut short");
  const json mended = result("grid.toml --out twice");
  EXPECT_EQ(mended["computed"], 1);
  EXPECT_EQ(mended["points"], first["points"]);
  EXPECT_FALSE(exists("twice/epsilon=0.9,seed=2.h5.part"));
}

TEST_F(SweepCommand, GoesOnAfterSignals_long) {
  const json whole = result("long.toml --out whole --threads 2");
  for (const std::string signal : {"INT", "TERM", "KILL"}) {
    const std::string out = "long.toml --out " + signal;
    const Outcome stopped =
        run_and_signal("sweep --json --threads 2 " + out, "ls " + signal + "/*.h5.part", signal);
    if (signal != "KILL") {
      EXPECT_EQ(stopped.exit_code, 75) << signal;
      EXPECT_TRUE(contains(stopped.err, "the same command continues with them"));
      EXPECT_EQ(count_of_files(signal, ".lock"), 0u);
      // The members that were running are saved.
      EXPECT_GT(count_of_files(signal, ".h5.part.checkpoint"), 0u);
    }
    EXPECT_FALSE(exists(signal + "/summary.h5"));
    const json rest = result(out);
    EXPECT_GT(rest["computed"], 0);
    EXPECT_EQ(rest["points"], whole["points"]) << signal;
    // KILL may leave a draft without a name, when it comes just as a file is begun.
    const std::string unfinished = signal == "KILL" ? ".h5.part" : ".part";
    EXPECT_EQ(count_of_files(signal, ".checkpoint"), 0u);
    EXPECT_EQ(count_of_files(signal, unfinished) + count_of_files(signal, ".lock"), 0u);
    EXPECT_TRUE(read(signal + "/summary.h5") == read("whole/summary.h5"));
  }
}

// What can be continued, but not now, must not be begun again.
TEST_F(SweepCommand, KeepsAMemberThatAnotherProgramHasOpen_long) {
  run_and_signal("sweep --threads 1 long.toml --out locked", "ls locked/*.h5.part", "INT");
  const std::filesystem::directory_iterator files(path("locked"));
  const auto part = std::find_if(begin(files), end(files), [](const auto& file) {
    return file.path().string().ends_with(".h5.part");
  });
  ASSERT_NE(part, end(files));
  const std::string name = "locked/" + part->path().filename().string(), before = read(name);
  const int file = open(path(name).c_str(), O_RDONLY);
  ASSERT_EQ(flock(file, LOCK_EX), 0);
  const Outcome refused = run("sweep long.toml --out locked");
  close(file);
  EXPECT_EQ(refused.exit_code, 5);
  EXPECT_TRUE(contains(refused.err, "has the file open for writing"));
  EXPECT_TRUE(read(name) == before);
  EXPECT_TRUE(exists(name + ".checkpoint"));
  EXPECT_EQ(result("long.toml --out locked")["missing"], 0);
}

TEST_F(SweepCommand, TwoSweepsOfOneFolderDoNotRunTheSame_long) {
  Outcome other;
  std::thread first([&] { other = run("sweep --json long.toml --out both --threads 1"); });
  while (!exists("both/grid.toml")) std::this_thread::yield();
  const Outcome outcome = run("sweep --json long.toml --out both --threads 1");
  first.join();
  for (const Outcome& one : {outcome, other}) {
    EXPECT_TRUE(one.exit_code == 0 || one.exit_code == 75) << one.err;
  }
  EXPECT_EQ(result("long.toml --out both")["points"], result("long.toml --out alone")["points"]);
}

TEST_F(SweepCommand, KeepsToTheGridOfItsFolder) {
  result("grid.toml --out here");
  write("grid.toml", read("grid.toml") + "\"needles.k\" = 2\n");
  EXPECT_TRUE(run("sweep grid.toml --out here")
                  .fails(3, "--out here: is of another grid, scene or version"));
  EXPECT_EQ(result("grid.toml --out here --force")["computed"], 6);

  // What is the same in both is kept.
  write("more.toml",
        std::string(read("grid.toml")).replace(read("grid.toml").find("1, 2"), 4, "7, 1, 2"));
  EXPECT_EQ(result("more.toml --out here --force")["computed"], 2);

  write("here/epsilon=0.9,seed=1.h5", "no such thing");
  EXPECT_TRUE(run("sweep more.toml --out here")
                  .fails(3, "here/epsilon=0.9,seed=1.h5: expected a member of this grid"));
  EXPECT_EQ(result("more.toml --out here --force")["computed"], 1);
}

// Inelastic pairs collapse sooner or later without the t_c rule.
TEST_F(SweepCommand, AFailedMemberIsNamedAndAffectsNoOther) {
  write("failing.toml", R"(seeds = [1, 2]
needles = { count = 200, box = 6 }
until.collisions_per_needle = 100
[parameters]
"collisions.epsilon" = [1, 0.3]
)");
  const Outcome outcome = run("sweep --json --quiet failing.toml --out f");
  EXPECT_EQ(outcome.exit_code, 4);
  EXPECT_TRUE(
      contains(outcome.err, {"member epsilon=0.3,seed=1: ", "member epsilon=0.3,seed=2: ",
                             "collapse of needles ", "saved in f/epsilon=0.3,seed=1.failed.h5"}));
  EXPECT_EQ(outcome.json()["failed"], json({"epsilon=0.3,seed=1", "epsilon=0.3,seed=2"}));
  EXPECT_EQ(outcome.json()["points"][0]["seeds"].size(), 2u);
  EXPECT_EQ(outcome.json()["points"][0]["results"]["collisions"]["mean"], 10000);
  EXPECT_TRUE(outcome.json()["points"][1]["results"]["collisions"]["mean"].is_null());

  const Outcome again = run("sweep --json --quiet failing.toml --out f");
  EXPECT_EQ(again.exit_code, 4);
  EXPECT_EQ(again.json()["computed"], 0);
  EXPECT_TRUE(contains(again.err, "member epsilon=0.3,seed=2: failed before"));
}

TEST_F(SweepCommand, ErrorsOfUsageAndInputAreReported) {
  const std::tuple<std::string, int, std::string> cases[] = {
      {"grid.toml --out a --member 0/3", 2, "--member 0/3: expected K/M"},
      {"grid.toml --out a --member 4/3", 2, "--member 4/3: expected K/M"},
      {"grid.toml --out a --member 1", 2, "--member 1: expected K/M"},
      {"grid.toml --out a --threads 0", 2, "--help"},
      {"grid.toml", 3, "grid.toml: out is missing: expected a folder, or --out DIR"},
      {"cooling.toml --out a", 3, "cooling.toml: seeds is missing: expected a list"},
      {"none.toml --out a", 5, "none.toml: cannot be read"},
      {"grid.toml --out cooling.toml", 5, "--out cooling.toml: cannot be made"},
      {"grid.toml --out a --isa bogus", 3, "--isa bogus: expected auto"}};
  for (const auto& [arguments, code, message] : cases) {
    EXPECT_TRUE(run("sweep --quiet " + arguments).fails(code, message)) << arguments;
  }
}

TEST_F(SweepCommand, ExampleIsAGridThatCanBeRun) {
  const std::string source = NEEDLEWORK_SOURCE;
  const Outcome outcome =
      run("sweep --json '" + source + "/profiles/sweep-cooling.toml' --out example --member 12/12");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.json()["members"], 12);
  EXPECT_EQ(outcome.json()["missing"], 11);
}

class SweepOverRanks : public SweepCommand {
 protected:
  void SetUp() override {
    // What mpirun says does not matter as long as it starts processes.
    const Outcome start = shell(launcher + "true");
    if (start.exit_code != 0) GTEST_SKIP() << "mpirun cannot start two processes: " << start.err;
    if (run("sweep grid.toml --out probe", launcher).err.find("built with MPI") !=
        std::string::npos)
      GTEST_SKIP() << "the program was built without MPI";
  }

  static void expect_once(const std::string& text, const std::string& part) {
    EXPECT_TRUE(contains(text, part));
    EXPECT_EQ(text.find(part), text.rfind(part)) << text;
  }

  const std::string launcher =
      "OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 mpirun --oversubscribe -n 2 ";
};

TEST_F(SweepOverRanks, GiveTheSameSummary) {
  const json ranks = result("grid.toml --out ranks --threads 1", launcher);
  EXPECT_EQ(ranks["ranks"], 2);
  EXPECT_EQ(ranks["computed"], 6);
  EXPECT_EQ(ranks["points"], result("grid.toml --out one")["points"]);
  EXPECT_TRUE(read("ranks/summary.h5") == read("one/summary.h5"));
}

TEST_F(SweepOverRanks, GoOnAfterASignal_long) {
  const json whole = result("long.toml --out whole --threads 2");
  const Outcome stopped = run_and_signal("sweep long.toml --out ranks --threads 1",
                                         "ls ranks/*.h5.part", "TERM", launcher);
  EXPECT_NE(stopped.exit_code, 0);
  // Ranks that their launcher leaves behind keep what they are running for a moment, in which a
  // fast machine may complete the sweep.
  Outcome rest;
  while ((rest = run("sweep --json long.toml --out ranks")).exit_code == 75) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  ASSERT_EQ(rest.exit_code, 0) << rest.err;
  EXPECT_EQ(rest.json()["points"], whole["points"]);
}

// In one needle nothing can ever happen: half of the members fail. What was in the log before ends
// in the middle of a line.
TEST_F(SweepOverRanks, WriteOneLogOfWholeLines_long) {
  write("half.toml", R"(scene = "cooling.toml"
seeds = [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20]
[parameters]
"needles.count" = [1, 60]
"collisions.epsilon" = 0.8
)");
  const std::string broken = "{\"event\": \"sta";
  write("log", broken);
  const std::string command = "sweep half.toml --out half --threads 1 --quiet --progress-every 0";
  EXPECT_NE(run(command + " --log log", launcher).exit_code, 0);
  std::istringstream text(read("log"));
  std::string line;
  std::getline(text, line);
  EXPECT_EQ(line, broken);
  std::vector<std::string> events;
  std::map<std::string, std::size_t> ends_of_members;
  while (std::getline(text, line)) {
    ASSERT_TRUE(json::accept(line)) << line;
    const json entry = json::parse(line);
    events.push_back(entry["event"]);
    if (entry.contains("member")) ++ends_of_members[entry["member"]];
  }
  ASSERT_FALSE(events.empty());
  EXPECT_EQ(events.front(), "start");
  EXPECT_EQ(events.back(), "end");
  for (const std::string once : {"start", "end"}) {
    EXPECT_EQ(std::count(events.begin(), events.end(), once), 1) << once;
  }
  EXPECT_EQ(std::count(events.begin(), events.end(), "member_finished"), 20);
  EXPECT_EQ(std::count(events.begin(), events.end(), "member_failed"), 20);
  EXPECT_EQ(ends_of_members.size(), 40u) << "each once";
}

TEST_F(SweepOverRanks, NoOtherCommandRunsOnSeveral_long) {
  for (const std::string command : {"run small.toml --out twice.h5", "check small.toml"}) {
    const Outcome outcome = run(command, launcher);
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_EQ(outcome.out, "");
    const std::string message = "started as 2 processes by MPI: expected one: --threads N";
    expect_once(outcome.err, message);
    EXPECT_TRUE(contains(outcome.err, "needlework sweep"));
  }
  EXPECT_FALSE(exists("twice.h5"));
  EXPECT_EQ(run("run small.toml --quiet", "OMPI_COMM_WORLD_SIZE=1").exit_code, 0);
  EXPECT_TRUE(contains(run("run --help", launcher).out, "SCENE"));
}

TEST_F(SweepOverRanks, ReportAnErrorOnce) {
  const Outcome outcome = run("sweep grid.toml", launcher);
  EXPECT_EQ(outcome.exit_code, 3);
  const std::string message = "needlework: grid.toml: out is missing";
  expect_once(outcome.err, message);
}

}  // namespace
}  // namespace needlework
