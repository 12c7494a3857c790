// Collapses in the engine against a run in quad precision with a collision rule, contacts and
// sliding of its own (tests/support/quad_gas.h), bounce by bounce and to the end of contact.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "needlework/error.h"
#include "tests/hard_cases/collapsing_pairs.h"
#include "tests/support/by_build.h"
#include "tests/support/parameter_name.h"
#include "tests/support/quad_gas.h"
#include "tests/support/runs.h"

namespace needlework::test {
namespace {

constexpr int thinner = test::by_build(1, 5);

QuadRule rule_of(const Scene& scene, bool rounded = false) {
  const auto& c = scene.collisions;
  return {scene.needles.k, c.epsilon, c.beta, c.tc.value_or(0), rounded};
}

Scene scene_with(double epsilon, double beta, double tc = 0, std::uint64_t count = 2) {
  Scene scene = scene_of(count, 6);
  scene.collisions.epsilon = epsilon;
  scene.collisions.beta = beta;
  if (tc > 0) scene.collisions.tc = tc;
  return scene;
}

double distance(const Real& a, const Real& b) { return std::abs(static_cast<double>(Real(a - b))); }

struct EngineRun {
  State initial, end;
  std::vector<Collision> collisions;
  double epoch_length;
  std::string failure;

  EngineRun(const Scene& scene, const State& state, double until) {
    Followed run(scene, state);
    initial = run->copy();
    epoch_length = run->epoch_length();
    try {
      run->advance(until_time(until));
    } catch (const InvalidStateError& error) {
      failure = error.what();
    }
    end = run->copy();
    collisions = run.collisions;
  }

  Real time_of(const Collision& c) const {
    return Real(static_cast<double>(c.epoch)) * epoch_length + c.offset;
  }
};

double energy_of(const State& state, double k = 6) {
  double sum = 0;
  for (std::size_t i = 0; i < state.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      sum += 0.5 * std::pow(state.velocity[i][axis], 2) +
             std::pow(state.angular_velocity[i][axis], 2) / (4 * k);
    }
  }
  return sum;
}

/// The largest differences between two runs.
struct Worst {
  double time = 0, arm = 0, velocity = 0, energy = 0;

  void add(const QuadCollision& truth, const Real& at, const std::array<Real, 2>& arms,
           const Real& normal_velocity) {
    time = std::max(time, distance(truth.time, at));
    for (int i = 0; i < 2; ++i) arm = std::max(arm, distance(truth.arms[i], arms[i]));
    velocity = std::max(velocity, distance(truth.normal_velocity, normal_velocity));
  }
};

/// Compares the engine with an exact run, and that run with one whose records are rounded like the
/// engine's. The latter difference is unavoidable in double.
struct Comparison {
  Worst engine, rounded;
  std::size_t collisions = 0, by_rule = 0;

  /// Goes through the engine's collisions, and leaves `truth` just after the last.
  void follow(const EngineRun& run, QuadGas& truth, QuadGas twin, double until) {
    bool together = true;
    for (const Collision& c : run.collisions) {
      const auto exact = truth.collide(until);
      ASSERT_TRUE(exact) << "no contact at " << c.time;
      ASSERT_TRUE(exact->first == c.first && exact->second == c.second)
          << "engine: " << c.first << "-" << c.second << " at " << c.time
          << ", exact: " << exact->first << "-" << exact->second << " at "
          << static_cast<double>(exact->time);
      ASSERT_EQ(exact->contact_time_rule, c.contact_time_rule) << c.time;
      engine.add(*exact, run.time_of(c), {c.arm_first, c.arm_second}, c.normal_velocity);
      ++collisions;
      by_rule += c.contact_time_rule;
      if (!together) continue;
      const auto other = twin.collide(until);
      together =
          other.has_value() && other->first == exact->first && other->second == exact->second;
      if (together) rounded.add(*exact, other->time, other->arms, other->normal_velocity);
    }
    engine.energy = std::max(engine.energy, distance(truth.energy(), energy_of(run.end)));
    if (together)
      rounded.energy = std::max(rounded.energy, distance(truth.energy(), twin.energy()));
  }

