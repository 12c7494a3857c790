// What `needlework check` and `needlework info` print.
#include <string>

#include "needlework/h5md.h"
#include "needlework/initial_state.h"
#include "needlework/theory.h"
#include "tests/cli/described_keys.h"
#include "tests/cli/program.h"

namespace needlework {
namespace {

using CheckCommand = ProgramTest;

const std::string piston = R"(needles = { count = 300, box = [10, 10, 2.5] }
until.collisions_per_needle = 10
[[walls]]
axis = "z"
side = "low"
epsilon = 0.5
motion = { velocity = 1 }
[[walls]]
axis = "z"
side = "high"
motion = { velocity = 0.5, stop_at = 3 }
)";

TEST_F(CheckCommand, ExplainsAScene) {
  EXPECT_TRUE(contains(output_of("check small.toml --set collisions.tc_relative=1e-3"),
                       {"Small gas\n", "50, k = 6, uniform rods", "elastic (epsilon = 1)",
                        "0.001 of the present mean free time", "collisions_per_needle = 10",
                        "250 collisions", "memory", "wall time"}));
}

TEST_F(CheckCommand, PrintsOneJsonObject) {
  const Outcome outcome = run("check small.toml --json");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.err, "");
  const auto json = outcome.json();
  EXPECT_EQ(json["needles"], 50);
  EXPECT_DOUBLE_EQ(json["density"].get<double>(), 0.4);
  EXPECT_DOUBLE_EQ(json["mean_free_time"].get<double>(),
                   1 / theory::collision_rate(0.4, {1, 1}, 6));
  EXPECT_NEAR(json["expected"]["collisions"].get<double>(), 250, 1e-6);
  EXPECT_EQ(json["expected"]["stop"], "collisions_per_needle");
  EXPECT_TRUE(json["tc"].is_null());
  EXPECT_GT(json["memory_bytes"].get<double>(), 0);
}

// The keys of all kinds of scenes together.
TEST_F(CheckCommand, PrintsWhatItsDocumentDescribes) {
  write("driven.toml", R"(needles = { box = 5 }
until.time = 1
collisions = { epsilon = 0.5, sliding = true }
forces.gravity = [0, 0, -1]
driving.kicks = { every = 0.1, translational = 2 }
species = [{ name = "a", count = 5 }, { name = "b", count = 5, length = 0.5 }]
walls = [{ axis = "z", side = "both" }]
)");
  auto object = run("check small.toml --json").json();
  object.update(run("check driven.toml --json").json());
  object.update(run("check small.toml --json --set needles.diameter=0.1").json());
  write("piston.toml", piston);
  object.update(run("check piston.toml --json").json());
  object.update(run("check small.toml --json --set shear.rate=0.1").json());
  EXPECT_EQ(keys_of(object), sorted(described_keys("json.md")["Scene explained by check"]));
}

// n = 300 / (100 (2.5 - 1/2)), and the low wall comes towards the gas at the thermal speed. At time
// 1 the high one stops at 3; at time 2 one length is left of the box.
TEST_F(CheckCommand, TellsWhatPistonsDoAtTheStartAndWhenTheyMeet) {
  write("piston.toml", piston);
  auto json = json_of("check piston.toml --json");
  EXPECT_NEAR(json["walls"][0]["hits_per_time"].get<double>(), 150 * 1.29851, 1e-2);
  EXPECT_NEAR(json["walls"][0]["force"].get<double>(), 0.75 * 150 * 2.40987, 1e-2);
  EXPECT_NEAR(json["walls"][1]["force"].get<double>(), 150 * 0.60438, 1e-2);
  EXPECT_TRUE(json["walls"][0]["stop_time"].is_null());
  EXPECT_EQ(json["walls"][1]["stop_time"], 1);
  EXPECT_EQ(json["moving_walls"]["meet"], nlohmann::json({{"axis", "z"}, {"time", 2}}));
  EXPECT_EQ(json["moving_walls"]["time"], 2);
  EXPECT_NEAR(json["moving_walls"]["volume"].get<double>(), 100, 1e-10);
  EXPECT_TRUE(json["expected"].is_null());
  EXPECT_TRUE(contains(output_of("check piston.toml"),
                       {"moves at 1 along z; at the start", "until it stops at 3, at time 1",
                        "at time 2: 3 needles per unit of volume; then the walls along z leave no "
                        "more room, and the run ends"}));
  json = json_of("check piston.toml --json --set until.time=1.5");
  EXPECT_EQ(json["moving_walls"]["time"], 1.5);
  EXPECT_NEAR(json["moving_walls"]["volume"].get<double>(), 150, 1e-10);
  EXPECT_TRUE(contains(output_of("check piston.toml --set until.time=1.5"),
                       {"at time 1.5: 2 needles per unit of volume\n"}));
  // Without an end nothing is said of it.
  const std::string apart = "check piston.toml --json --set walls.z-low.motion.velocity=-1";
  EXPECT_TRUE(json_of(apart)["moving_walls"]["time"].is_null());
}

