// What `needlework bench` measures and prints, and how it judges two results.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <vector>

#include "kernels/isa.h"
#include "tests/cli/program.h"

namespace needlework {
namespace {

using nlohmann::json;

constexpr const char* baseline_name = "s/linked-lists/indexed-heap/standard/scalar/threads:1";
constexpr const char* case_name = "s/auto/auto/standard/avx512/threads:1";

constexpr const char* own_scene =
    "needles = { count = 100, box = 5 }\ncollisions = { epsilon = 0.9, tc_relative = 1e-2 }\n";

class BenchCommand : public ProgramTest {
 protected:
  BenchCommand() { write("own.toml", own_scene); }
  // The cases of a scene, each measured once and for a moment.
  json cases_of(const std::string& arguments) const {
    return json_of("bench --repetitions 1 --min-time 0 --json --scene " + arguments)["cases"];
  }

  static json case_of(const std::string& name, bool baseline, const std::vector<double>& us) {
    return {{"name", name}, {"baseline", baseline}, {"us_per_collision", us}};
  }

  static json results_of(const std::vector<double>& baseline, const std::vector<double>& other) {
    return {{"format", 2},
            {"subset", "made up"},
            {"cases", {case_of(baseline_name, true, baseline), case_of(case_name, false, other)}}};
  }

  void write_results(const std::string& file, const std::vector<double>& baseline,
                     const std::vector<double>& other) const {
    write(file, results_of(baseline, other).dump());
  }

