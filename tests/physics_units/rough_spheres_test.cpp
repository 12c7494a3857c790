// The rule of collisions of rough spheres: what it keeps, what it makes of the relative velocity of
// the surfaces, and that it can be turned back.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <string>

#include "src/physics/collision.h"
#include "tests/support/by_build.h"
#include "tests/support/kernel_pair.h"
#include "tests/support/random.h"

namespace needlework::rough_spheres {
namespace {

using test::Random;
using test::vec3;
using Vector = Eigen::Vector3d;

constexpr std::uint64_t seed = 611;
constexpr int encounters = test::by_build(3000, 300);
constexpr double rounding = 1e-14;

Vector eigen(const Vec3d& a) { return {a.x, a.y, a.z}; }

struct Motion {
  Vec3d v, w;
};

struct Encounter {
  Species kinds[2];
  Motion motion[2];
  Vec3d normal;  // from the second to the first
  Restitution rule;

  Body body(int i) const { return body_of(kinds[i]); }
  template <Surface surface = Surface::rough_sphere>
  Impact collide() const {
    kernels::ContactGeometry contact;
    contact.normal = normal;
    contact.u_first = contact.u_second = {0, 0, 1};
    const Body bodies[] = {body(0), body(1)};
    return needlework::collide<surface>(
        {motion[0].v, motion[0].w, motion[1].v, motion[1].w, bodies[0], bodies[1], contact, 1},
        rule);
  }
  double radius(int i) const { return kinds[i].diameter / 2; }
  /// Of the surface of the first at the contact, relative to that of the second.
  Vector slip(const Motion& first, const Motion& second) const {
    const Vector n = eigen(normal);
    return eigen(first.v) - eigen(second.v) - radius(0) * eigen(first.w).cross(n) -
           radius(1) * eigen(second.w).cross(n);
  }
  double energy(const Motion& first, const Motion& second) const {
    const auto of = [&](int i, const Motion& m) {
      return 0.5 * kinds[i].mass * (dot(m.v, m.v)) + 0.5 * kinds[i].inertia() * dot(m.w, m.w);
    };
    return of(0, first) + of(1, second);
  }
  /// About the contact. [m L^2 / time]
  Vector angular_momentum(int i, const Motion& m) const {
    const double arm = i == 0 ? radius(0) : -radius(1);
    return arm * kinds[i].mass * eigen(normal).cross(eigen(m.v)) + kinds[i].inertia() * eigen(m.w);
  }
};

Encounter draw(Random& random) {
  Encounter e;
  for (int i = 0; i < 2; ++i) {
    e.kinds[i] = {.length = 0,
                  .mass = random.log_uniform(0.1, 10),
                  .diameter = random.log_uniform(0.3, 3),
                  .q = random.coin() ? 0.4 : random.uniform(0.05, 2.0 / 3)};
    e.motion[i] = {vec3(random.normal_vector(1)), vec3(random.normal_vector(3))};
  }
  e.normal = vec3(random.direction());
  e.rule = {random.uniform(), random.uniform(-1, 1)};
  if (random.below(4) == 0) e.rule.epsilon = random.coin() ? 1 : 0;
  if (random.below(3) == 0) e.rule.beta = random.below(3) - 1;
  if (dot(e.motion[0].v - e.motion[1].v, e.normal) > 0) e.normal = -e.normal;
  return e;
}

Motion first_of(const Impact& impact) { return {impact.v_first, impact.w_first}; }
Motion second_of(const Impact& impact) { return {impact.v_second, impact.w_second}; }

// What rounding may leave, relative to the largest numbers of the encounter.
double noise(const Encounter& e) {
  double out = 0;
  for (int i = 0; i < 2; ++i)
    out += eigen(e.motion[i].v).norm() + eigen(e.motion[i].w).norm() * e.radius(i);
  return rounding * out *
         (1 + e.kinds[0].mass / e.kinds[1].mass + e.kinds[1].mass / e.kinds[0].mass);
}

template <class Check>
void for_each_encounter(Check check) {
  Random random(seed);
  for (int n = 0; n < encounters && !testing::Test::HasFailure(); ++n) {
    SCOPED_TRACE("seed " + std::to_string(seed) + ", encounter " + std::to_string(n));
    const Encounter e = draw(random);
    check(e, e.collide());
  }
}

TEST(RoughSpheres, PartAsTheTwoRestitutionsSay) {
  for_each_encounter([](const Encounter& e, const Impact& impact) {
    const Vector n = eigen(e.normal);
    const Vector before = e.slip(e.motion[0], e.motion[1]);
    const Vector after = e.slip(first_of(impact), second_of(impact));
    const double stiff = 1 / std::min(e.kinds[0].q, e.kinds[1].q);
    EXPECT_NEAR(after.dot(n), -e.rule.epsilon * before.dot(n), noise(e));
    const Vector slipped = after - n * after.dot(n) + e.rule.beta * (before - n * before.dot(n));
    EXPECT_LT(slipped.norm(), stiff * noise(e));
    EXPECT_EQ(impact.normal_velocity, dot(e.motion[0].v - e.motion[1].v, e.normal));
  });
}

TEST(RoughSpheres, KeepMomentumAndTheAngularMomentumOfEachAboutTheContact) {
  for_each_encounter([](const Encounter& e, const Impact& impact) {
    const auto momentum = [&](const Motion& a, const Motion& b) {
      return Vector(e.kinds[0].mass * eigen(a.v) + e.kinds[1].mass * eigen(b.v));
    };
    const double mass = e.kinds[0].mass + e.kinds[1].mass;
    EXPECT_LT(
        (momentum(first_of(impact), second_of(impact)) - momentum(e.motion[0], e.motion[1])).norm(),
        mass * noise(e));
    for (int i = 0; i < 2; ++i) {
      const Motion after = i == 0 ? first_of(impact) : second_of(impact);
      EXPECT_LT((e.angular_momentum(i, after) - e.angular_momentum(i, e.motion[i])).norm(),
                mass * e.kinds[i].diameter * noise(e));
      // No impulse has an arm about the normal.
      const Vector turned = eigen(after.w) - eigen(e.motion[i].w);
      EXPECT_LE(std::abs(turned.dot(eigen(e.normal))),
                rounding * (turned.norm() + eigen(e.motion[i].w).norm()));
    }
  });
}

TEST(RoughSpheres, LoseTheEnergyThatIsReported) {
  int lossless = 0;
  for_each_encounter([&](const Encounter& e, const Impact& impact) {
    const double before = e.energy(e.motion[0], e.motion[1]),
                 after = e.energy(first_of(impact), second_of(impact));
    EXPECT_NEAR(after - before, impact.energy_change, 20 * rounding * before);
    EXPECT_LE(impact.energy_change, 0);
    if (e.rule.epsilon == 1 && std::abs(e.rule.beta) == 1) {
      ++lossless;
      EXPECT_EQ(impact.energy_change, 0);
    }
  });
  EXPECT_GT(lossless, encounters / 100);
}

// Elastic collisions of perfectly rough spheres, with all velocities turned around.
TEST(RoughSpheres, CollideBackwards) {
  for_each_encounter([](Encounter e, const Impact&) {
    e.rule = {1, 1};
    const Impact there = e.collide();
    Encounter back = e;
    back.motion[0] = {-there.v_first, -there.w_first};
    back.motion[1] = {-there.v_second, -there.w_second};
    const Impact again = back.collide();
    const double stiff = 1 / std::min(e.kinds[0].q, e.kinds[1].q);
    const auto expect_back = [&](const Vec3d& now, const Vec3d& then, double unit) {
      EXPECT_LT((eigen(now) + eigen(then)).norm(), unit * stiff * noise(e));
    };
    expect_back(again.v_first, e.motion[0].v, 1);
    expect_back(again.v_second, e.motion[1].v, 1);
    expect_back(again.w_first, e.motion[0].w, 4 / e.kinds[0].diameter);
    expect_back(again.w_second, e.motion[1].w, 4 / e.kinds[1].diameter);
  });
}

// The smooth rule has no spins in it, and leaves them.
TEST(RoughSpheres, AreSmoothToTheLastBitAtBetaOfMinusOne) {
  for_each_encounter([](Encounter e, const Impact&) {
    e.rule.beta = -1;
    const Impact rough = e.collide(), smooth = e.collide<Surface::sphere>();
    EXPECT_EQ(rough.v_first, smooth.v_first);
    EXPECT_EQ(rough.v_second, smooth.v_second);
    EXPECT_EQ(rough.w_first, e.motion[0].w);
    EXPECT_EQ(smooth.w_second, e.motion[1].w);
    EXPECT_EQ(rough.energy_change, smooth.energy_change);
  });
}

TEST(RoughSpheres, DoNotDependOnTheirOrder) {
  for_each_encounter([](const Encounter& e, const Impact& impact) {
    Encounter other = e;
    std::swap(other.kinds[0], other.kinds[1]);
    std::swap(other.motion[0], other.motion[1]);
    other.normal = -e.normal;
    const Impact back = other.collide();
    EXPECT_EQ(back.v_first, impact.v_second);
    EXPECT_EQ(back.v_second, impact.v_first);
    EXPECT_EQ(back.w_first, impact.w_second);
    EXPECT_EQ(back.w_second, impact.w_first);
    EXPECT_EQ(back.impulse, -impact.impulse);
    EXPECT_EQ(back.energy_change, impact.energy_change);
  });
}

}  // namespace
}  // namespace needlework::rough_spheres
