// Whatever effects a scene has, it has one trajectory: with every search, calendar and instruction
// set, on threads, and wherever it is stopped, saved and continued.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "kernels/isa.h"
#include "needlework/error.h"
#include "src/calendar/names.h"
#include "src/engine/initial_gas.h"
#include "src/engine/make_loop.h"
#include "src/engine/run.h"
#include "tests/engine/effect_scenes.h"
#include "tests/support/parallel_loops.h"
#include "tests/support/same_run.h"
#include "tests/support/scenes.h"

namespace needlework {
namespace {

using test::EffectScene;

// All that is summed and counted beside collisions, to the last bit.
void expect_same_sums(const Simulation& a, const Simulation& b) {
  EXPECT_EQ(a.time(), b.time());
  EXPECT_EQ(a.totals().collisions, b.totals().collisions);
  EXPECT_EQ(a.totals().tc_collisions, b.totals().tc_collisions);
  EXPECT_EQ(a.collisions_by_pair(), b.collisions_by_pair());
  EXPECT_EQ(a.events_by_source(), b.events_by_source());
  EXPECT_EQ(test::numbers_of(a.energy_budget()), test::numbers_of(b.energy_budget()));
  EXPECT_EQ(a.t_tr_integral(), b.t_tr_integral());
  EXPECT_EQ(a.virial(), b.virial());
  const auto stress = a.stress_sums(), other_stress = b.stress_sums();
  ASSERT_EQ(stress.has_value(), other_stress.has_value());
  if (stress) {
    EXPECT_EQ(stress->kinetic, other_stress->kinetic);
    EXPECT_EQ(stress->collisional, other_stress->collisional);
  }
  const auto walls = a.wall_totals(), other_walls = b.wall_totals();
  ASSERT_EQ(walls.size(), other_walls.size());
  for (std::size_t n = 0; n < walls.size(); ++n) {
    EXPECT_EQ(walls[n].hits, other_walls[n].hits);
    EXPECT_EQ(walls[n].impulse, other_walls[n].impulse);
    EXPECT_EQ(walls[n].normal_impulse, other_walls[n].normal_impulse);
    EXPECT_EQ(walls[n].impulse_x, other_walls[n].impulse_x);
    EXPECT_EQ(walls[n].impulse_y, other_walls[n].impulse_y);
    EXPECT_EQ(walls[n].impulse_z, other_walls[n].impulse_z);
    EXPECT_EQ(walls[n].work, other_walls[n].work);
    EXPECT_EQ(walls[n].place, other_walls[n].place);
  }
  const auto held = a.sliding_contacts(), other_held = b.sliding_contacts();
  ASSERT_EQ(held.has_value(), other_held.has_value());
  if (!held) return;
  EXPECT_EQ(held->entered, other_held->entered);
  EXPECT_EQ(held->ended_by_force, other_held->ended_by_force);
  EXPECT_EQ(held->ended_by_tip, other_held->ended_by_tip);
  EXPECT_EQ(held->ended_by_strike, other_held->ended_by_strike);
  EXPECT_EQ(held->time, other_held->time);
}

void expect_the_same(const test::Followed& truth, const test::Followed& other) {
  ASSERT_NO_FATAL_FAILURE(test::expect_same(truth.recorded(), other.recorded()));
  ASSERT_NO_FATAL_FAILURE(expect_same_sums(truth.simulation, other.simulation));
}

constexpr const char* searches[] = {"linked-lists", "linked-cells", "capsules", "auto"};

// With the n-th calendar, instruction set and order of storage.
Scene with_parts(Scene scene, const char* search, std::size_t n) {
  const auto isas = kernels::available();
  scene.engine.search = search;
  scene.engine.queue = calendar_names()[n % calendar_names().size()];
  scene.engine.isa = kernels::name_of(isas[n % isas.size()]);
  scene.engine.storage = n % 2 == 0 ? "sorted" : "by-id";
  return scene;
}

class EveryEffect : public testing::TestWithParam<EffectScene> {
 protected:
  EveryEffect() : truth_(test::searched_by(scene(), "all-pairs")) { truth_->advance(end()); }

