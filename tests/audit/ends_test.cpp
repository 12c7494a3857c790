// What the engine says about the contact time in force, the start and the end of a run is derived
// again from the scene; other numbers are noticed.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "src/audit/audit.h"
#include "tests/support/audit_setup.h"
#include "tests/support/runs.h"
#include "tests/support/scenes.h"

namespace needlework::test {
namespace {

using audit::Kind;

/// A run of the engine to the end of its scene.
struct Whole {
  explicit Whole(const Scene& its_scene) : scene(its_scene) {
    Followed run(scene);
    initial = run->copy();
    epoch_length = run->epoch_length();
    stop = run->advance(scene.until);
    end = run->time();
    collisions = run.collisions;
  }

  audit::Setup setup() const {
    return audit_setup(scene, epoch_length, 0);  // no flights of pairs
  }
  std::uint64_t count(Kind kind) const {
    audit::Audit audit(initial, setup());
    audit.check_start(scene, given ? &*given : nullptr);
    for (const Collision& collision : collisions) audit.add(collision);
    audit.finish(end);
    audit.check_end(scene.until, stop, end);
    return audit.findings().count(kind);
  }

  Scene scene;
  State initial;
  std::optional<State> given;
  double epoch_length = 1, end = 0;
  std::vector<Collision> collisions;
  Stop stop{};
};

Scene cooling() {
  Scene scene = test::inelastic(scene_of(60, 4), 0.7, 0.02);
  scene.initial.t_rot = 0.5;
  scene.until.collisions_per_needle = 60;
  return scene;
}

// The engine's quadrature is exact to 1e-6 only.
TEST(AuditWindows, HaveTheMeanFreeTimeOfTheEngine) {
  for (const double k : {0.01, 2.0, 6.0, 300.0}) {
    for (const auto& [t_tr, t_rot] : {std::pair(1.0, 1.0), std::pair(1.0, 0.0), std::pair(0.0, 1.0),
                                      std::pair(1e-4, 3.0), std::pair(5.0, 1e-3)}) {
      Scene scene = scene_of(50, 5);
      scene.needles.k = k;
      scene.initial.t_tr = t_tr;
      scene.initial.t_rot = t_rot;
      const audit::Temperatures gas{50, t_tr, t_rot};
      const audit::AuditedBody body{.k = k};
      const double ours = audit::mean_free_time({&gas, 1}, {&body, 1}, {}, 125);
      EXPECT_NEAR(ours / Simulation(scene).mean_free_time(), 1, audit::Windows::tolerance / 2)
          << k << ", " << t_tr << ", " << t_rot;
    }
  }
}

TEST(AuditWindows, HaveTheMeanFreeTimeOfTheEngineForMixtures) {
  for (const auto& [t_tr, t_rot] :
       {std::pair(1.0, 1.0), std::pair(1.0, 0.0), std::pair(0.2, 3.0)}) {
    Scene scene = scene_of(0, 25);
    scene.species = {
        {.name = "a", .count = 50, .length = 0.5, .mass = 3, .k = 2, .t_tr = t_tr, .t_rot = t_rot},
        {.name = "b", .count = 30, .length = 10, .mass = 9, .k = 40, .t_tr = 0.1, .t_rot = 0.01},
        {.name = "c", .count = 1, .length = 2, .mass = 1e-3, .k = 6, .t_tr = 1, .t_rot = 1}};
    const Simulation simulation(scene);
    std::vector<audit::Temperatures> gas;
    std::vector<audit::AuditedBody> bodies;
    const auto totals = simulation.species_totals();
    for (std::size_t n = 0; n < 3; ++n) {
      const Species& each = scene.species[n];
      gas.push_back({static_cast<double>(each.count), totals[n].t_tr, totals[n].t_rot});
      bodies.push_back({n, each.length, each.mass, each.k});
    }
    const double ours = audit::mean_free_time(gas, bodies, scene.composition(), 25 * 25 * 25);
    EXPECT_NEAR(ours / simulation.mean_free_time(), 1, audit::Windows::tolerance / 2)
        << t_tr << ", " << t_rot;
  }
}

TEST(AuditEnds, OfAMixtureAreThoseOfItsScene) {
  Scene scene = scene_of(0, 5);
  scene.species = {{.name = "a", .count = 50, .length = 0.5, .mass = 3, .k = 2, .t_tr = 2},
                   {.name = "b", .count = 20, .length = 1.5, .mass = 1, .k = 6, .t_rot = 0.5}};
  scene.collisions.epsilon = 0.7;
  scene.collisions.tc_relative = 0.02;
  scene.until.energy_ratio = 0.5;
  const Whole run(scene);
  EXPECT_EQ(run.stop, Stop::energy);
  EXPECT_EQ(run.count(Kind::wrong_start), 0u);
  EXPECT_EQ(run.count(Kind::wrong_end), 0u);
  EXPECT_EQ(run.count(Kind::wrong_rule), 0u);

  Whole hotter = run;
  hotter.scene.species[0].t_tr = 2.0001;
  EXPECT_EQ(hotter.count(Kind::wrong_start), 1u);
  Whole swapped = run;
  std::swap(swapped.scene.species[0].count, swapped.scene.species[1].count);
  EXPECT_EQ(swapped.count(Kind::wrong_start), 1u);
  Whole given = run;
  given.given = run.initial;
  EXPECT_EQ(given.count(Kind::wrong_start), 0u);
  std::swap(given.given->species.front(), given.given->species.back());
  EXPECT_EQ(given.count(Kind::wrong_start), 1u);
  Whole later = run;
  later.scene.until.energy_ratio = 0.6;
  EXPECT_EQ(later.count(Kind::wrong_end), 1u);
}

TEST(AuditWindows, DecideWhenARelativeContactTimeApplies) {
  Whole run(cooling());
  std::size_t elastic = 0;
  for (const Collision& collision : run.collisions) elastic += collision.contact_time_rule;
  EXPECT_GT(elastic, run.collisions.size() / 20);
  EXPECT_LT(elastic, run.collisions.size() / 2);
  EXPECT_EQ(run.count(Kind::wrong_rule), 0u);
  // The engine could use another contact time: one of the initial mean free time, or another share.
  for (const double factor : {0.99, 1.01}) {
    Whole other = run;
    *other.scene.collisions.tc_relative *= factor;
    EXPECT_GT(other.count(Kind::wrong_rule), 0u) << factor;
  }
  Whole absolute = run;
  absolute.scene.collisions.tc = 0.02 * Simulation(run.scene).mean_free_time();
  absolute.scene.collisions.tc_relative.reset();
  EXPECT_GT(absolute.count(Kind::wrong_rule), 10u);
}

TEST(AuditWindows, JudgeEachCollision) {
  Whole run(cooling());
  for (const bool was_elastic : {false, true}) {
    Whole other = run;
    std::size_t n = run.collisions.size() / 2;
    while (run.collisions[n].contact_time_rule != was_elastic) ++n;
    other.collisions[n].contact_time_rule = !was_elastic;
    EXPECT_GE(other.count(Kind::wrong_rule), 1u);
  }
}

TEST(AuditStart, IsTheGasOfTheScene) {
  const Whole run(cooling());
  EXPECT_EQ(run.count(Kind::wrong_start), 0u);
  const auto altered = [&](auto&& alter) {
    Whole other = run;
    alter(other);
    return other.count(Kind::wrong_start);
  };
  EXPECT_EQ(altered([](Whole& w) { w.scene.initial.t_tr *= 1 + 1e-9; }), 1u);
  EXPECT_EQ(altered([](Whole& w) { w.scene.initial.t_rot *= 1 - 1e-9; }), 1u);
  EXPECT_EQ(altered([](Whole& w) { w.scene.needles.count += 1; }), 1u);
  EXPECT_EQ(altered([](Whole& w) { w.scene.needles.box[1] *= 1 + 1e-12; }), 1u);
  EXPECT_EQ(altered([](Whole& w) { w.initial.position[7][0] += w.scene.needles.box[0]; }), 1u);
  EXPECT_EQ(altered([](Whole& w) { w.initial.orientation[7][0] += 1e-9; }), 1u);
  EXPECT_EQ(altered([](Whole& w) { w.epoch_length *= 2; }), 1u);
  EXPECT_EQ(altered([](Whole& w) {
              for (auto& v : w.initial.velocity) v[2] += 1e-9;
            }),
            1u);
}

TEST(AuditStart, IsTheStateThatWasGiven) {
  Whole run(cooling());
  run.given = run.initial;
  std::swap(run.given->id[3], run.given->id[8]);  // rows in any order
  for (auto* rows : {&run.given->position, &run.given->velocity, &run.given->orientation,
                     &run.given->angular_velocity}) {
    std::swap((*rows)[3], (*rows)[8]);
  }
  run.given->position[5][1] -= 3 * run.scene.needles.box[1];
  EXPECT_EQ(run.count(Kind::wrong_start), 0u);
  for (auto State::*rows :
       {&State::position, &State::velocity, &State::orientation, &State::angular_velocity}) {
    Whole other = run;
    ((*other.given).*rows)[3][1] += 1e-9;
    EXPECT_EQ(other.count(Kind::wrong_start), 1u);
  }
}

TEST(AuditEnd, IsAtTheFirstConditionThatIsMet) {
  using enum Stop;
  const auto run_to = [](Scene::Until until) {
    Scene scene = cooling();
    scene.until = until;
    return Whole(scene);
  };
  const auto altered = [](Whole run, auto&& alter) {
    alter(run);
    return run.count(Kind::wrong_end);
  };
  const auto drop_last = [](Whole& w) { w.collisions.pop_back(); };
  {
    const Whole run =
        run_to({.time = 3, .collisions_per_needle = 1e6, .energy_ratio = {}, .wall_s = {}});
    ASSERT_EQ(run.stop, time);
    EXPECT_EQ(run.count(Kind::wrong_end), 0u);
    EXPECT_EQ(altered(run, [](Whole& w) { w.end *= 1 + 1e-9; }), 1u);
    EXPECT_EQ(altered(run, [](Whole& w) { *w.scene.until.time *= 0.9; }), 1u);
    EXPECT_EQ(altered(run, [](Whole& w) { w.scene.until.time.reset(); }), 1u);
    EXPECT_EQ(altered(run, [](Whole& w) { w.scene.until.energy_ratio = 0.9; }), 1u);
    EXPECT_EQ(altered(run, [](Whole& w) { w.scene.until.collisions_per_needle = 1; }), 1u);
  }
  {
    const Whole run =
        run_to({.time = 1e6, .collisions_per_needle = 20, .energy_ratio = {}, .wall_s = {}});
    ASSERT_EQ(run.stop, Stop::collisions);
    EXPECT_EQ(run.count(Kind::wrong_end), 0u);
    EXPECT_EQ(altered(run, drop_last), 1u);
    EXPECT_EQ(altered(run, [](Whole& w) { w.scene.until.collisions_per_needle = 19.9; }), 1u);
    EXPECT_EQ(altered(run, [](Whole& w) { w.end *= 1.01; }), 1u);
  }
  {
    const Whole run =
        run_to({.time = {}, .collisions_per_needle = {}, .energy_ratio = 0.3, .wall_s = {}});
    ASSERT_EQ(run.stop, energy);
    EXPECT_EQ(run.count(Kind::wrong_end), 0u);
    EXPECT_EQ(altered(run, [](Whole& w) { *w.scene.until.energy_ratio *= 0.99; }), 1u);
    EXPECT_EQ(altered(run, [](Whole& w) { *w.scene.until.energy_ratio *= 1.01; }), 1u);
    EXPECT_EQ(altered(run, [](Whole& w) { w.stop = nothing_can_happen; }), 1u);
  }
}

}  // namespace
}  // namespace needlework::test
