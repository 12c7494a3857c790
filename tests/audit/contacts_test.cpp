// The audit of needles that slide on each other finds nothing wrong with the engine, and everything
// that is planted.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "needlework/error.h"
#include "src/audit/joint_motion.h"
#include "tests/support/sliding_run.h"

namespace needlework::test {
namespace {

using audit::Findings;
using audit::Kind;

Scene sliding_mixture() {
  Scene scene = scene_of(0, 5);
  scene.species = three_species();
  scene.collisions.epsilon = 0.6;
  scene.collisions.sliding = true;
  scene.pairs = {{.between = {"short", "long"}, .epsilon = 0.3, .beta = {}},
                 {.between = {"middle", "middle"}, .epsilon = 1, .beta = {}}};
  return scene;
}

void expect_clean_run(const Scene& scene, double per_needle, std::uint64_t least_entered) {
  const SlidingRun run(scene, per_needle);
  const Findings findings = run.audited();
  EXPECT_TRUE(findings.clean()) << name_of(scene) << ": " << listed(findings);
  EXPECT_LE(findings.undecided, 2 + findings.contacts / 50) << name_of(scene);
  EXPECT_EQ(findings.entered, run.contacts.entered);
  EXPECT_GE(findings.entered, least_entered / audit_share) << name_of(scene);
  // All but those that last until the end.
  EXPECT_EQ(findings.ended,
            run.contacts.ended_by_force + run.contacts.ended_by_tip + run.contacts.ended_by_strike);
}

TEST(AuditOfContacts, FindsNothingWrongWithTheEngine) {
  expect_clean_run(sliding_gas(150, 0.72, 0.5), 10, 20);
  expect_clean_run(sliding_gas(150, 6, 0.5), 5, 5);
  expect_clean_run(sliding_gas(80, 1, 0), 3, 20);
}

TEST(AuditOfContacts, FindsNothingWrongInLongerRuns_long) {
  expect_clean_run(sliding_gas(150, 0.72, 0.5), 20, 40);
  expect_clean_run(sliding_gas(150, 6, 0.5), 15, 20);
  expect_clean_run(sliding_gas(100, 1, 0.9), 100, 1);
}

TEST(AuditOfContacts, FindsNothingWrongWithOtherThresholdsAndElasticStrikes) {
  Scene late = sliding_gas(120, 2, 0.3);
  late.collisions.sliding_below = 0.05;
  Scene early = sliding_gas(120, 2, 0.3);
  early.collisions.sliding_below = 1e-5;
  Scene elastic = sliding_gas(120, 4, 0.5);
  elastic.collisions.elastic_strikes = true;
  expect_clean_run(late, 12, 40);
  expect_clean_run(early, 12, 10);
  expect_clean_run(elastic, 20, 40);
}

TEST(AuditOfContacts, FindsNothingWrongWithMixtures) {
  expect_clean_run(sliding_mixture(), 15, 20);
  // The same in other units of length, mass and energy.
  Scene small = sliding_mixture();
  for (double& edge : small.needles.box) edge *= 3e-5;
  for (Species& each : small.species) {
    each.length *= 3e-5;
    each.mass *= 1e20;
    each.t_tr *= 1e-30;
    each.t_rot *= 1e-30;
  }
  expect_clean_run(small, 10, 12);
}

// A light needle that swings on a heavy one: what is rounded at the beginning of a contact has
// grown by 2e4 at its end.
TEST(AuditOfContacts, KnowsHowFarRoundingGrowsBetweenHeavyAndLightNeedles) {
  Scene scene = scene_of(0, 1);
  scene.needles.box = {3.075, 4.603, 3.133};
  scene.needles.seed = 69;
  scene.collisions = {.epsilon = 0.5, .sliding = true};
  scene.species = {
      {.name = "long", .count = 40, .length = 1.2152842639254506, .mass = 1e6, .k = 1},
      {.name = "middle", .count = 5, .length = 1.0039665989085633, .mass = 1e6, .k = 1, .t_rot = 0},
      {.name = "light", .count = 5, .length = 0.3, .mass = 1e-3, .k = 100, .t_rot = 0}};
  expect_clean_run(scene, 2 * audit_share, 2);
}

// Redraws of a thermostat are strikes, and the threshold is not known.
TEST(AuditOfContacts, FindsNothingWrongWithTheThermostat) {
  Scene scene = sliding_gas(100, 1, 0.4);
  scene.driving.andersen = {.rate = 1, .temperature = 1};
  const Findings findings = audited(scene, 8.0 / audit_share);
  EXPECT_TRUE(findings.clean()) << listed(findings);
  EXPECT_LE(findings.undecided, 2 + findings.contacts / 50);
  EXPECT_GE(findings.entered, 20u / audit_share);
  EXPECT_GT(findings.draws, 100u / audit_share);
}

// --- Faults in what is reported.

class FalseReportOfContacts : public testing::Test {
 protected:
  FalseReportOfContacts() : run(sliding_gas(60, 2, 0.5), 30 * audit_share) {}

