// Arguments that are NULL or impossible are refused with a message that names them.
#include <cmath>
#include <limits>

#include "tests/c/c_simulation.h"

namespace needlework {
namespace {

using test::Arrays;
using test::cooling;
using test::CSimulation;

TEST(CArguments, OfScenesNameTheirKeyAndLine) {
  const auto expect_input = [](const std::string& scene, const std::string& message) {
    const CSimulation simulation(scene);
    EXPECT_EQ(simulation, nullptr);
    EXPECT_EQ(simulation.error.code, NEEDLEWORK_INPUT);
    EXPECT_TRUE(std::string(simulation.error.message).starts_with(message))
        << simulation.error.message;
  };
  expect_input("needles = { count = 60, box = 5 }\ncollisions.epsilon = 1.5\n",
               "scene: line 2: collisions.epsilon = 1.5: expected ");
  expect_input("needles = { count = 60 }\n", "scene: needles.box is missing: expected ");
  expect_input("needles = { count = 60, box = 5, boks = 1 }\n", "scene: line 1: needles.boks");
  expect_input("engine.threads = 1000000\n" + cooling, "scene: line 1: engine.threads = 1000000");
  expect_input("what", "scene: line 1: ");
  expect_input("", "scene: needles.count is missing: expected ");
  expect_input("# " + std::string(2 << 20, 'x'), "scene: ");

  needlework_error error;
  EXPECT_EQ(needlework_open("no/such/scene.toml", 0, &error), nullptr);
  EXPECT_EQ(error.code, NEEDLEWORK_IO);
  EXPECT_TRUE(std::string(error.message).starts_with("no/such/scene.toml: ")) << error.message;
}

TEST(CArguments, ThatAreTooLongForAMessageAreCutOffBetweenCharacters) {
  std::string long_name;
  for (int n = 0; n < 1000; ++n) long_name += "\u00e4";
  for (const std::string& name : {long_name, "a" + long_name}) {
    needlework_error error;
    EXPECT_EQ(needlework_open(name.c_str(), 0, &error), nullptr);
    const std::string message = error.message;
    EXPECT_GE(message.size(), 1021u);
    EXPECT_EQ(message.substr(message.size() - 2), "\u00e4");
  }
}

TEST(CArguments, OfCreationMayNotBeNull) {
  needlework_error error;
  EXPECT_EQ(needlework_create(nullptr, 0, &error), nullptr);
  EXPECT_EQ(error.code, NEEDLEWORK_USAGE);
  EXPECT_STREQ(error.message, "scene is NULL: expected a pointer");
  EXPECT_EQ(needlework_open(nullptr, 0, &error), nullptr);
  EXPECT_STREQ(error.message, "path is NULL: expected a pointer");
  EXPECT_EQ(needlework_resume(nullptr, &error), nullptr);
  EXPECT_EQ(error.code, NEEDLEWORK_USAGE);
  EXPECT_STREQ(error.message, "file is NULL: expected a pointer");
  EXPECT_EQ(needlework_create_from("", nullptr, 0, &error), nullptr);
  EXPECT_STREQ(error.message, "initial is NULL: expected a pointer");
  EXPECT_EQ(needlework_create_from(nullptr, nullptr, 0, nullptr), nullptr);
  EXPECT_EQ(needlework_create(cooling.c_str(), 6, &error), nullptr);
  EXPECT_EQ(error.code, NEEDLEWORK_USAGE);
  EXPECT_STREQ(error.message, "flags = 6: expected 0 or NEEDLEWORK_REPLACE");
}

TEST(CArguments, NeedASimulation) {
  test::expect_all_refuse(nullptr);
  EXPECT_EQ(needlework_count(nullptr), 0u);
  EXPECT_STREQ(needlework_message(nullptr), "simulation is NULL: expected a pointer");
  needlework_destroy(nullptr);
  needlework_interrupt(nullptr);
}

class CArgumentsOf : public testing::Test {
 protected:
  void expect_usage(int code, const std::string& message) const {
    EXPECT_EQ(code, NEEDLEWORK_USAGE);
    EXPECT_EQ(simulation_.message(), message);
  }
  const CSimulation simulation_{cooling};
};

TEST_F(CArgumentsOf, ASimulationMayNotBeNull) {
  const needlework_const_vectors absent{};
  std::uint64_t value;
  EXPECT_EQ(simulation_.message(), "");
  expect_usage(needlework_advance(simulation_, nullptr, nullptr),
               "limits is NULL: expected a pointer");
  expect_usage(needlework_get_box(simulation_, nullptr), "box is NULL: expected a pointer");
  expect_usage(needlework_get_state(simulation_, nullptr), "into is NULL: expected a pointer");
  expect_usage(needlework_write_state(simulation_, nullptr, 0), "path is NULL: expected a pointer");
  expect_usage(needlework_get_totals(simulation_, nullptr), "totals is NULL: expected a pointer");
  expect_usage(needlework_get_hash(simulation_, nullptr), "hash is NULL: expected a pointer");
  expect_usage(needlework_get_counter(simulation_, nullptr, &value),
               "name is NULL: expected a pointer");
  expect_usage(needlework_get_counter(simulation_, "events", nullptr),
               "value is NULL: expected a pointer");
  expect_usage(needlework_set_velocities(simulation_, nullptr, &absent),
               "velocity is NULL: expected a pointer");
  const double numbers[180] = {};
  const needlework_const_vectors present{numbers, 0, 0};
  expect_usage(needlework_set_velocities(simulation_, &present, &absent),
               "angular_velocity->data is NULL: expected a pointer");
  EXPECT_EQ(needlework_setting(simulation_, nullptr), nullptr);
  EXPECT_EQ(simulation_.message(), "name is NULL: expected a pointer");
}

TEST_F(CArgumentsOf, ASimulationMustBePossible) {
  std::uint64_t value;
  const auto discard = [](const needlework_collision*, std::size_t, void*) { return 0; };
  expect_usage(needlework_set_callback(simulation_, 0, discard, nullptr),
               "batch = 0: expected at least 1");
  expect_usage(needlework_get_counter(simulation_, "evnts", &value),
               "name = \"evnts\": expected one of needlework_counter_name()");
  expect_usage(needlework_write_state(simulation_, "a.h5", 2),
               "flags = 2: expected 0 or NEEDLEWORK_REPLACE");
  EXPECT_EQ(needlework_setting(simulation_, "colour"), nullptr);
  EXPECT_EQ(simulation_.message(), "name = \"colour\": expected search, queue, isa or effects");
}

TEST_F(CArgumentsOf, LimitsMustBeSetAndNotNegative) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const auto run : {needlework_run_until, needlework_advance}) {
    const auto expect = [&](const needlework_limits& limits, const std::string& message) {
      expect_usage(run(simulation_, &limits, nullptr), message);
    };
    expect({},
           "limits: no end condition: expected one or more of time, collisions, "
           "collisions_per_needle, energy_ratio, wall_s");
    expect({-1, 0, 0, 0, 0}, "limits: time = -1: expected a number >= 0");
    expect({nan, 0, 0, 0, 0}, "limits: time = nan: expected a number >= 0");
    expect({0, 0, -2, 0, 0}, "limits: collisions_per_needle = -2: expected a number >= 0");
    expect({0, 1, 0, nan, 0}, "limits: energy_ratio = nan: expected a number >= 0");
    expect({1, 0, 0, 0, -1}, "limits: wall_s = -1: expected a number >= 0");
  }
  EXPECT_EQ(simulation_.totals().time, 0);
}

