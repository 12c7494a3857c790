// The audit's own motion of needles in contact: against a contact held by a force in quad
// precision, and its bounds and contacts with third needles against dense samples.
#include "src/audit/joint_motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "src/audit/contact_finder.h"
#include "src/audit/guided_flight.h"
#include "src/audit/tolerances.h"
#include "tests/support/sliding_oracle.h"

namespace needlework::test {
namespace {

using audit::AuditedBody;
using audit::Extended;
using audit::JointMotion;
using audit::Needle;
using audit::Record;
using Vector3 = audit::Vector<double>;

const std::array<AuditedBody, 2> alike_bodies = {AuditedBody{}, AuditedBody{}};
const std::array<AuditedBody, 2> unlike_bodies = {AuditedBody{.length = 1, .mass = 1, .k = 6},
                                                  AuditedBody{.length = 0.6, .mass = 2.5, .k = 3}};

// Pairs that begin to slide on each other, where the force presses, and needles about them.
class RandomContacts {
 public:
  explicit RandomContacts(const std::array<AuditedBody, 2>& bodies) : bodies_(bodies) {}

  struct Contact {
    std::array<Record, 2> records;
    Vector3 r12;
    int side;
  };

  Contact draw() {
    for (;;) {
      Contact out;
      for (std::size_t i = 0; i < 2; ++i) out.records[i] = record(3.5);
      const auto& [a, b] = out.records;
      out.r12 = b.u * arm(bodies_[1]) - a.u * arm(bodies_[0]);
      out.records[0].r = b.r + out.r12;
      const audit::RelativeState before = audit::relative_state(a, b, out.r12);
      const audit::Touch touch(before, bodies_);
      const audit::RelativeState state =
          audit::after_change(before, bodies_, touch, -touch.normal_velocity);
      out.side = touch.normal_velocity > 0 ? -1 : 1;
      if (!(audit::Touch(state, bodies_).pressing(out.side) > 0)) continue;
      // The same impulse on both, so that the drift stays.
      const Extended m1 = bodies_[0].mass, m2 = bodies_[1].mass;
      const audit::Vector<Extended> push = (state.v - before.v) * (m1 * m2 / (m1 + m2));
      out.records[0].v = out.records[0].v + audit::to<double>(push * (1 / m1));
      out.records[1].v = out.records[1].v - audit::to<double>(push * (1 / m2));
      out.records[0].w = audit::to<double>(audit::cross(state.u1, state.du1));
      out.records[1].w = audit::to<double>(audit::cross(state.u2, state.du2));
      return out;
    }
  }

  Record record(double spin) {
    Record out{};
    out.u = normal();
    out.u = out.u * (1 / audit::norm(out.u));
    out.v = normal();
    out.w = normal() * spin;
    out.w = out.w - out.u * audit::dot(out.w, out.u);
    return out;
  }
  Vector3 normal() { return {{gauss_(source_), gauss_(source_), gauss_(source_)}}; }

 private:
  double arm(const AuditedBody& body) { return body.length / 2 * (2 * uniform_(source_) - 1); }