// A thermal wall that slides is hit as others are, and by how much is drawn.
TEST_F(CheckCommand, KnowsTheHitsOnWallsThatSlide) {
  write("couette.toml", R"(needles = { count = 1000, box = [10, 10, 2] }
until.time = 1
walls = [{ axis = "z", side = "both", temperature = 1, motion = { tangential = [1, 0] } }]
)");
  const auto json = json_of("check couette.toml --json");
  EXPECT_NEAR(json["walls"][0]["hits_per_time"].get<double>(), 454.6, 0.05);
  EXPECT_TRUE(json["walls"][0]["force"].is_null());
  EXPECT_EQ(json["walls"][0]["motion"], nlohmann::json({{"tangential", {1, 0}}}));
  EXPECT_FALSE(json.contains("moving_walls"));
}

TEST_F(CheckCommand, ExplainsWallsAndDriving) {
  // Per needle and time 0.4546 hits of each wall and a force of 2/3 between walls 2 apart.
  write("walls.toml", R"(needles = { count = 1000, box = [10, 10, 2] }
until.time = 1
driving.kicks = { every = 0.1, translational = 2 }
driving.andersen = { rate = 0.5, temperature = 3 }
walls = [{ axis = "z", side = "both" }]
)");
  const auto json = json_of("check walls.toml --json");
  ASSERT_EQ(json["walls"].size(), 2u);
  EXPECT_EQ(json["walls"][1]["side"], "high");
  EXPECT_NEAR(json["walls"][0]["hits_per_time"].get<double>(), 454.6, 0.05);
  EXPECT_NEAR(json["walls"][0]["force"].get<double>(), 2000.0 / 3, 1e-6);
  EXPECT_NEAR(json["driving"]["kicks"]["energy_per_needle_and_time"].get<double>(), 6 * 0.999,
              1e-9);
  EXPECT_EQ(json["driving"]["andersen"]["temperature"], 3);
  EXPECT_TRUE(json["expected"].is_null());
  // H (H - delta) / (H - 1/2)^2 of the rate without walls.
  EXPECT_NEAR(json["mean_free_time"].get<double>(), 1 / (1.237662 * 5 * 2 * (2 - 0.753889) / 2.25),
              1e-5);
  const Outcome text = run("check walls.toml");
  EXPECT_TRUE(contains(text.out, {"z-low: elastic (epsilon = 1); at the start 454.6 hits per time",
                                  "thermostat at temperature 3"}));
}

