// Rods that overlap are reported once, until they are out of each other.
#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <vector>

#include "src/audit/audit.h"
#include "src/audit/rod_flight.h"
#include "tests/support/audited.h"
#include "tests/support/runs.h"

namespace needlework::test {
namespace {

using audit::Findings;
using audit::Kind;

constexpr double edge_of_line = 40;

struct Ball {
  double x, v;
};

// Spheres of diameter 1 on a line along x.
State balls_on_a_line(std::initializer_list<Ball> balls) {
  State state;
  state.box = {edge_of_line, edge_of_line, edge_of_line};
  state.resize(balls.size());
  std::size_t i = 0;
  for (const auto& [x, v] : balls) {
    state.position[i] = {x, 20, 20};
    state.velocity[i] = {v, 0, 0};
    state.orientation[i] = {0, 0, 1};
    state.id[i] = static_cast<std::uint32_t>(i);
    ++i;
  }
  return state;
}

Scene scene_of_balls(std::size_t count) {
  Scene scene;
  scene.species = {{.name = "balls", .count = count, .length = 0, .diameter = 1}};
  scene.needles.box = {edge_of_line, edge_of_line, edge_of_line};
  return scene;
}

struct Recorded {
  std::vector<Happening> happenings;
  double epoch_length = 1;
};

Recorded recorded(const State& balls, double end) {
  Simulation run(scene_of_balls(balls.size()), balls);
  Recorded out{.epoch_length = run.epoch_length()};
  run.on_happening([&](const Happening& happening) { out.happenings.push_back(happening); });
  run.advance(until_time(end));
  return out;
}

Findings findings_of(const State& balls, const Recorded& run, double end) {
  audit::Audit audit(balls, audit_setup(scene_of_balls(balls.size()), run.epoch_length));
  for (const Happening& happening : run.happenings) audit.add(happening);
  audit.finish(end);
  return audit.findings();
}

// Ball 0 is in ball 2 from time 1 on, whose collision is missing. It is hit by ball 1 at 1.5,
// before it is out, and is out at 2, or still in when the run ends.
TEST(OverlapsOfRods, AreMissedOnce) {
  for (const double end : {1.2, 1.9, 1.99}) {
    const Recorded run = recorded(balls_on_a_line({{15, -1}, {19, -3}}), end);
    EXPECT_EQ(run.happenings.size(), end > 1.5 ? 1u : 0u);
    const Findings findings = findings_of(balls_on_a_line({{15, -1}, {19, -3}, {13, 0}}), run, end);
    EXPECT_EQ(findings.count(Kind::missed), 1u) << end << ": " << listed(findings);
    for (const Kind kind : {Kind::late, Kind::early, Kind::spurious, Kind::wrong_rule})
      EXPECT_EQ(findings.count(kind), 0u) << end << ": " << listed(findings);
  }
}

// Ball 0 leaves ball 2 at time 3, is sent back by ball 1, and is in ball 2 again from about 10 on.
TEST(OverlapsOfRods, AreMissedAgainWhereRodsComeBack) {
  const Recorded run = recorded(balls_on_a_line({{15, -1}, {9, 0.2}}), 12);
  ASSERT_EQ(run.happenings.size(), 1u);
  EXPECT_NEAR(run.happenings[0].event.time, 5 / 1.2, 1e-12);
  for (const double end : {5.0, 12.0}) {
    const Findings findings = findings_of(balls_on_a_line({{15, -1}, {9, 0.2}, {13, 0}}), run, end);
    EXPECT_EQ(findings.count(Kind::missed), end < 10 ? 1u : 2u) << listed(findings);
  }
}

// Two balls collide 0.1 late, 0.2 deep in each other, and part.
TEST(OverlapsOfRods, OfALateCollisionAreNotMissed) {
  const State balls = balls_on_a_line({{15, -1}, {19, -3}});
  Recorded run = recorded(balls, 1.8);
  ASSERT_EQ(run.happenings.size(), 1u);
  Collision& late = run.happenings[0].event;
  late.time += 0.1;
  late.offset += 0.1;
  late.after[0].position[0] -= 0.1;
  late.after[1].position[0] -= 0.3;
  const Findings findings = findings_of(balls, run, 1.8);
  EXPECT_EQ(findings.count(Kind::late), 1u) << listed(findings);
  EXPECT_EQ(findings.count(Kind::missed), 0u) << listed(findings);
  EXPECT_NEAR(findings.overlaps->at_collisions, 0.2, 1e-12);
}

// By more than rounding explains, and of balls at rest.
TEST(OverlapsOfRods, AreMissedFromTheLimitOn) {
  const audit::Space space{
      .box = {edge_of_line, edge_of_line, edge_of_line}, .longest = 1, .gravity = {}};
  const auto flight_of = [&](double x) {
    return audit::Needle({{}, {{x, 20, 20}}, {}, {{0, 0, 1}}, {}}, {.length = 0, .diameter = 1});
  };
  const audit::Needle first = flight_of(13), second = flight_of(14);
  const double limit = audit::RodFlight(first, second, {0, 0, 0}, space).limit(1);
  ASSERT_GT(limit, 0.5e-13);
  ASSERT_LT(limit, 1e-12);
  const auto found = [&](double limits) {
    return findings_of(balls_on_a_line({{13, 0}, {14 - limits * limit, 0}}), {}, 1);
  };
  EXPECT_TRUE(found(0).clean());
  EXPECT_NEAR(found(0.8).overlaps->at_most, 2 * limit, 1e-6 * limit);
  EXPECT_TRUE(found(0.8).clean());
  EXPECT_EQ(found(1.2).count(Kind::missed), 1u);
}

}  // namespace
}  // namespace needlework::test