  std::array<AuditedBody, 2> bodies_;
  std::mt19937_64 source_{5};
  std::normal_distribution<double> gauss_;
  std::uniform_real_distribution<double> uniform_;
};

JointMotion motion_of(const RandomContacts::Contact& contact,
                      const std::array<AuditedBody, 2>& bodies) {
  return JointMotion(Needle(contact.records[0], bodies[0]), Needle(contact.records[1], bodies[1]),
                     contact.r12, contact.side);
}

Vec3d as_vec(const Vector3& a) { return {a[0], a[1], a[2]}; }

class JointMotionOracle : public testing::TestWithParam<std::array<AuditedBody, 2>> {};

TEST_P(JointMotionOracle, IsThatOfAContactHeldByAForce) {
  const std::array<AuditedBody, 2>& bodies = GetParam();
  RandomContacts contacts(bodies);
  const auto kernel_body = [](const AuditedBody& body) {
    return kernels::SlidingBody{body.length / 2, body.mass, 1 / body.inverse_inertia<double>()};
  };
  int by_force = 0, by_tip = 0;
  for (int n = 0; n < 30; ++n) {
    const RandomContacts::Contact contact = contacts.draw();
    JointMotion motion = motion_of(contact, bodies);
    const auto& [a, b] = contact.records;
    SlidingOracle oracle({kernel_body(bodies[0]), kernel_body(bodies[1])},
                         {as_vec(contact.r12), as_vec(a.v - b.v), as_vec(a.u), as_vec(b.u),
                          as_vec(a.w), as_vec(b.w)},
                         contact.side);
    ASSERT_TRUE(motion.follow(3));
    const auto end = motion.first_below(0, 0, 3);
    ASSERT_TRUE(end);
    bool is_force = false;
    double least = HUGE_VAL;
    for (const JointMotion::Room& room : motion.rooms_at(*end)) {
      if (std::abs(room.value) < least) least = std::abs(room.value), is_force = room.is_of_force;
    }
    (is_force ? by_force : by_tip) += 1;
    const auto kind = is_force ? kernels::SlidingEnd::Force : kernels::SlidingEnd::Tip;
    EXPECT_NEAR(static_cast<double>(oracle.end_near(*end, kind).time), *end, 1e-14) << n;
    oracle.advance(*end);
    const audit::RelativeState state = motion.state_at(*end);
    const auto vec = [](const audit::Vector<Extended>& v) { return as_vec(audit::to<double>(v)); };
    const auto difference = oracle.difference(
        {vec(state.r), vec(state.v), vec(state.u1), vec(state.u2),
         vec(audit::cross(state.u1, state.du1)), vec(audit::cross(state.u2, state.du2))});
    EXPECT_LT(difference.position, 1e-15) << n;
    EXPECT_LT(difference.velocity, 2e-14) << n;
  }
  EXPECT_GT(by_force, 2);
  EXPECT_GT(by_tip, 2);
}

INSTANTIATE_TEST_SUITE_P(Bodies, JointMotionOracle, testing::Values(alike_bodies, unlike_bodies),
                         [](const auto& info) { return info.index == 0 ? "Alike" : "Unlike"; });

TEST(JointMotion, StaysWithinItsBounds) {
  RandomContacts contacts(alike_bodies);
  for (int n = 0; n < 20; ++n) {
    JointMotion motion = motion_of(contacts.draw(), alike_bodies);
    constexpr double begin = 0.05, end = 0.2, step = 1e-5;
    ASSERT_TRUE(motion.follow(end + step));
    for (int needle = 0; needle < 2; ++needle) {
      const JointMotion::Most most = motion.most(needle, begin, end);
      double speed = 0, acceleration = 0, turning = 0, faster = 0;
      for (double s = begin; s < end; s += 0.01) {
        const audit::BodyState here = motion.at(needle, s), later = motion.at(needle, s + step);
        speed = std::max(speed, static_cast<double>(audit::norm(here.v)));
        turning = std::max(turning, static_cast<double>(audit::norm(here.du)));
        const auto rate = [&](const auto& a, const auto& b) {
          return static_cast<double>(audit::norm(b - a) / Extended(step));
        };
        acceleration = std::max(acceleration, rate(here.v, later.v));
        faster =
            std::max(faster, rate(audit::cross(here.u, here.du), audit::cross(later.u, later.du)));
      }
      EXPECT_LE(speed, most.speed);
      EXPECT_LE(turning, most.turning);
      EXPECT_LE(acceleration, most.acceleration * 1.001);
      EXPECT_LE(faster, most.turned_faster * 1.001);
      EXPECT_GT(8 * acceleration, most.acceleration);  // and they are of use
      EXPECT_GT(50 * faster, most.turned_faster);
    }
  }
}

// Third needles that pass a needle in contact: the finder sees each change of sign on the needles
// that dense samples show, and no other.
TEST(GuidedFlight, HasTheContactsThatSamplesShow) {
  RandomContacts contacts(alike_bodies);
  audit::Space space;
  space.box = {50, 50, 50};
  constexpr double duration = 0.4;
  constexpr int samples = 4000;
  int met = 0, tips = 0;
  for (int n = 0; n < 200; ++n) {
    const RandomContacts::Contact contact = contacts.draw();
    JointMotion motion = motion_of(contact, alike_bodies);
    ASSERT_TRUE(motion.follow(duration));
    const int index = n % 2;
    const Needle mine(contact.records[index]);
    Record passes = contacts.record(3.5);
    passes.v = passes.v * 3.0;
    // In reach at half of the time.
    passes.r = audit::to<double>(motion.at(index, duration / 2).r) - passes.v * (duration / 2) +
               contacts.normal() * 0.2;
    const Needle third(passes);
    audit::GuidedFlight pair({mine, &motion, index, 0.0}, {third}, {}, space, {}, duration);
    audit::ContactFinder finder(pair);
    std::vector<double> found, shown;
    for (auto next = finder.first(0, duration); next; next = finder.next(next->end, duration)) {
      if (next->certain) found.push_back(next->begin);
    }
    const auto on_needles = [](const audit::Sample& at) {
      return at.margin[0] > 0 && at.margin[1] > 0;
    };
    audit::Sample before = pair.sample(0);
    bool at_tip = false;
    for (int i = 1; i <= samples; ++i) {
      const audit::Sample here = pair.sample(duration * i / samples);
      if (before.f * here.f < 0) {
        if (on_needles(before) && on_needles(here)) shown.push_back(duration * (i - 0.5) / samples);
        at_tip |= on_needles(before) != on_needles(here);
      }
      before = here;
    }
    tips += at_tip;
    if (at_tip) continue;  // which samples do not decide
    ASSERT_EQ(found.size(), shown.size()) << n;
    for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], shown[i], 2e-4);
    met += static_cast<int>(found.size());
  }
  EXPECT_LE(tips, 2);
  EXPECT_GT(met, 40);
}

