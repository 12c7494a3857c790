// Whole collapses of pairs that slide on each other, in the engine, against quad precision: there
// every bounce is followed until the flights last for a millionth, and a force holds the contact
// that they tend to (tests/support/quad_gas.h, sliding_oracle.h).
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "kernels/sliding_entry.h"
#include "src/physics/vectors.h"
#include "tests/support/by_build.h"
#include "tests/support/parameter_name.h"
#include "tests/support/quad_gas.h"
#include "tests/support/runs.h"
#include "tests/support/sliding_oracle.h"

namespace needlework::test {
namespace {

using kernels::SlidingEnd;
using kernels::SlidingState;

constexpr double edge = 5, flown_before = 1e-3, longest = 1.2, least_flight = 1e-6;
constexpr kernels::SlidingBody homogeneous{.half = 0.5, .mass = 1, .inertia = 1. / 12};
constexpr kernels::SlidingBodies two_alike{homogeneous, homogeneous};

Vec3d to_vec3d(const Vec<Real>& a) {
  return {static_cast<double>(a[0]), static_cast<double>(a[1]), static_cast<double>(a[2])};
}

SlidingState relative_state(const NeedleState& a, const NeedleState& b) {
  return {to_vec3d(a.position - b.position), to_vec3d(a.velocity - b.velocity),
          to_vec3d(a.orientation),           to_vec3d(b.orientation),
          to_vec3d(a.angular_velocity),      to_vec3d(b.angular_velocity)};
}

SlidingState relative_state(const Collision& c) {
  const StateAfterCollision &a = c.after[0], &b = c.after[1];
  Vec3d apart = vector_of(a.position) - vector_of(b.position);
  for (double Vec3d::*axis : {&Vec3d::x, &Vec3d::y, &Vec3d::z})
    apart.*axis -= edge * std::round(apart.*axis / edge);
  return {apart,
          vector_of(a.velocity) - vector_of(b.velocity),
          vector_of(a.orientation),
          vector_of(b.orientation),
          vector_of(a.angular_velocity),
          vector_of(b.angular_velocity)};
}

// A collision as a gas of T = 1 has them, which flies back to before it; after it, the contact
// presses, so that the needles may bounce again soon.
State draw_pressed_encounter(Random& random, double epsilon) {
  const double spin = std::sqrt(1 / homogeneous.inertia);
  for (;;) {
    const std::array<double, 2> arms{random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5)};
    const PairState pair = draw_contact(random, {.arms = arms, .spin = {spin, spin}});
    const SlidingState here = relative_state(pair.first, pair.second);
    const kernels::SlidingContact contact = kernels::sliding_contact(two_alike, here);
    if (12 * random.uniform() > contact.sin_angle * std::abs(contact.speed)) continue;
    const auto decision = kernels::sliding_entry(two_alike, here, epsilon, 0.5).decision;
    using enum kernels::SlidingDecision;
    if (decision != Enters && decision != ShortContact) continue;
    const NeedlePair before = before_contact(pair, flown_before, 1);
    State state;
    state.box = {edge, edge, edge};
    for (const FreeNeedle* needle : {&before.first, &before.second}) {
      const auto& r = needle->position;
      state.position.push_back({r[0] + edge / 2, r[1] + edge / 2, r[2] + edge / 2});
      state.orientation.push_back(needle->orientation);
      state.velocity.push_back(needle->velocity);
      state.angular_velocity.push_back(needle->angular_velocity);
    }
    return state;
  }
}

// The end of a contact.
struct Ended {
  SlidingEnd how;
  double time;
  SlidingState after;
};

// The first contact in the engine, if there is one.
std::optional<Ended> in_engine(const State& start, double epsilon, double flight_below) {
  Scene scene = scene_of(2, edge);
  const double mean_free_time = Simulation(scene, start).mean_free_time();
  scene.collisions.epsilon = epsilon;
  scene.collisions.sliding = true;
  scene.collisions.sliding_below = flight_below / mean_free_time;
  Simulation simulation(scene, start);
  std::optional<Ended> out;
  simulation.on_happening([&](const Happening& what) {
    if (what.kind != Happening::contact_ended || out) return;
    out = {SlidingEnd::None, what.event.time, relative_state(what.event)};
    simulation.interrupt();
  });
  simulation.advance(until_time(longest));
  if (!out) return out;
  out->how = simulation.sliding_contacts()->ended_by_tip > 0 ? SlidingEnd::Tip : SlidingEnd::Force;
  return out;
}

// The same in quad.
struct Truth {
  SlidingEnd how;
  Quad time;
  SlidingOracle after;
};

std::optional<Truth> in_quad(const State& start, double epsilon) {
  QuadGas gas(start, {6, epsilon, -1, 0, false});
  Real last = -longest;
  for (;;) {
    const auto bounce = gas.collide(longest);
    if (!bounce) return std::nullopt;
    const bool is_over = bounce->time - last < least_flight;
    last = bounce->time;
    if (!is_over) continue;
    const SlidingState here = relative_state(gas.needles()[0], gas.needles()[1]);
    const int side = bounce->normal_velocity > 0 ? -1 : 1;
    // About when it ends, by the kernel.
    SlidingState state = kernels::in_contact(two_alike, here);
    double lasts = 0;
    SlidingEnd how = SlidingEnd::None;
    while (how == SlidingEnd::None) {
      const kernels::SlidingStep step = kernels::sliding_step(two_alike, state, side, INFINITY);
      state = state_after(two_alike, step);
      lasts += step.duration;
      how = step.end;
    }
    SlidingOracle contact(two_alike, here, side);
    const SlidingOracle::End end = contact.end_near(lasts, how);
    if (last + end.time > longest) return std::nullopt;
    contact.advance(end.time);
    return Truth{how, last + end.time, contact};
  }
}

// Of the engine, for one threshold, by how contacts end.
struct Errors {
  std::vector<double> time, velocity, energy;

