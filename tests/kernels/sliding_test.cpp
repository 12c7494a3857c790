// Contacts of needles that slide on each other, against contacts held by a force in quad precision.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <random>
#include <vector>

#include "kernels/sliding_entry.h"
#include "tests/support/sliding_oracle.h"

namespace needlework::kernels {
namespace {

constexpr SlidingBody rod{.half = 0.5, .mass = 1, .inertia = 1. / 12};
const SlidingBodies alike{rod, rod};
const SlidingBodies unlike{rod, {.half = 0.8, .mass = 2.5, .inertia = 0.3}};

// Collisions as a gas in equilibrium has them, in proportion to |u1 x u2| |V_n|.
class Collisions {
 public:
  explicit Collisions(const SlidingBodies& bodies) : bodies_(bodies) {}

  SlidingState draw() {
    for (;;) {
      SlidingState s;
      s.u_first = direction(), s.u_second = direction();
      s.v = std::sqrt(1 / bodies_.first.mass + 1 / bodies_.second.mass) * normal();
      s.w_first = spin(s.u_first, bodies_.first), s.w_second = spin(s.u_second, bodies_.second);
      s.r = s.u_second * arm(bodies_.second) - s.u_first * arm(bodies_.first);
      const SlidingContact contact = sliding_contact(bodies_, s);
      if (12 * uniform_(source_) < contact.sin_angle * std::abs(contact.speed)) return s;
    }
  }

  // One that begins a contact with epsilon = 0.
  SlidingEntry contact() {
    for (;;) {
      const SlidingEntry entry = sliding_entry(bodies_, draw(), 0, 0);
      if (entry.decision == SlidingDecision::Enters) return entry;
    }
  }

 private:
  Vec3d normal() {
    const double x = gauss_(source_), y = gauss_(source_), z = gauss_(source_);
    return {x, y, z};
  }
  Vec3d direction() {
    const Vec3d a = normal();
    return a * (1 / std::sqrt(dot(a, a)));
  }
  Vec3d spin(const Vec3d& u, const SlidingBody& body) {
    const Vec3d w = normal() * (1 / std::sqrt(body.inertia));
    return w - dot(w, u) * u;
  }
  double arm(const SlidingBody& body) { return body.half * (2 * uniform_(source_) - 1); }