  using Which = std::function<bool(std::size_t)>;

  const Collision& event(std::size_t n) const { return run.happenings[n].event; }
  bool is_of_same(std::size_t n, std::size_t m) const {
    return event(n).first == event(m).first && event(n).second == event(m).second;
  }
  bool ends(std::size_t n) const { return run.happenings[n].kind == Happening::contact_ended; }
  bool enters(std::size_t n) const { return run.happenings[n].kind == Happening::contact_entered; }
  bool is_after_strike(std::size_t n) const {
    return n > 0 && ends(n) && event(n - 1).epoch == event(n).epoch &&
           event(n - 1).offset == event(n).offset;
  }
  // An end by which the two do not collide.
  bool ends_by_itself(std::size_t n) const { return ends(n) && !is_after_strike(n); }
  bool collides_at_end(std::size_t n) const {
    return is_after_strike(n) && n + 1 < run.happenings.size() && is_of_same(n, n + 1) &&
           run.happenings[n + 1].kind == Happening::pair && event(n + 1).time == event(n).time;
  }
  // The entry of the contact that ends at n.
  std::size_t entry_of(std::size_t n) const {
    std::size_t entry = n;
    while (!(enters(entry) && is_of_same(entry, n))) --entry;
    return entry;
  }
  // The motion from there on, as the audit computes it.
  audit::JointMotion motion_from(std::size_t entry) const {
    const Collision& begin = event(entry);
    const auto needle = [&](int i) {
      const StateAfterCollision& after = begin.after[static_cast<std::size_t>(i)];
      return audit::Needle(audit::Record{{},
                                         audit::vector(after.position),
                                         audit::vector(after.velocity),
                                         audit::vector(after.orientation),
                                         audit::vector(after.angular_velocity)});
    };
    audit::Vector<double> r12 = needle(0).record.r - needle(1).record.r;
    for (int axis = 0; axis < 3; ++axis) {
      const double edge = run.scene.needles.box[static_cast<std::size_t>(axis)];
      r12[axis] -= edge * std::floor(r12[axis] / edge + 0.5);
    }
    return audit::JointMotion(needle(0), needle(1), r12, begin.normal_velocity < 0 ? 1 : -1);
  }
  double time_between(std::size_t n, std::size_t m) const {
    return static_cast<double>(event(m).epoch - event(n).epoch) * run.setup.epoch_length +
           (event(m).offset - event(n).offset);
  }
  // In the middle of the run.
  std::size_t find(const Which& which) const {
    std::size_t n = run.happenings.size() / 3;
    while (n < run.happenings.size() && !which(n)) ++n;
    EXPECT_LT(n, run.happenings.size());
    return n;
  }
  // What the audit finds of a run without this report.
  Findings without(std::size_t n) const {
    SlidingRun other = run;
    other.happenings.erase(other.happenings.begin() + static_cast<std::ptrdiff_t>(n));
    other.stop_after(n + soon);
    return other.audited();
  }
  // What it finds up to a report that is not right.
  Findings altered(std::size_t n, const std::function<void(Happening&)>& alter) const {
    SlidingRun other = run;
    alter(other.happenings[n]);
    other.stop_after(n + 1);
    return other.audited();
  }

