// Velocities replaced by a caller: the run goes on from them, and no needle comes through another.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "needlework/error.h"
#include "src/audit/audit.h"
#include "src/calendar/all.h"
#include "tests/support/same_run.h"
#include "tests/support/sides.h"

namespace needlework {
namespace {

using test::thin;
using test::until_collisions;
using test::until_time;
using test::operator*;
using test::operator-;

using Rows = std::vector<std::array<double, 3>>;

Rows times(double factor, Rows rows) {
  for (auto& row : rows) {
    for (double& x : row) x *= factor;
  }
  return rows;
}

/// All velocities of the present state, times a factor.
void scale_velocities(Simulation& simulation, double factor) {
  const State state = simulation.copy();
  simulation.set_velocities(times(factor, state.velocity), times(factor, state.angular_velocity));
}
void reverse(Simulation& simulation) { scale_velocities(simulation, -1); }

/// New ones, of temperature 1 and k = 6.
void draw_velocities(Simulation& simulation, std::uint64_t seed) {
  test::Random random(seed);
  Rows velocity, angular_velocity;
  for (std::size_t n = 0; n < simulation.copy().size(); ++n) {
    velocity.push_back(random.normal_vector(1));
    angular_velocity.push_back(random.normal_vector(std::sqrt(12.0)));
  }
  simulation.set_velocities(velocity, angular_velocity);
}

/// Up to the collision of this number.
Scene::Until until_collision(double number, double needles) {
  return until_collisions(2 * (number - 0.5) / needles);
}

struct Parts {
  std::string search, queue;
  int threads = 1;

  std::string name() const {
    return search + ", " + queue + ", threads " + std::to_string(threads);
  }
  Scene of(Scene scene) const {
    scene.engine.search = search;
    scene.engine.queue = queue;
    scene.engine.threads = threads;
    return scene;
  }
};

template <class... Queues>
std::vector<std::string> names_of(CalendarList<Queues...>) {
  return {Queues::name...};
}

/// Every search, with every calendar in turn, and several threads; all-pairs first.
std::vector<Parts> all_parts() {
  std::vector<Parts> out;
  const std::vector<std::string> queues = names_of(AllCalendars<CalendarList>());
  std::size_t n = 0;
  for (const char* search : {"all-pairs", "linked-lists", "linked-cells", "capsules"}) {
    for (int times = 0; times < 2; ++times) out.push_back({search, queues[n++ % queues.size()]});
  }
  for (const char* search : {"linked-cells", "capsules"}) {
    out.push_back({search, "cell-calendar", 2});
  }
  return out;
}

/// What is done and seen with one choice of parts is the same with all.
void expect_same_with_all_parts(const Scene& scene,
                                const std::function<test::Recorded(const Scene&)>& run) {
  const std::vector<Parts> parts = all_parts();
  const test::Recorded truth = run(parts.front().of(scene));
  for (const Parts& other : parts) {
    SCOPED_TRACE(other.name());
    ASSERT_NO_FATAL_FAILURE(test::expect_same(truth, run(other.of(scene))));
  }
}

/// Follows a simulation; both end together.
struct Followed {
  explicit Followed(const Scene& scene) : simulation(std::make_unique<Simulation>(scene)) {
    follow();
  }
  Followed(const Scene& scene, const State& state)
      : simulation(std::make_unique<Simulation>(scene, state)) {
    follow();
  }
  void follow() {
    simulation->on_collision([this](const Collision& c) { collisions.push_back(c); });
  }
  test::Recorded recorded() const {
    return {collisions, simulation->copy(), simulation->totals(), simulation->trajectory_hash(),
            simulation->epoch_length()};
  }
  Simulation* operator->() { return simulation.get(); }
  Simulation& operator*() { return *simulation; }

