// The audit of needles that slide on each other beside walls, under gravity and beside kicks finds
// nothing wrong with the engine, and everything that is planted.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "tests/support/sliding_run.h"
#include "tests/support/wall.h"

namespace needlework::test {
namespace {

using audit::Findings;
using audit::Kind;

Scene sliding_between_walls(double epsilon = 0.4) {
  Scene scene = scene_of(60, 3);
  scene.collisions.epsilon = epsilon;
  scene.collisions.sliding = true;
  scene.walls = {wall("z", "both")};
  return scene;
}

Scene sliding_with_kicks() {
  Scene scene = scene_of(60, 3.2);
  scene.collisions.epsilon = 0.2;
  scene.collisions.sliding = true;
  scene.collisions.sliding_below = 0.01;
  scene.driving.kicks = {.every = 0.04, .translational = 1, .rotational = 1};
  return scene;
}

TEST(AuditOfContactsBesideWalls, FindsNothingWrongWithTheEngine) {
  Scene falling = sliding_between_walls();
  falling.walls[0].epsilon = 0.7;
  falling.forces.gravity = {0, 0, -2};
  Scene moving = sliding_between_walls(0);
  moving.walls = {wall("z", "low"), wall("z", "high")};
  moving.walls[0].motion = Scene::WallMotion{.amplitude = 0.1, .frequency = 2, .phase = 0};
  moving.walls[1].temperature = 1;
  Scene elastic = sliding_between_walls(0.3);
  elastic.collisions.elastic_strikes = true;
  elastic.walls.push_back(wall("x", "both"));
  Scene kicked = sliding_between_walls();
  kicked.forces.gravity = {0, 0, 1};
  kicked.driving.kicks = {.every = 0.05, .translational = 1, .rotational = 2};
  for (const Scene& scene : {falling, moving, elastic, kicked}) {
    const Findings findings = audited(scene, 0.6 / audit_share);
    EXPECT_TRUE(findings.clean()) << name_of(scene) << ": " << listed(findings);
    EXPECT_LE(findings.undecided, 2 + findings.contacts / 50) << name_of(scene);
    EXPECT_GE(findings.entered, 3u / audit_share) << name_of(scene);
    EXPECT_GE(findings.hits, 15u / audit_share) << name_of(scene);
  }
}

TEST(AuditOfContactsBesideKicks, FindsNothingWrongWithTheEngine) {
  Scene elastic = sliding_with_kicks();
  elastic.collisions.elastic_strikes = true;
  Scene from_rest = sliding_with_kicks();
  from_rest.initial.t_tr = from_rest.initial.t_rot = 0;
  for (const Scene& scene : {sliding_with_kicks(), elastic, from_rest}) {
    const Findings findings = audited(scene, 1.2 / audit_share);
    EXPECT_TRUE(findings.clean()) << name_of(scene) << ": " << listed(findings);
    EXPECT_LE(findings.undecided, 2 + findings.contacts / 50) << name_of(scene);
    EXPECT_GE(findings.entered, 10u / audit_share) << name_of(scene);
  }
}

// --- Faults in what is reported.

class FalseReportBesideWalls : public testing::Test {
 protected:
  FalseReportBesideWalls() : run(falling(), 12 * audit_share) {}

  static Scene falling() {
    Scene scene = scene_of(80, 3);
    scene.needles.box[2] = 1.2;
    scene.collisions = {.epsilon = 0.3, .sliding = true, .sliding_below = 0.01};
    scene.walls = {wall("z", "both")};
    scene.forces.gravity = {0, 0, -1};
    return scene;
  }
  // A hit of a needle in contact, which ends by it.
  std::size_t strike() const {
    for (std::size_t n = 0; n + 1 < run.happenings.size(); ++n) {
      const Happening &hit = run.happenings[n], &next = run.happenings[n + 1];
      if (hit.kind == Happening::wall && next.kind == Happening::contact_ended &&
          next.event.time == hit.event.time &&
          (next.event.first == hit.event.first || next.event.second == hit.event.first)) {
        return n;
      }
    }
    ADD_FAILURE() << "no needle in contact hits a wall";
    return 0;
  }
  // What the audit finds up to a report that is not right.
  Findings altered(std::size_t n, const std::function<void(Happening&)>& alter) const {
    SlidingRun other = run;
    alter(other.happenings[n]);
    other.stop_after(n + 1);
    return other.audited();
  }