  // The verdict on the one case of new.json that is not the baseline, against old.json.
  std::string verdict(int expected_exit_code) const {
    const json comparison = json_of("bench --results new.json --compare old.json --json", "",
                                    expected_exit_code)["comparison"];
    EXPECT_EQ(comparison.size(), 1u);
    EXPECT_EQ(comparison[0]["name"], case_name);
    return comparison[0]["verdict"];
  }
};

TEST_F(BenchCommand, MeasuresTheBaselineAndTheEngine) {
  const Outcome outcome = run("bench smoke --repetitions 2 --min-time 0 --json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  const json object = outcome.json();
  for (const char* key : {"subset", "machine", "compiler", "flags", "version", "date"}) {
    EXPECT_TRUE(object[key].is_string()) << key;
  }
  ASSERT_EQ(object["cases"].size(), 2u);
  const json &baseline = object["cases"][0], &engine = object["cases"][1];
  EXPECT_TRUE(baseline["baseline"]);
  EXPECT_EQ(baseline["search"], "linked-lists");
  EXPECT_EQ(baseline["queue"], "indexed-heap");
  EXPECT_EQ(baseline["isa"], "scalar");
  EXPECT_EQ(baseline["speedup"], 1.0);
  EXPECT_FALSE(engine["baseline"]);
  EXPECT_NE(engine["search"], "auto");
  EXPECT_EQ(engine["isa"], kernels::name_of(kernels::available().back()));
  EXPECT_EQ(engine["warm_up_hash"], baseline["warm_up_hash"]);
  for (const json& one : object["cases"]) {
    EXPECT_EQ(one["us_per_collision"].size(), 2u);
    EXPECT_EQ(one["collisions"], json({50, 50}));
    EXPECT_LE(one["best_us_per_collision"], one["median_us_per_collision"]);
    EXPECT_GT(one["best_us_per_collision"], 0.0);
    EXPECT_GT(one["bytes_per_needle"][0], 192.0) << "a record alone has so many";
    for (const char* counter : {"events", "searches", "candidates", "evaluated"}) {
      EXPECT_GE(one["per_collision"][counter], 1.0) << counter;
    }
  }
}

TEST_F(BenchCommand, MeasuresAtLeastTheTimeAskedFor) {
  const json object = run("bench smoke --repetitions 1 --min-time 0.02 --json").json();
  for (const json& one : object["cases"]) {
    const double us = one["us_per_collision"][0];
    EXPECT_GE(us * one["collisions"][0].get<double>(), 0.02e6);
  }
}

TEST_F(BenchCommand, PrintsATableAndKeepsItsResults) {
  const std::string first = output_of("bench smoke --repetitions 4 --min-time 0 --json kept.json");
  EXPECT_TRUE(
      contains(first, {"n=1,N=200/auto/auto/standard/", "range of 4 interleaved repetitions"}));
  EXPECT_EQ(run("bench --results kept.json").out, first);
  const Outcome itself = run("bench --results kept.json --compare kept.json");
  EXPECT_TRUE(contains(itself.out, "baseline, +0.0 % by itself"));
  EXPECT_EQ(itself.exit_code, 0);
  EXPECT_TRUE(run("bench smoke --json kept.json")
                  .fails(5, "--json kept.json: exists already: expected a new file, or --force"));
}

TEST_F(BenchCommand, MeasuresASceneOfTheUserWithTheStrategiesAskedFor) {
  const json object = json_of(
      "bench --scene own.toml --set needles.count=120 --searches linked-cells,all-pairs "
      "--queues bucket,lazy-heap,bucket --isa scalar --repetitions 6 --min-time 0 --json");
  EXPECT_EQ(object["subset"], "own.toml");
  ASSERT_EQ(object["cases"].size(), 5u);
  const json& baseline = object["cases"][0];
  EXPECT_TRUE(baseline["baseline"]);
  EXPECT_EQ(baseline["search_asked"], "auto");
  EXPECT_EQ(baseline["queue"], "tournament");
  std::vector<std::string> asked;
  for (const json& one : object["cases"]) {
    EXPECT_EQ(one["scene"], "own");
    EXPECT_EQ(one["needles"], 120);
    EXPECT_EQ(one["threads"], 1);
    EXPECT_EQ(one["accuracy"], "standard");
    EXPECT_EQ(one["warm_up_hash"], baseline["warm_up_hash"]);
    EXPECT_LE(one["speedup_low"], one["speedup"]);
    EXPECT_GE(one["speedup_high"], one["speedup"]);
    if (one == baseline) continue;
    EXPECT_EQ(one["isa"], "scalar");
    asked.push_back(one["search_asked"].get<std::string>() + " " +
                    one["queue_asked"].get<std::string>());
  }
  EXPECT_EQ(asked, (std::vector<std::string>{"linked-cells bucket", "linked-cells lazy-heap",
                                             "all-pairs bucket", "all-pairs lazy-heap"}));
  EXPECT_EQ(files(), (std::vector<std::string>{"own.toml", small}));
}

TEST_F(BenchCommand, ComparesSearchesWhereNothingIsSaid) {
  const json cases = cases_of("own.toml");
  ASSERT_EQ(cases.size(), 3u);
  EXPECT_EQ(cases[1]["search"], "linked-cells");
  EXPECT_EQ(cases[2]["search"], "capsules");
  EXPECT_TRUE(cases[1]["speedup_low"].is_null()) << "one repetition has no interval";
}

TEST_F(BenchCommand, ComparesLevelsOfAccuracyAndSizes) {
  const json cases = cases_of(
      "own.toml --set engine.search='\"capsules\"' --accuracy fast,standard,rigorous "
      "--capsule-radii 0.1,0.2");
  ASSERT_EQ(cases.size(), 7u);
  const char* levels[] = {"fast", "standard", "rigorous"};
  for (std::size_t n = 1; n < 7; ++n) {
    const json& one = cases[n];
    EXPECT_EQ(one["accuracy"], levels[(n - 1) / 2]);
    EXPECT_EQ(one["capsule_radius"], n % 2 ? 0.1 : 0.2);
  }
  EXPECT_EQ(cases_of("own.toml --searches linked-cells --cell-sides 0.5")[1]["cell_side"], 0.5);
}

TEST_F(BenchCommand, ComparesOtherValuesOfAnyKey) {
  const Outcome outcome =
      run("bench --scene own.toml --vary collisions.epsilon=0.5 --vary needles.count=50 "
          "--repetitions 1 --min-time 0 --json kept.json --csv kept.csv");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const json kept = json::parse(read("kept.json"));
  ASSERT_EQ(kept["cases"].size(), 3u);
  EXPECT_TRUE(kept["cases"][0]["setting"].is_null());
  EXPECT_EQ(kept["cases"][1]["setting"], "collisions.epsilon=0.5");
  EXPECT_EQ(kept["cases"][2]["setting"], "needles.count=50");
  EXPECT_TRUE(contains(read("kept.csv"), ",needles.count=50,"));
  // A value with the sign that separates the parts of a name.
  ASSERT_EQ(run("run small.toml --quiet --out start.h5").exit_code, 0);
  write("state.toml", "");
  const json state =
      cases_of("state.toml --set initial.file='\"start.h5\"' --vary initial.file='\"" +
               path("start.h5") + "\"'");
  ASSERT_EQ(state.size(), 2u);
  EXPECT_EQ(state[1]["setting"], "initial.file=\"" + path("start.h5") + "\"");
}

TEST_F(BenchCommand, SaysInItsFilesWhatWasChosen) {
  ASSERT_EQ(
      run("bench --scene own.toml --queues auto --repetitions 1 --min-time 0 --json kept.json")
          .exit_code,
      0);
  const json one = json::parse(read("kept.json"))["cases"][0];
  EXPECT_EQ(one["search_asked"], "auto");
  EXPECT_EQ(one["search"], "linked-cells");
  EXPECT_EQ(one["queue"], "tournament");
  const json again = json_of("bench --results kept.json --json")["cases"][0];
  EXPECT_EQ(again["search"], "linked-cells");
}

TEST_F(BenchCommand, TakesWallTimesOfThreadsAndLeavesOutWhatNeedsOne) {
  const Outcome outcome =
      run("bench --scene own.toml --threads 1,2 --queues auto,tournament --repetitions 1 "
          "--min-time 0 --json kept.json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_TRUE(contains(outcome.err, "tournament/standard/"));
  EXPECT_TRUE(
      contains(outcome.err, "threads:2: left out, as its search or calendar is for one thread"));
  EXPECT_TRUE(contains(outcome.out, "Wall time of the event loop"));
  const json kept = json::parse(read("kept.json"));
  EXPECT_EQ(kept["clock"], "wall");
  ASSERT_EQ(kept["cases"].size(), 3u);
  EXPECT_EQ(kept["cases"][1]["threads"], 2);
  EXPECT_EQ(kept["cases"][2]["queue_asked"], "tournament");
}

TEST_F(BenchCommand, StartsFromTheStateThatASceneNames) {
  ASSERT_EQ(run("run small.toml --quiet --out start.h5").exit_code, 0);
  write("own.toml", "initial.file = 'start.h5'\n");
  const json own = cases_of("own.toml")[0], other = cases_of("small.toml")[0];
  EXPECT_EQ(own["needles"], 50);
  EXPECT_NE(own["warm_up_hash"], other["warm_up_hash"]);
}

TEST_F(BenchCommand, WritesATableWithAFieldForEachPartOfAName) {
  write("my, scene.toml", own_scene);
  ASSERT_EQ(run("bench --scene 'my, scene.toml' --queues bucket --repetitions 6 --min-time 0 "
                "--json kept.json --csv kept.csv")
                .exit_code,
            0);
  std::istringstream lines(read("kept.csv"));
  std::string header, baseline, bucket, more;
  std::getline(lines, header);
  std::getline(lines, baseline);
  std::getline(lines, bucket);
  EXPECT_FALSE(std::getline(lines, more)) << more;
  EXPECT_TRUE(
      header.starts_with("scene,search_asked,queue_asked,accuracy,isa,threads,storage,cell_side,"
                         "capsule_radius,setting,"
                         "search,queue,needles,density,baseline,median_us_per_collision,"))
      << header;
  const std::string isa(kernels::name_of(kernels::available().back()));
  EXPECT_TRUE(baseline.starts_with("\"my, scene\",auto,auto,standard," + isa + ",1,sorted,"))
      << baseline;
  EXPECT_TRUE(bucket.starts_with("\"my, scene\",auto,bucket,standard," + isa + ",1,sorted,"))
      << bucket;
  EXPECT_TRUE(contains(bucket, ",linked-cells,bucket,100,0.8,false,"));
  EXPECT_TRUE(bucket.ends_with(",6,cpu")) << bucket;
  // The same from a file, but for what only measuring tells.
  ASSERT_EQ(run("bench --results kept.json --csv again.csv").exit_code, 0);
  EXPECT_TRUE(contains(read("again.csv"), ",auto,bucket,standard," + isa + ",1"));
}

TEST_F(BenchCommand, WritesOneLineForEachCaseAndNoOtherSamples) {
  ASSERT_EQ(run("bench smoke --repetitions 3 --min-time 0 --json kept.json").exit_code, 0);
  const json kept = json::parse(read("kept.json"));
  ASSERT_EQ(kept["cases"].size(), 2u);
  for (const json& one : kept["cases"]) {
    EXPECT_EQ(one.size(), 15u) << "name, its ten parts, what was chosen, baseline, times: " << one;
    EXPECT_EQ(one["us_per_collision"].size(), 3u);
    EXPECT_EQ(one["scene"], "n=1,N=200");
    EXPECT_TRUE(one["baseline"].is_boolean());
  }
  std::istringstream lines(read("kept.json"));
  std::size_t found = 0;
  for (std::string line; std::getline(lines, line);) {
    for (const json& one : kept["cases"]) {
      found += line.starts_with("  {\"name\": " + one["name"].dump()) &&
               (line.ends_with("]}") || line.ends_with("]},"));
    }
  }
  EXPECT_EQ(found, 2u) << read("kept.json");
}

TEST_F(BenchCommand, TablesFitAHundredColumnsWithNamesOfCasesInFull) {
  // The longest names and the widest numbers of all subsets.
  json results = results_of({1000.4, 4000}, {9.994, 1234.5});
  const std::string longest =
      "n=0.72,N=8000,k=100/linked-cells/auto/standard/avx512/threads:1/side:1.23";
  const std::string baseline =
      "n=0.72,N=8000,k=100/linked-lists/indexed-heap/standard/scalar/threads:1";
  results["cases"][0]["name"] = baseline;
  results["cases"][1]["name"] = longest;
  results["machine"] = "AMD EPYC 7763 64-Core Processor";
  write("wide.json", results.dump());
  for (const char* arguments :
       {"bench --results wide.json", "bench --results wide.json --compare wide.json"}) {
    const std::string outcome = output_of(arguments);
    EXPECT_TRUE(contains(outcome, {longest, baseline}));
    std::istringstream lines(outcome);
    for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 100u) << line;
  }
  // Medians and ranges.
  EXPECT_TRUE(
      contains(run("bench --results wide.json").out, {"2500  1000-4000", " 622  9.99-1234"}));
  const std::string list = run("bench --list").out;
  std::istringstream cases(list);
  for (std::string line; std::getline(cases, line);) {
    const std::string name = line.substr(std::min(line.size(), line.find_first_not_of(' ')));
    if (name.find("/threads:") == std::string::npos) continue;
    EXPECT_LE(name.substr(0, name.find(' ')).size(), longest.size()) << line;
  }
}

TEST_F(BenchCommand, ReadsAllCommittedResultsOfScenes) {
  std::size_t read_files = 0;
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(NEEDLEWORK_SOURCE "/bench/results")) {
    const std::string file = entry.path().string();
    if (entry.path().extension() != ".json") continue;
    std::ifstream in(file);
    const json content = json::parse(in);
    if (!content.contains("format")) continue;  // of other programs, with another key for times
    ++read_files;
    const Outcome outcome = run("bench --results " + file);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_TRUE(content["commit"].is_string() && content["command"].is_string()) << file;
  }
  EXPECT_GT(read_files, 0u);
}

TEST_F(BenchCommand, ListsItsSubsets) {
  for (const char* subset :
       {"quick", "dilute", "dense", "searches", "queues", "isa", "steps", "density", "size",
        "storage", "matrix", "cloud", "effects", "hulls", "mixtures"}) {
    EXPECT_TRUE(contains(output_of("bench --list"), std::string(subset) + " ")) << subset;
  }
  // What roughness costs is seen beside the same spheres without it.
  EXPECT_TRUE(contains(output_of("bench --list"), {"  spheres/auto/", "  rough-spheres/auto/",
                                                   "  rough-spheres/linked-lists/"}));
  EXPECT_TRUE(contains(run("bench --help").out, "Whitney"));
}

const std::vector<double> steady{40, 41, 40.5, 40.2, 40.8};

TEST_F(BenchCommand, FindsFasterAndSlower) {
  write_results("old.json", steady, {10, 10.3, 10.1, 10.2, 10.1});
  write_results("new.json", steady, {8, 8.2, 8.1, 8.3, 8.1});
  EXPECT_EQ(verdict(1), "faster");
  write_results("new.json", steady, {12, 12.2, 12.1, 12.3, 12.1});
  EXPECT_EQ(verdict(1), "slower");
}

TEST_F(BenchCommand, FindsNoDifference) {
  write_results("old.json", steady, {10, 10.3, 10.1, 10.2, 10.1});
  write_results("new.json", steady, {10.1, 10.2, 10.1, 10.1, 10.2});
  EXPECT_EQ(verdict(0), "same");
}

TEST_F(BenchCommand, JudgesByTheBaselineOfTheSameRepetition) {
  write_results("old.json", steady, {10, 10.25, 10.125, 10.05, 10.2});
  // A machine at half and at a third of its speed.
  write_results("new.json", {80, 123, 81, 120.6, 81.6}, {20, 30.75, 20.25, 30.15, 20.4});
  EXPECT_EQ(verdict(0), "same");
}

TEST_F(BenchCommand, DoesNotJudgeNoise) {
  write_results("old.json", steady, {10, 14, 9, 12, 10});
  write_results("new.json", steady, {9, 13, 8, 11, 10});
  EXPECT_EQ(verdict(0), "unclear");
  // However clear the difference looks, three repetitions are too few to judge.
  write_results("old.json", {40, 40, 40}, {10, 10, 10});
  write_results("new.json", {40, 40, 40}, {5, 5, 5});
  EXPECT_EQ(verdict(0), "unclear");
}

TEST_F(BenchCommand, JudgesTheTimesOfRunsThatDifferInOneSetting) {
  json old = results_of(steady, {10, 10.3, 10.1, 10.2, 10.1});
  json now = results_of(steady, {12, 12.2, 12.1, 12.3, 12.1});
  for (json& one : now["cases"]) {
    std::string name = one["name"];
    name.replace(name.find("standard"), 8, "rigorous");
    one["name"] = name;
  }
  write("old.json", old.dump());
  write("new.json", now.dump());
  const json judged =
      json_of("bench --results new.json --compare old.json --json", "", 1)["comparison"];
  ASSERT_EQ(judged.size(), 2u) << "the baseline as well";
  EXPECT_EQ(judged[0]["verdict"], "same");
  EXPECT_EQ(judged[1]["verdict"], "slower");
  EXPECT_EQ(judged[1]["old_name"], case_name);
  EXPECT_TRUE(judged[1]["new_relative_cost"].is_null());
  const Outcome text = run("bench --results new.json --compare old.json");
  EXPECT_TRUE(contains(text.out, "accuracy: standard before, rigorous now."));
}

TEST_F(BenchCommand, ReportsCasesThatOnlyOneResultHas) {
  write_results("new.json", steady, steady);
  json old = results_of(steady, steady);
  old["cases"][1]["name"] = "s/other";
  write("old.json", old.dump());
  EXPECT_TRUE(contains(output_of("bench --results new.json --compare old.json"),
                       "only in the new results"));
  old["cases"][0]["name"] = "s/another";
  write("old.json", old.dump());
  EXPECT_TRUE(run("bench --results new.json --compare old.json").fails(3, "no case in common"));
  // Reported before anything is measured: this would take a quarter of an hour.
  EXPECT_TRUE(run("bench smoke --min-time 200 --json new_too.json --compare old.json")
                  .fails(3, "no case in common"));
}

TEST_F(BenchCommand, WarnsOfOtherCausesOfChangedCosts) {
  json old = results_of(steady, steady), now = old;
  old["machine"] = "A";
  now["machine"] = "B";
  old["compiler"] = now["compiler"] = "C";
  now["flags"] = "-O3";
  write("old.json", old.dump());
  write("new.json", now.dump());
  EXPECT_EQ(run("bench --results new.json --compare old.json").err,
            "needlework: warning: machine: A before, B now\n"
            "needlework: warning: flags: ? before, -O3 now\n");
  EXPECT_EQ(run("bench --results new.json --compare new.json").err, "");
}

TEST_F(BenchCommand, RefusesBadInput) {
  json bare = results_of(steady, steady), uneven = bare, negative = bare, older = bare, none = bare;
  bare["cases"].erase(0);
  uneven["cases"][1] = case_of(case_name, false, {1, 2});
  negative["cases"][1]["us_per_collision"][2] = -1;
  older["format"] = 1;
  none["cases"][0]["us_per_collision"] = json::array();
  write("bare.json", bare.dump());
  write("uneven.json", uneven.dump());
  write("negative.json", negative.dump());
  write("older.json", older.dump());
  write("none.json", none.dump());
  write("broken.json", "{\"format\": 2, \"cases\": [");
  write("other.json", "{\"needles\": 5}");
  write("list.json", "[2]");
  const struct {
    const char *arguments, *message;
    int exit_code;
  } cases[] = {
      {"bench fast", "SUBSET fast: expected one of quick, dilute", 3},
      {"bench smoke --json out.txt", "--json out.txt: expected a name that ends in .json", 3},
      {"bench smoke --json no/out.json", "expected a folder that exists", 5},
      {"bench smoke --compare absent.json", "absent.json: cannot be read", 5},
      {"bench smoke --compare broken.json", "broken.json: ", 3},
      {"bench --results other.json", "expected a file that needlework bench --json FILE has", 3},
      {"bench --results list.json", "expected a file that needlework bench --json FILE has", 3},
      {"bench smoke --compare older.json", "older.json: format 1: expected 2; measure again", 3},
      {"bench --results bare.json", "bare.json: scene s: expected a baseline among the cases", 3},
      {"bench --results uneven.json", "has 2 repetitions: expected 5, as many as the baseline", 3},
      {"bench --results negative.json", "us_per_collision -1: expected a number above 0", 3},
      {"bench --results none.json", "is empty: expected at least one repetition", 3},
      {"bench smoke --repetitions 0", "--help", 2},
      {"bench smoke --min-time -1", "--help", 2},
      {"bench smoke quick", "--help", 2},
      {"bench smoke --scene small.toml", "SUBSET excludes --scene", 2},
      {"bench --queues bucket", "--queues requires --scene", 2},
      {"bench --set needles.count=3", "--set requires --scene", 2},
      {"bench --scene none.toml", "none.toml: ", 5},
      {"bench --scene small.toml --set needles.counts=3", "did you mean", 3},
      {"bench --scene small.toml --queues bucket,heap", "--queues heap: expected \"auto\", ", 3},
      {"bench --scene small.toml --searches 7", "--searches 7: expected \"auto\", ", 3},
      {"bench --scene small.toml --threads 0", "--threads 0: expected ", 3},
      {"bench --scene small.toml --isa none", "--isa none: expected ", 3},
      {"bench --scene small.toml --csv out.txt", "--csv out.txt: expected a name that ends in", 3},
      {"bench --scene small.toml --set initial.t_tr=0 --set initial.t_rot=0 --min-time 0",
       "nothing can happen: expected needles that collide", 4}};
  for (const auto& [arguments, message, exit_code] : cases) {
    EXPECT_TRUE(run(arguments).fails(exit_code, message)) << arguments;
  }
}

}  // namespace
}  // namespace needlework
