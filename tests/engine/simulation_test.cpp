// The simulation as a client sees it.
#include "needlework/simulation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cfenv>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "needlework/error.h"
#include "needlework/initial_state.h"
#include "tests/support/message_of.h"
#include "tests/support/rods.h"
#include "tests/support/scenes.h"

namespace needlework {
namespace {

using test::until_collisions;
using test::until_time;

TEST(Simulation, IsNotChangedByStoppingToLook) {
  const Scene scene = test::inelastic(test::scene_of(200, 6), 0.9);
  Simulation whole(scene), pieces(scene);
  whole.advance(until_time(5));
  for (int n = 1; n <= 1000; ++n) {
    ASSERT_EQ(pieces.advance(until_time(5 * n / 1000.0)), Stop::time);
    (void)pieces.copy();
  }
  EXPECT_EQ(whole.trajectory_hash(), pieces.trajectory_hash());
  EXPECT_EQ(whole.copy().position, pieces.copy().position);
  EXPECT_GT(whole.totals().collisions, 200u);
}

TEST(Simulation, EndsAtTheExactCollision) {
  const Scene scene = test::scene_of(100, 5);
  Simulation simulation(scene);
  double last = 0;
  simulation.on_collision([&](const Collision& c) { last = c.time; });
  EXPECT_EQ(simulation.advance(until_collisions(4)), Stop::collisions);
  EXPECT_EQ(simulation.totals().collisions, 200u);
  EXPECT_EQ(simulation.time(), last);
}

TEST(Simulation, TellsTheTimesOfCollisions_long) {
  for (const int threads : {1, 2, 5}) {
    const Scene scene = test::on_threads(test::scene_of(2000, 14), threads);
    for (const bool both : {false, true}) {
      Simulation simulation(scene);
      std::vector<double> times, whole;
      simulation.on_collision_times([&](std::span<const double> some) {
        times.insert(times.end(), some.begin(), some.end());
      });
      if (both) simulation.on_collision([&](const Collision& c) { whole.push_back(c.time); });
      simulation.advance(until_collisions(20));
      ASSERT_EQ(times.size(), 20000u);
      if (threads > 1) {
        EXPECT_GT(simulation.counters().phases, 5u);
      }
      std::sort(times.begin(), times.end());
      EXPECT_EQ(times.back(), simulation.time());
      if (both) {
        EXPECT_EQ(times, whole) << threads;
      }
      simulation.on_collision_times({});
      simulation.advance(until_collisions(22));
      EXPECT_EQ(times.size(), 20000u);
    }
  }
}

TEST(Simulation, DriftOfEnergyIsThatOfAnElasticGas) {
  Scene scene = test::scene_of(100, 5);
  Simulation simulation(scene);
  const double start = simulation.totals().energy;
  EXPECT_EQ(simulation.energy_drift(), 0);
  simulation.advance(until_collisions(300));
  const double changed = simulation.totals().energy / start - 1;
  EXPECT_NE(changed, 0);
  EXPECT_NEAR(simulation.energy_drift(), changed, 1e-15);
}

// Without rounding each change of energy to the nearest quantum, it would be about 7e-14.
TEST(Simulation, DriftOfEnergyIsThatOfRoundingInAnInelasticGas) {
  const Scene scene = test::inelastic(test::scene_of(400, 8), 0.8);
  Simulation simulation(scene);
  const double start = simulation.totals().energy;
  simulation.advance(until_collisions(300));
  EXPECT_LT(simulation.totals().energy, 1e-3 * start);
  EXPECT_NE(simulation.energy_drift(), 0);
  EXPECT_LT(std::abs(simulation.energy_drift()), 2e-14);
  Simulation continued(scene, simulation.checkpoint());
  EXPECT_EQ(continued.energy_drift(), simulation.energy_drift());
}

TEST(Simulation, EndsAtTheFirstCollisionBelowTheEnergy) {
  const Scene scene = test::inelastic(test::scene_of(100, 5), 0.7);
  Simulation simulation(scene);
  const double start = simulation.totals().energy;
  double before_last = 0, energy = start;
  simulation.on_collision([&](const Collision& c) {
    before_last = energy;
    energy += c.energy_change / 100;
  });
  Scene::Until until;
  until.energy_ratio = 0.5;
  EXPECT_EQ(simulation.advance(until), Stop::energy);
  EXPECT_LE(simulation.totals().energy, 0.5 * start * (1 + 1e-12));
  EXPECT_GT(before_last, 0.5 * start);
}

TEST(Simulation, StopsWhenInterrupted) {
  const Scene scene = test::scene_of(200, 5);
  Simulation simulation(scene);
  std::size_t seen = 0;
  simulation.on_collision([&](const Collision&) {
    if (++seen == 500) simulation.interrupt();
  });
  EXPECT_EQ(simulation.advance(until_collisions(1000)), Stop::interrupted);
  EXPECT_GE(seen, 500u);
  EXPECT_LT(seen, 2000u);
}

TEST(Simulation, RefusesStatesThatAreNotGases) {
  const Scene scene = test::scene_of(3, 3);
  const State good = draw_initial_state(scene);
  const auto refused = [&](auto change, const std::string& words) {
    State bad = good;
    change(bad);
    const std::string message =
        test::message_of<InputError>([&] { Simulation simulation(scene, bad); });
    EXPECT_NE(message.find(words), std::string::npos) << message;
  };
  refused(
      [](State& s) {
        s.position[2] = {1, NAN, 2};
      },
      "state: needle 2: position = (1, nan, 2): expected finite numbers");
  refused(
      [](State& s) {
        s.angular_velocity[1] = {HUGE_VAL, 0, 0};
      },
      "state: needle 1: angular velocity = (inf, 0, 0): expected finite numbers");
  refused(
      [](State& s) {
        s.orientation[0] = {0, 0, 0};
      },
      "state: needle 0: orientation = (0, 0, 0): expected one that is not 0");
  refused([](State& s) { s.box[1] = 2.0; }, "2.01");
  refused([](State& s) { s.velocity.pop_back(); }, "velocity");
  refused([](State& s) { s.velocity.clear(); }, "velocity");
  refused([](State& s) { s.orientation.clear(); }, "orientation");
  refused([](State& s) { s.angular_velocity.clear(); }, "angular");
  refused([](State& s) { s.id = {4, 7, 4}; }, "distinct");
  Scene unknown = scene;
  unknown.engine.search = "guess";
  EXPECT_THROW(Simulation(unknown, good), InputError);
  unknown = scene;
  unknown.engine.queue = "guess";
  EXPECT_THROW(Simulation(unknown, good), InputError);
  EXPECT_THROW(Simulation(scene).advance({}), InputError);
}

// The engine reads no files, whether there is such a file or not.
TEST(Simulation, RefusesASceneWhoseStateIsInAFile) {
  Scene scene = test::scene_of(3, 3);
  scene.initial.file = "absent.h5";
  const auto message = [&] {
    return test::message_of<InputError>([&] { Simulation simulation(scene); });
  };
  const std::string why =
      ": expected none, as Simulation(scene) reads no files: read the state with "
      "io::read_last_frame() and pass it to Simulation(scene, state)";
  EXPECT_EQ(message(), "initial.file = absent.h5" + why);
  const std::string place = "s.toml: line 7: initial.file = 'absent.h5'";
  scene.places["initial.file"] = place;
  EXPECT_EQ(message(), place + why);
  EXPECT_EQ(Simulation(scene, draw_initial_state(test::scene_of(4, 3))).copy().size(), 4u);
}

bool are_same(const State& a, const State& b) {
  return a.box == b.box && a.position == b.position && a.velocity == b.velocity &&
         a.orientation == b.orientation && a.angular_velocity == b.angular_velocity &&
         a.image == b.image && a.id == b.id;
}

TEST(Simulation, CopiesIntoMemoryThatThereIs) {
  const Scene scene = test::scene_of(200, 5);
  Simulation simulation(scene);
  State state;
  simulation.copy(state);
  const auto* positions = state.position.data();
  const auto* ids = state.id.data();
  for (const double time : {0.0, 0.3, 2.0, 2.0}) {
    simulation.advance(until_time(time));
    simulation.copy(state);
    EXPECT_EQ(state.position.data(), positions);
    EXPECT_EQ(state.id.data(), ids);
    EXPECT_TRUE(are_same(state, simulation.copy())) << "at " << time;
    EXPECT_EQ(simulation.time(), time);
  }
  // A state of more needles is cut to size; what it held is gone.
  State larger = draw_initial_state(test::scene_of(300, 9));
  simulation.copy(larger);
  EXPECT_TRUE(are_same(larger, state));
}

TEST(Simulation, CopiesNeedlesInOrderOfTheirIds) {
  const Scene scene = test::scene_of(120, 4);
  // With and without gaps between the ids.
  for (const std::uint32_t step : {1u, 3u}) {
    State initial = draw_initial_state(scene);
    initial.id.resize(initial.size());
    for (std::size_t n = 0; n < initial.size(); ++n) {
      initial.id[n] = static_cast<std::uint32_t>(step * (n * 77 % initial.size()));
    }
    const Simulation simulation(scene, initial);
    const State all = simulation.copy();
    for (std::size_t n = 0; n < initial.size(); ++n) {
      const std::size_t row = initial.id[n] / step;
      ASSERT_EQ(all.id[row], initial.id[n]);
      ASSERT_EQ(all.velocity[row], initial.velocity[n]);
    }
  }
}

TEST(Simulation, GivesOneNeedleAsItsRowOfAll) {
  const Scene scene = test::scene_of(120, 4);
  State initial = draw_initial_state(scene);
  initial.id.resize(initial.size());
  // Neither in order nor without gaps.
  for (std::size_t n = 0; n < initial.size(); ++n) {
    initial.id[n] = static_cast<std::uint32_t>(7 + 3 * (n * 77 % initial.size()));
  }
  Simulation simulation(scene, initial);
  for (const double time : {0.0, 0.01, 3.0, 3.5}) {
    simulation.advance(until_time(time));
    const State all = simulation.copy();
    for (std::size_t row = 0; row < all.size(); ++row) {
      const FreeNeedle one = simulation.needle(all.id[row]);
      ASSERT_TRUE(one.position == all.position[row] && one.velocity == all.velocity[row] &&
                  one.orientation == all.orientation[row] &&
                  one.angular_velocity == all.angular_velocity[row])
          << "at " << time << ", needle " << all.id[row];
    }
  }
  for (const std::uint32_t id : {0u, 6u, 8u, 7u + 3 * 120, 0xffffffffu}) {
    EXPECT_EQ(test::message_of<InputError>([&] { simulation.needle(id); }),
              "needle " + std::to_string(id) + ": expected the id of a needle");
  }
}

TEST(Simulation, GivesAWrappedStateWithImages) {
  const Scene scene = test::scene_of(50, 3);
  Simulation simulation(scene);
  const State start = simulation.copy();
  simulation.advance(until_time(20));
  const State end = simulation.copy();
  std::int64_t crossed = 0;
  for (std::size_t i = 0; i < end.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_GE(end.position[i][axis], 0);
      EXPECT_LT(end.position[i][axis], 3);
      crossed += std::abs(end.image[i][axis]);
    }
    const auto& u = end.orientation[i];
    EXPECT_NEAR(u[0] * u[0] + u[1] * u[1] + u[2] * u[2], 1, 1e-15);
  }
  EXPECT_GT(crossed, 100);
}

// Unwrapped centres move by v dt between two copies, independent of when they are wrapped.
TEST(Simulation, MovesCentresWithTheirVelocities) {
  const Scene scene = test::scene_of(30, 3);
  Simulation simulation(scene);
  State before = simulation.copy();
  for (int n = 1; n <= 200; ++n) {
    std::uint64_t collisions = simulation.totals().collisions;
    simulation.advance(until_time(n * 0.01));
    const State after = simulation.copy();
    if (simulation.totals().collisions == collisions) {
      for (std::size_t i = 0; i < after.size(); ++i) {
        for (int axis = 0; axis < 3; ++axis) {
          const double moved = after.position[i][axis] - before.position[i][axis] +
                               3.0 * (after.image[i][axis] - before.image[i][axis]);
          ASSERT_NEAR(moved, before.velocity[i][axis] * 0.01, 1e-13);
        }
      }
    }
    before = after;
  }
}

// Nothing of it is limited in silence: 2^31 boxes are crossed at the time 2.1e9.
TEST(Simulation, EndsBeforeImagesDoNotFitTheFile) {
  const Scene scene = test::scene_of(1, 4);
  State state = draw_initial_state(scene);
  state.velocity = {{4, 0, 0}};
  state.angular_velocity = {{0, 0, 0}};
  Simulation simulation(scene, state);
  simulation.advance(until_time(2e9));
  EXPECT_NEAR(simulation.copy().image[0][0], 2e9, 1);
  EXPECT_THROW(simulation.advance(until_time(2.2e9)), InvalidStateError);
  EXPECT_EQ(simulation.time(), 2e9);
  EXPECT_EQ(simulation.advance(until_time(2.1e9)), Stop::time) << "an earlier end";
}

// At a renewal or at the second needle of a collision: the state stays as it was before, and can be
// saved and continued.
TEST(Simulation, StaysSoundWhereAnEventCrossesTooManyBoxes) {
  constexpr std::int32_t most = 0x7fffffff - (1 << 11);
  for (const int n : {0, 1, 2, 3, 4, 5, 6, 7}) {
    const Scene scene = test::on_threads(test::scene_of(60, 5, 1 + n), 1 + n % 2);
    State state = draw_initial_state(scene);
    state.image.resize(state.size());
    for (std::size_t i = 1; i < state.size(); i += 2) state.image[i].fill(most);
    Simulation simulation(scene, state);
    const auto failure_of = [](Simulation& of) {
      return test::message_of<InvalidStateError>([&] {
        try {
          of.advance(until_collisions(1000));
        } catch (const UnfinishedEventError& error) {
          ADD_FAILURE() << error.what();
        }
      });
    };
    const std::string failure = failure_of(simulation);
    EXPECT_TRUE(failure.ends_with("expected an earlier end of the run, or a larger box"));
    const double time = simulation.time();
    const Checkpoint saved = simulation.checkpoint();
    Simulation again(scene, saved);
    EXPECT_EQ(again.time(), time);
    for (Simulation* each : {&simulation, &again}) {
      EXPECT_EQ(failure_of(*each), failure);
      EXPECT_EQ(each->checkpoint().bytes.size(), saved.bytes.size());
    }
    // As a run that ends there by itself.
    Simulation truth(scene, draw_initial_state(scene));
    truth.advance(until_time(time));
    EXPECT_EQ(simulation.trajectory_hash(), truth.trajectory_hash());
    EXPECT_EQ(simulation.copy().position, truth.copy().position);
  }
}

void expect_refusal(std::string_view message, const std::function<void()>& make) {
  const std::string found = test::message_of<InputError>(make);
  EXPECT_TRUE(found.starts_with("the scene: " + std::string(message))) << found << message;
}

// What the reader of scene files refuses must not hang or miss collisions in a scene made in code.
TEST(SceneMadeInCode, IsRefusedWithNumbersOutOfRange) {
  static constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const struct {
    const char* message;
    void (*spoil)(Scene&);
    bool only_drawn = false;
  } cases[] = {
      {"engine.capsule_radius = nan: ", [](Scene& s) { s.engine.capsule_radius = nan; }},
      {"engine.capsule_radius = -1: ", [](Scene& s) { s.engine.capsule_radius = -1; }},
      {"engine.cell_side = 0: ", [](Scene& s) { s.engine.cell_side = 0; }},
      {"engine.sampling_step = 0: ", [](Scene& s) { s.engine.sampling_step = 0; }},
      {"engine.root_tolerance = 1: ", [](Scene& s) { s.engine.root_tolerance = 1; }},
      {"engine.threads = -3: ", [](Scene& s) { s.engine.threads = -3; }},
      {"engine.team = \"foo\": ", [](Scene& s) { s.engine.team = "foo"; }},
      {"engine.storage = \"a\\nb\": ", [](Scene& s) { s.engine.storage = "a\nb"; }},
      {"collisions.epsilon = 2: ", [](Scene& s) { s.collisions.epsilon = 2; }},
      {"collisions.epsilon = nan: ", [](Scene& s) { s.collisions.epsilon = nan; }},
      {"collisions.beta = 5: ", [](Scene& s) { s.collisions.beta = 5; }},
      {"collisions.tc = nan: ", [](Scene& s) { s.collisions.tc = nan; }},
      {"collisions: ", [](Scene& s) { s.collisions.tc = s.collisions.tc_relative = 1; }},
      {"needles.k = 0: ", [](Scene& s) { s.needles.k = 0; }},
      {"species.length = -1: ",
       [](Scene& s) { s.species.push_back({.name = "a", .count = 20, .length = -1}); }},
      {"initial.t_tr = -1: ", [](Scene& s) { s.initial.t_tr = -1; }, true},
      {"species.t_rot = nan: ",
       [](Scene& s) { s.species.push_back({.name = "a", .count = 20, .t_rot = nan}); }, true},
      {"needles.count = 1.8446744073709552e+19: ",
       [](Scene& s) { s.needles.count = ~std::uint64_t{0}; }, true},
      {"needles.box = [6, nan, 6]: ",
       [](Scene& s) {
         s.needles.box = {6, nan, 6};
       },
       true},
      {"needles.box = [6, 6, 2]: expected an edge from 2.01 to 1e9, or an array of three edges",
       [](Scene& s) {
         s.needles.box = {6, 6, 2};
       },
       true},
  };
  for (const auto& [message, spoil, only_drawn] : cases) {
    Scene scene = test::scene_of(20, 5);
    const State state = Simulation(scene).copy();
    spoil(scene);
    expect_refusal(message, [&] { Simulation simulation(scene); });
    if (only_drawn) {
      expect_refusal(message, [&] { draw_initial_state(scene); });
      EXPECT_EQ(Simulation(scene, state).needles(), 20U) << message;
    } else {
      expect_refusal(message, [&] { Simulation simulation(scene, state); });
    }
  }
}

TEST(SceneMadeInCode, MayHoldAnythingWhereItIsNotRead) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Scene scene = test::scene_of(20, 5);
  scene.title = "two\nlines";
  scene.needles.seed = ~std::uint64_t{0};
  scene.until.time = infinity;
  scene.until.energy_ratio = 0;
  scene.output.file = "latin-1 \xe4.h5";
  scene.output.frame_times = {2, 1};
  scene.output.observables = {"of my own"};
  scene.output.checkpoint_every = infinity;
  scene.species.push_back({.name = {}, .count = 20});
  scene.needles.k = 0;
  scene.initial.t_tr = -1;
  Simulation simulation(scene);
  const State state = simulation.copy();
  EXPECT_EQ(simulation.advance(until_collisions(1)), Stop::collisions);
  scene.initial.file = "any\nfile";
  EXPECT_EQ(Simulation(scene, state).needles(), 20U);
}