  SlidingRun run;
};

TEST_F(FalseReportBesideWalls, NoneIsSeenWhereThereIsNone) {
  const Findings findings = run.audited();
  EXPECT_TRUE(findings.clean()) << listed(findings);
}

TEST_F(FalseReportBesideWalls, OfAHitInContactLeftOutIsSeen) {
  const std::size_t n = strike();
  const std::uint32_t id = run.happenings[n].event.first;
  SlidingRun other = run;
  other.happenings.erase(other.happenings.begin() + static_cast<std::ptrdiff_t>(n));
  other.stop_after(n + 1);
  // The end of the contact comes at the same instant, with velocities that nothing explains.
  const Findings findings = other.audited();
  EXPECT_TRUE(std::ranges::any_of(findings.listed, [&](const audit::Difference& each) {
    return each.kind == Kind::wrong_rule && (each.first == id || each.second == id);
  })) << listed(findings);
  // Where nothing follows, the tip is in the wall.
  SlidingRun unfinished = run;
  unfinished.stop_after(n);
  unfinished.end = run.happenings[n].event.time + 1e-9;
  EXPECT_EQ(unfinished.audited().count(Kind::missed), 1u);
  unfinished.end = run.happenings[n].event.time - 1e-9;
  EXPECT_TRUE(unfinished.audited().clean());
}

TEST_F(FalseReportBesideWalls, OfAHitInContactAtAnotherTimeIsSeen) {
  const std::size_t n = strike();
  const auto moved = [&](double by) {
    return altered(n, [&](Happening& h) { h.event.offset += by, h.event.time += by; });
  };
  EXPECT_EQ(moved(1e-9).count(Kind::late), 1u);
  EXPECT_EQ(moved(-1e-9).count(Kind::early), 1u);
}

TEST_F(FalseReportBesideWalls, OfAnyNumberOfAHitInContactIsSeen) {
  const std::size_t n = strike();
  const auto wrong = [&](auto&& alter) {
    return altered(n, [&](Happening& h) { alter(h.event); }).count(Kind::wrong_rule);
  };
  EXPECT_EQ(wrong([](Collision&) {}), 0u);
  EXPECT_EQ(wrong([](Collision& c) { c.impulse[2] += 1e-10; }), 1u);
  EXPECT_EQ(wrong([](Collision& c) { c.normal_velocity -= 1e-10; }), 1u);
  EXPECT_EQ(wrong([](Collision& c) { c.energy_change += 1e-8; }), 1u);
  EXPECT_EQ(wrong([](Collision& c) { c.after[0].position[1] += 1e-10; }), 1u);
  EXPECT_EQ(wrong([](Collision& c) { c.after[0].velocity[0] += 1e-10; }), 1u);
  EXPECT_EQ(wrong([](Collision& c) { c.after[0].orientation[0] += 1e-10; }), 1u);
  EXPECT_EQ(wrong([](Collision& c) { c.after[0].angular_velocity[1] += 1e-9; }), 1u);
}

// What ran is not what the scene says.
TEST_F(FalseReportBesideWalls, OfAnotherSceneIsSeen) {
  const auto found = [&](auto&& alter) {
    SlidingRun other = run;
    alter(other.setup);
    return other.audited();
  };
  EXPECT_FALSE(found([](audit::Setup& setup) { setup.gravity[2] *= 1 + 1e-8; }).clean());
  EXPECT_GE(
      found([](audit::Setup& setup) { setup.walls[0].epsilon = 1 - 1e-9; }).count(Kind::wrong_rule),
      1u);
  // A hit in contact is elastic then, and was not by what it says.
  SlidingRun other = run;
  const std::size_t n = strike();
  other.setup.sliding->elastic_strikes = true;
  other.happenings[n].event.contact_time_rule = false;
  EXPECT_TRUE(std::ranges::any_of(other.audited().listed, [&](const audit::Difference& each) {
    return each.kind == Kind::wrong_rule && each.at_wall &&
           each.time == run.happenings[n].event.time;
  }));
}

class FalseReportBesideKicks : public testing::Test {
 protected:
  FalseReportBesideKicks() : run(sliding_with_kicks(), 8 * audit_share) {}

  // A collision at the instant of a kick: of two that slid on each other until then.
  std::size_t collision_by_kick() const {
    for (const auto& [n, time, after] : run.kicks) {
      if (n < run.happenings.size() && run.happenings[n].event.time == time) return n;
    }
    ADD_FAILURE() << "no kick drives needles in contact into each other";
    return 0;
  }

  SlidingRun run;
};

TEST_F(FalseReportBesideKicks, NoneIsSeenWhereThereIsNone) {
  const Findings findings = run.audited();
  EXPECT_TRUE(findings.clean()) << listed(findings);
}

TEST_F(FalseReportBesideKicks, OfTheCollisionThatAKickBringsAboutIsSeen) {
  const std::size_t n = collision_by_kick();
  const Collision& event = run.happenings[n].event;
  SlidingRun other = run;
  other.happenings.erase(other.happenings.begin() + static_cast<std::ptrdiff_t>(n));
  for (auto& kick : other.kicks) kick.happenings -= kick.happenings > n;
  other.stop_after(n + 100);
  const Findings findings = other.audited();
  EXPECT_TRUE(std::ranges::any_of(findings.listed, [&](const audit::Difference& each) {
    return each.kind == Kind::missed && each.first == event.first && each.second == event.second;
  })) << listed(findings);
}

TEST_F(FalseReportBesideKicks, OfANeedleInContactThatIsKickedOtherwiseIsSeen) {
  const std::size_t n = collision_by_kick();
  const std::uint32_t id = run.happenings[n].event.first;
  for (const auto member :
       {&State::position, &State::velocity, &State::orientation, &State::angular_velocity}) {
    SlidingRun other = run;
    const auto kick = std::ranges::find(other.kicks, n, &SlidingRun::Kick::happenings);
    (kick->after.*member)[id][1] += 1e-9;
    other.stop_after(n + 1);
    const Findings findings = other.audited();
    EXPECT_TRUE(std::ranges::any_of(findings.listed, [&](const audit::Difference& each) {
      return each.kind == Kind::wrong_rule && each.first == id && each.second == id;
    })) << listed(findings);
  }
}

}  // namespace
}  // namespace needlework::test