  static const Scene& scene() { return GetParam().scene; }
  static const Scene::Until& end() { return GetParam().end; }
  // Among all scenes, so that each pair of parts is together in some.
  static std::size_t number() { return GetParam().name.size(); }
  void expect_the_same_with(const Scene& with) {
    SCOPED_TRACE(with.engine.search + ", " + with.engine.queue + ", " + with.engine.isa);
    test::Followed other(with);
    other->advance(end());
    ASSERT_NO_FATAL_FAILURE(expect_the_same(truth_, other));
  }

  test::Followed truth_;
};

TEST_P(EveryEffect, HasOneTrajectory) {
  // What is compared has happened.
  EXPECT_GT(truth_.collisions.size(), 40u);
  if (scene().collisions.sliding) {
    EXPECT_GT(truth_->sliding_contacts()->entered, 5u);
    if (scene().driving.kicks || scene().driving.andersen) {
      EXPECT_GT(truth_->sliding_contacts()->ended_by_strike,
                truth_->sliding_contacts()->entered / 4);
    }
  }
  for (const WallTotals& wall : truth_->wall_totals()) EXPECT_GT(wall.hits, 0u);
  Scene undriven = scene();
  undriven.driving = {};
  if (scene().driving.kicks || scene().driving.andersen) {
    EXPECT_NE(test::hash_of(undriven, end()), truth_->trajectory_hash());
  }
  for (std::size_t n = 0; n < calendar_names().size(); ++n) {
    const char* search = searches[n % std::size(searches)];
    ASSERT_NO_FATAL_FAILURE(expect_the_same_with(with_parts(scene(), search, n + number())));
  }
}

TEST_P(EveryEffect, HasOneTrajectoryOfAllSearchesAndCalendars_long) {
  for (const char* search : searches) {
    for (std::size_t n = 0; n < calendar_names().size(); ++n)
      ASSERT_NO_FATAL_FAILURE(expect_the_same_with(with_parts(scene(), search, n)));
  }
}

// Of eight times as many needles in a box as dense, so that threads share the work; with short
// sight phases are rolled back again and again.
TEST_P(EveryEffect, HasOneTrajectoryOnThreads) {
  Scene large = scene();
  large.needles.count *= 8;
  for (Species& each : large.species) each.count *= 8;
  for (double& edge : large.needles.box) edge *= 2;
  for (Scene::Wall& wall : large.walls) {
    if (!wall.motion || !wall.motion->stop_at) continue;
    *wall.motion->stop_at *= 2;
    *wall.motion->velocity *= 2;  // at the same time
  }
  const Scene::Until end = GetParam().share_of_end(0.25);
  test::Followed truth(large);
  truth->advance(end);
  for (const auto& [search, threads] : {std::pair("linked-cells", 2), {"capsules", 3}}) {
    SCOPED_TRACE(search);
    test::Followed other(test::on_threads(test::searched_by(large, search), threads));
    other->advance(end);
    ASSERT_NO_FATAL_FAILURE(expect_the_same(truth, other));
  }
  // A simulation kicks needles and cools those that grow, not its loop.
  if (large.driving.kicks || large.driving.growth || large.walls.empty() ||
      large.forces.gravity[0] != 0)
    return;
  needlework::Run run(large, make_gas(large, draw_initial_state(large)));
  const auto loop =
      test::parallel_loop(run, "capsules", 3, {.sight = 0.3, .least = 1, .by_cost = false});
  loop->advance(StopConditions(run, end));
  EXPECT_GT(run.tally.counters.phases, 0u);
  EXPECT_EQ(run.tally.hash.hex(), truth->trajectory_hash());
  EXPECT_EQ(test::numbers_of(run.energy_budget()), test::numbers_of(truth->energy_budget()));
}

// What a run of the scene must not be continued as.
std::vector<Scene> other_scenes(const Scene& scene) {
  std::vector<Scene> out;
  const auto add = [&](bool has, const auto& change) {
    if (has) change(out.emplace_back(scene));
  };
  add(scene.species.size() > 1, [](Scene& s) { s.species[1].mass *= 1.01; });
  add(!scene.species.empty() && scene.species.back().diameter > 0,
      [](Scene& s) { s.species.back().diameter *= 1.01; });
  add(!scene.pairs.empty(), [](Scene& s) { s.pairs[0].epsilon = 0.7; });
  add(scene.shear.has_value(), [](Scene& s) { s.shear->rate *= 1.01; });
  add(scene.collisions.sliding, [](Scene& s) { s.collisions.sliding_below = 2e-3; });
  add(scene.collisions.elastic_strikes, [](Scene& s) { s.collisions.elastic_strikes = false; });
  add(!scene.walls.empty(), [](Scene& s) { s.walls[0].epsilon *= 0.99; });
  if (!scene.walls.empty() && scene.walls[0].motion) {
    const Scene::WallMotion& motion = *scene.walls[0].motion;
    add(motion.amplitude > 0, [](Scene& s) { s.walls[0].motion->frequency *= 1.01; });
    add(motion.velocity.has_value(), [](Scene& s) { *s.walls[0].motion->velocity *= 1.01; });
    add(motion.velocity && !motion.stop_at, [](Scene& s) {
      s.walls[0].motion->stop_at = *s.walls[0].motion->velocity > 0 ? 100 : -100;
    });
    add(motion.stop_at.has_value(), [](Scene& s) { *s.walls[0].motion->stop_at *= 1.01; });
    add(motion.tangential.has_value(),
        [](Scene& s) { (*s.walls[0].motion->tangential)[1] += 0.1; });
  }
  add(scene.forces.gravity[2] != 0, [](Scene& s) { s.forces.gravity[2] *= 1.01; });
  add(scene.forces.gravity[0] != 0, [](Scene& s) { s.forces.gravity[0] *= 1.01; });
  add(scene.driving.kicks.has_value(), [](Scene& s) { s.driving.kicks->rotational += 1; });
  add(scene.driving.andersen.has_value(), [](Scene& s) { s.driving.andersen->rate += 1; });
  add(scene.driving.kicks || scene.driving.andersen, [](Scene& s) { s.needles.seed += 1; });
  add(scene.driving.growth.has_value(), [](Scene& s) { s.driving.growth->rate *= 1.01; });
  add(scene.driving.growth.has_value(), [](Scene& s) { *s.driving.growth->until_packing += 0.01; });
  add(scene.driving.growth.has_value(), [](Scene& s) { *s.driving.growth->cool_every *= 1.01; });
  return out;
}

// At many times or collisions, so that contacts last at some of them, and some are within strikes
// or at kicks.
TEST_P(EveryEffect, GoesOnFromStopsAndCheckpoints) {
  test::Followed first(scene()), stopped(scene());
  constexpr int parts = 12;
  for (int part = 0; part < parts; ++part) {
    SCOPED_TRACE(part);
    first->advance(GetParam().share_of_end(part / double(parts)));
    const Checkpoint saved = first->checkpoint();
    test::Followed second(scene(), saved);
    ASSERT_NO_FATAL_FAILURE(expect_same_sums(first.simulation, second.simulation));
    second.collisions = first.collisions;
    second->advance(end());
    ASSERT_NO_FATAL_FAILURE(expect_the_same(truth_, second));
  }
  // Also at the instant of a kick, and between two.
  for (const double time : {0.0, 0.05, 0.07, 0.11, 0.11, 0.2, 0.22})
    stopped->advance(test::until_time(time));
  stopped->advance(end());
  ASSERT_NO_FATAL_FAILURE(expect_the_same(truth_, stopped));
  for (const Scene& other : other_scenes(scene()))
    EXPECT_THROW(Simulation(other, first->checkpoint()), InputError);
}

INSTANTIATE_TEST_SUITE_P(Scenes, EveryEffect, testing::ValuesIn(test::effect_scenes()),
                         [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace needlework