  std::unique_ptr<Simulation> simulation;
  std::vector<Collision> collisions;
};

/// Collisions of a run that began anew at `start`, a multiple of the epoch, audited from there.
void expect_clean(const Scene& scene, const State& state, std::int64_t start_epoch,
                  const Followed& run, double end) {
  audit::Setup setup;
  setup.epoch_length = run.simulation->epoch_length();
  setup.rule = {scene.collisions.epsilon, scene.collisions.beta, scene.needles.k};
  setup.tc_relative = scene.collisions.tc_relative.has_value();
  audit::Audit audit(state, setup);
  for (Collision c : run.collisions) {
    c.epoch -= start_epoch;
    c.time = static_cast<double>(c.epoch) * setup.epoch_length + c.offset;
    audit.add(c);
  }
  audit.finish(end - static_cast<double>(start_epoch) * setup.epoch_length);
  EXPECT_TRUE(audit.tally().clean());
  for (const audit::Difference& d : audit.tally().listed) {
    ADD_FAILURE() << audit::name(d.kind) << " at " << d.time << ": " << d.first << ", " << d.second;
  }
  EXPECT_EQ(audit.tally().undecided, 0u);
  EXPECT_GT(audit.tally().contacts, 50u);
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
  for (std::size_t i = 0; i < state.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(state.position[i][axis], before.position[i][axis], 1e-15);
      EXPECT_NEAR(state.orientation[i][axis], before.orientation[i][axis], 1e-15);
      EXPECT_NEAR(state.angular_velocity[i][axis], before.angular_velocity[i][axis], 1e-14);
    }
  }

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
      if (cools) {
        scene.collisions.epsilon = 0.8;
        scene.collisions.beta = 0.2;
        scene.collisions.tc_relative = 1e-4;
      }
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
  const State now = simulation.copy();
  for (std::size_t i = 0; i < state.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(now.angular_velocity[i][axis], state.angular_velocity[i][axis], 1e-14);
    }
  }
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

// The last `count` collisions of a run happen again in the reverse order, seen from `turned`, when
// all velocities are reversed. The first may be at that very time.
void expect_retraced(const std::vector<Collision>& forth, const std::vector<Collision>& back,
                     double turned, double rested = 0) {
  ASSERT_EQ(back.size(), forth.size());
  for (std::size_t n = 0; n < back.size(); ++n) {
    const Collision &b = back[n], &f = forth[forth.size() - 1 - n];
    ASSERT_TRUE(b.first == f.first && b.second == f.second) << "collision " << n << " back";
    ASSERT_NEAR(b.time - turned - rested, turned - f.time, 1e-7) << "collision " << n << " back";
    // It was the velocity of approach, and of separation but for its sign.
    ASSERT_NEAR(b.normal_velocity, f.normal_velocity, 1e-6) << "collision " << n << " back";
    ASSERT_NEAR(b.arm_first, f.arm_first, 1e-6) << "collision " << n << " back";
  }
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
            ASSERT_NEAR(end.orientation[i][axis], start.orientation[i][axis], 1e-7);
            ASSERT_NEAR(end.velocity[i][axis], -start.velocity[i][axis], 1e-6);
          }
        }
      }
    }
  }
}

// Twice at one instant, the second time from records that have only been replaced.
TEST(SetVelocities, OfATouchingPairMayBeSetAgainAtOnce) {
  const Scene scene = test::scene_of(60, 4, 7);
  for (const int times : {2, 3, 4}) {
    Followed run(scene);
    run->advance(until_collision(30, 60));
    std::vector<Collision> forth;
    forth.swap(run.collisions);
    const double turned = run->time();
    for (int n = 0; n < times; ++n) reverse(*run);
    run->advance(until_collision(60, 60));
    if (times % 2 == 1) {
      ASSERT_NO_FATAL_FAILURE(expect_retraced(forth, run.collisions, turned));
    } else {
      // As if nothing had been.
      Followed plain(scene);
      plain->advance(until_collision(60, 60));
      ASSERT_EQ(run.collisions.size(), 30u);
      for (std::size_t n = 0; n < 30; ++n) {
        const Collision &a = run.collisions[n], &b = plain.collisions[30 + n];
        ASSERT_TRUE(a.first == b.first && a.second == b.second) << "collision " << n;
        ASSERT_NEAR(a.time, b.time, 1e-9);
      }
    }
  }
}