TEST_F(CheckCommand, ExplainsGravity) {
  write("falling.toml", R"(needles = { box = [10, 10, 6] }
until.time = 1
forces.gravity = [0, 0, -0.5]
species = [{ name = "light", count = 10, t_rot = 2 },
           { name = "heavy", count = 20, mass = 3, t_rot = 2 }]
walls = [{ axis = "z", side = "low" }]
)");
  const auto json = run("check falling.toml --json").json();
  ASSERT_EQ(json["falling"].size(), 1u);
  EXPECT_EQ(json["falling"][0]["axis"], "z");
  EXPECT_NEAR(json["falling"][0]["weight"].get<double>(), 0.5 * (10 + 20 * 3), 1e-12);
  EXPECT_NEAR(json["falling"][0]["scale_heights"][0].get<double>(), 1.4 / 0.5, 1e-12);
  EXPECT_NEAR(json["falling"][0]["scale_heights"][1].get<double>(), 1.4 / 1.5, 1e-12);
  const Outcome text = run("check falling.toml");
  EXPECT_TRUE(
      contains(text.out, "along z: weight N m g = 35, scale height T / (m g) = 2.8, 0.9333"));
}

TEST_F(CheckCommand, KnowsTheRatesOfMixturesBetweenNearWalls) {
  write("near.toml", R"(needles.box = [10, 10, 1.3]
until.time = 1
species = [{ name = "short", count = 100, length = 0.6 },
           { name = "long", count = 50, length = 1.1 }]
walls = [{ axis = "z", side = "both" }]
)");
  const auto walled = run("check near.toml --json").json();
  ASSERT_TRUE(walled.contains("pairs"));
  Species small, large;
  small.length = 0.6;
  large.length = 1.1;
  small.count = 100;
  large.count = 50;
  const Composition both({small, large}, {});
  const std::vector<theory::Temperatures> warm(2, {1, 1});
  const double open = theory::mixture_rates(both, 130, warm).collisions[both.pair_index(0, 1)];
  EXPECT_NEAR(walled["pairs"]["short-long"]["collisions_per_time"].get<double>(),
              open * theory::pair_factor_between_walls(small, warm[0], large, warm[1], 1.3),
              1e-9 * open);
}

TEST_F(CheckCommand, SaysWhatLimitsCores) {
  const std::string large = "check small.toml --set needles.count=9000 --set needles.box=30 ";
  const auto json = run(large + "--threads auto --json", "SLURM_CPUS_PER_TASK=1").json();
  EXPECT_EQ(json["threads"], 1);
  EXPECT_EQ(json["cores"]["usable"], 1);
  EXPECT_EQ(json["cores"]["slurm_cpus_per_task"], 1);
  EXPECT_GE(json["cores"]["online"], json["cores"]["affinity"]);
  if (json["cores"]["online"] > 1) {
    EXPECT_TRUE(contains(run(large, "SLURM_CPUS_PER_TASK=1").out, "SLURM_CPUS_PER_TASK=1\n"));
  }
  EXPECT_TRUE(run("check small.toml --json").json()["cores"]["slurm_cpus_per_task"].is_null());
}

// With files in the place of those that a container has.
TEST_F(CheckCommand, RespectsTheCpuQuotaOfAContainer) {
  const std::string in_container =
      "unshare -m sh -c 'mount --bind \"$0\" /sys/fs/cgroup && exec \"$@\"' " + path("groups");
  std::filesystem::create_directory(path("groups"));
  write("groups/cpu.max", "150000 100000\n");
  if (shell(in_container + " true").exit_code != 0) GTEST_SKIP() << "no right to mount";
  const std::string large =
      "small.toml --threads auto --set needles.count=9000 --set needles.box=30 --json ";
  const auto json = run("check " + large, in_container).json();
  EXPECT_EQ(json["cores"]["quota"], 1.5);
  EXPECT_EQ(json["cores"]["quota_file"], "/sys/fs/cgroup/cpu.max");
  EXPECT_EQ(json["cores"]["usable"], 1);
  EXPECT_EQ(json["threads"], 1);
  const auto ran = run("run " + large + "--set until.collisions_per_needle=0.1", in_container);
  EXPECT_EQ(ran.json()["threads"], 1) << ran.err;
}

