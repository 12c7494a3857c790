// Velocities replaced by a caller: the run continues from them.
#include "tests/engine/set_velocities.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "needlework/error.h"
#include "src/audit/audit.h"
#include "tests/support/all_near.h"
#include "tests/support/audit_setup.h"
#include "tests/support/message_of.h"
#include "tests/support/same_run.h"
#include "tests/support/scenes.h"

namespace needlework {
namespace {

using test::all_parts;
using test::draw_velocities;
using test::expect_retraced;
using test::expect_same_with_all_parts;
using test::Followed;
using test::Parts;
using test::reverse;
using test::Rows;
using test::scale_velocities;
using test::thin;
using test::times;
using test::until_collision;
using test::until_collisions;
using test::until_time;

/// Collisions of a run that was restarted at `start`, a multiple of the epoch, audited from there.
void expect_clean(const Scene& scene, const State& state, std::int64_t start_epoch,
                  const Followed& run, double end) {
  const audit::Setup setup = test::audit_setup(scene, run->epoch_length());
  audit::Audit audit(state, setup);
  for (Collision c : run.collisions) {
    c.epoch -= start_epoch;
    c.time = static_cast<double>(c.epoch) * setup.epoch_length + c.offset;
    audit.add(c);
  }
  audit.finish(end - static_cast<double>(start_epoch) * setup.epoch_length);
  EXPECT_TRUE(audit.findings().clean());
  for (const audit::Difference& d : audit.findings().listed) {
    ADD_FAILURE() << audit::name(d.kind) << " at " << d.time << ": " << d.first << ", " << d.second;
  }
  EXPECT_EQ(audit.findings().undecided, 0u);
  EXPECT_GT(audit.findings().contacts, 50u);
}

TEST(SetVelocities, ToThoseThatTheNeedlesHaveGoesOn) {
  const Scene scene = test::scene_of(60, 4, 3);
  Followed run(scene);
  const std::int64_t epochs = 4;
  const double then = static_cast<double>(epochs) * run->epoch_length();
  ASSERT_EQ(run->advance(until_time(then)), Stop::time);
  const State before = run->copy();
  const Totals totals = run->totals();
  const std::string hash = run->trajectory_hash();
  ASSERT_GT(run.collisions.size(), 60u);
  run->set_velocities(before.velocity, before.angular_velocity);

  EXPECT_EQ(run->trajectory_hash(), hash);
  EXPECT_EQ(run->time(), then);
  EXPECT_EQ(run->totals().collisions, totals.collisions);
  EXPECT_NEAR(run->totals().energy, totals.energy, 1e-15 * totals.energy);
  const State state = run->copy();
  EXPECT_EQ(state.velocity, before.velocity);
  EXPECT_EQ(state.image, before.image);
  EXPECT_TRUE(test::all_near(state.position, before.position, 1e-15));
  EXPECT_TRUE(test::all_near(state.orientation, before.orientation, 1e-15));
  EXPECT_TRUE(test::all_near(state.angular_velocity, before.angular_velocity, 1e-14));

  // The same as of a run that begins here.
  Followed fresh(scene, state);
  run.collisions.clear();
  const double more = 4 * run->mean_free_time();
  ASSERT_EQ(run->advance(until_time(then + more)), Stop::time);
  ASSERT_EQ(fresh->advance(until_time(more)), Stop::time);
  ASSERT_EQ(run.collisions.size(), fresh.collisions.size());
  ASSERT_GT(run.collisions.size(), 80u);
  for (std::size_t n = 0; n < run.collisions.size(); ++n) {
    const Collision &a = run.collisions[n], &b = fresh.collisions[n];
    ASSERT_TRUE(a.first == b.first && a.second == b.second && a.shift == b.shift)
        << "collision " << n;
    ASSERT_NEAR(a.time - then, b.time, 1e-9) << "collision " << n;
    ASSERT_NEAR(a.normal_velocity, b.normal_velocity, 1e-7) << "collision " << n;
  }
  EXPECT_NEAR(run->totals().energy, totals.energy, 1e-13 * totals.energy);
  expect_clean(scene, state, epochs, run, then + more);
}

TEST(SetVelocities, ToOthersIsFollowedAsTheAuditSays) {
  for (const bool cools : {false, true}) {
    for (const double factor : {1.0, 100.0, 0.01}) {
      SCOPED_TRACE((cools ? "cooling, times " : "elastic, times ") + std::to_string(factor));
      Scene scene = test::scene_of(60, 4, 4);
      if (cools) scene = test::inelastic(scene, 0.8, 1e-4, 0.2);
      Followed run(scene);
      const double then = 3 * run->epoch_length();
      run->advance(until_time(then));
      draw_velocities(*run, 17);
      scale_velocities(*run, factor);
      const State state = run->copy();
      const Totals totals = run->totals();
      const double square = factor * factor;
      EXPECT_NEAR(totals.t_tr, square, 0.5 * square);
      EXPECT_NEAR(totals.t_rot, square, 0.5 * square);
      Simulation fresh(scene, state);
      EXPECT_NEAR(run->mean_free_time(), fresh.mean_free_time(), 1e-12 * fresh.mean_free_time());
      EXPECT_NEAR(totals.energy, fresh.totals().energy, 1e-14 * totals.energy);
      run.collisions.clear();
      const double end = then + 4 * run->mean_free_time();
      ASSERT_EQ(run->advance(until_time(end)), Stop::time);
      expect_clean(scene, state, 3, run, end);
      if (!cools) {
        EXPECT_NEAR(run->totals().energy, totals.energy, 1e-13 * totals.energy);
      }
    }
  }
}

TEST(SetVelocities, TakesOffWhatTurnsANeedleAboutItself) {
  Simulation simulation(test::scene_of(20, 4));
  const State state = simulation.copy();
  Rows spun = state.angular_velocity;
  for (std::size_t i = 0; i < state.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) spun[i][axis] += 7 * state.orientation[i][axis];
  }
  simulation.set_velocities(state.velocity, spun);
  EXPECT_TRUE(test::all_near(simulation.copy().angular_velocity, state.angular_velocity, 1e-14));
}

TEST(SetVelocities, TakesRowsByAscendingId) {
  const Scene scene = test::scene_of(50, 4);
  State state = draw_initial_state(scene);
  for (std::uint32_t n = 0; n < 50; ++n) state.id.push_back(1000 - 7 * n);
  Simulation simulation(scene, state);
  simulation.advance(until_time(1));
  Rows velocity, angular_velocity;
  for (int n = 0; n < 50; ++n) {
    velocity.push_back({1.0 * n, -2.0 * n, 0.5});
    angular_velocity.push_back({0, 0, 0});
  }
  simulation.set_velocities(velocity, angular_velocity);
  const State now = simulation.copy();
  EXPECT_TRUE(std::is_sorted(now.id.begin(), now.id.end()));
  EXPECT_EQ(now.velocity, velocity);
  EXPECT_EQ(now.angular_velocity, angular_velocity);
  EXPECT_EQ(simulation.needle(1000).velocity, velocity[49]);
  EXPECT_EQ(simulation.needle(1000 - 7 * 49).velocity, velocity[0]);
}

TEST(SetVelocities, ReversedRetraceEveryCollision) {
  for (const double beta : {-1.0, 1.0}) {
    Scene scene = test::scene_of(60, 4, 6);
    scene.collisions.beta = beta;
    for (const Parts& parts : all_parts()) {
      for (const std::size_t count : {1u, 7u, 30u, 60u}) {
        SCOPED_TRACE(parts.name() + ", beta " + std::to_string(beta) + ", from collision " +
                     std::to_string(count));
        const auto until = [](std::size_t n) {
          return until_collision(static_cast<double>(n), 60);
        };
        Followed run(parts.of(scene));
        const State start = run->copy();
        // At a collision, in which the pair would come through each other were its side lost.
        ASSERT_EQ(run->advance(until(count)), Stop::collisions);
        ASSERT_EQ(run.collisions.size(), count);
        const double turned = run->time();
        EXPECT_EQ(run.collisions.back().time, turned);
        std::vector<Collision> forth;
        forth.swap(run.collisions);
        reverse(*run);
        run->advance(until(2 * count));
        ASSERT_NO_FATAL_FAILURE(expect_retraced(forth, run.collisions, turned));
        EXPECT_EQ(run.collisions.front().time, turned) << "the touching pair, at once";
        run->advance(until_time(2 * turned));
        const State end = run->copy();
        ASSERT_EQ(run.collisions.size(), count);
        for (std::size_t i = 0; i < end.size(); ++i) {
          for (int axis = 0; axis < 3; ++axis) {
            const double moved = end.position[i][axis] - start.position[i][axis] +
                                 4.0 * (end.image[i][axis] - start.image[i][axis]);
            ASSERT_NEAR(moved, 0, 1e-7);
          }
        }
        ASSERT_TRUE(test::all_near(end.orientation, start.orientation, 1e-7));
        ASSERT_TRUE(test::all_near(end.velocity, times(-1, start.velocity), 1e-6));
      }
    }
  }
}

TEST(SetVelocities, IsTheSameWithEverySearchCalendarAndThread) {
  const Scene scene = test::inelastic(test::scene_of(150, 5, 12), 0.9, 1e-2, 0.1);
  expect_same_with_all_parts(scene, [](const Scene& with_parts) {
    Followed run(with_parts);
    run->advance(until_collisions(2));
    reverse(*run);
    run->advance(until_collisions(4));
    draw_velocities(*run, 3);
    run->advance(until_time(run->time() + 0.1));
    scale_velocities(*run, 1e-3);
    run->advance(until_collisions(6));
    return run.recorded();
  });
}

// Of so many that threads share the work.
TEST(SetVelocities, IsTheSameOnThreadsThatShareTheWork_long) {
  const auto run = [&](int threads) {
    Followed run(
        test::on_threads(test::inelastic(test::scene_of(3000, 9, 13), 0.9, 1e-2), threads));
    for (const double mean : {3.0, 6.0, 9.0}) {
      run->advance(until_collisions(mean / thin));
      if (mean < 5) {
        reverse(*run);
      } else {
        draw_velocities(*run, 5);
      }
    }
    run->advance(until_collisions(12.0 / thin));
    if (threads > 1) {
      EXPECT_GT(run->counters().phases, run->counters().redone);
    }
    return run.recorded();
  };
  const test::Recorded truth = run(1);
  for (const int threads : {2, 3}) {
    ASSERT_NO_FATAL_FAILURE(test::expect_same(truth, run(threads))) << threads << " threads";
  }
}

// The rule looks back over the change of velocities.
TEST(SetVelocities, LeavesTheMemoryOfTheContactTime) {
  constexpr double tc = 0.02;
  Scene scene = test::scene_of(100, 4, 14);
  scene.collisions.epsilon = 0.9;
  scene.collisions.tc = tc;
  for (const Parts& parts : all_parts()) {
    SCOPED_TRACE(parts.name());
    Followed run(parts.of(scene));
    std::map<std::uint32_t, double> last;
    std::uint64_t by_rule = 0, over_the_change = 0, others = 0;
    double changed = 0;
    run->on_collision([&](const Collision& c) {
      double since = std::numeric_limits<double>::infinity();
      for (const std::uint32_t id : {c.first, c.second}) {
        if (last.contains(id)) since = std::min(since, c.time - last[id]);
        last[id] = c.time;
      }
      if (std::abs(since - tc) < 1e-12) return;
      ASSERT_EQ(c.contact_time_rule, since < tc) << "at " << c.time << ", last " << since << " ago";
      if (c.contact_time_rule) {
        ASSERT_EQ(c.energy_change, 0);
      }
      by_rule += c.contact_time_rule;
      over_the_change += c.contact_time_rule && c.time - since <= changed;
      others += !c.contact_time_rule;
    });
    for (int n = 1; n <= 12; ++n) {
      run->advance(until_collisions(0.25 * n));
      changed = run->time();
      // Half of them at a collision, which happens again at once then, and half between two.
      if (n % 2 == 0) run->advance(until_time(changed += 1e-4));
      if (n % 3 == 0) {
        draw_velocities(*run, static_cast<std::uint64_t>(n));
      } else {
        reverse(*run);
      }
    }
    run->advance(until_collisions(4));
    EXPECT_EQ(run->totals().tc_collisions, by_rule);
    EXPECT_GT(over_the_change, 7u);
    EXPECT_GT(others, 50u);
  }
}

// A relative one is that of the new velocities from then on, not from the next window.
TEST(SetVelocities, SetTheContactTimeInForce) {
  const Scene scene = test::inelastic(test::scene_of(100, 4, 15), 0.9, 0.2);
  for (const double factor : {0.125, 8.0}) {
    SCOPED_TRACE(factor);
    Followed run(scene);
    run->advance(until_collisions(2));
    scale_velocities(*run, factor);
    Simulation fresh(scene, run->copy());
    const double mean = run->mean_free_time();
    EXPECT_NEAR(mean, fresh.mean_free_time(), 1e-12 * mean);
    const double tc = 0.2 * mean;
    std::map<std::uint32_t, double> last;
    for (const Collision& c : run.collisions) last[c.first] = last[c.second] = c.time;
    run.collisions.clear();
    run->advance(until_time(run->time() + 0.5 * mean));  // within the window
    std::uint64_t by_rule = 0;
    for (const Collision& c : run.collisions) {
      double since = std::numeric_limits<double>::infinity();
      for (const std::uint32_t id : {c.first, c.second}) {
        if (last.contains(id)) since = std::min(since, c.time - last[id]);
        last[id] = c.time;
      }
      if (std::abs(since - tc) < 1e-9 * tc) continue;
      EXPECT_EQ(c.contact_time_rule, since < tc) << since << " against " << tc;
      by_rule += c.contact_time_rule;
    }
    EXPECT_GT(run.collisions.size(), 15u);
    EXPECT_GT(by_rule, 0u);
  }
}

TEST(SetVelocities, RefusesBadRowsAndChangesNothing) {
  const Scene scene = test::inelastic(test::scene_of(40, 4, 16), 0.9);
  Simulation simulation(scene), truth(scene);
  for (Simulation* each : {&simulation, &truth}) each->advance(until_collisions(2));
  const State state = simulation.copy();
  const auto refused = [&](const Rows& velocity, const Rows& angular_velocity) {
    return test::message_of<InputError>(
        [&] { simulation.set_velocities(velocity, angular_velocity); });
  };
  const auto with = [](Rows rows, std::size_t row, double value) {
    rows[row][1] = value;
    return rows;
  };
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const Rows &v = state.velocity, &w = state.angular_velocity;
  EXPECT_EQ(refused({}, w), "set_velocities: 0 rows of velocity: expected 40");
  EXPECT_EQ(refused(Rows(41), w), "set_velocities: 41 rows of velocity: expected 40");
  EXPECT_EQ(refused(v, Rows(39)), "set_velocities: 39 rows of angular velocity: expected 40");
  EXPECT_EQ(refused(v, {}), "set_velocities: 0 rows of angular velocity: expected 40");
  const auto expect_row = [](const std::string& message, const std::string& row, double value) {
    EXPECT_TRUE(message.starts_with("set_velocities: " + row + " = (") &&
                message.ends_with("): expected finite numbers, their squares too") &&
                message.find(fmt::format(", {}, ", value)) != std::string::npos)
        << message;
  };
  expect_row(refused(with(v, 7, nan), w), "row 7 of velocity", nan);
  expect_row(refused(v, with(w, 39, -infinity)), "row 39 of angular velocity", -infinity);
  expect_row(refused(with(v, 3, 1e200), w), "row 3 of velocity", 1e200);
  EXPECT_EQ(refused(Rows(40, {0, 1e153, 0}), w),
            "set_velocities: an energy of 2e+307: expected at most 1e+290, in the units of the "
            "engine");
  EXPECT_TRUE(refused(with(v, 3, 1e20), w).starts_with("set_velocities: a mean free time of "));
  EXPECT_EQ(simulation.copy().position, state.position);
  EXPECT_EQ(simulation.copy().velocity, state.velocity);
  for (Simulation* each : {&simulation, &truth}) each->advance(until_collisions(10));
  EXPECT_EQ(simulation.trajectory_hash(), truth.trajectory_hash());
  EXPECT_EQ(simulation.copy().position, truth.copy().position);
  EXPECT_EQ(simulation.counters().searches, truth.counters().searches);
}

TEST(SetVelocities, LeavesFixedNeedlesAtRest) {
  Scene scene = test::scene_of(0, 6, 5);
  scene.species = {{.name = "moving", .count = 20}, {.name = "still", .count = 10, .fixed = true}};
  Simulation simulation(scene);
  const State state = simulation.copy();
  const auto refused = [&](Rows velocity, Rows angular_velocity) {
    return test::message_of<InputError>(
        [&] { simulation.set_velocities(velocity, angular_velocity); });
  };
  Rows v = state.velocity, w = state.angular_velocity;
  for (std::size_t i = 0; i < 20; ++i) v[i] = {1, 0, 0};
  const Rows along = v;
  v[20] = {0, 0, 2};
  EXPECT_EQ(refused(v, w),
            "set_velocities: row 20 of velocity = (0, 0, 2): expected 0, as its species is fixed");
  w[29] = {0, 1, 0};
  EXPECT_EQ(refused(along, w),
            "set_velocities: row 29 of angular velocity = (0, 1, 0): expected 0, as its species is "
            "fixed");
  EXPECT_EQ(simulation.copy().velocity, state.velocity);
  simulation.set_velocities(along, state.angular_velocity);
  simulation.advance(until_collisions(5));
  const State after = simulation.copy();
  EXPECT_TRUE(
      std::equal(after.position.begin() + 20, after.position.end(), state.position.begin() + 20));
}

TEST(SetVelocities, OfNoNeedlesOrOneAreSet) {
  Simulation none(test::scene_of(0, 4));
  none.set_velocities({}, {});
  EXPECT_EQ(none.advance(until_time(1)), Stop::time);
  Simulation one(test::scene_of(1, 4));
  one.advance(until_time(1));
  const std::array<double, 3> before = one.copy().position[0];
  const Rows velocity{{0.25, 0, 0}}, still(1);
  one.set_velocities(velocity, still);
  one.advance(until_time(2));
  EXPECT_NEAR(one.totals().energy, 0.5 * 0.25 * 0.25, 1e-16);
  EXPECT_NEAR(std::remainder(one.copy().position[0][0] - before[0] - 0.25, 4), 0, 1e-14);
}

// The ratio of an end by energy is that to the energy at the start of the run.
TEST(SetVelocities, LeaveTheEnergyOfTheStart) {
  for (const int threads : {1, 2}) {
    Simulation simulation(
        test::on_threads(test::inelastic(test::scene_of(100, 5, 17), 0.8), threads));
    const double start = simulation.totals().energy;
    simulation.advance(until_collisions(1));
    scale_velocities(simulation, 2);
    EXPECT_GT(simulation.totals().energy, 2.5 * start);
    Scene::Until until;
    until.energy_ratio = 0.75;
    EXPECT_EQ(simulation.advance(until), Stop::energy);
    EXPECT_NEAR(simulation.totals().energy, 0.75 * start, 0.02 * start);
    EXPECT_LE(simulation.totals().energy, 0.75 * start * (1 + 1e-12));
    // At once when it has been fallen below.
    scale_velocities(simulation, 0.5);
    const std::uint64_t collisions = simulation.totals().collisions;
    until.energy_ratio = 0.25;
    EXPECT_EQ(simulation.advance(until), Stop::energy);
    EXPECT_EQ(simulation.totals().collisions, collisions);
  }
}

}  // namespace
}  // namespace needlework