// All needles rest for a while, the pair on its contact, and go back then.
TEST(SetVelocities, OfATouchingPairMayBeZeroForAWhile) {
  const Scene scene = test::scene_of(60, 4, 8);
  for (const Parts& parts : all_parts()) {
    SCOPED_TRACE(parts.name());
    for (const double rest : {0.0, 0.7, 1e6}) {
      SCOPED_TRACE(rest);
      Followed run(parts.of(scene));
      run->advance(until_collision(30, 60));
      std::vector<Collision> forth;
      forth.swap(run.collisions);
      const double turned = run->time();
      const State then = run->copy();
      scale_velocities(*run, 0);
      EXPECT_EQ(run->totals().energy, 0);
      if (rest > 0) {
        EXPECT_EQ(run->advance(until_collisions(2)), Stop::nothing_can_happen);
        EXPECT_EQ(run->advance(until_time(turned + rest)), Stop::time);
      }
      const double again = run->time();
      EXPECT_NEAR(again, turned + rest, 1e-9);
      run->set_velocities(times(-1, then.velocity), times(-1, then.angular_velocity));
      run->advance(until_collision(60, 60));
      ASSERT_NO_FATAL_FAILURE(expect_retraced(forth, run.collisions, turned, again - turned));
      EXPECT_EQ(run.collisions.front().time, again);
    }
  }
}

// Needle 0 struck at one instant by needle 1 from above and by needle 2 from below.
class BothSides {
 public:
  BothSides(const Parts& parts, double arm) {
    State state;
    state.box = {4, 4, 4};
    state.position = {{2, 2, 2}, {2 + arm, 2, 3}, {2 + arm, 2, 1}};
    state.orientation = {{1, 0, 0}, {0, 1, 0}, {0, 1, 0}};
    state.velocity = {{0, 0, 0}, {0, 0, -1}, {0, 0, 1}};
    state.angular_velocity = Rows(3);
    run_ = std::make_unique<Followed>(parts.of(test::scene_of(0, 4)), state);
    // After the first of the two.
    EXPECT_EQ((*run_)->advance(until_collision(1, 3)), Stop::collisions);
    EXPECT_EQ((*run_)->time(), 1);
  }

  /// Sets velocities along z and no rotation, follows them for a while, and expects each needle on
  /// its side.
  void expect_sides(double z0, double z1, double z2) {
    Followed& run = *run_;
    run.collisions.clear();
    run->set_velocities(Rows{{0, 0, z0}, {0, 0, z1}, {0, 0, z2}}, Rows(3));
    const double begin = run->time();
    for (int step = 1; step <= 20; ++step) {
      run->advance(until_time(begin + step * 0.01));
      const State state = run->copy();
      ASSERT_NO_FATAL_FAILURE(expect_side(state, 1, 1)) << "step " << step;
      ASSERT_NO_FATAL_FAILURE(expect_side(state, 2, -1)) << "step " << step;
    }
  }
  const std::vector<Collision>& collisions() const { return run_->collisions; }

 private:
  // Unless the needle has left needle 0 by one of the ends.
  void expect_side(const State& state, std::size_t i, int side) {
    const test::PairState pair = test::pair_of(state, i, 0);
    const auto s = test::arms(pair);
    if (abs(s[0]) > 0.5 || abs(s[1]) > 0.5) return;
    // e_y x e_x points down.
    ASSERT_GE(-side * test::slopes(pair).f, -1e-15) << "needle " << i;
  }

  std::unique_ptr<Followed> run_;
};