// In the wrong unit, say.
TEST_F(CheckCommand, WarnsOfAContactTimeBeyondTheMeanFreeTime) {
  const std::string cooling = "check small.toml --set collisions.epsilon=0.9 --set collisions.tc=";
  EXPECT_TRUE(run(cooling + "100").complains("warning: --set collisions.tc=100: is "));
  EXPECT_TRUE(run(cooling + "100").complains("mean free times at the start: a large part of all"));
  EXPECT_EQ(run(cooling + "0.05").err, "");
}

TEST_F(CheckCommand, KnowsWhatRoomThereIsForRods) {
  const std::string spheres = R"(until.time = 1
species = [{ name = "spheres", count = 864, length = 0, diameter = 1 }]
)";
  write("spheres.toml", "needles.box = 8.6\n" + spheres);
  const auto json = run("check spheres.toml --json").json();
  EXPECT_EQ(json["placing"]["method"], "lattice");
  EXPECT_EQ(json["placing"]["collisions_per_rod"], 400);
  EXPECT_GT(json["placing"]["wall_s"].get<double>(), 0.1);
  EXPECT_GT(json["expected"]["wall_s"].get<double>(), json["placing"]["wall_s"].get<double>());
  const auto dilute = run("check spheres.toml --json --set needles.box=20").json();
  EXPECT_EQ(dilute["placing"]["method"], "insertion");
  EXPECT_NEAR(dilute["placing"]["tries_per_rod"].get<double>(), 1.29, 0.02);
  EXPECT_TRUE(
      contains(run("check spheres.toml").out, "on a lattice, then 400 elastic collisions each"));
  for (const char* command : {"check", "run"}) {
    const Outcome refused = run(command + std::string(" spheres.toml --set needles.box=5.6"));
    EXPECT_EQ(refused.exit_code, 3);
    EXPECT_TRUE(
        contains(refused.err, "864 spheres take up 2.576 of it, and no packing more than 0.7405"));
  }
  EXPECT_FALSE(run("check small.toml --json").json().contains("placing"));
}

TEST_F(CheckCommand, CountsBodiesInCubesOfTheirExtentsWithCaps) {
  write("rods.toml", "needles = { count = 100, box = 11, diameter = 0.1 }\nuntil.time = 1\n");
  EXPECT_TRUE(contains(run("check rods.toml").out, ", 0.1 needles per cube of their extent\n"));
  write("mixture.toml",
        "needles.box = 11\nuntil.time = 1\nspecies = [{ name = \"rods\", count = 50, length = 1, "
        "diameter = 0.1 }, { name = \"needles\", count = 50, length = 1 }]\n");
  EXPECT_TRUE(
      contains(run("check mixture.toml").out, ", 0.1 needles per cube of the longest extent\n"));
}

TEST_F(CheckCommand, RefusesAStateThatRunRefuses) {
  Scene scene;
  scene.needles.count = 2;
  scene.needles.box = {5, 5, 5};
  State state = draw_initial_state(scene);
  state.id = {0, 1};
  const auto refused = [&](const char* command) {
    io::Writer writer(path("state.h5"), true, scene, {.isa = "scalar", .epoch_length = 1});
    writer.write_frame({}, state);
    writer.close();
    write("from.toml", "initial.file = 'state.h5'\nuntil.time = 1\n");
    const Outcome outcome = run(std::string(command) + " from.toml");
    EXPECT_EQ(outcome.exit_code, 3) << command;
    return outcome.err;
  };
  state.position[1][0] = 1e15;
  EXPECT_TRUE(contains(refused("check"), "needle 1: position 1000000000000000 in a box of 5"));
  EXPECT_EQ(refused("check"), refused("run"));
  state.position[1][0] = 1;
  state.velocity[1][0] = 1e150;
  EXPECT_TRUE(contains(refused("check"), "an energy of 5e+299: expected at most"));
  EXPECT_EQ(refused("check"), refused("run"));
}