TEST(CArguments, OfFunctionsWithoutASimulation) {
  needlework_error error;
  double x = -1;
  needlework_gas gas{6, 0.8, -1};
  EXPECT_EQ(needlework_predict(nullptr, &x, nullptr, nullptr, &error), NEEDLEWORK_USAGE);
  EXPECT_STREQ(error.message, "pairs is NULL: expected a pointer");
  needlework_pairs pairs{};
  EXPECT_EQ(needlework_predict(&pairs, nullptr, nullptr, nullptr, nullptr), NEEDLEWORK_OK);
  pairs.count = 1;
  EXPECT_EQ(needlework_predict(&pairs, &x, nullptr, nullptr, &error), NEEDLEWORK_USAGE);
  EXPECT_STREQ(error.message, "pairs->r1.data is NULL: expected a pointer");
  const double r[3] = {1, 0, 0};
  pairs.r1.data = pairs.u1.data = pairs.v1.data = pairs.w1.data = r;
  pairs.r2.data = pairs.u2.data = pairs.v2.data = pairs.w2.data = r;
  EXPECT_EQ(needlework_predict(&pairs, &x, nullptr, nullptr, &error), NEEDLEWORK_USAGE);
  EXPECT_STREQ(error.message, "pairs->horizon is NULL: expected a pointer");
  pairs.count = 0;
  pairs.accuracy = "perfect";
  EXPECT_EQ(needlework_predict(&pairs, &x, nullptr, nullptr, &error), NEEDLEWORK_USAGE);
  EXPECT_STREQ(error.message,
               "pairs->accuracy: engine.accuracy = \"perfect\": expected one of fast, standard, "
               "rigorous");

  EXPECT_EQ(needlework_collision_rate(6, 1, 1, 1, nullptr, &error), NEEDLEWORK_USAGE);
  EXPECT_STREQ(error.message, "rate is NULL: expected a pointer");
  EXPECT_EQ(needlework_collision_rate(-6, 1, 1, 1, &x, &error), NEEDLEWORK_USAGE);
  EXPECT_TRUE(std::string(error.message).starts_with("k = -6: expected ")) << error.message;
  EXPECT_EQ(needlework_ratio(nullptr, &x, &error), NEEDLEWORK_USAGE);
  EXPECT_STREQ(error.message, "gas is NULL: expected a pointer");
  EXPECT_EQ(needlework_ratio(&gas, nullptr, &error), NEEDLEWORK_USAGE);
  EXPECT_EQ(needlework_cooling(&gas, 1, 1, 1, nullptr, &x, &x, &error), NEEDLEWORK_USAGE);
  EXPECT_STREQ(error.message, "tau is NULL: expected a pointer");
  const double tau = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(needlework_cooling(&gas, 1, 1, 1, &tau, &x, nullptr, &error), NEEDLEWORK_USAGE);
  EXPECT_EQ(needlework_cooling(nullptr, 1, 1, 1, &tau, &x, nullptr, nullptr), NEEDLEWORK_USAGE);
  gas.epsilon = 2;
  EXPECT_EQ(needlework_ratio(&gas, &x, &error), NEEDLEWORK_USAGE);
  EXPECT_TRUE(std::string(error.message).starts_with("epsilon = 2: expected ")) << error.message;
  EXPECT_EQ(x, -1) << "nothing is written on failure";
}

}  // namespace
}  // namespace needlework