TEST(SetVelocities, OfANeedleTouchingTwoKeepBothSides) {
  for (const Parts& parts : all_parts()) {
    for (const double arm : {0.0, 0.25, 0.4375}) {
      SCOPED_TRACE(parts.name() + ", arm " + std::to_string(arm));
      {
        SCOPED_TRACE("all away from each other");
        BothSides scene(parts, arm);
        ASSERT_NO_FATAL_FAILURE(scene.expect_sides(0, 1, -1));
        EXPECT_EQ(scene.collisions().size(), 0u);
      }
      {
        SCOPED_TRACE("both towards the one between them");
        BothSides scene(parts, arm);
        ASSERT_NO_FATAL_FAILURE(scene.expect_sides(0, -1, 1));
        ASSERT_GE(scene.collisions().size(), 2u);
        EXPECT_EQ(scene.collisions().front().time, 1);
        EXPECT_EQ(scene.collisions()[1].time, 1);
      }
      for (const double side : {-1.0, 1.0}) {
        SCOPED_TRACE("the one between them towards one");
        BothSides scene(parts, arm);
        ASSERT_NO_FATAL_FAILURE(scene.expect_sides(side, 0, 0));
        ASSERT_GE(scene.collisions().size(), 1u);
        EXPECT_EQ(scene.collisions().front().second, side > 0 ? 1u : 2u);
      }
      {
        SCOPED_TRACE("all along, then at rest, then together");
        BothSides scene(parts, arm);
        ASSERT_NO_FATAL_FAILURE(scene.expect_sides(0.5, 0.5, 0.5));
        ASSERT_NO_FATAL_FAILURE(scene.expect_sides(0, 0, 0));
        EXPECT_EQ(scene.collisions().size(), 0u);
        ASSERT_NO_FATAL_FAILURE(scene.expect_sides(0, -1, 1));
        ASSERT_GE(scene.collisions().size(), 2u);
      }
    }
  }
}

// Many needles whose contact points come to one point at time 1: nearly all pairs touch to within
// rounding, in the midst of a train of collisions. Whatever velocities they get then, none comes
// through another.
TEST(SetVelocities, OfManyThroughOnePointKeepTheirSides) {
  constexpr double little = 1e-4;
  int told = 0;
  std::uint64_t touches = 0;
  for (const int count : {3, 8, 14}) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      const Scene scene = test::scene_of(0, 6);
      test::Random random(4711 + seed);
      State state;
      state.box = {6, 6, 6};
      for (int n = 0; n < count; ++n) {
        const test::Vec<double> u = random.direction(), v = random.normal_vector(0.7);
        state.position.push_back(test::Vec<double>{3, 3, 3} - random.uniform(-0.45, 0.45) * u - v);
        state.orientation.push_back(u);
        state.velocity.push_back(v);
        state.angular_velocity.push_back({0, 0, 0});
      }
      Simulation rehearsal(scene, state);
      rehearsal.advance(until_time(1 - little));
      const State before = rehearsal.copy();
      const std::uint64_t early = rehearsal.totals().collisions;
      rehearsal.advance(until_time(1 + little));
      const std::uint64_t all = rehearsal.totals().collisions - early;
      ASSERT_GE(all, static_cast<std::uint64_t>(count) - 1);
      const auto parts = all_parts();
      for (std::uint64_t n = 1; n <= all; n += 1 + all / 8) {
        for (int kind = 0; kind < 4; ++kind) {
          const Parts& chosen = parts[(n + seed + static_cast<std::uint64_t>(kind)) % parts.size()];
          SCOPED_TRACE(std::to_string(count) + " needles, seed " + std::to_string(seed) +
                       ", after collision " + std::to_string(n) + " of " + std::to_string(all) +
                       ", kind " + std::to_string(kind) + ", " + chosen.name());
          Simulation simulation(chosen.of(scene), state);
          simulation.advance(until_collision(static_cast<double>(early + n), count));
          ASSERT_EQ(simulation.totals().collisions, early + n);
          if (kind == 0) reverse(simulation);
          if (kind == 1) draw_velocities(simulation, seed);
          if (kind == 2) {
            scale_velocities(simulation, 0);
            draw_velocities(simulation, seed);
          }
          if (kind == 3) scale_velocities(simulation, 0.5);
          simulation.advance(until_time(simulation.time() + little));
          touches += simulation.counters().touches;
          told += test::expect_same_sides(before, simulation.copy());
          // And again, from there back to the point.
          reverse(simulation);
          simulation.advance(until_time(simulation.time() + 3 * little));
          told += test::expect_same_sides(before, simulation.copy());
        }
      }
    }
  }
  EXPECT_GT(told, 500);
  EXPECT_GT(touches, 1000u);
}

