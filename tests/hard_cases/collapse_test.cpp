// Pairs that bounce on each other faster and faster must never hang, jump, or pass through each
// other.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "needlework/error.h"
#include "tests/hard_cases/collapsing_pairs.h"
#include "tests/hard_cases/hard_scene.h"
#include "tests/support/message_of.h"
#include "tests/support/runs.h"

namespace needlework {
namespace {

using test::collapsing_pair;
using test::until_time;

// The relation of two needles: the contact function, and the arms of the nearest points of their
// lines.
struct Standing {
  double gap;
  double arm_first, arm_second;
  bool inside() const { return std::abs(arm_first) < 0.49 && std::abs(arm_second) < 0.49; }
};

Standing standing(const State& s) {
  using Vector = Eigen::Vector3d;
  const Vector a(s.orientation[0].data()), b(s.orientation[1].data());
  Vector r = Vector(s.position[0].data()) - Vector(s.position[1].data());
  for (int i = 0; i < 3; ++i) r[i] -= s.box[i] * std::round(r[i] / s.box[i]);
  const Vector x = a.cross(b);
  return {r.dot(x), b.cross(r).dot(x) / x.squaredNorm(), a.cross(r).dot(x) / x.squaredNorm()};
}

// Checks a pair at small steps: while both arms are inside, the gap must not change its sign.
class SideWatch {
 public:
  ::testing::AssertionResult keeps_side(const State& state) {
    const Standing now = standing(state);
    const bool through = before_.inside() && now.inside() && before_.gap * now.gap < 0 &&
                         std::min(std::abs(before_.gap), std::abs(now.gap)) > 1e-13;
    const double was = before_.gap;
    // A gap within rounding gives no side, so the previous one is kept.
    if (!now.inside() || std::abs(now.gap) > 1e-13) before_ = now;
    if (!through) return ::testing::AssertionSuccess();
    return ::testing::AssertionFailure() << "gap from " << was << " to " << now.gap;
  }

 private:
  Standing before_{0, 1, 1};
};

Scene pair_scene(double epsilon) {
  Scene scene = test::scene_of(2, 6);
  scene.collisions.epsilon = epsilon;
  return scene;
}

TEST(Collapse, WithoutContactTimeEndsInAClearError) {
  for (const double epsilon : {0.0, 0.3, 0.5, 0.8}) {
    Simulation simulation(pair_scene(epsilon), collapsing_pair(0.05));
    double last = 0;
    simulation.on_collision([&](const Collision& c) {
      ASSERT_GE(c.time, last);
      last = c.time;
    });
    const std::string message =
        test::message_of<InvalidStateError>([&] { simulation.advance(until_time(0.3)); });
    for (const char* words :
         {"needles 0 and 1", "at time 0.", "gap", epsilon == 0 ? "epsilon = 0" : "tc_relative"}) {
      EXPECT_NE(message.find(words), std::string::npos) << message;
    }
    // The state before the failed event can still be read.
    EXPECT_EQ(simulation.time(), last);
    EXPECT_GE(standing(simulation.copy()).gap, -1e-14);
  }
}

TEST(Collapse, WithContactTimeSlidesToItsEndOnTheRightSide) {
  for (const double tc : {1e-2, 1e-3, 1e-4, 1e-5}) {
    Scene scene = pair_scene(0.5);
    scene.collisions.tc = tc;
    Simulation simulation(scene, collapsing_pair(0.05));
    double last_bounce = 0;
    simulation.on_collision([&](const Collision& c) { last_bounce = c.time; });
    SideWatch watch;
    for (int n = 1; n <= 4000; ++n) {
      simulation.advance(until_time(n * 5e-4));
      ASSERT_TRUE(watch.keeps_side(simulation.copy())) << "tc " << tc << ", step " << n;
    }
    const Totals totals = simulation.totals();
    // The sliding contact lasts some tenths of a time unit.
    EXPECT_GT(static_cast<double>(totals.tc_collisions), 0.1 / tc) << "tc " << tc;
    EXPECT_LT(static_cast<double>(totals.collisions), 4 / tc) << "tc " << tc;
    EXPECT_LT(last_bounce, 1.9) << "tc " << tc << ": still sliding";
  }
}

TEST(Collapse, IsTheSameForEverySearch) {
  Scene scene = pair_scene(0.5);
  scene.collisions.tc = 1e-3;
  EXPECT_EQ(test::run_hard(scene, collapsing_pair(0.05), until_time(2)).stop, Stop::time);
}

// A third needle strikes one of the pair during the collapse, at a random instant. The records are
// replaced while the pair touches to within rounding.
TEST(Collapse, StruckByAThirdNeedleStaysOnItsSide) {
  std::uint64_t touches = 0;
  int struck = 0;
  for (int n = 0; n < 20; ++n) {
    Scene scene = test::scene_of(3, 6);
    scene.collisions.epsilon = 0.5;
    scene.collisions.tc = 2e-8;  // gaps of 1e-16: below the rounding of the records
    State state = collapsing_pair(0.05);
    // The third needle comes from above onto needle 0, across its far arm, soon after the pair has
    // collapsed. A run without the third needle gives the position of needle 0 at that time.
    const double arrival = 0.084024 + 1e-6 * n;
    Simulation rehearsal(scene, state);
    rehearsal.advance(until_time(arrival));
    const double height = rehearsal.copy().position[0][2];
    state.position.push_back({3.3, 2.6, height + 0.7 * arrival});
    state.orientation.push_back({0, 1, 0});
    state.velocity.push_back({0, 0.5, -0.7});
    state.angular_velocity.push_back({0, 0, 0});
    Simulation simulation(scene, state);
    bool third = false;
    simulation.on_collision([&](const Collision& c) { third |= c.second == 2; });
    SideWatch watch;
    ASSERT_TRUE(watch.keeps_side(simulation.copy()));
    for (int step = 1; step <= 100 && !third; ++step) {
      simulation.advance(until_time(0.08403 + 1e-6 * step));
      ASSERT_TRUE(watch.keeps_side(simulation.copy())) << "n " << n << ", step " << step;
    }
    const double then = simulation.time();
    for (int step = 1; step <= 20; ++step) {
      simulation.advance(until_time(then + 2.5e-6 * step));
      ASSERT_TRUE(watch.keeps_side(simulation.copy())) << "n " << n << ", step " << step;
    }
    struck += third;
    touches += simulation.counters().touches;
  }
  EXPECT_EQ(struck, 20);
  EXPECT_GT(touches, 0u);
}

}  // namespace
}  // namespace needlework
