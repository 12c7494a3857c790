// Scenes with parameters at the ends of their ranges.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "needlework/error.h"
#include "needlework/initial_state.h"
#include "tests/hard_cases/hard_scene.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"

namespace needlework::test {
namespace {

Scene gas(std::uint64_t count, double side) { return scene_of(count, side, 77); }

/// The initial state of a scene at temperatures that its file could not hold.
State at_temperatures(Scene scene, double t_tr, double t_rot) {
  scene.initial.t_tr = scene.initial.t_rot = 1;
  State state = draw_initial_state(scene);
  for (Three& v : state.velocity) v = std::sqrt(t_tr) * v;
  for (Three& w : state.angular_velocity) w = std::sqrt(t_rot) * w;
  return state;
}

Scene::Until until_energy(double ratio) {
  Scene::Until until;
  until.energy_ratio = ratio;
  return until;
}

TEST(FewNeedles, NoneOrOneHasNothingToMeet) {
  for (const std::uint64_t count : {0u, 1u}) {
    const Scene scene = gas(count, 3);
    const HardRun open = run_hard(scene, until_collisions(1));
    EXPECT_EQ(open.stop, Stop::nothing_can_happen);
    for (const double time : {1e6, 1e9}) {
      const HardRun run = run_hard(scene, until_time(time));
      EXPECT_EQ(run.stop, Stop::time);
      EXPECT_EQ(run.time, time);
      EXPECT_EQ(run.end.size(), count);
    }
  }
}

TEST(FewNeedles, TwoOrThreeMeetAndCool) {
  for (const std::uint64_t count : {2u, 3u}) {
    Scene scene = gas(count, 3);
    const HardRun elastic = run_hard(scene, until_collisions(30.0 / thin), {.everywhere = false});
    EXPECT_EQ(elastic.stop, Stop::collisions);
    scene.collisions.epsilon = 0.9;
    scene.collisions.tc_relative = 1e-3;
    const HardRun cooling = run_hard(scene, until_collisions(30.0 / thin), {.everywhere = false});
    EXPECT_EQ(cooling.stop, Stop::collisions);
  }
}

// In the end they are so slow that the next collision is later than all representable times, which
// end at 2^62 initial mean free times.
TEST(FewNeedles, TwoMayCoolToTheEndOfTheClock) {
  Scene scene = test::inelastic(scene_of(2, 2.01, 78), 0.5, 1e-5, -0.06425226462371303);
  for (const int threads : {1, 2}) {
    scene = test::on_threads(scene, threads);
    Simulation simulation(scene);
    EXPECT_THROW(simulation.advance(until_collisions(1e6)), InvalidStateError);
    const Totals cold = simulation.totals();
    EXPECT_GT(cold.collisions, 100u);
    EXPECT_LT(cold.energy, 1e-35);
    EXPECT_GT(cold.time, 0);
    EXPECT_THROW(simulation.advance(until_collisions(1e6)), InvalidStateError);
    EXPECT_EQ(simulation.advance(until_time(9e18)), Stop::time);
    EXPECT_EQ(simulation.time(), 9e18);
  }
}

TEST(AtRest, NothingHappens) {
  Scene resting = gas(50, 3);
  resting.initial.t_tr = resting.initial.t_rot = 0;
  EXPECT_EQ(run_hard(resting, until_collisions(1)).stop, Stop::nothing_can_happen);
  const HardRun run = run_hard(resting, until_time(1e15));
  EXPECT_EQ(run.stop, Stop::time);
  EXPECT_EQ(run.time, 1e15);
  EXPECT_EQ(run.last.energy, 0);
  // All with one velocity.
  State state = draw_initial_state(resting);
  for (Three& v : state.velocity) v = {0.3, -0.2, 1e-9};
  EXPECT_EQ(run_hard(resting, state, until_collisions(1)).stop, Stop::nothing_can_happen);
}

// One needle moves among many at rest, and sets them in motion.
TEST(AtRest, AllButOneAreSetInMotion) {
  Scene resting = gas(60, 4);
  resting.initial.t_tr = resting.initial.t_rot = 0;
  for (const bool spins : {false, true}) {
    State state = draw_initial_state(resting);
    if (spins) {
      const Three u = state.orientation[17];
      state.angular_velocity[17] = 5.0 * cross(u, Three{u[1], u[2], -u[0]});
      state.velocity[17] = {0.01, 0.02, 0};
    } else {
      state.velocity[17] = {1, 0.5, 0.2};
    }
    const HardRun run = run_hard(resting, state, until_collisions(5.0 / thin));
    EXPECT_EQ(run.stop, Stop::collisions) << spins;
  }
}

// Needles that only fly or only rotate, so that nothing may be divided by 0; and very different
// scales.
TEST(Scales, OfFlightAndRotationMayBeFarApart) {
  for (const auto& [t_tr, t_rot] : std::vector<std::array<double, 2>>{
           {1, 0}, {0, 1}, {1, 1e-12}, {1e-12, 1}, {1, 1e-300}, {1e-300, 1}, {1, 5e-324}}) {
    const Scene scene = gas(60, 3);
    SCOPED_TRACE("T_tr " + std::to_string(std::log10(t_tr)) + ", T_rot " +
                 std::to_string(std::log10(t_rot)));
    // Audited only where the audit, which is not made for rotation on the spot, does not take
    // minutes.
    const Watch watch{.everywhere = false,
                      .undecided = 2,
                      .audited = t_tr == 1 && (t_rot == 0 || t_rot > 1e-100)};
    const HardRun run =
        run_hard(scene, at_temperatures(scene, t_tr, t_rot), until_collisions(6.0 / thin), watch);
    EXPECT_EQ(run.stop, Stop::collisions);
    EXPECT_NEAR(run.last.energy, run.first.energy, 1e-12 * run.first.energy);
  }
}

TEST(Inertia, MayBeOfAnySize_long) {
  for (const double k : {1e-3, 2.0, 6.0, 1000.0, 1e6}) {
    for (const double epsilon : {1.0, 0.8}) {
      Scene scene = gas(60, 3);
      scene.needles.k = k;
      scene.collisions.epsilon = epsilon;
      if (epsilon < 1) scene.collisions.tc_relative = 1e-3;
      SCOPED_TRACE(name_of(scene) + ", k " + std::to_string(k));
      const HardRun run =
          run_hard(scene, until_collisions(6.0 / thin), {.everywhere = false, .undecided = 2});
      EXPECT_EQ(run.stop, Stop::collisions);
    }
  }
}

TEST(Restitution, MayBeAnyOfItsRange_long) {
  for (const double beta : {-1.0, -0.5, 0.0, 0.5, 1.0}) {
    for (const double epsilon : {1.0, 0.5, 0.0}) {
      Scene scene = test::inelastic(gas(60, 3), epsilon, 1e-2, beta);
      SCOPED_TRACE(name_of(scene));
      const HardRun run =
          run_hard(scene, until_collisions(6.0 / thin), {.everywhere = false, .undecided = 20});
      // Without a rebound no contact time helps.
      if (epsilon > 0) {
        EXPECT_EQ(run.stop, Stop::collisions) << run.failure;
      } else if (run.failed()) {
        EXPECT_NE(run.failure.find("collapse"), std::string::npos) << run.failure;
      }
    }
  }
}

// Each collapse in a cooling gas without a contact time is reported with pair, time and gap.
TEST(Restitution, WithoutContactTimeEndsInAClearError_long) {
  for (const double epsilon : {0.0, 0.2, 0.6}) {
    for (const double beta : {-1.0, 0.0}) {
      Scene scene = gas(60, 4);
      scene.collisions.epsilon = epsilon;
      scene.collisions.beta = beta;
      SCOPED_TRACE(name_of(scene));
      const HardRun run =
          run_hard(scene, until_collisions(200.0 / thin), {.everywhere = false, .audited = false});
      // Rough needles lose their energy before they collapse, except for epsilon = 0.
      if (thin == 1 && (beta == -1 || epsilon == 0)) {
        EXPECT_TRUE(run.failed());
      }
      for (const char* part :
           {"collapse", "at time", epsilon == 0 ? "epsilon = 0" : "tc_relative"}) {
        if (!run.failed()) continue;
        EXPECT_NE(run.failure.find(part), std::string::npos) << run.failure;
      }
    }
  }
}

TEST(Density, MayBeTwoHundred_long) {
  Scene scene = gas(1650 / thin, 2.02);
  const HardRun run =
      run_hard(scene, until_collisions(1), {.everywhere = false, .share = 0.02, .undecided = 2});
  EXPECT_EQ(run.stop, Stop::collisions);
  EXPECT_GE(run.end.size() / std::pow(2.02, 3), 200 / thin);
}

// To 1e-30 of the energy, at times of 1e15: the resolution of time is the same as at the start.
TEST(LongTimes, EnergyFallsBy30Decades_long) {
  Scene scene = test::inelastic(gas(40, 3), 0.6);
  const HardRun run = run_hard(scene, until_energy(thin == 1 ? 1e-30 : 1e-6),
                               {.everywhere = false, .share = 0.05, .undecided = 10});
  EXPECT_EQ(run.stop, Stop::energy);
  EXPECT_LE(run.last.energy, run.first.energy * (thin == 1 ? 1e-30 : 1e-6) * (1 + 1e-9));
  if (thin == 1) {
    EXPECT_GT(run.time, 1e14);
  }
  std::printf("time %g, %zu collisions, %zu by tc\n", run.time, run.collisions.size(),
              static_cast<std::size_t>(run.last.tc_collisions));
}

// A contact that is predicted long before: its time is that of the quotient.
TEST(LongTimes, AContactAt1e15IsOnTime) {
  for (const double speed : {1e-15, 0x1p-50, 3e-16}) {
    State state = empty_state({4, 4, 4});
    add_needle(state, {2, 2, 2}, {1, 0, 0}, {0, 0, 0}, {0, 0, 0});
    add_needle(state, {2.25, 2.125, 2.75}, {0, 1, 0}, {0, 0, -speed}, {0, 0, 0});
    const HardRun run = run_hard(gas(2, 4), state, until_time(3e15));
    ASSERT_GE(run.collisions.size(), 1u);
    EXPECT_NEAR(run.collisions[0].time * speed, 0.75, 1e-15);
  }
}

// All velocities times a power of two give the same trajectory, bit for bit, up to the ends of the
// range.
TEST(Scaling, ByPowersOfTwoToTheEndsOfTheRange) {
  Scene absolute = gas(100, 4);
  absolute.collisions = {.epsilon = 0.8, .tc = 1e-3};
  for (const Scene& scene :
       {inelastic(gas(100, 4), 0.8), inelastic(gas(120, 4), 0.9, 1e-3, 0.3), absolute}) {
    const State state = draw_initial_state(scene);
    const double collisions = 600.0 / thin;
    const Recorded truth = record(scene, state, collisions);
    for (const int power : {-60, 60, 300, -300, 400, -400}) {
      SCOPED_TRACE(name_of(scene) + ", times 2^" + std::to_string(power));
      State scaled = state;
      for (auto* rows : {&scaled.velocity, &scaled.angular_velocity}) {
        for (Three& row : *rows) row = std::ldexp(1.0, power) * row;
      }
      Scene faster = scene;
      if (scene.collisions.tc) faster.collisions.tc = std::ldexp(*scene.collisions.tc, -power);
      const Recorded run = record(faster, scaled, collisions);
      ASSERT_EQ(run.epoch_length, std::ldexp(truth.epoch_length, -power));
      ASSERT_EQ(run.collisions.size(), truth.collisions.size());
      for (std::size_t n = 0; n < truth.collisions.size(); ++n) {
        const Collision &a = truth.collisions[n], &b = run.collisions[n];
        ASSERT_TRUE(a.first == b.first && a.second == b.second && a.shift == b.shift &&
                    a.epoch == b.epoch && std::ldexp(a.offset, -power) == b.offset &&
                    a.arm_first == b.arm_first && a.contact_time_rule == b.contact_time_rule &&
                    std::ldexp(a.impulse[0], power) == b.impulse[0] &&
                    std::ldexp(a.impulse[1], power) == b.impulse[1])
            << n;
      }
      EXPECT_EQ(run.end.position, truth.end.position);
      EXPECT_EQ(run.end.orientation, truth.end.orientation);
    }
  }
}

// If squares of velocities overflow or underflow, the events are right or there is an error that
// says so.
TEST(Scaling, BeyondTheRangeIsAClearErrorOrRight) {
  for (const double temperature : {1e300, 1e307, 1e-300, 1e-306, 1e-310, 1e-320, 5e-324}) {
    const Scene scene = gas(40, 3);
    SCOPED_TRACE(temperature);
    try {
      const HardRun run =
          run_hard(scene, at_temperatures(scene, temperature, temperature), until_collisions(4),
                   {.everywhere = false,
                    .undecided = 2,
                    .audited = temperature > 1e-250 && temperature < 1e250});
      EXPECT_EQ(run.stop, Stop::collisions) << run.failure;
      std::printf("T %g: %zu collisions, failure %s\n", temperature, run.collisions.size(),
                  run.failure.c_str());
    } catch (const InputError& error) {
      std::printf("T %g: %s\n", temperature, error.what());
    }
  }
}

TEST(Subnormal, ComponentsChangeNothing_long) {
  Random random(5);
  const double least = std::numeric_limits<double>::denorm_min();
  Scene scene = gas(60, 3);
  State state = draw_initial_state(scene);
  for (std::size_t i = 0; i < state.size(); ++i) {
    const auto tiny = [&] {
      return least * static_cast<double>(1 + random.below(1000000)) * (random.coin() ? 1 : -1);
    };
    const auto axis = static_cast<std::size_t>(random.below(3));
    const auto other = (axis + 1) % 3;
    if (i % 4 == 0) state.position[i][axis] = std::abs(tiny());
    if (i % 4 == 1) state.velocity[i][axis] = tiny();
    if (i % 4 == 2) state.angular_velocity[i] = {tiny(), tiny(), tiny()};
    if (i % 4 == 3) {
      state.orientation[i] = {tiny(), tiny(), tiny()};
      state.orientation[i][axis] = 1;
      state.angular_velocity[i] = {tiny(), tiny(), tiny()};
      state.angular_velocity[i][other] = random.normal();
    }
  }
  // For many pairs f is subnormal at the start.
  const HardRun run = run_hard(scene, state, until_collisions(3.0 / thin), {.undecided = 800});
  EXPECT_EQ(run.stop, Stop::collisions);
  // Directors given by subnormal numbers only.
  for (auto& u : state.orientation) {
    u = {least * 3, -least * 5000, least * static_cast<double>(random.below(10000))};
  }
  EXPECT_EQ(
      run_hard(scene, state, until_collisions(3), {.everywhere = false, .audited = false}).stop,
      Stop::collisions);
}

}  // namespace
}  // namespace needlework::test