  void print(const std::string& name) const {
    std::printf(
        "%s: %zu collisions, %zu by t_c | time %.1e (rounding alone %.1e) arms %.1e (%.1e) "
        "velocity %.1e (%.1e) energy %.1e (%.1e)\n",
        name.c_str(), collisions, by_rule, engine.time, rounded.time, engine.arm, rounded.arm,
        engine.velocity, rounded.velocity, engine.energy, rounded.energy);
  }

  /// The engine's largest error is at most `factor` times that of rounding alone.
  void expect_near(double factor) const {
    const auto near = [&](double off, double rounding, const char* what) {
      EXPECT_LE(off, std::max(1e-13, factor * rounding)) << what;
    };
    near(engine.time, rounded.time, "time");
    near(engine.arm, rounded.arm, "arm");
    near(engine.velocity, rounded.velocity, "normal velocity");
    near(engine.energy, rounded.energy, "energy");
  }
};

// Processes all bounces that quad resolves, whose times add up to the end of the collapse.
void collapse(QuadGas& gas, double until) {
  for (int bounce = 0; bounce < 5000; ++bounce) {
    const Real before = gas.time();
    ASSERT_TRUE(gas.collide(until));
    if (gas.time() - before < 1e-15) return;
  }
  FAIL() << "no collapse";
}

struct Rule {
  double epsilon, beta;
};

class CollapseInQuad : public testing::TestWithParam<Rule> {
 protected:
  std::string name() const {
    char text[64];
    std::snprintf(text, sizeof text, "epsilon %g beta %g", GetParam().epsilon, GetParam().beta);
    return text;
  }
};

// Without a contact time: every bounce is compared, until the run reports that the next is below
// what double resolves. Then the collapse is almost over: `rest` is the time until its end.
TEST_P(CollapseInQuad, IsFollowedToItsEnd) {
  const double until = 1;
  Random random(11);
  Comparison all;
  int collapsed = 0;
  double rest = 0;
  for (int n = 0; n < 20 / thinner; ++n) {
    SCOPED_TRACE(name() + ", pair " + std::to_string(n));
    const Scene scene = scene_with(GetParam().epsilon, GetParam().beta);
    const EngineRun run(scene, draw_collapsing_pair(random), until);
    QuadGas truth(run.initial, rule_of(scene));
    ASSERT_NO_FATAL_FAILURE(
        all.follow(run, truth, QuadGas(run.initial, rule_of(scene, true)), until));
    if (run.failure.empty()) {
      EXPECT_FALSE(truth.collide(until)) << "a collision of the exact run that the engine lacks";
      continue;
    }
    ++collapsed;
    EXPECT_NE(run.failure.find("collapse of needles 0 and 1"), std::string::npos) << run.failure;
    const Real reported = truth.time();
    ASSERT_NO_FATAL_FAILURE(collapse(truth, until));
    rest = std::max(rest, distance(truth.time(), reported));
  }
  all.print(name());
  std::printf("%d collapsed, rest at most %.1e\n", collapsed, rest);
  all.expect_near(8);
  // Smooth needles push with a lasting force, and rough ones come to rest on each other. The gaps
  // of these shrink with the cube of time, so that double resolves less of it.
  EXPECT_LT(rest, GetParam().beta == -1 ? 1e-10 : 1e-5);
  if (GetParam().beta <= 0 && GetParam().epsilon < 0.7) {
    EXPECT_GT(collapsed, 0);
  }
}

// With a contact time: all bounces, the sliding contact to its end, and the flight after it.
TEST_P(CollapseInQuad, WithContactTimeIsTheSame) {
  const double until = 2;
  Random random(12);
  Comparison all;
  for (int n = 0; n < 8 / thinner + 1; ++n) {
    SCOPED_TRACE(name() + ", pair " + std::to_string(n));
    const Scene scene = scene_with(GetParam().epsilon, GetParam().beta, 5e-3);
    const EngineRun run(scene, draw_collapsing_pair(random), until);
    ASSERT_EQ(run.failure, "");
    QuadGas truth(run.initial, rule_of(scene));
    ASSERT_NO_FATAL_FAILURE(
        all.follow(run, truth, QuadGas(run.initial, rule_of(scene, true)), until));
    EXPECT_FALSE(truth.collide(until)) << "a collision of the exact run that the engine lacks";
  }
  all.print(name());
  all.expect_near(8);
}

std::string rule_name(const testing::TestParamInfo<Rule>& info) {
  const Rule& rule = info.param;
  return test::parameter_name({{"epsilon", rule.epsilon}, {"beta", rule.beta}});
}

INSTANTIATE_TEST_SUITE_P(Rules, CollapseInQuad,
                         testing::Values(Rule{0.3, -1}, Rule{0.6, -1}, Rule{0.9, -1}, Rule{0.8, 0},
                                         Rule{0.3, 0.5}, Rule{0.6, 1}),
                         rule_name);
INSTANTIATE_TEST_SUITE_P(Rules_long, CollapseInQuad, testing::Values(Rule{0.3, 0}), rule_name);

// A third needle strikes one of a collapsing pair between two of its bounces, which may be very
// close. The records are then replaced while the gap of the pair is very small.
State struck_pair(Random& random, double epsilon, int bounces) {
  for (;;) {
    State state = draw_collapsing_pair(random);
    QuadGas pair(state, {6, epsilon, -1, 0, false});
    Real last = 0, before = 0;
    for (int n = 0; n < bounces; ++n) {
      before = last;
      const auto bounce = pair.collide(1);
      if (!bounce) break;
      last = bounce->time;
    }
    // Intervals between bounces shrink by epsilon, so this is well before the next.
    const Real gap = (last - before) * epsilon, then = last + gap * Real(random.uniform(0.1, 0.9));
    if (last == 0 || gap > 0.05) continue;
    pair.collide(then);
    if (pair.time() != then) continue;
    const NeedleState& struck = pair.needles()[random.below(2)];
    const Vec<Real> point =
        struck.position + Real(random.uniform(-0.45, 0.45)) * struck.orientation;
    NeedleState third;
    third.orientation = convert<Real>(random.direction());
    third.position = point - Real(random.uniform(-0.45, 0.45)) * third.orientation;
    third.velocity = convert<Real>(random.normal_vector(3));
    third.angular_velocity = convert<Real>(random.normal_vector(2));
    const FreeNeedle start = rounded(flown(read(rounded(third)), -then));
    const auto& r = start.position;
    if (std::max({std::abs(r[0] - 3), std::abs(r[1] - 3), std::abs(r[2] - 3)}) > 1.9) continue;
    state.position.push_back(r);
    state.orientation.push_back(start.orientation);
    state.velocity.push_back(start.velocity);
    state.angular_velocity.push_back(start.angular_velocity);
    return state;
  }
}

TEST(CollapseOfThree, IsTheSameInQuad_long) {
  const double until = 0.3;
  for (const double tc : {0.0, 5e-3}) {
    for (const double epsilon : {0.3, 0.6, 0.8}) {
      Random random(13);
      Comparison all;
      int struck = 0, collapsed = 0;
      double shortest = 1;  // shortest time between two bounces of a pair with a strike between
                            // them
      for (int n = 0; n < 30 / thinner; ++n) {
        SCOPED_TRACE("t_c " + std::to_string(tc) + ", epsilon " + std::to_string(epsilon) +
                     ", case " + std::to_string(n));
        const Scene scene = scene_with(epsilon, -1, tc, 3);
        const EngineRun run(scene, struck_pair(random, epsilon, 2 + n % 14), until);
        QuadGas truth(run.initial, rule_of(scene));
        ASSERT_NO_FATAL_FAILURE(
            all.follow(run, truth, QuadGas(run.initial, rule_of(scene, true)), until));
        collapsed += !run.failure.empty();
        if (run.failure.empty()) {
          EXPECT_FALSE(truth.collide(until))
              << "a collision of the exact run that the engine lacks";
        }
        const auto& c = run.collisions;
        for (std::size_t m = 2; m < c.size(); ++m) {
          if (c[m].second != 1 || c[m - 1].second != 2 || c[m - 2].second != 1) continue;
          ++struck;
          shortest = std::min(shortest, distance(run.time_of(c[m]), run.time_of(c[m - 2])));
        }
      }
      all.print("t_c " + std::to_string(tc) + ", epsilon " + std::to_string(epsilon));
      std::printf("%d struck between two bounces, %.1e apart or more; %d reported\n", struck,
                  shortest, collapsed);
      all.expect_near(100);  // a few of these histories amplify their first rounding
      EXPECT_GT(struck, 15 / thinner);
      EXPECT_LT(shortest, 1e-2);
      if (tc > 0) {
        EXPECT_EQ(collapsed, 0);
      }
    }
  }
}

// The engine represents a sliding contact by tiny elastic bounces, with intervals of at most t_c.
// The exact motion keeps the contact points together by a force along the normal.
struct Slide {
  QuadSlide slide;
  Real begin;
  double energy;