TEST(SetVelocities, IsTheSameWithEverySearchCalendarAndThread) {
  Scene scene = test::scene_of(150, 5, 12);
  scene.collisions.epsilon = 0.9;
  scene.collisions.beta = 0.1;
  scene.collisions.tc_relative = 1e-2;
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
TEST(SetVelocities, IsTheSameOnThreadsThatShareTheWork) {
  Scene scene = test::scene_of(3000, 9, 13);
  scene.collisions.epsilon = 0.9;
  scene.collisions.tc_relative = 1e-2;
  const auto run = [&](int threads) {
    scene.engine.threads = threads;
    Followed run(scene);
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
  Scene scene = test::scene_of(100, 4, 15);
  scene.collisions.epsilon = 0.9;
  scene.collisions.tc_relative = 0.2;
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
  Scene scene = test::scene_of(40, 4, 16);
  scene.collisions.epsilon = 0.9;
  scene.collisions.tc_relative = 1e-3;
  Simulation simulation(scene), truth(scene);
  for (Simulation* each : {&simulation, &truth}) each->advance(until_collisions(2));
  const State state = simulation.copy();
  const auto refused = [&](const Rows& velocity, const Rows& angular_velocity) -> std::string {
    try {
      simulation.set_velocities(velocity, angular_velocity);
      return "accepted";
    } catch (const InputError& error) {
      return error.what();
    }
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
  EXPECT_EQ(refused(with(v, 7, nan), w),
            "set_velocities: row 7 of velocity: expected finite numbers");
  EXPECT_EQ(refused(v, with(w, 39, -infinity)),
            "set_velocities: row 39 of angular velocity: expected finite numbers");
  EXPECT_EQ(refused(v, with(w, 0, nan)),
            "set_velocities: row 0 of angular velocity: expected finite numbers");
  EXPECT_EQ(simulation.copy().position, state.position);
  EXPECT_EQ(simulation.copy().velocity, state.velocity);
  for (Simulation* each : {&simulation, &truth}) each->advance(until_collisions(10));
  EXPECT_EQ(simulation.trajectory_hash(), truth.trajectory_hash());
  EXPECT_EQ(simulation.copy().position, truth.copy().position);
  EXPECT_EQ(simulation.counters().searches, truth.counters().searches);
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
  Scene scene = test::scene_of(100, 5, 17);
  scene.collisions.epsilon = 0.8;
  scene.collisions.tc_relative = 1e-3;
  for (const int threads : {1, 2}) {
    scene.engine.threads = threads;
    Simulation simulation(scene);
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

// What collisions take is counted from the energy that the velocities brought.
TEST(SetVelocities, KeepTheAccountOfTheEnergy) {
  Scene scene = test::scene_of(100, 5, 18);
  scene.collisions.epsilon = 0.8;
  scene.collisions.beta = 0.2;
  scene.collisions.tc_relative = 1e-3;
  Simulation simulation(scene);
  double energy = 0;
  simulation.on_collision([&](const Collision& c) { energy += c.energy_change; });
  for (int n = 1; n <= 6; ++n) {
    scale_velocities(simulation, n % 2 ? 3 : 0.1);
    energy = 100 * simulation.totals().energy;
    simulation.advance(until_collisions(n));
    EXPECT_NEAR(100 * simulation.totals().energy, energy, 1e-12 * energy);
  }
}

}  // namespace
}  // namespace needlework