// Whatever a host program has chosen for itself, which it finds again.
TEST(Simulation, ComputesInTheDefaultFloatingPointEnvironment) {
  const Scene scene = test::scene_of(100, 5);
  const auto hash_of = [](Simulation& simulation) {
    simulation.advance(until_collisions(5));
    const State state = simulation.copy();
    simulation.set_velocities(state.angular_velocity, state.velocity);
    simulation.advance(until_collisions(10));
    return simulation.trajectory_hash();
  };
  Simulation usual(scene);
  const std::string expected = hash_of(usual);
  for (const int mode : {FE_UPWARD, FE_TOWARDZERO}) {
    ASSERT_EQ(std::fesetround(mode), 0);
    Simulation simulation(scene);
    const std::string found = hash_of(simulation);
    const double energy = simulation.totals().energy;
    EXPECT_EQ(std::fegetround(), mode);
    std::fesetround(FE_TONEAREST);
    EXPECT_EQ(found, expected);
    EXPECT_EQ(energy, usual.totals().energy);
  }
}

// The sum of many terms, whose last bits depend on how it is rounded.
TEST(Simulation, TellsTheVirialInTheDefaultFloatingPointEnvironment) {
  const Scene scene = test::rods_and_spheres(20, 7, 1);
  Simulation usual(scene);
  for (int n = 1; n <= 20; ++n) {
    usual.advance(until_collisions(n));
    const double expected = usual.virial();
    for (const int mode : {FE_UPWARD, FE_DOWNWARD}) {
      ASSERT_EQ(std::fesetround(mode), 0);
      const double found = usual.virial();
      std::fesetround(FE_TONEAREST);
      EXPECT_EQ(found, expected);
    }
  }
}

TEST(Simulation, ContinuesCheckpointsOfAsManyNeedlesAsItsScene) {
  Scene scene = test::scene_of(20, 5);
  const Checkpoint saved = Simulation(scene).checkpoint();
  scene.needles.count = 21;
  EXPECT_THROW(Simulation(scene, saved), InputError);
  scene.needles.count = 0;  // as where a file has given it
  EXPECT_EQ(Simulation(scene, saved).needles(), 20U);
}

TEST(Simulation, RefusesEndsThatAreNoNumbers) {
  Simulation simulation(test::scene_of(20, 5));
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  for (const auto end : {&Scene::Until::time, &Scene::Until::collisions_per_needle,
                         &Scene::Until::energy_ratio, &Scene::Until::wall_s}) {
    Scene::Until until;
    until.*end = nan;
    EXPECT_THROW(simulation.advance(until), InputError);
  }
  EXPECT_EQ(simulation.advance(until_time(0.1)), Stop::time);
}

}  // namespace
}  // namespace needlework