  Slide(const State& start, double epsilon) {
    // The exact collapse, then the exact slide.
    const double until = 5;
    QuadGas gas(EngineRun(scene_with(epsilon, -1), start, 0).initial, {6, epsilon, -1, 0, false});
    collapse(gas, until);
    begin = gas.time();
    energy = static_cast<double>(gas.energy());
    slide = gas.slide(1000);
    const QuadSlide coarse = gas.slide(500);
    EXPECT_LT(distance(slide.time, coarse.time), 1e-7);
    EXPECT_LT(distance(slide.gap, 0), 1e-7);
    EXPECT_LT(distance(slide.normal_velocity, 0), 1e-7);
  }

  double velocities_off(const State& end) const {
    double off = 0;
    for (int i = 0; i < 2; ++i) {
      const NeedleState& needle = i == 0 ? slide.end.first : slide.end.second;
      for (int axis = 0; axis < 3; ++axis) {
        off = std::max({off, distance(end.velocity[i][axis], needle.velocity[axis]),
                        distance(end.angular_velocity[i][axis], needle.angular_velocity[axis])});
      }
    }
    return off;
  }
};

// Measured: velocities are off by up to 0.8 t_c, the energy by 0.06 t_c^2, the end of contact by
// 0.3 t_c. So the collision rule loses what the collapse loses, and t_c sets the accuracy.
TEST(SlidingContact, TendsToThatOfAForceWithTheContactTime) {
  const State start = collapsing_pair(0.05);
  const Slide truth(start, 0.5);
  std::printf("collapse ends at %.9f, slide at %.9f\n", static_cast<double>(truth.begin),
              static_cast<double>(truth.slide.time));
  EXPECT_TRUE(truth.slide.over_a_tip);
  for (const double tc : {1e-2, 1e-3, 1e-4, thinner == 1 ? 1e-5 : 1e-4}) {
    const EngineRun run(scene_with(0.5, -1, tc), start, 2);
    ASSERT_EQ(run.failure, "");
    const double velocity = truth.velocities_off(run.end);
    const double end = distance(run.time_of(run.collisions.back()), truth.slide.time);
    const double energy = std::abs(energy_of(run.end) - truth.energy);
    std::printf("t_c %g: %zu bounces, last off by %.2e, velocities by %.2e, energy by %.2e\n", tc,
                run.collisions.size(), end, velocity, energy);
    EXPECT_LT(end, tc);
    EXPECT_LT(velocity, 2 * tc);
    EXPECT_LT(energy, 0.3 * tc * tc);
  }
}

TEST(SlidingContact, OfAnyTwoNeedlesEndsAsThatOfAForce) {
  const double tc = 1e-3, epsilon = 0.3;
  Random random(11);
  int over_tips = 0, parted = 0;
  double worst_end = 0, worst_velocity = 0;
  for (int n = 0; n < 20 / thinner; ++n) {
    SCOPED_TRACE("pair " + std::to_string(n));
    const State start = draw_collapsing_pair(random);
    const Slide truth(start, epsilon);
    const double end = static_cast<double>(truth.slide.time);
    const EngineRun run(scene_with(epsilon, -1, tc), start, end + 0.02);
    ASSERT_EQ(run.failure, "");
    (truth.slide.over_a_tip ? over_tips : parted) += 1;
    worst_end = std::max(worst_end, distance(run.time_of(run.collisions.back()), end));
    worst_velocity = std::max(worst_velocity, truth.velocities_off(run.end));
  }
  std::printf("%d over a tip, %d parted; last bounce off by %.2e, velocities by %.2e\n", over_tips,
              parted, worst_end, worst_velocity);
  EXPECT_LT(worst_end, 2 * tc);
  EXPECT_LT(worst_velocity, 20 * tc);
  if (thinner == 1) {
    EXPECT_GT(over_tips, 0);
    EXPECT_GT(parted, 0);
  }
}

}  // namespace
}  // namespace needlework::test
