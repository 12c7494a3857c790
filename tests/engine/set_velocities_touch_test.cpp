// Velocities replaced by a caller while needles touch: none comes through another.
#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "tests/engine/set_velocities.h"
#include "tests/support/sides.h"

namespace needlework {
namespace {

using test::all_parts;
using test::draw_velocities;
using test::expect_retraced;
using test::Followed;
using test::Parts;
using test::reverse;
using test::Rows;
using test::scale_velocities;
using test::times;
using test::until_collision;
using test::until_collisions;
using test::until_time;
using test::operator*;
using test::operator-;

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

// Many needles whose contact points meet in one point at time 1: nearly all pairs touch to within
// rounding, in the midst of a train of collisions. Whatever velocities they get then, none comes
// through another.
TEST(SetVelocities, OfManyThroughOnePointKeepTheirSides_long) {
  constexpr double little = 1e-4;
  int compared = 0;
  std::uint64_t touches = 0;
  for (const int count : {3, 8, 14}) {
    for (std::uint64_t seed = 1; seed <= 2; ++seed) {
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
          compared += test::expect_same_sides(before, simulation.copy());
          // And again, from there back to the point.
          reverse(simulation);
          simulation.advance(until_time(simulation.time() + 3 * little));
          compared += test::expect_same_sides(before, simulation.copy());
        }
      }
    }
  }
  EXPECT_GT(compared, 100);
  EXPECT_GT(touches, 200u);
}

}  // namespace
}  // namespace needlework
