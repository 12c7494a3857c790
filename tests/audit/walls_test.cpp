// The audit of hits on walls, against needles whose motion is computed here, and planted mistakes.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "needlework/error.h"
#include "src/audit/audit.h"
#include "tests/support/audited.h"

namespace needlework::test {
namespace {

using audit::Findings;
using audit::Kind;
using V = std::array<double, 3>;

V cross(const V& a, const V& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// One needle of length 1 and mass 1 with k = 6 that turns about y, between or over walls along z.
struct OneNeedle {
  static constexpr double k = 6, inertia = 1 / (2 * k);

  std::vector<Scene::Wall> walls;
  double gravity = 0;
  long double time = 0;  // so that its rounding does not matter beside that of the reports
  V r{1, 1, 2}, v{0.3, 0, -1}, u{0, 0, 1}, w{0, 0, 0};
  std::vector<Happening> happenings;

  double phase(const Scene::Wall& each, long double t) const {
    const long double turns = each.motion->frequency * t;
    return static_cast<double>(2 * std::numbers::pi_v<long double> * (turns - std::floor(turns))) +
           each.motion->phase;
  }
  static bool travels(const Scene::Wall& each) { return each.motion && each.motion->velocity; }
  static bool is_moving(const Scene::Wall& each, long double t) {
    const auto& motion = *each.motion;
    const long double place = each.side == "high" ? 4 : 0;
    return !motion.stop_at || t < (*motion.stop_at - place) / *motion.velocity;
  }
  double surface(const Scene::Wall& each, long double t) const {
    const double place = each.side == "high" ? 4 : 0;
    if (travels(each)) {
      const auto& motion = *each.motion;
      if (motion.stop_at && !is_moving(each, t)) return *motion.stop_at;
      return static_cast<double>(place + *motion.velocity * t);
    }
    return each.motion ? place + each.motion->amplitude * std::sin(phase(each, t)) : place;
  }
  double surface_speed(const Scene::Wall& each, long double t) const {
    if (!each.motion) return 0;
    if (travels(each)) return is_moving(each, t) ? *each.motion->velocity : 0;
    const double turn = 2 * std::numbers::pi * each.motion->frequency;
    return each.motion->amplitude * turn * std::cos(phase(each, t));
  }
  /// Director after a time; w is along y.
  V director(double s) const {
    const double c = std::cos(w[1] * s), q = std::sin(w[1] * s);
    return {u[0] * c + u[2] * q, 0, u[2] * c - u[0] * q};
  }
  double height(const Scene::Wall& each, int tip, double s) const {
    const double sign = each.side == "high" ? -1 : 1;
    const double z = r[2] + v[2] * s + gravity * s * s / 2 + 0.5 * tip * director(s)[2];
    return sign * (z - surface(each, time + s));
  }

  /// Flies to the next hit, found by small steps and halving, and reports it.
  void hit() {
    double first = 100;
    std::size_t where = 0;
    int which = 0;
    for (std::size_t n = 0; n < walls.size(); ++n) {
      for (const int tip : {1, -1}) {
        double s = 1e-9;
        while (s < first && height(walls[n], tip, s) > 0) s += 1e-3;
        if (s >= first) continue;
        double low = std::max(1e-9, s - 1e-3), high = s;
        for (int i = 0; i < 100; ++i) {
          const double middle = 0.5 * (low + high);
          (height(walls[n], tip, middle) > 0 ? low : high) = middle;
        }
        if (high < first) first = high, where = n, which = tip;
      }
    }
    fly(first);
    const Scene::Wall& each = walls[where];
    const double n = each.side == "high" ? -1 : 1, arm = 0.5 * which;
    const V turn = cross(w, u);
    const double tip = n * (v[2] + arm * turn[2]);
    const double vn = tip - n * surface_speed(each, time);
    const double give = 1 + 0.25 / inertia * (1 - u[2] * u[2]);
    const double impulse = -(1 + each.epsilon) * vn / give;
    v[2] += n * impulse;
    const V twist = cross(u, {0, 0, n * impulse});
    for (std::size_t axis = 0; axis < 3; ++axis) w[axis] += arm / inertia * twist[axis];
    Happening& out = report(Happening::wall);
    out.event.second = static_cast<std::uint32_t>(where);
    out.event.arm_first = arm;
    out.event.normal_velocity = vn;
    out.event.impulse = {0, 0, n * impulse};
    out.event.energy_change = impulse * (tip + impulse * give / 2);
  }
  void fly(double s) {
    for (const std::size_t axis : {0u, 1u, 2u}) r[axis] += v[axis] * s;
    r[2] += gravity * s * s / 2;
    v[2] += gravity * s;
    u = director(s);
    time += s;
  }
  Happening& report(Happening::Kind kind) {
    Happening& out = happenings.emplace_back();
    out.kind = kind;
    out.source = 1;
    out.event.epoch = static_cast<std::int64_t>(std::floor(time));
    out.event.offset = static_cast<double>(time - std::floor(time));
    out.event.time = static_cast<double>(time);
    out.event.after[0] = {r, v, u, w};
    return out;
  }
};

struct Case {
  State initial;
  audit::Setup setup;
  std::vector<Happening> happenings;
  double end;

  Findings audited() const {
    audit::Audit audit(initial, setup);
    for (const Happening& each : happenings) audit.add(each);
    audit.finish(end);
    return audit.findings();
  }
};

Scene::Wall wall(const char* side, double epsilon = 1) {
  Scene::Wall out;
  out.axis = "z";
  out.side = side;
  out.epsilon = epsilon;
  return out;
}

Case made(OneNeedle needle, int hits) {
  Case out;
  out.initial.box = {4, 4, 4};
  out.initial.position = {needle.r};
  out.initial.velocity = {needle.v};
  out.initial.orientation = {needle.u};
  out.initial.angular_velocity = {needle.w};
  out.initial.id = {0};
  out.initial.species = {0};
  out.setup.composition =
      Composition({{.name = "a", .count = 1, .k = OneNeedle::k}}, Restitution{});
  out.setup.walls = needle.walls;
  out.setup.gravity = {0, 0, needle.gravity};
  for (int n = 0; n < hits; ++n) needle.hit();
  out.happenings = needle.happenings;
  out.end = static_cast<double>(needle.time);
  return out;
}

OneNeedle turning() {
  OneNeedle out;
  out.walls = {wall("low"), wall("high")};
  out.u = {0.6, 0, 0.8};
  out.w = {0, 2.5, 0};
  return out;
}

OneNeedle vibrated() {
  OneNeedle out = turning();
  out.gravity = -0.8;
  out.walls = {wall("low", 0.9)};
  out.walls[0].motion = Scene::WallMotion{.amplitude = 0.15, .frequency = 0.7, .phase = 1};
  return out;
}

// Between walls of which one stops soon, after a few hits, and one goes on.
OneNeedle pressed() {
  OneNeedle out = turning();
  out.walls[0].epsilon = 0.9;
  out.walls[0].motion = Scene::WallMotion{};
  out.walls[0].motion->velocity = 0.3;
  out.walls[0].motion->stop_at = 1;
  out.walls[1].motion = Scene::WallMotion{};
  out.walls[1].motion->velocity = -0.125;
  return out;
}

TEST(AuditOfWalls, FindsNothingWrongWithNeedlesBetweenWalls) {
  OneNeedle straight;
  straight.walls = {wall("low"), wall("high")};
  OneNeedle falling = straight;
  falling.gravity = -1;
  falling.walls = {wall("low", 0.5)};
  for (const OneNeedle& needle : {straight, falling, turning(), vibrated(), pressed()}) {
    const int hits = needle.walls[0].epsilon == 0.5 ? 6 : 40;  // it comes to rest
    const Findings findings = made(needle, hits).audited();
    EXPECT_TRUE(findings.clean()) << listed(findings);
    EXPECT_EQ(findings.hits, static_cast<std::uint64_t>(hits));
    EXPECT_GE(findings.at_walls, static_cast<std::uint64_t>(hits));
  }
}

TEST(AuditOfWalls, SeesWhatIsPlanted) {
  struct Planted {
    Kind kind;
    std::function<void(Collision&)> change;
  };
  const double rounding = 1e-9;
  const std::vector<Planted> all = {
      {Kind::wrong_rule, [&](Collision& c) { c.impulse[2] *= 1 + rounding; }},
      {Kind::wrong_rule, [&](Collision& c) { c.normal_velocity *= 1 + rounding; }},
      {Kind::wrong_rule, [&](Collision& c) { c.energy_change += rounding; }},
      {Kind::wrong_rule, [&](Collision& c) { c.after[0].velocity[0] += rounding; }},
      {Kind::wrong_rule, [&](Collision& c) { c.after[0].angular_velocity[1] *= 1 + rounding; }},
      {Kind::wrong_rule, [&](Collision& c) { c.after[0].position[1] += rounding; }},
      {Kind::wrong_rule, [&](Collision& c) { c.after[0].orientation[0] += rounding; }},
      {Kind::wrong_rule, [&](Collision& c) { c.contact_time_rule = true; }},
      {Kind::wrong_rule, [&](Collision& c) { c.arm_first *= 0.9; }},
      {Kind::late, [&](Collision& c) { c.offset += 1e-6, c.time += 1e-6; }},
      {Kind::early, [&](Collision& c) { c.offset -= 1e-6, c.time -= 1e-6; }},
      {Kind::spurious, [&](Collision& c) { c.offset -= 0.1, c.time -= 0.1; }},
  };
  for (const auto& [needle, hits] :
       {std::pair(turning(), 5), {vibrated(), 5}, {pressed(), 2}, {pressed(), 9}}) {
    for (std::size_t n = 0; n < all.size(); ++n) {
      Case planted = made(needle, hits);
      Collision& last = planted.happenings.back().event;
      if (last.offset < 0.11 || last.offset > 0.99) continue;
      all[n].change(last);
      planted.end = last.time;
      EXPECT_GT(planted.audited().count(all[n].kind), 0u) << n;
    }
  }
}

TEST(AuditOfWalls, SeesHitsThatAreMissing) {
  Case missing = made(turning(), 6);
  missing.happenings.pop_back();
  missing.end += 0.05;
  const Findings at_end = missing.audited();
  EXPECT_EQ(at_end.count(Kind::missed), 1u);
  ASSERT_EQ(at_end.listed.size(), 1u);
  EXPECT_TRUE(at_end.listed[0].at_wall);
  Case between = made(turning(), 6);
  between.happenings.erase(between.happenings.begin() + 2);
  EXPECT_GT(between.audited().count(Kind::missed), 0u);
}

// A hit and a flight that are right for a wall that rests, goes on or moves another way.
TEST(AuditOfWalls, SeesWallsThatMoveOtherwise) {
  const auto is_seen = [](std::size_t wall, const std::function<void(Scene::WallMotion&)>& change) {
    Case other = made(pressed(), 9);
    EXPECT_TRUE(other.audited().clean());
    change(*other.setup.walls[wall].motion);
    return !other.audited().clean();
  };
  using Motion = Scene::WallMotion;
  EXPECT_TRUE(is_seen(0, [](Motion& m) { m.velocity = 0.3 * (1 + 1e-9); }));
  EXPECT_TRUE(is_seen(0, [](Motion& m) { m.stop_at = 1 + 1e-9; }));
  EXPECT_TRUE(is_seen(0, [](Motion& m) { m.stop_at.reset(); }));
  EXPECT_TRUE(is_seen(1, [](Motion& m) { m.velocity = -0.125 * (1 + 1e-9); }));
  EXPECT_TRUE(is_seen(1, [](Motion& m) { m.velocity = 0.125; }));
  EXPECT_TRUE(is_seen(1, [](Motion& m) { m.velocity.reset(); }));
}

TEST(AuditOfWalls, SeesHitsOutOfOrderAndOnOtherWalls) {
  Case turned = made(turning(), 4);
  std::swap(turned.happenings[2], turned.happenings[3]);
  EXPECT_GT(turned.audited().count(Kind::wrong_order), 0u);
  Case other = made(turning(), 4);
  other.happenings[3].event.second = 1 - other.happenings[3].event.second;
  EXPECT_GT(other.audited().count(Kind::spurious), 0u);
  other.happenings[3].event.second = 2;
  EXPECT_THROW(other.audited(), InputError);
}

TEST(AuditOfWalls, OfAThermalWallIsOfTimeAndPlaceAlone) {
  OneNeedle needle = turning();
  needle.walls[1].temperature = 2;
  Case thermal = made(needle, 5);
  Case changed = thermal;
  bool found = false;
  for (Happening& each : changed.happenings) {
    if (each.event.second != 1 || found) continue;
    found = true;
    each.event.impulse[1] += 1;
    EXPECT_TRUE(changed.audited().clean());
    each.event.after[0].position[2] += 1e-6;
    EXPECT_FALSE(changed.audited().clean());
  }
  EXPECT_TRUE(found);
}

TEST(AuditOfWalls, FollowsNeedlesThroughAThermostat) {
  OneNeedle needle = turning();
  needle.hit();
  Case start = made(turning(), 0);
  needle.fly(0.05);
  needle.v = {0.1, 0.2, 0.3};
  needle.w = {0, 1, 0};
  needle.report(Happening::thermostat).source = 2;
  for (int n = 0; n < 4; ++n) needle.hit();
  start.happenings = needle.happenings;
  start.end = static_cast<double>(needle.time);
  const Findings findings = start.audited();
  EXPECT_TRUE(findings.clean()) << listed(findings);
  EXPECT_EQ(findings.draws, 1u);
  EXPECT_EQ(findings.hits, 5u);
  start.happenings[1].event.after[0].orientation[0] += 1e-6;
  EXPECT_GT(start.audited().count(Kind::wrong_rule), 0u);
  start.happenings[1].kind = Happening::other;
  EXPECT_THROW(start.audited(), InputError);
}

}  // namespace
}  // namespace needlework::test