  SlidingBodies bodies_;
  std::mt19937_64 source_{43};
  std::normal_distribution<double> gauss_;
  std::uniform_real_distribution<double> uniform_;
};

// How far the kernel is off in one contact.
struct Held {
  SlidingEnd how = SlidingEnd::None;
  int steps = 0;
  double end = 0;       ///< [time]
  double velocity = 0;  ///< after the end, of any component [L / time, 1 / time]
  double energy = 0;    ///< relative
  double gap = 0;       ///< the largest |f| within steps [L]
  double position = 0;  ///< and of any component of r and u [L, 1]
};

// Follows a contact with the kernel and the oracle side by side.
void follow(const SlidingBodies& bodies, Collisions& collisions, Held& held) {
  const SlidingEntry entry = collisions.contact();
  test::SlidingOracle oracle(bodies, entry.after, entry.side);
  const double energy = sliding_energy(bodies, entry.after);
  SlidingState state = entry.after;
  while (held.how == SlidingEnd::None) {
    const SlidingStep step = sliding_step(bodies, state, entry.side, INFINITY);
    ASSERT_NE(step.end, SlidingEnd::Unresolvable);
    ++held.steps;
    held.how = step.end;
    for (const double part : {0.37, 0.83}) {
      const SlidingState inside = step.at(part * step.duration);
      const SlidingContact contact = sliding_contact(bodies, inside);
      held.gap = std::max(held.gap, std::abs(contact.gap) * contact.sin_angle);
      test::SlidingOracle then = oracle;
      then.advance(part * step.duration);
      ASSERT_FALSE(then.has_ended());
      held.position = std::max(held.position, then.difference(inside).position);
      ASSERT_NEAR(static_cast<double>(then.force() - then.force_by_curvature()), 0, 1e-15);
    }
    if (step.end != SlidingEnd::None) {
      const test::SlidingOracle::End end = oracle.end_near(step.duration, step.end);
      held.end = std::abs(static_cast<double>(end.time - step.duration));
    }
    oracle.advance(step.duration);
    state = state_after(bodies, step);
  }
  held.velocity = oracle.difference(state).velocity;
  held.energy = std::abs(sliding_energy(bodies, state) / energy - 1);
}

using Contacts = std::vector<Held>;

void follow_all(const SlidingBodies& bodies, int count, Contacts& contacts) {
  Collisions collisions(bodies);
  for (int n = 0; n < count; ++n)
    ASSERT_NO_FATAL_FAILURE(follow(bodies, collisions, contacts.emplace_back()));
}

// What is not exceeded by this share of the contacts, in percent.
template <class Member>
Member of_percent(int share, const Contacts& contacts, Member Held::*member) {
  std::vector<Member> values;
  for (const Held& held : contacts) values.push_back(held.*member);
  std::ranges::sort(values);
  return values[std::min(values.size() - 1, values.size() * share / 100)];
}

Contacts that_end(SlidingEnd how, const Contacts& contacts) {
  Contacts out;
  std::ranges::copy_if(contacts, std::back_inserter(out),
                       [&](const Held& held) { return held.how == how; });
  return out;
}

double steps_each(const Contacts& contacts) {
  double sum = 0;
  for (const Held& held : contacts) sum += held.steps;
  return sum / static_cast<double>(contacts.size());
}

class SlidingAgainstQuad : public testing::TestWithParam<SlidingBodies> {};

TEST_P(SlidingAgainstQuad, EndsAndMovesAsAContactHeldByAForce) {
  Contacts contacts;
  ASSERT_NO_FATAL_FAILURE(follow_all(GetParam(), 20, contacts));
  // Medians, and what near parallel needles reach.
  const auto median = [&](double Held::*of) { return of_percent(50, contacts, of); };
  const auto largest = [&](double Held::*of) { return of_percent(100, contacts, of); };
  EXPECT_LT(median(&Held::end), 2e-15);
  EXPECT_LT(largest(&Held::end), 1e-12);
  EXPECT_LT(median(&Held::velocity), 1e-14);
  EXPECT_LT(largest(&Held::velocity), 8e-12);
  EXPECT_LT(median(&Held::energy), 2e-15);
  EXPECT_LT(largest(&Held::energy), 1e-13);
  EXPECT_LT(largest(&Held::gap), 4e-14);
  EXPECT_LT(largest(&Held::position), 4e-14);
  EXPECT_LT(steps_each(contacts), 8);
  const std::size_t forces = that_end(SlidingEnd::Force, contacts).size();
  EXPECT_GT(forces, 0u);
  EXPECT_LT(forces, contacts.size());
}

INSTANTIATE_TEST_SUITE_P(Bodies, SlidingAgainstQuad, testing::Values(alike, unlike));

TEST(SlidingAgainstQuadAtLength, EndsAndMovesAsAContactHeldByAForce_long) {
  Contacts contacts;
  ASSERT_NO_FATAL_FAILURE(follow_all(alike, 1000, contacts));
  const std::size_t forces = that_end(SlidingEnd::Force, contacts).size();
  EXPECT_GT(forces, contacts.size() / 5);
  EXPECT_LT(forces, contacts.size() / 2);
  EXPECT_LT(steps_each(contacts), 6.5);
  for (const SlidingEnd how : {SlidingEnd::Force, SlidingEnd::Tip}) {
    const Contacts some = that_end(how, contacts);
    std::printf("%s: %zu; median, 99 %%, largest:", how == SlidingEnd::Tip ? "tip" : "force",
                some.size());
    const auto expect = [&](const char* name, double Held::*of, double median, double most,
                            double largest) {
      std::printf(" %s %.1e %.1e %.1e", name, of_percent(50, some, of), of_percent(99, some, of),
                  of_percent(100, some, of));
      EXPECT_LT(of_percent(50, some, of), median) << name;
      EXPECT_LT(of_percent(99, some, of), most) << name;
      EXPECT_LT(of_percent(100, some, of), largest) << name;
    };
    expect("end", &Held::end, 4e-15, 5e-14, 1e-12);
    expect("velocity", &Held::velocity, 2e-15, 2e-13, 8e-12);
    expect("energy", &Held::energy, 1e-15, 1e-14, 1e-12);
    expect("gap", &Held::gap, 1e-15, 2e-15, 4e-15);
    expect("position", &Held::position, 2e-15, 4e-15, 8e-15);
    std::printf("\n");
  }
  std::printf("%.2f steps a contact\n", steps_each(contacts));
}

// Needles in contact whose contact points approach or part with a speed.
SlidingState with_speed(const SlidingBodies& bodies, const SlidingState& touching, double speed) {
  const SlidingContact contact = sliding_contact(bodies, touching);
  return after_impulse(bodies, touching, contact, (speed - contact.speed) / contact.inverse);
}

TEST(SlidingEntry, IsForTrainsOnly) {
  Collisions collisions(alike);
  for (int n = 0; n < 200; ++n) {
    const SlidingEntry contact = collisions.contact();
    const double into = -contact.side * 1e-9;
    const SlidingState slow = with_speed(alike, contact.after, into);
    EXPECT_EQ(sliding_entry(alike, slow, 1, 1e-3).decision, SlidingDecision::Elastic);
    EXPECT_EQ(sliding_entry(alike, slow, 0.8, 1e-14).decision, SlidingDecision::LongFlight);
    // From the other side the same force pulls.
    const SlidingState other = with_speed(alike, contact.after, -into);
    EXPECT_EQ(sliding_entry(alike, other, 0.8, 1e-3).decision, SlidingDecision::Parts);

    const SlidingEntry entry = sliding_entry(alike, slow, 0.8, 1e-3);
    if (entry.decision == SlidingDecision::ShortContact) continue;
    ASSERT_EQ(entry.decision, SlidingDecision::Enters);
    EXPECT_EQ(entry.side, contact.side);
    const double before = sliding_energy(alike, slow), after = sliding_energy(alike, entry.after);
    EXPECT_NEAR(entry.loss, before - after, 1e-14 * before);
    const SlidingContact pressed = sliding_contact(alike, entry.after);
    const double a = entry.side * pressed.force * pressed.inverse;
    EXPECT_NEAR(entry.train * 0.2 * a / (2 * 0.8 * 1e-9), 1, 1e-5);
    EXPECT_LT(std::abs(pressed.speed), 1e-14);
  }
}

// Whether a contact lasts long enough is computed ahead: next to its end a pair bounces.
TEST(SlidingEntry, NeedsAContactThatLastsTwiceTheTrain) {
  Collisions collisions(alike);
  int refused = 0;
  for (int n = 0; n < 100; ++n) {
    const SlidingEntry contact = collisions.contact();
    SlidingState state = contact.after;
    SlidingStep step = sliding_step(alike, state, contact.side, INFINITY);
    while (step.end == SlidingEnd::None) {
      state = state_after(alike, step);
      step = sliding_step(alike, state, contact.side, INFINITY);
    }
    const double left = 1e-3 * step.duration;
    const SlidingState late = in_contact(alike, step.at(step.duration - left));
    const SlidingContact pressed = sliding_contact(alike, late);
    const double a = contact.side * pressed.force * pressed.inverse;
    // Trains of 4 and of 0.25 times what is left, at epsilon = 0.5: V0 = |V_n| / 2 = a train / 4.
    const auto train_of = [&](double times) {
      return with_speed(alike, late, -contact.side * a * times * left / 2);
    };
    const auto decision = [&](double times) {
      return sliding_entry(alike, train_of(times), 0.5, INFINITY).decision;
    };
    if (step.end == SlidingEnd::Force) continue;
    EXPECT_NE(decision(4), SlidingDecision::Enters);
    EXPECT_EQ(decision(0.25), SlidingDecision::Enters);
    refused += decision(4) == SlidingDecision::ShortContact;
  }
  EXPECT_GT(refused, 20);
}

// A collision beside a third needle begins no contact. Slow ones are elastic, others have the
// epsilon of the pair, raised by no more than the velocity of the threshold.
TEST(SlidingEntry, LetsCrowdedNeedlesBounce) {
  Collisions collisions(alike);
  for (int n = 0; n < 100; ++n) {
    const SlidingEntry contact = collisions.contact();
    const double below = 1e-5 / sliding_contact(alike, contact.after).rate;
    const auto crowded = [&](double speed, double epsilon) {
      return sliding_entry(alike, with_speed(alike, contact.after, -contact.side * speed), epsilon,
                           below, true);
    };
    for (const double epsilon : {0.0, 0.5}) {
      EXPECT_EQ(crowded(1e-9, epsilon).decision, SlidingDecision::Crowded);
      EXPECT_EQ(crowded(1e-9, epsilon).epsilon, 1);
    }
    EXPECT_EQ(crowded(1, 0.5).epsilon, 0.5);
    EXPECT_GT(crowded(1, 0).epsilon, 0);
    EXPECT_LT(crowded(1, 0).epsilon, 1e-2);
    EXPECT_EQ(crowded(1, 0.5).side, contact.side);
  }
}

TEST(SlidingStep, IsCutByTheLimitOnly) {
  Collisions collisions(alike);
  const SlidingEntry contact = collisions.contact();
  const SlidingStep whole = sliding_step(alike, contact.after, contact.side, INFINITY);
  const double limit = whole.duration / 3;
  const SlidingStep cut = sliding_step(alike, contact.after, contact.side, limit);
  EXPECT_EQ(cut.duration, limit);
  EXPECT_EQ(cut.end, SlidingEnd::None);
  const SlidingState a = cut.at(limit), b = whole.at(limit);
  EXPECT_NEAR(a.r.x, b.r.x, 1e-14);
  EXPECT_NEAR(a.v.x, b.v.x, 1e-13);
}

// Also where both arms run off within one part of the search.
TEST(SlidingStep, EndsAtTheFirstOfBothTips) {
  Collisions collisions(alike);
  for (int n = 0; n < 1000; ++n) {
    const SlidingEntry contact = collisions.contact();
    SlidingStep step = sliding_step(alike, contact.after, contact.side, INFINITY);
    while (step.end == SlidingEnd::None)
      step = sliding_step(alike, state_after(alike, step), contact.side, INFINITY);
    const SlidingContact last = sliding_contact(alike, step.at(step.duration));
    EXPECT_LT(std::max(std::abs(last.arm_first), std::abs(last.arm_second)), 0.5 + 1e-13);
  }
}

// Velocities by 2^-p and times by 2^p: the same bits.
TEST(SlidingStep, KnowsNoUnitOfTime) {
  Collisions collisions(unlike);
  for (int n = 0; n < 20; ++n) {
    const SlidingEntry contact = collisions.contact();
    SlidingState slow = contact.after;
    for (Vec3d* a : {&slow.v, &slow.w_first, &slow.w_second}) *a = *a * 0x1p-40;
    const SlidingStep fast = sliding_step(unlike, contact.after, contact.side, INFINITY);
    const SlidingStep step = sliding_step(unlike, slow, contact.side, INFINITY);
    EXPECT_EQ(step.duration, fast.duration * 0x1p40);
    EXPECT_EQ(step.end, fast.end);
    const SlidingState there = state_after(unlike, step), then = state_after(unlike, fast);
    EXPECT_TRUE(there.r == then.r);
    EXPECT_TRUE(there.w_first == then.w_first * 0x1p-40);
  }
}

// Needles without a turn, or in uniform motion on each other, press on nothing: the contact is held
// until an arm has run off, and its side is not lost.
TEST(SlidingStep, HoldsWhatNothingPresses) {
  SlidingState state;
  state.u_first = {1, 0, 0}, state.u_second = {0, 1, 0};
  state.v = {0.25, 0, 0};
  for (const int side : {-1, 1}) {
    SlidingState now = state;
    double elapsed = 0;
    SlidingStep step;
    do {
      step = sliding_step(alike, now, side, INFINITY);
      now = state_after(alike, step);
      elapsed += step.duration;
    } while (step.end == SlidingEnd::None);
    EXPECT_EQ(step.end, SlidingEnd::Tip);
    EXPECT_NEAR(elapsed, 2, 1e-14);
    EXPECT_EQ(now.r.z, 0);
    EXPECT_EQ(side_after(step.end, side), -side);
  }
}

TEST(SlidingStep, EndsAtOnceAtATipThatMovesOut) {
  SlidingState state;
  state.u_first = {1, 0, 0}, state.u_second = {0, 1, 0};
  state.r = {-0.5, 0, 0};
  state.v = {-1, 0, 0};
  const SlidingStep step = sliding_step(alike, state, 1, INFINITY);
  EXPECT_EQ(step.end, SlidingEnd::Tip);
  EXPECT_LT(step.duration, 1e-15);
}

TEST(SlidingStep, SaysThatParallelNeedlesAreBeyondIt) {
  SlidingState state;
  state.u_first = state.u_second = {1, 0, 0};
  state.r = {0, 0, 0.1};
  state.v = {1, 0, 0};
  EXPECT_EQ(sliding_step(alike, state, 1, 1).end, SlidingEnd::Unresolvable);
}

}  // namespace
}  // namespace needlework::kernels