// |f''|, and how margins bend, by differences of samples.
TEST(GuidedFlight, BoundsHowItsFunctionsBend) {
  RandomContacts contacts(alike_bodies);
  audit::Space space;
  space.box = {50, 50, 50};
  constexpr double duration = 0.2, step = 1e-4;
  for (int n = 0; n < 50; ++n) {
    const RandomContacts::Contact contact = contacts.draw();
    JointMotion motion = motion_of(contact, alike_bodies);
    Record passes = contacts.record(3.5);
    passes.r = contact.records[0].r + contacts.normal() * 0.3;
    const Needle mine(contact.records[0]), third(passes);
    const audit::GuidedFlight pair({mine, &motion, 0, 0.0}, {third}, {}, space, {}, duration);
    double distance = 0, most = 0, margin = 0;
    for (double s = step; s < duration; s += 0.005) {
      const audit::Sample a = pair.sample(s - step), b = pair.sample(s), c = pair.sample(s + step);
      distance = std::max(distance, b.distance);
      most = std::max(most, std::abs(c.df - a.df) / (2 * step));
      // Not next to the needle's middle, where the margin has a kink.
      const double kink = 0.45 * b.sine * b.sine;
      if (a.margin[0] < kink && b.margin[0] < kink && c.margin[0] < kink)
        margin =
            std::max(margin, std::abs(a.margin[0] - 2 * b.margin[0] + c.margin[0]) / (step * step));
    }
    EXPECT_LE(most, pair.bend(0, duration, distance) * 1.01);
    EXPECT_GT(most, 0);
    EXPECT_LE(margin, pair.margin_bend(distance) * 1.01);
  }
}

}  // namespace
}  // namespace needlework::test