  void add(const Ended& engine, const Truth& truth) {
    time.push_back(std::abs(static_cast<double>(truth.time - engine.time)));
    velocity.push_back(truth.after.difference(engine.after).velocity);
    const double energy_there = static_cast<double>(truth.after.energy());
    energy.push_back(std::abs(kernels::sliding_energy(two_alike, engine.after) / energy_there - 1));
  }

  void print(const char* name) const {
    std::printf("  %s: %zu; median, 90 %%, largest:", name, time.size());
    for (const auto* all : {&time, &velocity, &energy}) {
      std::printf(" %s %.1e %.1e %.1e",
                  all == &time       ? "time"
                  : all == &velocity ? "| velocity"
                                     : "| energy",
                  most_of(*all, 0.5), most_of(*all, 0.9), most_of(*all, 1));
    }
    std::printf("\n");
  }

  // What this share of the values does not exceed.
  static double most_of(std::vector<double> values, double share) {
    if (values.empty()) return 0;
    std::ranges::sort(values);
    const auto n = static_cast<std::size_t>(share * static_cast<double>(values.size()));
    return values[std::min(n, values.size() - 1)];
  }
};

struct Threshold {
  double flight_below;  ///< [time]
  Errors by_force, at_tip;
  int in_vain = 0;     ///< a contact where in quad there are finitely many bounces
  int lost = 0;        ///< no contact where in quad there are infinitely many
  int other_ends = 0;  ///< by force in one and at a tip in the other

  void add(const std::optional<Ended>& engine, const std::optional<Truth>& truth) {
    in_vain += engine && !truth;
    lost += truth && !engine;
    if (!engine || !truth) return;
    other_ends += truth->how != engine->how;
    (truth->how == SlidingEnd::Force ? by_force : at_tip).add(*engine, *truth);
  }

  void print() const {
    std::printf("flights below %g: %d in vain, %d lost, %d with another end\n", flight_below,
                in_vain, lost, other_ends);
    by_force.print("by force");
    at_tip.print("at a tip");
  }

  template <class Member>
  double median(Member member) const {
    std::vector<double> all = by_force.*member;
    all.insert(all.end(), (at_tip.*member).begin(), (at_tip.*member).end());
    return Errors::most_of(all, 0.5);
  }
};

using Thresholds = std::array<Threshold, 3>;

Thresholds follow_collapses(double epsilon, int count) {
  Thresholds out{{{3e-3}, {1e-3}, {3e-4}}};
  Random random(17);
  for (int found = 0; found < count;) {
    const State start = draw_pressed_encounter(random, epsilon);
    const auto truth = in_quad(start, epsilon);
    found += truth.has_value();
    for (Threshold& threshold : out)
      threshold.add(in_engine(start, epsilon, threshold.flight_below), truth);
  }
  std::printf("epsilon %g\n", epsilon);
  for (const Threshold& threshold : out) threshold.print();
  for (const Threshold& threshold : out) {
    EXPECT_LE(threshold.in_vain, threshold.flight_below > 1e-3 ? count / 100 : 0);
    EXPECT_EQ(threshold.lost, 0);
    EXPECT_EQ(threshold.other_ends, 0);
  }
  return out;
}

TEST(SlidingCollapse, EndsAsInQuad) {
  const Thresholds found = follow_collapses(0.5, by_build(20, 4));
  EXPECT_LT(found[2].median(&Errors::velocity), 2e-8);
  EXPECT_LT(found[2].median(&Errors::energy), 2e-9);
  EXPECT_LT(found[2].median(&Errors::time), 1e-9);
}

// The medians of an independent program, which knows bounces and contacts of pairs only.
struct Figures {
  double epsilon;
  std::array<double, 3> velocity;  ///< for each threshold
  double by_force;                 ///< share of contacts that end so

  friend void PrintTo(const Figures& figures, std::ostream* out) {
    *out << "epsilon " << figures.epsilon;
  }
};

class SlidingCollapses : public testing::TestWithParam<Figures> {};

// Two standard errors of such a median of a thousand are about a sixth.
TEST_P(SlidingCollapses, EndAsInQuadAThousandTimes) {
  constexpr int count = 1000;
  const Thresholds found = follow_collapses(GetParam().epsilon, count);
  for (int n = 0; n < 3; ++n) {
    const double velocity = found[n].median(&Errors::velocity), figure = GetParam().velocity[n];
    EXPECT_LT(velocity, 1.3 * figure) << found[n].flight_below;
    EXPECT_GT(velocity, 0.7 * figure) << found[n].flight_below;
    EXPECT_LT(found[n].median(&Errors::time), 0.05 * figure);
    EXPECT_LT(found[n].median(&Errors::energy), 0.15 * figure);
    const auto forces = static_cast<double>(found[n].by_force.time.size());
    EXPECT_NEAR(forces / count, GetParam().by_force, 0.04);
  }
}

std::string figures_name(const testing::TestParamInfo<Figures>& info) {
  return parameter_name({{"epsilon", info.param.epsilon}});
}

INSTANTIATE_TEST_SUITE_P(Rules_long, SlidingCollapses,
                         testing::Values(Figures{0.5, {1.9e-6, 6e-8, 1.8e-9}, 0.25}), figures_name);
INSTANTIATE_TEST_SUITE_P(Rules_slow, SlidingCollapses,
                         testing::Values(Figures{0.8, {9e-6, 3e-7, 8e-9}, 0.21}), figures_name);

}  // namespace
}  // namespace needlework::test