TEST_F(CheckCommand, WarnsOfADriftThatAStateWithoutAFlowHasInOne) {
  write("still.toml",
        "needles = { count = 50, box = 5 }\nuntil.time = 0\noutput.file = 'still.h5'\n");
  ASSERT_EQ(run("run still.toml").exit_code, 0);
  write("on.toml", "initial.file = 'still.h5'\nuntil.time = 1\n");
  const std::string drift = "still.h5': says no flow";
  EXPECT_FALSE(contains(run("check on.toml").err, drift));
  EXPECT_TRUE(contains(run("check on.toml --set shear.rate=1").err, drift));
  EXPECT_FALSE(contains(run("check on.toml --set shear.rate=1e-3").err, drift));
  // It does not stay beside a thermostat.
  EXPECT_FALSE(contains(
      run("check on.toml --set shear.rate=1 --set driving.andersen={rate=1,temperature=1}").err,
      drift));
}

TEST_F(CheckCommand, SaysWhenAnEndIsOutOfReach) {
  const std::string at_rest = "check small.toml --json --set initial.t_tr=0 --set initial.t_rot=0";
  EXPECT_TRUE(run(at_rest).fails(3, "nothing can ever happen, as all needles move alike"));
  EXPECT_TRUE(run(at_rest + " --set until.time=1").json()["mean_free_time"].is_null());
  const auto json =
      run("check small.toml --json --set until.collisions_per_needle=none --set until.wall_s=1")
          .json();
  EXPECT_TRUE(json["expected"].is_null());
}

TEST_F(CheckCommand, ExplainsAnEmptyBox) {
  const std::string empty = "check small.toml --set needles.count=0 --set until.time=1";
  EXPECT_EQ(run(empty + " --json").json()["expected"]["wall_s"], 0);
}

TEST_F(CheckCommand, WritesNothing) {
  EXPECT_EQ(run("check small.toml --set output.file=a.h5").exit_code, 0);
  EXPECT_EQ(files(), std::vector<std::string>{small});
}

TEST_F(CheckCommand, AcceptsAllProfiles) {
  for (const auto& entry : std::filesystem::directory_iterator(NEEDLEWORK_SOURCE "/profiles")) {
    if (entry.path().filename().string().starts_with("sweep-")) continue;  // a grid, no scene
    if (entry.is_directory()) continue;
    const Outcome outcome = run("check '" + entry.path().string() + "'");
    EXPECT_EQ(outcome.exit_code, 0) << entry.path() << "\n" << outcome.err;
    EXPECT_EQ(outcome.err, "") << entry.path();
  }
}

// Peaks at the end of setting up, so the run itself can be short.
TEST_F(CheckCommand, EstimatesTheMemoryOfALargeRun) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers take several times the memory";
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
  GTEST_SKIP() << "sanitizers take several times the memory";
#endif
#endif
  const std::string large =
      " small.toml --json --set needles.count=100000 --set until.collisions_per_needle=0.1"
      " --set needles.box=";
  for (const std::string more : {"51.8", "22.3", "51.8 --set output.file=a.h5"}) {
    const auto estimate = run("check" + large + more).json();
    const auto taken = run("run" + large + more).json();
    const double ratio =
        estimate["memory_bytes"].get<double>() / taken["peak_rss_bytes"].get<double>();
    EXPECT_GT(ratio, 1 / 1.5) << more;
    EXPECT_LT(ratio, 1.5) << more;
  }
}

// Fast enough for a million collisions to take seconds, slow enough to be true.
TEST_F(CheckCommand, EstimatesTheTimeOfARun) {
  const std::string scene =
      "check small.toml --json --set needles.count=20000 --set until.collisions_per_needle=100";
  const auto seconds = [&](const std::string& more) {
    return run(scene + more).json()["expected"]["wall_s"].get<double>();
  };
  for (const std::string box : {" --set needles.box=12", " --set needles.box=30"}) {
    EXPECT_GT(seconds(box), 3) << box;
    EXPECT_LT(seconds(box), 30) << box;
    EXPECT_GT(seconds(box + " --isa scalar"), seconds(box));
    EXPECT_GT(seconds(box + " --set engine.search=linked-lists"), 2 * seconds(box)) << box;
  }
}

}  // namespace
}  // namespace needlework