  SlidingRun run;
  // So many reports later a needle has met others.
  static constexpr std::size_t soon = 200;
};

TEST_F(FalseReportOfContacts, NoneIsSeenWhereThereIsNone) {
  const Findings findings = run.audited();
  EXPECT_TRUE(findings.clean()) << listed(findings);
}

TEST_F(FalseReportOfContacts, OfAnEndAtAnotherTimeIsSeen) {
  const std::size_t n = find([&](std::size_t m) { return ends_by_itself(m); });
  const auto moved = [&](double by) {
    return altered(n, [&](Happening& h) { h.event.offset += by, h.event.time += by; });
  };
  EXPECT_EQ(moved(1e-9).count(Kind::late), 1u);
  EXPECT_EQ(moved(-1e-9).count(Kind::early), 1u);
  EXPECT_GE(moved(1e-9).count(Kind::wrong_rule), 1u);  // not with these places and velocities
}

TEST_F(FalseReportOfContacts, OfAnEndLeftOutIsSeen) {
  const std::size_t by_itself = find([&](std::size_t m) { return ends_by_itself(m); });
  EXPECT_GE(without(by_itself).count(Kind::missed), 1u);
  // Also where the run ends before anything else happens.
  SlidingRun unfinished = run;
  unfinished.happenings.resize(by_itself);
  unfinished.end = event(by_itself).time - 1e-6;
  EXPECT_TRUE(unfinished.audited().clean());
  unfinished.end = event(by_itself).time + 1e-6;
  EXPECT_EQ(unfinished.audited().count(Kind::missed), 1u);
  // By a strike: the two would go on sliding although they part, or collide, by it.
  const std::size_t parts =
      find([&](std::size_t m) { return is_after_strike(m) && !collides_at_end(m); });
  EXPECT_GE(without(parts).count(Kind::missed), 1u);
  const std::size_t collides = find([&](std::size_t m) { return collides_at_end(m); });
  EXPECT_FALSE(without(collides).clean());
}

TEST_F(FalseReportOfContacts, OfTheCollisionThatAStrikeOwesIsSeen) {
  const std::size_t n = find([&](std::size_t m) { return collides_at_end(m); });
  const Findings findings = without(n + 1);
  EXPECT_GE(findings.count(Kind::wrong_rule), 1u) << listed(findings);
}

TEST_F(FalseReportOfContacts, OfAnEntryLeftOutIsSeen) {
  const std::size_t n = find([&](std::size_t m) { return enters(m); });
  EXPECT_GE(without(n).count(Kind::missed), 1u);
}

TEST_F(FalseReportOfContacts, OfAnEntryThatIsNoneIsSeen) {
  const std::size_t collision =
      find([&](std::size_t m) { return run.happenings[m].kind == Happening::pair; });
  EXPECT_GE(altered(collision, [](Happening& h) { h.kind = Happening::contact_entered; })
                .count(Kind::wrong_rule),
            1u);
  const std::size_t entry = find([&](std::size_t m) { return enters(m); });
  EXPECT_GE(altered(entry, [](Happening& h) { h.kind = Happening::pair; }).count(Kind::wrong_rule),
            1u);
  const std::size_t end = find([&](std::size_t m) { return ends(m); });
  SlidingRun twice = run;
  twice.stop_after(end + 1);
  twice.happenings.insert(twice.happenings.begin() + static_cast<std::ptrdiff_t>(end),
                          run.happenings[end]);
  EXPECT_EQ(twice.audited().count(Kind::spurious), 1u);
}

TEST_F(FalseReportOfContacts, OfAStrikeLeftOutIsSeen) {
  const std::size_t n = find([&](std::size_t m) {
    return m + 1 < run.happenings.size() && run.happenings[m].kind == Happening::pair &&
           is_after_strike(m + 1) && !is_of_same(m, m + 1);
  });
  const Findings findings = without(n);
  EXPECT_GE(findings.count(Kind::missed), 1u) << listed(findings);
  // And where it is a little too late.
  const Findings late = altered(n, [](Happening& h) { h.event.offset += 1e-9; });
  EXPECT_GE(late.count(Kind::late), 1u) << listed(late);
}

TEST_F(FalseReportOfContacts, OfAnyNumberIsSeen) {
  const auto wrong = [&](std::size_t n, auto&& alter) {
    return altered(n, [&](Happening& h) { alter(h.event); }).count(Kind::wrong_rule);
  };
  // Far from parallel, where arms and what follows from them are well known.
  const auto is_steep = [&](std::size_t m) { return event(m).sin_angle > 0.6; };
  const std::size_t by_itself =
      find([&](std::size_t m) { return ends_by_itself(m) && is_steep(m); });
  const std::size_t entry = find([&](std::size_t m) { return enters(m) && is_steep(m); });
  EXPECT_GE(wrong(by_itself, [](Collision& c) { c.after[0].velocity[0] -= 1e-10; }), 1u);
  EXPECT_GE(wrong(by_itself, [](Collision& c) { c.energy_change -= 1e-10; }), 1u);
  for (const std::size_t n : {by_itself, entry}) {
    EXPECT_GE(wrong(n, [](Collision& c) { c.arm_first += 1e-9; }), 1u);
    EXPECT_GE(wrong(n, [](Collision& c) { c.arm_second += 1e-9; }), 1u);
    EXPECT_GE(wrong(n, [](Collision& c) { c.impulse[1] += 1e-10; }), 1u);
    EXPECT_GE(wrong(n, [](Collision& c) { c.energy_change += 1e-10; }), 1u);
    EXPECT_GE(wrong(n, [](Collision& c) { c.after[0].position[2] += 1e-10; }), 1u);
    EXPECT_GE(wrong(n, [](Collision& c) { c.after[1].velocity[0] += 1e-10; }), 1u);
    EXPECT_GE(wrong(n, [](Collision& c) { c.after[0].angular_velocity[1] += 1e-9; }), 1u);
    EXPECT_GE(wrong(n, [](Collision& c) { c.after[1].orientation[0] += 1e-10; }), 1u);
    EXPECT_GE(wrong(n, [](Collision& c) { c.after[1].orientation[0] = NAN; }), 1u);
  }
}

// What ran is not what the scene says.
TEST_F(FalseReportOfContacts, OfAnotherSceneIsSeen) {
  const auto wrong = [&](auto&& alter) {
    SlidingRun other = run;
    alter(other.setup);
    return other.audited().count(Kind::wrong_rule);
  };
  EXPECT_EQ(wrong([](audit::Setup&) {}), 0u);
  EXPECT_GE(wrong([](audit::Setup& setup) { setup.sliding->below *= 1.5; }), 1u);
  EXPECT_GE(wrong([](audit::Setup& setup) { setup.sliding->below /= 1.5; }), 1u);
  EXPECT_GE(wrong([](audit::Setup& setup) { setup.sliding->elastic_strikes = true; }), 1u);
  EXPECT_GE(wrong([](audit::Setup& setup) {
              setup.composition.set_restitution(0, 0, {0.5 + 1e-9, -1});
            }),
            1u);
  SlidingRun none = run;
  none.setup.sliding.reset();
  EXPECT_THROW(none.audited(), InputError);
}

// --- A history that is consistent but wrong: a contact that is held for too long, or let go too
// soon, with places and velocities of that time.

TEST_F(FalseReportOfContacts, OfAContactHeldTooLongIsSeen) {
  int by_force = 0, by_tip = 0;
  for (std::size_t n = 0; n < run.happenings.size(); ++n) {
    if (!ends_by_itself(n) || (by_force > 2 && by_tip > 2)) continue;
    const double lasted = time_between(entry_of(n), n);
    audit::JointMotion motion = motion_from(entry_of(n));
    ASSERT_TRUE(motion.follow(1.1 * lasted));
    bool is_force = false;
    for (const auto& room : motion.rooms_at(lasted)) {
      if (std::abs(room.value) < 1e-9 && room.is_of_force) is_force = true;
    }
    if ((is_force ? by_force : by_tip)++ > 2) continue;
    for (const double by : {1e-7, -1e-7}) {
      const Findings findings = altered(n, [&](Happening& h) {
        h.event.offset += by;
        h.event.time += by;
        const audit::Touch touch = motion.touch_at(lasted + by);
        h.event.arm_first = static_cast<double>(touch.arms[0]);
        h.event.arm_second = static_cast<double>(touch.arms[1]);
        for (int i = 0; i < 2; ++i) {
          const audit::BodyState there = motion.at(i, lasted + by);
          const auto put = [](std::array<double, 3>& out, const audit::Vector<audit::Extended>& a) {
            for (int axis = 0; axis < 3; ++axis)
              out[static_cast<std::size_t>(axis)] = static_cast<double>(a[axis]);
          };
          StateAfterCollision& after = h.event.after[static_cast<std::size_t>(i)];
          put(after.position, there.r);
          put(after.velocity, there.v);
          put(after.orientation, there.u);
          put(after.angular_velocity, audit::cross(there.u, there.du));
        }
      });
      EXPECT_EQ(findings.count(Kind::late), by > 0 ? 1u : 0u) << listed(findings);
      EXPECT_EQ(findings.count(Kind::early), by < 0 ? 1u : 0u) << listed(findings);
    }
  }
  EXPECT_GE(by_force, 1);
  EXPECT_GE(by_tip, 3);
}

// A needle at rest, of which the engine knew nothing, lies where one of two in contact passes.
TEST_F(FalseReportOfContacts, OfANeedleThatIsPassedInContactIsSeen) {
  for (const int index : {0, 1}) {
    const std::size_t n = find(
        [&](std::size_t m) { return ends_by_itself(m) && time_between(entry_of(m), m) > 0.02; });
    const std::size_t entry = entry_of(n);
    const double half = time_between(entry, n) / 2;
    audit::JointMotion motion = motion_from(entry);
    ASSERT_TRUE(motion.follow(2 * half));
    const audit::BodyState there = motion.at(index, half);
    const audit::Extended arm = 0.3;
    const audit::Vector<audit::Extended> place = there.r + there.u * arm;
    const audit::Vector<audit::Extended> along = audit::cross(there.u, there.v + there.du * arm);
    SlidingRun other = run;
    other.stop_after(n + 1);
    State& state = other.initial;
    const std::size_t ghost = state.size();
    state.resize(ghost + 1);
    state.id[ghost] = static_cast<std::uint32_t>(ghost);
    state.velocity[ghost] = state.angular_velocity[ghost] = {0, 0, 0};
    for (int axis = 0; axis < 3; ++axis) {
      const auto component = static_cast<std::size_t>(axis);
      state.position[ghost][component] = static_cast<double>(place[axis]);
      state.orientation[ghost][component] = static_cast<double>(along[axis] / audit::norm(along));
    }
    const Findings findings = other.audited();
    const std::uint32_t id = index == 0 ? event(n).first : event(n).second;
    EXPECT_TRUE(std::ranges::any_of(findings.listed, [&](const audit::Difference& each) {
      return each.kind == Kind::missed && each.first == id && each.second == ghost &&
             std::abs(each.time - (event(entry).time + half)) < 1e-9;
    })) << listed(findings);
  }
}

TEST_F(FalseReportOfContacts, IsSeenAsWellAfterAnInterruption) {
  const std::size_t n = find([&](std::size_t m) { return ends_by_itself(m); });
  run.happenings[n].event.after[0].velocity[0] += 1e-10;
  const std::size_t struck = find([&](std::size_t m) { return collides_at_end(m); });
  run.stop_after(std::max(n, struck) + 30);
  const Findings whole = run.audited();
  EXPECT_FALSE(whole.clean());
  const std::size_t entry = entry_of(n);
  for (const std::size_t at : {std::size_t{1}, entry + 1, n, n + 1, struck, struck + 1}) {
    audit::Audit first(run.initial, run.setup);
    for (std::size_t m = 0; m < at; ++m) first.add(run.happenings[m]);
    audit::Audit second(run.initial, run.setup);
    second.resume(first.checkpoint());
    for (const Happening& happening : run.happenings) second.add(happening);
    second.finish(run.end);
    EXPECT_EQ(listed(second.findings()), listed(whole)) << at;
  }
}

}  // namespace
}  // namespace needlework::test
