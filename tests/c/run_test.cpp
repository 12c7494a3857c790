// Runs through C are the runs of the program, in one piece or in many.
#include "tests/c/c_simulation.h"
#include "tests/cli/program.h"
#include "tests/support/contains.h"

namespace needlework {
namespace {

using test::cooling;
using test::CSimulation;

class CRun : public ProgramTest {};

TEST_F(CRun, HasTheHashOfTheProgram) {
  const std::string scene = NEEDLEWORK_SOURCE "/profiles/quickstart.toml";
  const Outcome program =
      run("run '" + scene + "' --json --quiet --set until.collisions_per_needle=10");
  ASSERT_EQ(program.exit_code, 0) << program.err;
  needlework_error error;
  needlework_simulation* simulation = needlework_open(scene.c_str(), 0, &error);
  ASSERT_NE(simulation, nullptr) << error.message;
  EXPECT_EQ(error.code, NEEDLEWORK_OK);
  EXPECT_STREQ(error.message, "");
  EXPECT_EQ(needlework_count(simulation), 2000u);
  needlework_limits limits{};
  limits.collisions_per_needle = 10;
  int stop = -1;
  EXPECT_EQ(needlework_run_until(simulation, &limits, &stop), NEEDLEWORK_OK);
  EXPECT_EQ(stop, NEEDLEWORK_STOP_COLLISIONS);
  char hash[33];
  EXPECT_EQ(needlework_get_hash(simulation, hash), NEEDLEWORK_OK);
  EXPECT_EQ(hash, program.json()["trajectory_hash"]);
  needlework_totals totals;
  EXPECT_EQ(needlework_get_totals(simulation, &totals), NEEDLEWORK_OK);
  EXPECT_EQ(totals.collisions, program.json()["collisions"]);
  EXPECT_EQ(totals.tc_collisions, program.json()["tc_collisions"]);
  EXPECT_EQ(totals.time, program.json()["time"]);
  EXPECT_EQ(totals.energy, program.json()["energy"]);
  EXPECT_EQ(totals.initial_energy, program.json()["energy_initial"]);
  needlework_destroy(simulation);
}

TEST_F(CRun, HasTheSameHashInPiecesFromTheStartAndFromNow) {
  const CSimulation whole(cooling), from_start(cooling), from_now(cooling);
  whole.run_to(300);
  for (std::uint64_t n = 7; n < 300; n += 7) from_start.run_to(n);
  from_start.run_to(300);
  EXPECT_EQ(from_start.hash(), whole.hash());

  needlework_limits limits{};
  limits.collisions = 50;
  for (int piece = 0; piece < 6; ++piece) {
    EXPECT_EQ(needlework_advance(from_now, &limits, nullptr), NEEDLEWORK_OK);
  }
  EXPECT_EQ(from_now.hash(), whole.hash());
  EXPECT_EQ(from_now.totals().collisions, 300u);
}

TEST_F(CRun, StopsAtEachLimitFromTheStartAndFromNow) {
  const CSimulation simulation(cooling);
  int stop = -1;
  const auto run_until = [&](const needlework_limits& limits) {
    EXPECT_EQ(needlework_run_until(simulation, &limits, &stop), NEEDLEWORK_OK);
    return stop;
  };
  const auto advance = [&](const needlework_limits& limits) {
    EXPECT_EQ(needlework_advance(simulation, &limits, &stop), NEEDLEWORK_OK);
    return stop;
  };
  EXPECT_EQ(run_until({0.5, 0, 0, 0, 0}), NEEDLEWORK_STOP_TIME);
  EXPECT_EQ(simulation.totals().time, 0.5);
  EXPECT_EQ(advance({0.25, 0, 0, 0, 0}), NEEDLEWORK_STOP_TIME);
  EXPECT_NEAR(simulation.totals().time, 0.75, 1e-12);
  EXPECT_EQ(run_until({0.5, 0, 0, 0, 0}), NEEDLEWORK_STOP_TIME);  // is past already
  EXPECT_NEAR(simulation.totals().time, 0.75, 1e-12);

  EXPECT_EQ(run_until({0, 0, 4, 0, 0}), NEEDLEWORK_STOP_COLLISIONS);
  EXPECT_EQ(simulation.totals().collisions, 120u);
  EXPECT_EQ(advance({0, 0, 1, 0, 0}), NEEDLEWORK_STOP_COLLISIONS);
  EXPECT_EQ(simulation.totals().collisions, 150u);
  EXPECT_EQ(advance({0, 1, 1, 0, 0}), NEEDLEWORK_STOP_COLLISIONS);  // the first one met
  EXPECT_EQ(simulation.totals().collisions, 151u);

  const double energy = simulation.totals().energy;
  EXPECT_EQ(advance({0, 0, 0, 0.9, 0}), NEEDLEWORK_STOP_ENERGY);
  EXPECT_LE(simulation.totals().energy, 0.9 * energy);
  EXPECT_GT(simulation.totals().energy, 0.8 * energy);
  EXPECT_EQ(run_until({0, 0, 0, 0.1, 0}), NEEDLEWORK_STOP_ENERGY);
  EXPECT_LE(simulation.totals().energy, 0.1 * simulation.totals().initial_energy);
  EXPECT_EQ(run_until({0, 0, 0, 0, 1e-9}), NEEDLEWORK_STOP_WALL_TIME);
}

TEST_F(CRun, EndsAsTheSceneSaysWithoutLimits) {
  const CSimulation simulation(cooling + "until.collisions_per_needle = 2\n");
  int stop = -1;
  EXPECT_EQ(needlework_run_until(simulation, nullptr, &stop), NEEDLEWORK_OK);
  EXPECT_EQ(stop, NEEDLEWORK_STOP_COLLISIONS);
  EXPECT_EQ(simulation.totals().collisions, 60u);

  const CSimulation endless(cooling);
  EXPECT_EQ(needlework_run_until(endless, nullptr, nullptr), NEEDLEWORK_USAGE);
  EXPECT_EQ(endless.message(), "limits is NULL: expected limits, as the scene has no [until]");

  // No share of the energy at the start, which was none, is ever reached.
  const CSimulation still(cooling +
                          "until.energy_ratio = 0.5\ninitial = { t_tr = 0, t_rot = 0 }\n");
  std::vector<double> moving(3 * needlework_count(still), 0.5);
  moving[0] = -1;
  const needlework_const_vectors velocity{moving.data(), 0, 0};
  ASSERT_EQ(needlework_set_velocities(still, &velocity, nullptr), NEEDLEWORK_OK);
  EXPECT_EQ(needlework_run_until(still, nullptr, nullptr), NEEDLEWORK_USAGE);
  EXPECT_TRUE(test::contains(still.message(), "expected another limit, as the gas was at rest"));
}

TEST_F(CRun, OfNoNeedlesOrOneHasNothingToDo) {
  for (const char* count : {"0", "1"}) {
    const CSimulation simulation(std::string("needles = { count = ") + count + ", box = 5 }\n");
    int stop = -1;
    for (const needlework_limits& limits :
         {needlework_limits{0, 5, 0, 0, 0}, {0, 0, 1, 0, 0}, {0, 0, 0, 0.5, 0}}) {
      EXPECT_EQ(needlework_advance(simulation, &limits, &stop), NEEDLEWORK_OK);
      EXPECT_EQ(stop, NEEDLEWORK_STOP_NOTHING_CAN_HAPPEN);
      EXPECT_EQ(needlework_run_until(simulation, &limits, &stop), NEEDLEWORK_OK);
      EXPECT_EQ(stop, NEEDLEWORK_STOP_NOTHING_CAN_HAPPEN);
    }
    const needlework_limits time{2, 0, 0, 0, 0};
    EXPECT_EQ(needlework_advance(simulation, &time, &stop), NEEDLEWORK_OK);
    EXPECT_EQ(stop, NEEDLEWORK_STOP_TIME);
    EXPECT_EQ(simulation.totals().time, 2);
    EXPECT_EQ(simulation.hash(), std::string(32, '0'));
  }
}

TEST_F(CRun, SaysWhichNeedlesCollapsed) {
  // Without the t_c rule, and with so much loss, some pair comes to rest on each other.
  const CSimulation simulation(
      "needles = { count = 60, box = 5 }\ncollisions.epsilon = 0.1\nengine.threads = 1\n");
  needlework_limits limits{};
  limits.collisions_per_needle = 1000;
  int stop = 99;
  EXPECT_EQ(needlework_run_until(simulation, &limits, &stop), NEEDLEWORK_INVALID_STATE);
  EXPECT_EQ(stop, 99) << "is written on success only";
  EXPECT_TRUE(simulation.message().starts_with("collapse of needles ")) << simulation.message();
  EXPECT_GT(simulation.totals().collisions, 0u);
  EXPECT_EQ(needlework_run_until(simulation, &limits, &stop), NEEDLEWORK_INVALID_STATE);
}

TEST_F(CRun, TellsSettingsAndCounters) {
  const CSimulation simulation(cooling + "engine.isa = \"scalar\"\n");
  simulation.run_to(20);
  EXPECT_STREQ(needlework_setting(simulation, "isa"), "scalar");
  EXPECT_STREQ(needlework_setting(simulation, "effects"), "inelastic tc");
  EXPECT_STRNE(needlework_setting(simulation, "search"), "auto");
  EXPECT_STRNE(needlework_setting(simulation, "queue"), "auto");
  std::size_t names = 0;
  for (; const char* name = needlework_counter_name(names); ++names) {
    std::uint64_t value = 0;
    EXPECT_EQ(needlework_get_counter(simulation, name, &value), NEEDLEWORK_OK) << name;
    EXPECT_TRUE(name != std::string("events") || value >= 20) << value;
  }
  EXPECT_GT(names, 10u);
  EXPECT_EQ(needlework_counter_name(std::size_t(-1)), nullptr);
  double box[3];
  EXPECT_EQ(needlework_get_box(simulation, box), NEEDLEWORK_OK);
  EXPECT_EQ(box[0] + box[1] + box[2], 15);
}

TEST_F(CRun, HasTheVersionAndTheCapabilitiesOfTheProgram) {
  const std::string version = run("--version").out;
  EXPECT_TRUE(test::contains(version, needlework_version()));
  for (const char* name : {"scalar", "sse4", "avx2", "avx512"}) {
    const bool offered = version.find(name) != version.npos;
    EXPECT_EQ(needlework_has((std::string("isa/") + name).c_str()), offered) << name;
  }
  EXPECT_EQ(needlework_has("threads"), 1);
  EXPECT_EQ(needlework_has("files/h5md"), 1);
  // Those that a simulation has, among them.
  EXPECT_EQ(needlework_has("effect/growth"), 1);
  const CSimulation gas(
      "needles = { count = 9, box = 5, diameter = 0.1 }\ncollisions.tc = 0.1\n"
      "forces.gravity = [0, 0, -1]\ndriving.kicks = { every = 1, translational = 1 }\n"
      "walls = [{ axis = \"z\", side = \"both\" }]\n");
  ASSERT_STREQ(needlework_setting(gas, "effects"), "elastic tc rods walls gravity kicks");
  for (const char* name : {"tc", "rods", "walls", "gravity", "kicks"})
    EXPECT_EQ(needlework_has((std::string("effect/") + name).c_str()), 1) << name;
  for (const char* name : {"", "isa", "isa/", "scalar", "gpu", "effect/elastic", "growth"})
    EXPECT_EQ(needlework_has(name), 0);
  EXPECT_EQ(needlework_has(nullptr), 0);
}

}  // namespace
}  // namespace needlework
