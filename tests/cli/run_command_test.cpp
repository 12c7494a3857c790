// What `needlework run` computes, prints and keeps.
#include <sched.h>

#include <cmath>
#include <set>

#include "kernels/isa.h"
#include "needlework/h5md.h"
#include "needlework/theory.h"
#include "tests/cli/described_keys.h"
#include "tests/cli/program.h"

namespace needlework {
namespace {

using nlohmann::json;

class RunCommand : public ProgramTest {
 protected:
  RunCommand() {
    write("cooling.toml", R"(title = "Cooling gas"
needles = { count = 200, box = 7 }
collisions = { epsilon = 0.9, tc_relative = 1e-3 }
until.energy_ratio = 0.05
)");
    write("endless.toml", R"(needles = { count = 500, box = 10 }
until.time = 1e12
)");
  }

  json result(const std::string& arguments, const std::string& before = "") const {
    return json_of("run --json " + arguments, before);
  }
};

TEST_F(RunCommand, PrintsAllKeysAndNothingElse) {
  const Outcome outcome = run("run --json small.toml");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.err, "");
  const json object = outcome.json();
  for (const char* key :
       {"needles", "collisions", "events", "threads", "tc_collisions", "seed", "peak_rss_bytes"}) {
    EXPECT_TRUE(object[key].is_number_integer()) << key;
  }
  for (const char* key : {"time", "collisions_per_needle", "collision_rate", "collision_rate_exact",
                          "energy", "energy_initial", "t_tr", "t_rot", "setup_s", "wall_s", "cpu_s",
                          "total_s", "collisions_per_s", "us_per_collision"}) {
    EXPECT_TRUE(object[key].is_number()) << key;
  }
  for (const char* key :
       {"isa", "search", "queue", "accuracy", "effects", "trajectory_hash", "version", "stop"}) {
    EXPECT_TRUE(object[key].is_string()) << key;
  }
  EXPECT_EQ(object["momentum"].size(), 3u);
  for (const auto& [key, value] : object["stats"].items()) {
    EXPECT_TRUE(value.is_number_integer() || key == "blocked_s") << key;
  }
  EXPECT_EQ(object["trajectory_hash"].get<std::string>().size(), 32u);
}

TEST_F(RunCommand, PrintsWhatItsDocumentDescribes) {
  auto described = described_keys("json.md");
  const json object = result("small.toml");
  EXPECT_EQ(keys_of(object), sorted(described["Result"]));
  EXPECT_EQ(keys_of(object["stats"]), sorted(described["Counters"]));
  write("species.toml",
        "needles.box = 5\nuntil.time = 1\n"
        "[[species]]\nname = 'rods'\ncount = 50\n");
  std::vector<std::string> all = described["Result"];
  for (const std::string& key : described["Result with species"]) all.push_back(key);
  EXPECT_EQ(keys_of(result("species.toml")), sorted(all));
  write("driven.toml",
        "needles = { count = 5, box = 4 }\nuntil.time = 1\n[[walls]]\naxis = 'x'\nside = 'both'\n"
        "[driving]\nkicks = { every = 1, translational = 1, rotational = 1 }\n"
        "andersen = { rate = 1, temperature = 1 }\n");
  const json driven = result("driven.toml");
  EXPECT_EQ(keys_of(driven["walls"][1]), sorted(described["Result with walls"]));
  write("channel.toml",
        "needles = { count = 5, box = 4 }\nuntil.time = 1\nforces.gravity = [1, 0, 0]\n"
        "[[walls]]\naxis = 'z'\nside = 'both'\ntemperature = 1\n");
  json budget = driven["energy_budget"];
  budget.update(result("channel.toml")["energy_budget"]);  // the thermostat knows no gravity
  write("sheared.toml", "needles = { count = 5, box = 4 }\nuntil.time = 1\nshear.rate = 1\n");
  budget.update(result("sheared.toml")["energy_budget"]);
  write("growing.toml",
        "needles = { count = 5, box = 4, diameter = 0.1 }\nuntil.time = 1\n"
        "driving.growth = { rate = 0.01 }\n");
  budget.update(result("growing.toml")["energy_budget"]);
  EXPECT_EQ(keys_of(budget), sorted(described["Result with walls or driving"]));
  write("wide.toml", "needles = { count = 5, box = 4, diameter = 0.1 }\nuntil.time = 1\n");
  std::vector<std::string> of_rods = described["Result"];
  of_rods.push_back("rods");
  for (const std::string& key : described["Result with rods that were drawn"]) {
    of_rods.push_back(key);
  }
  const json wide = result("wide.toml");
  EXPECT_EQ(keys_of(wide), sorted(of_rods));
  EXPECT_EQ(keys_of(wide["rods"]), sorted(described["Result with rods"]));
}

TEST_F(RunCommand, ReportsConsistentNumbers) {
  const json object = result("small.toml");
  EXPECT_EQ(object["needles"], 50);
  EXPECT_EQ(object["collisions"], 250);
  EXPECT_EQ(object["collisions_per_needle"], 10.0);
  EXPECT_EQ(object["stop"], "collisions");
  EXPECT_EQ(object["isa"], kernels::name_of(kernels::available().back()));
  EXPECT_NE(object["search"], "auto");
  EXPECT_NEAR(object["energy"].get<double>(), 2.5, 1e-12);
  EXPECT_DOUBLE_EQ(object["collision_rate"].get<double>(), 10 / object["time"].get<double>());
  EXPECT_DOUBLE_EQ(object["collision_rate_exact"].get<double>(),
                   theory::equilibrium_rate(50, 125, 50 * 2.5, 6));
  EXPECT_GE(object["total_s"].get<double>(), object["wall_s"].get<double>());
  EXPECT_GE(object["events"].get<int>(), 250);
}

TEST_F(RunCommand, GivesNullForWhatIsUndefined) {
  EXPECT_TRUE(result("cooling.toml")["collision_rate_exact"].is_null());
  const json empty = result("small.toml --set needles.count=0 --set until.time=1");
  for (const char* key : {"collisions_per_needle", "collision_rate", "us_per_collision"}) {
    EXPECT_TRUE(empty[key].is_null()) << key;
  }
}

TEST_F(RunCommand, EndsExactlyAtItsEnd) {
  EXPECT_EQ(result("small.toml --set until.time=1.2345")["time"], 1.2345);
  EXPECT_EQ(result("small.toml --set until.collisions_per_needle=3")["collisions"], 75);
  const json cooled = result("cooling.toml");
  EXPECT_EQ(cooled["stop"], "energy");
  const double ratio = cooled["energy"].get<double>() / cooled["energy_initial"].get<double>();
  EXPECT_LE(ratio, 0.05);
  EXPECT_GT(ratio, 0.0495);
}

TEST_F(RunCommand, SamplingDoesNotChangeTheTrajectory) {
  std::set<std::string> hashes;
  for (const char* sampling :
       {"", "--set output.series_per_decade=0.1", "--set output.series_per_decade=1000",
        "--out a.h5 --set output.frames=20 --set output.events=true",
        "--out b.h5 --set output.frames=[0.5,1,2]",
        "--out c.h5 --set output.series_every=0.1 "
        "--set \"output.observables=['fields','displacement','collision_statistics']\""}) {
    const json object = result(std::string("cooling.toml ") + sampling);
    hashes.insert(object["trajectory_hash"].get<std::string>() + object["time"].dump() +
                  object["energy"].dump());
  }
  EXPECT_EQ(hashes.size(), 1u);
}

TEST_F(RunCommand, TakesEverySearchAndItsSizesOnEveryInstructionSet) {
  std::set<std::string> hashes;
  const auto take = [&](const std::string& arguments, const std::string& search,
                        const std::string& isa) {
    const json object = result("small.toml " + arguments);
    EXPECT_EQ(object["search"], search) << arguments;
    EXPECT_EQ(object["isa"], isa) << arguments;
    hashes.insert(object["trajectory_hash"].get<std::string>());
    return object["stats"];
  };
  for (const std::string search : {"all-pairs", "linked-lists", "linked-cells", "capsules"}) {
    take("--isa scalar --set engine.search=" + search, search, "scalar");
  }
  for (const kernels::Isa available : kernels::available()) {
    const std::string isa(kernels::name_of(available));
    take("--isa " + isa + " --set engine.search=linked-cells", "linked-cells", isa);
    take("--set engine.search=capsules --set engine.isa=" + isa, "capsules", isa);
  }
  const std::string capsules = "--isa scalar --set engine.search=capsules ";
  const json thin = take(capsules + "--set engine.capsule_radius=0.05", "capsules", "scalar");
  const json thick = take(capsules + "--set engine.capsule_radius=1", "capsules", "scalar");
  EXPECT_GT(thin["rebuilds"].get<int>(), 2 * thick["rebuilds"].get<int>());
  const std::string cells = "--isa scalar --set engine.search=linked-cells ";
  const json narrow = take(cells + "--set engine.cell_side=0.5", "linked-cells", "scalar");
  const json wide = take(cells + "--set engine.cell_side=2.5", "linked-cells", "scalar");
  EXPECT_GT(narrow["crossings"].get<int>(), 2 * wide["crossings"].get<int>());
  EXPECT_EQ(hashes.size(), 1u);
}

TEST_F(RunCommand, TakesFlagOverSetOverScene) {
  write("thrice.toml", R"(needles = { count = 10, box = 5, seed = 1 }
engine = { threads = 2, isa = "avx512" }
until.time = 1
output.file = "scene.h5"
)");
  const std::string one_thread = "thrice.toml --set engine.threads=1 --set engine.isa=scalar ";
  EXPECT_EQ(result(one_thread)["file"], "scene.h5");
  EXPECT_EQ(result(one_thread + "--set output.file=set.h5")["file"], "set.h5");
  EXPECT_EQ(result(one_thread + "--set output.file=set2.h5 --out flag.h5")["file"], "flag.h5");
  EXPECT_FALSE(exists("set2.h5"));
  EXPECT_EQ(result("thrice.toml --out x.h5 --threads 1 --isa scalar")["threads"], 1);
  EXPECT_EQ(result(one_thread + "--out y.h5 --threads 2")["threads"], 2);
  EXPECT_EQ(result("small.toml --set needles.seed=8 --set needles.seed=9")["seed"], 9);
}

TEST_F(RunCommand, TakesTheEnvironmentLast) {
  EXPECT_EQ(result("small.toml", "OMP_NUM_THREADS=3")["threads"], 3);
  EXPECT_EQ(result("small.toml", "OMP_NUM_THREADS=3,2")["threads"], 3);
  EXPECT_EQ(result("small.toml", "OMP_NUM_THREADS=many")["threads"], 1);
  EXPECT_EQ(result("small.toml --set engine.threads=1", "OMP_NUM_THREADS=3")["threads"], 1);
  EXPECT_EQ(result("small.toml --set engine.queue=bucket", "OMP_NUM_THREADS=3")["threads"], 1);
  EXPECT_EQ(result("small.toml", "OMP_THREAD_LIMIT=2 OMP_NUM_THREADS=3")["threads"], 2);
  EXPECT_TRUE(run("run small.toml --quiet", "OMP_NUM_THREADS=1000")
                  .complains("warning: OMP_NUM_THREADS=1000: expected at most "));
  EXPECT_TRUE(run("run small.toml --threads 3", "OMP_THREAD_LIMIT=2")
                  .fails(3, "--threads 3: expected at most 2"));
  EXPECT_EQ(run("run small.toml", "NEEDLEWORK_ISA=bogus").exit_code, 3);
  EXPECT_EQ(result("small.toml", "NEEDLEWORK_ISA=scalar")["isa"], "scalar");
  EXPECT_EQ(result("small.toml --isa scalar", "NEEDLEWORK_ISA=bogus")["isa"], "scalar");
  EXPECT_EQ(result("small.toml --set engine.isa=scalar", "NEEDLEWORK_ISA=bogus")["isa"], "scalar");
}

TEST_F(RunCommand, RefusesAFileWithANeedleAcrossAWall) {
  ASSERT_EQ(run("run small.toml --quiet --out open.h5").exit_code, 0);
  write("walled.toml", R"(initial.file = "open.h5"
until.time = 1
walls = [{ axis = "z", side = "both" }]
)");
  for (const char* command : {"run walled.toml --quiet", "check walled.toml"}) {
    const Outcome outcome = run(command);
    EXPECT_TRUE(outcome.fails(3, "beyond the wall z-")) << command;
    EXPECT_TRUE(outcome.complains("expected both inside"));
  }
}

TEST_F(RunCommand, KeepsTheFirstAndTheLastFrame) {
  ASSERT_EQ(run("run small.toml --out two.h5").exit_code, 0);
  EXPECT_TRUE(contains(run("info two.h5").out, "2 frames"));
  ASSERT_EQ(run("run small.toml --out four.h5 --set output.frames=[0,1,2,1e9]").exit_code, 0);
  EXPECT_TRUE(contains(run("info four.h5").out, "4 frames"));
  const std::string at_rest = " --set initial.t_tr=0 --set initial.t_rot=0 --set until.time=0";
  ASSERT_EQ(run("run small.toml --out one.h5" + at_rest).exit_code, 0);
  EXPECT_TRUE(contains(run("info one.h5").out, "1 frame"));
}

TEST_F(RunCommand, GoesOnFromItsOwnFile) {
  write("next.toml", "[initial]\nfile = \"first.h5\"\n[until]\ncollisions_per_needle = 5\n");
  const json first = result("small.toml --out first.h5");
  const json next = result("next.toml");
  EXPECT_EQ(next["needles"], 50);
  EXPECT_EQ(next["collisions"], 125);
  EXPECT_NEAR(next["energy_initial"].get<double>(), first["energy"].get<double>(), 1e-14);
  EXPECT_TRUE(next["collision_rate_exact"].is_null());

  EXPECT_TRUE(run("run next.toml --set needles.count=49")
                  .fails(3, "--set needles.count=49: expected 50, as in first.h5"));
}

// By whatever name, and whatever --force says.
TEST_F(RunCommand, NeverReplacesWhatACommandReads) {
  ASSERT_EQ(run("run small.toml --out a.h5 --quiet").exit_code, 0);
  std::filesystem::create_symlink("a.h5", path("link.png"));
  write("next.toml", "initial.file = \"a.h5\"\nuntil.collisions_per_needle = 5\n");
  const std::string run_file = read("a.h5"), scene = read("next.toml");
  for (const char* command :
       {"run next.toml --out a.h5", "run next.toml --out link.png",
        "check next.toml --set "
        "output.file=a.h5",
        "run next.toml --out next.toml", "check next.toml --set output.file=next.toml",
        "check next.toml --set output.file=next.toml", "report a.h5 -o ./a.h5",
        "export a.h5 a.h5 --to xyz", "view a.h5 -o link.png"}) {
    const bool may_force = !std::string_view(command).starts_with("check");
    EXPECT_TRUE(run(std::string(command) + (may_force ? " --force" : ""))
                    .fails(5, " is read: expected another file"))
        << command;
    EXPECT_TRUE(read("a.h5") == run_file && read("next.toml") == scene) << command;
  }
}

TEST_F(RunCommand, SavesAndExitsWith75AtTheLimitOfWallTime) {
  const Outcome outcome = run("run endless.toml --json --out wall.h5 --set until.wall_s=0.5");
  EXPECT_TRUE(outcome.fails(75, "saved in wall.h5"));
  EXPECT_EQ(outcome.json()["stop"], "wall_time");
  EXPECT_GE(outcome.json()["total_s"].get<double>(), 0.5);
  EXPECT_EQ(io::read_last_frame(path("wall.h5")).size(), 500u);
}

// Inelastic pairs collapse sooner or later; without the t_c rule no correct run goes past that.
TEST_F(RunCommand, SavesAndExitsWith4WhenItCannotGoOnCorrectly) {
  const Outcome outcome =
      run("run small.toml --json --out end.h5 --set needles.count=200 --set needles.box=6 "
          "--set collisions.epsilon=0.5 --set until.collisions_per_needle=10000");
  EXPECT_EQ(outcome.exit_code, 4);
  EXPECT_TRUE(contains(outcome.err, "collapse of needles "));
  EXPECT_EQ(outcome.json()["stop"], "invalid_state");
  EXPECT_EQ(io::read_last_frame(path("end.h5")).size(), 200u);
}

TEST_F(RunCommand, IsSilentWhenQuietButForErrorsAndWarnings) {
  const Outcome quiet = run("run small.toml --quiet");
  EXPECT_EQ(quiet.exit_code, 0);
  EXPECT_EQ(quiet.out + quiet.err, "");
  const Outcome warned = run("run small.toml --quiet --set needles.k=1");
  EXPECT_EQ(warned.out, "");
  EXPECT_TRUE(warned.complains("needlework: warning: needles.k = 1: "));
}

// A word for the shell that leaves the program one of the processors that this one may use.
std::string on_one_processor() {
  cpu_set_t allowed;
  CPU_ZERO(&allowed);
  sched_getaffinity(0, sizeof allowed, &allowed);
  int first = 0;
  while (first < CPU_SETSIZE && !CPU_ISSET(first, &allowed)) ++first;
  return "taskset -c " + std::to_string(first);
}

// The placement of threads by the runtime and the system changes no bit, and threads that share a
// processor make progress, because a waiting thread soon yields.
TEST_F(RunCommand, RunsWhereverItsThreadsAreBound) {
  const std::string gas = "small.toml --set needles.count=1000 --set needles.box=9 --threads ";
  const json one = result(gas + '1');
  for (const std::string& before :
       {on_one_processor(), "OMP_PROC_BIND=true " + on_one_processor(),
        std::string("OMP_PROC_BIND=close OMP_PLACES=cores"), std::string("OMP_PROC_BIND=spread"),
        std::string("OMP_PROC_BIND=primary"), std::string("OMP_WAIT_POLICY=active")}) {
    for (const char* threads : {"2", "5"}) {
      SCOPED_TRACE(before);
      const json several = result(gas + threads, before);
      EXPECT_EQ(several["threads"], std::stoi(threads));
      EXPECT_EQ(several["queue"], "cell-calendar");
      EXPECT_GT(several["stats"]["phases"], 0);
      EXPECT_EQ(several["trajectory_hash"], one["trajectory_hash"]);
    }
  }
}

TEST_F(RunCommand, ReportsWhatThreadsDid) {
  const std::string more = "small.toml --set needles.count=1000 --set needles.box=8 ";
  const std::string few = "small.toml --set needles.count=20 --set needles.box=4 ";
  EXPECT_TRUE(contains(run("run " + more + "--threads 2").out, " events between stalls, blocked "));
  EXPECT_TRUE(contains(run("run " + few + "--threads 2").out, "2; one did all"));
  EXPECT_FALSE(contains(run("run " + more + "--threads 1").out, "threads"));
}

TEST_F(RunCommand, SumsUpInPlainWords) {
  const Outcome cooling = run("run cooling.toml --out c.h5");
  EXPECT_TRUE(contains(
      cooling.out,
      {"Cooling gas\n", "200 needles", "ran to its energy", "E/E(0) = 0.0", "measured/theory",
       "course        time      E/E(0)      theory      T_tr/T_rot  theory\n",
       "\n                1         0.", "\n                10        0.", "T_tr/T_rot", "t_c rule",
       "us per collision", "c.h5"}));
  const Outcome elastic = run("run small.toml");
  EXPECT_TRUE(contains(elastic.out, {"Small gas\n", "250, 10 per needle", "exact 0.4886", " +- "}));
}

TEST_F(RunCommand, DrawsOneLineOfProgressOnATerminal_long) {
  if (shell("script -qec true screen").exit_code != 0)
    GTEST_SKIP() << "no terminal can be had here";
  shell_and_signal("script -qefc \"'" NEEDLEWORK_PROGRAM "' run endless.toml --json\" screen",
                   "grep ' % done, ' screen", "TERM");
  const std::string screen = read("screen");
  EXPECT_TRUE(contains(screen, {"\r", " % done, "}));
  EXPECT_FALSE(contains(screen, "\033"));
}

TEST_F(RunCommand, DrawsChartsOnATerminalIfWatched) {
  if (shell("script -qec true screen").exit_code != 0)
    GTEST_SKIP() << "no terminal can be had here";
  const auto screen_of = [&](const std::string& arguments, const std::string& variables) {
    const std::string command =
        "stty cols 100 rows 30; '" NEEDLEWORK_PROGRAM "' " + arguments + " --watch";
    const std::string terminal = "TERM=xterm " + variables + " script -qec \"" + command;
    EXPECT_EQ(shell(terminal + "\" screen").exit_code, 0);
    return read("screen");
  };
  const std::string charts = "run cooling.toml --out c.h5 --force";
  const std::string screen = screen_of(charts, "NO_COLOR=");
  EXPECT_TRUE(
      contains(screen, {"E/E(0)", "T_tr/T_rot", "┤", "\033[33mo\033[0m", "measured/theory"}));
  const std::string plain = screen_of(charts, "NO_COLOR=1");
  EXPECT_TRUE(contains(plain, "┤"));
  EXPECT_FALSE(contains(plain, "\033[3"));

  // A run that is continued brings its samples along: the energy starts from E(0) nevertheless.
  const std::string more = "resume c.h5 --set until.energy_ratio=1e-3";
  const std::string continued = screen_of(more, "NO_COLOR=1");
  EXPECT_TRUE(contains(continued, "1┤o"));
}

TEST_F(RunCommand, WatchesOnATerminalOnly) {
  for (const char* before : {"TERM=xterm", "TERM=dumb", "TERM="}) {
    EXPECT_TRUE(run("run small.toml --watch --out a.h5", before)
                    .fails(2, "--watch expected a terminal on standard error"));
  }
  EXPECT_FALSE(exists("a.h5"));
  EXPECT_TRUE(run("run small.toml --watch --quiet").fails(2, "--watch"));
}

// In JSON and in the summary, also through resume; and not where nothing but needles exchanges it.
TEST_F(RunCommand, SaysWhereTheEnergyHasComeFrom) {
  write("shaken.toml",
        "needles = { count = 60, box = 4 }\ncollisions = { epsilon = 0.8, tc_relative = 1e-3 }\n"
        "forces.gravity = [0, 0, -1]\ndriving.kicks = { every = 0.3, translational = 1, "
        "rotational = 0 }\nuntil.time = 2\n[[walls]]\naxis = 'z'\nside = 'low'\n"
        "motion = { amplitude = 0.1, frequency = 1 }\n");
  const auto result = run("run shaken.toml --json --quiet --out shaken.h5").json();
  const auto resumed = run("resume shaken.h5 --json --quiet --set until.time=3").json();
  const auto longer = run("run shaken.toml --json --quiet --set until.time=3").json();
  for (const auto& json : {result, resumed}) {
    const auto& budget = json["energy_budget"];
    EXPECT_EQ(budget.size(), 4u) << budget;
    double sum = 0;
    for (const char* name : {"pairs", "kicks", "velocities_set"}) sum += budget[name].get<double>();
    ASSERT_EQ(budget["walls"].size(), 1u);
    sum += budget["walls"][0].get<double>();
    EXPECT_LT(budget["pairs"], 0);
    EXPECT_EQ(budget["velocities_set"], 0);
    EXPECT_NEAR(sum, json["energy"].get<double>() - json["energy_initial"].get<double>(), 1e-12);
    const auto& wall = json["walls"][0];
    EXPECT_NEAR(wall["pressure"].get<double>(),
                wall["impulse"].get<double>() / (16 * json["time"].get<double>()), 1e-12);
  }
  EXPECT_EQ(resumed["energy_budget"], longer["energy_budget"]);
  const std::string summary = run("run shaken.toml").out;
  EXPECT_TRUE(contains(summary, {"pressure", "energy from", "pairs -", "wall z low ", "kicks +"}));
  EXPECT_FALSE(contains(summary, "velocities_set"));
  EXPECT_FALSE(run(std::string("run ") + small + " --json").json().contains("energy_budget"));
  EXPECT_FALSE(contains(run(std::string("run ") + small).out, "energy from"));
}

}  // namespace
}  // namespace needlework
