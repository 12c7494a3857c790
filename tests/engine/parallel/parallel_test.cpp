// Runs on several threads equal those on one, bit for bit, to the last collision.
#include <gtest/gtest.h>
#include <omp.h>

#include <cmath>
#include <memory>
#include <utility>

#include "needlework/error.h"
#include "needlework/initial_state.h"
#include "src/engine/initial_gas.h"
#include "tests/support/parallel_loops.h"
#include "tests/support/same_run.h"
#include "tests/support/scenes.h"

namespace needlework {
namespace {

using test::thin;

struct Case {
  const char* name;
  std::uint64_t count;
  std::array<double, 3> box;
  double epsilon, beta, tc_relative, k, collisions;
  double shear_rate = 0;
};

Scene scene_of(const Case& c) {
  Scene scene = test::scene_of(c.count, c.box[0], 3);
  scene.needles.box = c.box;
  scene.needles.k = c.k;
  scene.collisions.epsilon = c.epsilon;
  scene.collisions.beta = c.beta;
  if (c.tc_relative > 0) scene.collisions.tc_relative = c.tc_relative;
  if (c.shear_rate != 0) scene.shear = Scene::Shear{.rate = c.shear_rate, .offset = 1};
  return scene;
}

void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

class ParallelRun : public testing::TestWithParam<Case> {};

TEST_P(ParallelRun, IsThatOfOneThread) {
  Scene scene = scene_of(GetParam());
  const double count = GetParam().collisions / thin;
  scene.engine.threads = 1;
  const test::Recorded truth = test::record(scene, count);
  for (const auto& [search, threads] :
       {std::pair("linked-cells", 2), {"linked-cells", 8}, {"capsules", 3}, {"capsules", 4}}) {
    SCOPED_TRACE(std::string(search) + " on " + std::to_string(threads) + " threads");
    scene.engine.search = search;
    scene = test::on_threads(scene, threads);
    ASSERT_NO_FATAL_FAILURE(test::expect_same(truth, test::record(scene, count)));
  }
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, ParallelRun,
    testing::Values(Case{"dilute_long", 2000, {14, 14, 14}, 1, -1, 0, 6, 10000},
                    Case{"dense_long", 4000, {7, 7, 7}, 1, -1, 0, 6, 10000},
                    Case{"very_dense", 2000, {2.7, 2.7, 2.7}, 1, -1, 0, 6, 4000},
                    Case{"cooling", 2000, {9, 9, 9}, 0.8, -1, 1e-3, 6, 10000},
                    Case{"strongly_cooling", 1000, {8, 8, 8}, 0.4, -1, 1e-2, 6, 10000},
                    Case{"rough", 1000, {10, 10, 10}, 0.9, 0.4, 1e-3, 6, 4000},
                    Case{"swift_rotation_long", 1000, {10, 10, 10}, 1, -1, 0, 50, 4000},
                    Case{"slab", 1000, {30, 2.01, 9}, 1, -1, 0, 6, 4000},
                    Case{"thread", 500, {200, 2.01, 2.01}, 0.9, -1, 1e-3, 6, 2000},
                    Case{"least_box", 300, {2.01, 2.01, 2.01}, 1, -1, 0, 6, 2000},
                    Case{"very_dilute", 300, {30, 30, 30}, 1, -1, 0, 6, 1000},
                    Case{"rare_long", 4000, {60, 60, 60}, 0.9, -1, 1e-3, 6, 5000},
                    Case{"sheared", 1000, {10, 10, 10}, 0.9, -1, 1e-3, 6, 4000, 0.3},
                    Case{"sheared_slab", 1000, {9, 30, 2.01}, 0.9, 0.4, 0, 6, 4000, -2},
                    Case{"sheared_dense", 2000, {5, 5, 5}, 0.9, -1, 1e-3, 6, 4000, 4},
                    Case{"two_needles", 2, {2.01, 2.01, 2.01}, 1, -1, 0, 6, 600}),
    [](const auto& info) { return std::string(info.param.name); });

// The system schedules the threads, so a run is repeated, more often in a build in which threads
// yield at random.
TEST(Parallel, IsTheSameEveryTime_long) {
  Scene scene = scene_of({"", 1000, {6, 6, 6}, 0.9, -1, 1e-3, 6, 0});
  scene.engine.threads = 1;
  const std::string truth = test::record(scene, 700).hash;
#ifdef NEEDLEWORK_RANDOM_YIELDS
  const int repeats = 25;
#else
  const auto repeats = static_cast<int>(25 / thin);
#endif
  for (int n = 0; n < repeats; ++n) {
    for (const int threads : {3, 8}) {
      scene = test::on_threads(scene, threads);
      ASSERT_EQ(test::record(scene, 700).hash, truth) << threads << " threads, run " << n;
    }
  }
}

// Between phases of several threads the gas may cool in stretches that one thread computes alone;
// the largest speed of an earlier phase is then out of date.
TEST(Parallel, UsesAllThreadsAfterALongStretchOnOne) {
  Scene scene = scene_of({"", 1000, {11, 11, 11}, 0.5, -1, 1e-3, 6, 0});
  const int steps = thin > 1 ? 20 : 100;
  const auto run = [&](int threads) {
    scene = test::on_threads(scene, threads);
    auto simulation = std::make_unique<Simulation>(scene);
    // Each step is too short for a phase.
    for (int n = 0; n <= steps; ++n) simulation->advance(test::until_collisions(0.2 * n));
    EXPECT_EQ(simulation->counters().phases, 0u);
    simulation->advance(test::until_collisions(0.2 * steps + 6));
    return simulation;
  };
  const auto truth = run(1), seen = run(2);
  EXPECT_EQ(seen->trajectory_hash(), truth->trajectory_hash());
  EXPECT_GT(seen->counters().phases, seen->counters().redone);
}

TEST(Parallel, UsesItsThreads) {
  Scene scene = scene_of({"", 2000, {14, 14, 14}, 1, -1, 0, 6, 0});
  scene = test::on_threads(scene, 2);
  Simulation simulation(scene);
  Scene::Until until;
  until.collisions_per_needle = 24;
  ASSERT_EQ(simulation.advance(until), Stop::collisions);
  const Counters& counters = simulation.counters();
  EXPECT_EQ(simulation.queue(), "cell-calendar");
  EXPECT_GT(counters.phases, 5u);
  EXPECT_LE(counters.redone, counters.phases / 5);
  EXPECT_GT(counters.messages, 10u);  // collisions over the border
  EXPECT_GT(counters.sorts, 0u);      // which divides the box again
}

TEST(Parallel, StopsWhereOneThreadStops_long) {
  Scene scene = scene_of({"", 1000, {8, 8, 8}, 0.8, -1, 1e-3, 6, 0});
  const auto stops = [&](int threads) {
    scene = test::on_threads(scene, threads);
    Simulation simulation(scene);
    std::vector<std::tuple<Stop, double, std::uint64_t, std::string>> out;
    std::vector<State> states;
    const auto advance = [&](const Scene::Until& until) {
      const Stop stop = simulation.advance(until);
      out.push_back(
          {stop, simulation.time(), simulation.totals().collisions, simulation.trajectory_hash()});
      states.push_back(simulation.copy());
    };
    for (const double time : {0.001, 0.13, 0.2, 0.2}) advance({.time = time});
    for (const double mean : {1.5, 1.502, 3.0}) advance({.collisions_per_needle = mean});
    for (const double ratio : {0.7, 0.31}) advance({.energy_ratio = ratio});
    return std::pair(out, states);
  };
  const auto [truth, states] = stops(1);
  for (const int threads : {2, 3, 8}) {
    const auto [stopped, seen] = stops(threads);
    ASSERT_EQ(stopped, truth) << threads << " threads";
    for (std::size_t n = 0; n < states.size(); ++n) {
      EXPECT_EQ(seen[n].position, states[n].position);
      EXPECT_EQ(seen[n].image, states[n].image);
      EXPECT_EQ(seen[n].velocity, states[n].velocity);
      EXPECT_EQ(seen[n].orientation, states[n].orientation);
    }
  }
}

// An end by energy cannot be foreseen: the phase in which it lies is rolled back.
TEST(Parallel, RollsBackWhatLiesBeyondTheEnd) {
  Scene scene = scene_of({"", 1000, {8, 8, 8}, 0.8, -1, 1e-3, 6, 0});
  scene = test::on_threads(scene, 2);
  Simulation simulation(scene);
  EXPECT_EQ(simulation.advance({.energy_ratio = 0.5}), Stop::energy);
  EXPECT_GE(simulation.counters().redone, 1u);
}

// The limit is slightly above a number of collisions, so one more is needed, and no time is left
// for a phase.
TEST(Parallel, EndsAtTheNextCollision) {
  Scene scene = scene_of({"", 1000, {8, 8, 8}, 1, -1, 0, 6, 0});
  std::size_t slightly_above = 0;
  for (int n = 1; n <= 300; n += 3) {
    const double mean = std::nextafter(n / 500.0, 1.0);
    slightly_above += mean * 500 > n;
    scene = test::on_threads(scene, 2);
    Simulation simulation(scene);
    ASSERT_EQ(simulation.advance({.collisions_per_needle = mean}), Stop::collisions);
    ASSERT_EQ(simulation.totals().collisions, static_cast<std::uint64_t>(std::ceil(mean * 500)));
  }
  EXPECT_GT(slightly_above, 30u);
}

// A run that is advanced in many short steps, as the program does, does not repeat a phase that has
// been rolled back. Needles that slide, with many more collisions than in thermal flight, do not
// make a phase endless.
TEST(Parallel, RollsBackAPhaseOnlyOnce_long) {
  Scene scene = scene_of({"", 2000, {7, 7, 7}, 0.6, -1, 1e-3, 6, 0});
  scene.initial.t_rot = 0;
  const auto run = [&](int threads, double wall) {
    scene = test::on_threads(scene, threads);
    auto simulation = std::make_unique<Simulation>(scene);
    Scene::Until until;
    until.energy_ratio = thin > 1 ? 0.7 : 0.3;
    if (wall > 0) until.wall_s = wall;
    Stop stop;
    do {
      stop = simulation->advance(until);
    } while (stop == Stop::wall_time);
    EXPECT_EQ(stop, Stop::energy);
    return simulation;
  };
  const auto truth = run(1, 0), seen = run(2, 1e-4);
  EXPECT_EQ(seen->trajectory_hash(), truth->trajectory_hash());
  const Counters& counters = seen->counters();
  EXPECT_GT(counters.phases, 2u);
  EXPECT_LE(counters.redone, 3u);
  // A phase has at most 2^15 collisions, and twice as many if it is rolled back.
  EXPECT_LE(counters.events, 2 * truth->counters().events);
}

// In rare gases a mean free time is longer than the times that the search can represent in float,
// so a phase ends before the search has to choose a new origin of time. Each end by energy rolls
// back a phase, which is only correct if the search's data of the needles that are not restored are
// valid at the earlier time.
TEST(Parallel, RollsBackPhasesOfRareGasesCorrectly) {
  const Scene scene =
      scene_of({"", 130, {1763.7097770949067, 2.01, 2.01}, 0.95, 0.0945871625986503, 1e-3, 6, 0});
  const int ends = thin > 1 ? 3 : 12;
  for (const int threads : {2, 3}) {
    Simulation truth(scene);
    needlework::Run run(scene, make_gas(scene, draw_initial_state(scene)));
    const auto loop = test::parallel_loop(run, "linked-cells", threads, test::short_phases, {});
    const Tally& tally = run.tally;
    for (int n = 1; n <= ends; ++n) {
      const Scene::Until until{.energy_ratio = std::pow(0.85, n)};
      ASSERT_EQ(loop->advance(StopConditions(run, until)), truth.advance(until));
      ASSERT_EQ(tally.hash.hex(), truth.trajectory_hash()) << threads << " threads, end " << n;
    }
    EXPECT_GT(tally.counters.phases, 2 * tally.counters.redone);
    EXPECT_GE(tally.counters.redone, static_cast<std::uint64_t>(ends / 2));
  }
}

// If subdomains hardly touch, only the comparison of their times keeps threads close enough in time
// to check which needles may have met.
TEST(Parallel, StaysTogetherInTimeInALongBox) {
  Scene scene = scene_of({"", 2000, {2000, 2.3, 2.3}, 1, -1, 0, 6, 0});
  scene = test::on_threads(scene, 3);
  Simulation simulation(scene);
  EXPECT_EQ(simulation.advance(test::until_collisions(10 / thin)), Stop::collisions);
  const Counters& counters = simulation.counters();
  EXPECT_GT(counters.phases, 1u);
  EXPECT_LE(counters.redone, counters.phases / 4);
}

// Scenes so small that one thread usually computes them alone.
TEST(Parallel, HasTheSameTrajectoryForFewNeedles_long) {
  for (const Case& c : {Case{"", 2, {2.01, 2.01, 2.01}, 1, -1, 0, 6, 300},
                        Case{"", 20, {3, 3, 3}, 0.9, 0.2, 1e-2, 6, 1000},
                        Case{"", 100, {4, 4, 4}, 0.8, -1, 1e-3, 6, 2000}}) {
    const Scene scene = scene_of(c);
    Scene::Until until;
    until.collisions_per_needle = 2 * c.collisions / static_cast<double>(c.count);
    Simulation truth(scene);
    truth.advance(until);
    for (const int threads : {2, 3, 8}) {
      needlework::Run run(scene, make_gas(scene, draw_initial_state(scene)));
      const auto loop = test::parallel_loop(run, "capsules", threads, test::short_phases, {});
      EXPECT_EQ(loop->advance(StopConditions(run, until)), Stop::collisions);
      const Tally& tally = run.tally;
      EXPECT_EQ(tally.hash.hex(), truth.trajectory_hash()) << c.count << ", " << threads;
      EXPECT_GT(tally.counters.phases, tally.counters.redone) << c.count << ", " << threads;
    }
  }
}

TEST(Parallel, ReportsThatOpenMPGivesFewerThreads) {
  Scene scene = scene_of({"", 1000, {8, 8, 8}, 1, -1, 0, 6, 0});
  scene = test::on_threads(scene, 2);
  const int levels = omp_get_max_active_levels();
  omp_set_max_active_levels(0);
  std::string message;
  try {
    Simulation{scene};
  } catch (const InputError& error) {
    message = error.what();
  }
  omp_set_max_active_levels(levels);
  EXPECT_NE(message.find("engine.threads = 2: expected at most 1"), std::string::npos) << message;
}

TEST(Parallel, FailsWhereOneThreadFails) {
  Scene scene = scene_of({"", 400, {5, 5, 5}, 0.2, -1, 0, 6, 0});
  const auto failure = [&](int threads) {
    scene = test::on_threads(scene, threads);
    Simulation simulation(scene);
    std::string message;
    try {
      simulation.advance({.collisions_per_needle = 1000});
    } catch (const InvalidStateError& error) {
      message = error.what();
    }
    return std::tuple(message, simulation.totals().collisions, simulation.trajectory_hash(),
                      simulation.copy().position);
  };
  const auto truth = failure(1);
  ASSERT_NE(std::get<0>(truth), "");
  for (const int threads : {2, 3, 8}) EXPECT_EQ(failure(threads), truth) << threads << " threads";
}

TEST(Parallel, CanBeInterrupted) {
  Scene scene = scene_of({"", 1000, {8, 8, 8}, 1, -1, 0, 6, 0});
  scene = test::on_threads(scene, 2);
  Simulation simulation(scene);
  simulation.on_collision([&](const Collision&) { simulation.interrupt(); });
  EXPECT_EQ(simulation.advance({.collisions_per_needle = 1e6}), Stop::interrupted);
  EXPECT_EQ(simulation.advance({.wall_s = 0.05}), Stop::interrupted);
}

// The last event that a thread processes in a phase need not be the latest, as it may have been
// deferred. A run that is interrupted between two phases must not be at a time before its records.
TEST(Parallel, IsInterruptedAfterAllItsRecords) {
  const Scene scene = scene_of({"", 1000, {11, 11, 11}, 1, -1, 0, 6, 0});
  const Scene::Until until{.collisions_per_needle = 1000};
  for (const int threads : {2, 3}) {
    needlework::Run run(scene, make_gas(scene, draw_initial_state(scene)));
    const auto loop = test::parallel_loop(run, "linked-cells", threads, test::short_phases, {});
    run.listeners.collision = [&](const Collision&) { run.interrupted = true; };
    for (int n = 0; n < 8; ++n) {
      run.interrupted = false;
      ASSERT_EQ(loop->advance(StopConditions(run, until)), Stop::interrupted);
      for (const Record& record : run.gas.records) ASSERT_LE(record.time, run.now) << threads;
    }
    EXPECT_GT(run.tally.counters.phases, run.tally.counters.redone);
  }
}

TEST(Parallel, RefusesSearchesAndCalendarsOfOneThread) {
  Scene scene = scene_of({"", 100, {8, 8, 8}, 1, -1, 0, 6, 0});
  scene = test::on_threads(scene, 2);
  scene.engine.search = "all-pairs";
  EXPECT_THROW(Simulation{scene}, InputError);
  scene.engine.search = "auto";
  scene.engine.queue = "tournament";
  EXPECT_THROW(Simulation{scene}, InputError);
}

}  // namespace
}  // namespace needlework
