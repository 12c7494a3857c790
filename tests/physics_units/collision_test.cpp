// The collision rule against a dense solution of its equations.
#include "src/physics/collision.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/by_build.h"
#include "tests/support/kernel_pair.h"
#include "tests/support/random.h"

namespace needlework {
namespace {

using kernels::ContactGeometry;
using kernels::Flight;
using test::Random;
using test::vec3;
using EigenVector = Eigen::Vector3d;
using Matrix = Eigen::Matrix3d;

constexpr std::uint64_t encounter_seed = 909;
constexpr int encounters = test::by_build(3000, 300);

struct Encounter {
  Flight first, second;
  ContactGeometry contact;
  int side = 0;
  double k = 6;
  Restitution restitution;

  template <bool smooth>
  Impact collide() const {
    const Body body = body_of(Species{.length = 1, .mass = 1, .k = k});
    return needlework::collide < smooth
               ? Surface::smooth
               : Surface::rough >
                     ({first.v, first.w, second.v, second.w, body, body, contact, side},
                      restitution);
  }
};

EigenVector eigen(const Vec3d& a) { return {a.x, a.y, a.z}; }

/// Velocity of the contact point of the first needle relative to that of the second.
EigenVector relative_velocity(const Encounter& e, const Vec3d& v1, const Vec3d& w1, const Vec3d& v2,
                              const Vec3d& w2) {
  const ContactGeometry& c = e.contact;
  return eigen(v1) - eigen(v2) + c.arm_first * eigen(w1).cross(eigen(c.u_first)) -
         c.arm_second * eigen(w2).cross(eigen(c.u_second));
}

EigenVector velocity_before(const Encounter& e) {
  return relative_velocity(e, e.first.v, e.first.w, e.second.v, e.second.w);
}
EigenVector velocity_after(const Encounter& e, const Impact& impact) {
  return relative_velocity(e, impact.v_first, impact.w_first, impact.v_second, impact.w_second);
}

/// Directors at this angle in a random plane.
Encounter draw(Random& random, double angle) {
  Encounter e;
  const EigenVector n = eigen(vec3(random.direction()));
  const EigenVector other = eigen(vec3(random.direction()));
  const EigenVector e1 = n.cross(other).normalized(), e2 = n.cross(e1);
  const double turn = random.uniform(0, 6.3);
  const auto director = [&](double a) { return EigenVector(std::cos(a) * e1 + std::sin(a) * e2); };
  const EigenVector u1 = director(turn), u2 = director(turn + angle);
  e.contact.u_first = {u1.x(), u1.y(), u1.z()};
  e.contact.u_second = {u2.x(), u2.y(), u2.z()};
  e.contact.normal = {n.x(), n.y(), n.z()};
  e.contact.sin_angle = std::abs(std::sin(angle));
  e.contact.arm_first = random.uniform(-0.5, 0.5);
  e.contact.arm_second = random.uniform(-0.5, 0.5);
  if (random.below(8) == 0) e.contact.arm_first = random.coin() ? 0.5 : 0;
  const auto needle = [&](const Vec3d& u) {
    return test::flight({}, u, vec3(random.normal_vector(1)), vec3(random.normal_vector(3)));
  };
  e.first = needle(e.contact.u_first);
  e.second = needle(e.contact.u_second);
  e.k = random.coin() ? 6 : random.log_uniform(0.1, 100);
  e.restitution = {random.uniform(), random.uniform(-1, 1)};
  if (random.below(4) == 0) e.restitution.epsilon = random.coin() ? 1 : 0;
  if (random.below(3) == 0) e.restitution.beta = random.below(3) - 1;
  e.side = velocity_before(e).dot(n) > 0 ? -1 : 1;
  return e;
}

/// Angles from all to nearly none.
double draw_angle(Random& random) {
  const double tilt = random.coin() ? random.uniform(0.1, 3) : random.log_uniform(1e-9, 0.1);
  return random.coin() ? tilt : -tilt;
}

Matrix mass_matrix(const Encounter& e) {
  const auto part = [&](const Vec3d& director, double arm) {
    const EigenVector u = eigen(director);
    return Matrix(2 * e.k * arm * arm * (Matrix::Identity() - u * u.transpose()));
  };
  return 2 * Matrix::Identity() + part(e.contact.u_first, e.contact.arm_first) +
         part(e.contact.u_second, e.contact.arm_second);
}

double kinetic_energy(const Encounter& e, const Vec3d& v1, const Vec3d& w1, const Vec3d& v2,
                      const Vec3d& w2) {
  const double inertia = 1 / (2 * e.k);
  return 0.5 * (dot(v1, v1) + dot(v2, v2)) + 0.5 * inertia * (dot(w1, w1) + dot(w2, w2));
}

/// What rounding may leave of a velocity: the rule subtracts terms of these sizes.
double noise(const Encounter& e, const Impact& impact) {
  const double spins =
      eigen(impact.w_first).norm() + eigen(impact.w_second).norm() + e.first.omega + e.second.omega;
  const double speeds = eigen(impact.v_first).norm() + eigen(impact.v_second).norm() +
                        eigen(e.first.v).norm() + eigen(e.second.v).norm();
  return 1e-15 * (speeds + spins);
}

class Collide : public testing::Test {
 protected:
  template <class Check>
  void for_each_encounter(Check check) {
    Random random(encounter_seed);
    for (int n = 0; n < encounters && !HasFailure(); ++n) {
      SCOPED_TRACE("seed " + std::to_string(encounter_seed) + ", encounter " + std::to_string(n));
      const Encounter e = draw(random, draw_angle(random));
      check(e, e.collide<false>());
    }
  }
};

TEST_F(Collide, GivesTheImpulseOfTheDenseEquations) {
  for_each_encounter([](const Encounter& e, const Impact& impact) {
    const EigenVector n = eigen(e.contact.normal), v = velocity_before(e);
    const double vn = v.dot(n);
    const EigenVector right =
        -(1 + e.restitution.epsilon) * vn * n - (1 + e.restitution.beta) * (v - vn * n);
    const EigenVector impulse = mass_matrix(e).ldlt().solve(right);
    EXPECT_LT((eigen(impact.impulse) - impulse).norm(), 4 * noise(e, impact));
    EXPECT_NEAR(impact.normal_velocity, vn, noise(e, impact));
  });
}

TEST_F(Collide, ChangesTheEnergyByWhatItSays) {
  for_each_encounter([](const Encounter& e, const Impact& impact) {
    const double before = kinetic_energy(e, e.first.v, e.first.w, e.second.v, e.second.w);
    const double after =
        kinetic_energy(e, impact.v_first, impact.w_first, impact.v_second, impact.w_second);
    EXPECT_NEAR(after - before, impact.energy_change, 1e-13 * (before + after));
    EXPECT_LE(impact.energy_change, 0);
    // The formula, with the inverse of the mass matrix in the plane.
    const EigenVector n = eigen(e.contact.normal), v = velocity_before(e);
    const double vn = v.dot(n);
    const EigenVector vt = v - vn * n;
    const Matrix m = mass_matrix(e);
    const double epsilon = e.restitution.epsilon, beta = e.restitution.beta;
    const double formula = -0.5 * (1 - epsilon * epsilon) * vn * vn / n.dot(m * n) -
                           0.5 * (1 - beta * beta) * vt.dot(m.ldlt().solve(vt));
    EXPECT_NEAR(impact.energy_change, formula, 1e-13 * (before + after));
    Encounter elastic = e;
    for (const double rough : {-1.0, 1.0}) {
      elastic.restitution = {1, rough};
      EXPECT_EQ(elastic.collide<false>().energy_change, 0);
    }
  });
}

TEST_F(Collide, ConservesMomentumAndAngularMomentaAboutTheContact) {
  for_each_encounter([](const Encounter& e, const Impact& impact) {
    const Vec3d before = e.first.v + e.second.v, after = impact.v_first + impact.v_second;
    EXPECT_LT(eigen(after - before).norm(), noise(e, impact));
    const double inertia = 1 / (2 * e.k);
    const auto about_contact = [&](const Vec3d& u, double arm, const Vec3d& v, const Vec3d& w) {
      return EigenVector(inertia * eigen(w) - arm * eigen(u).cross(eigen(v)));
    };
    const auto& c = e.contact;
    EXPECT_LT((about_contact(c.u_first, c.arm_first, impact.v_first, impact.w_first) -
               about_contact(c.u_first, c.arm_first, e.first.v, e.first.w))
                  .norm(),
              noise(e, impact) * (1 + inertia));
    EXPECT_LT((about_contact(c.u_second, c.arm_second, impact.v_second, impact.w_second) -
               about_contact(c.u_second, c.arm_second, e.second.v, e.second.w))
                  .norm(),
              noise(e, impact) * (1 + inertia));
  });
}

TEST_F(Collide, LeavesAngularVelocitiesNormalToTheDirectors) {
  for_each_encounter([](const Encounter& e, const Impact& impact) {
    const double allowed = 4 * noise(e, impact) * (1 + e.k);
    EXPECT_NEAR(dot(impact.w_first, e.contact.u_first), 0, allowed);
    EXPECT_NEAR(dot(impact.w_second, e.contact.u_second), 0, allowed);
  });
}

TEST_F(Collide, SmoothEqualsRoughWithBetaMinusOne) {
  for_each_encounter([](Encounter e, const Impact&) {
    e.restitution.beta = -1;
    const Impact rough = e.collide<false>(), smooth = e.collide<true>();
    const double allowed = noise(e, rough);
    EXPECT_LT(eigen(rough.impulse - smooth.impulse).norm(), allowed);
    EXPECT_LT(eigen(rough.w_first - smooth.w_first).norm(), allowed);
    EXPECT_NEAR(rough.energy_change, smooth.energy_change, 1e-15);
    EXPECT_EQ(rough.normal_velocity, smooth.normal_velocity);
  });
}

void expect_same(const Impact& a, const Impact& b) {
  EXPECT_EQ(a.impulse, b.impulse);
  EXPECT_EQ(a.normal_velocity, b.normal_velocity);
  EXPECT_EQ(a.energy_change, b.energy_change);
  EXPECT_EQ(a.v_first, b.v_first);
  EXPECT_EQ(a.w_first, b.w_first);
  EXPECT_EQ(a.v_second, b.v_second);
  EXPECT_EQ(a.w_second, b.w_second);
}

template <class Transform, class Back>
void expect_unchanged(const Encounter& e, Transform transform, Back back) {
  Encounter other = e;
  transform(other);
  expect_same(e.collide<false>(), back(other.collide<false>()));
  expect_same(e.collide<true>(), back(other.collide<true>()));
}

TEST_F(Collide, ExchangedNeedlesChangeNoBit) {
  for_each_encounter([](const Encounter& e, const Impact&) {
    const auto exchange = [](Encounter& a) {
      std::swap(a.first, a.second);
      std::swap(a.contact.u_first, a.contact.u_second);
      std::swap(a.contact.arm_first, a.contact.arm_second);
      a.contact.normal = -a.contact.normal;
    };
    const auto back = [](Impact a) {
      std::swap(a.v_first, a.v_second);
      std::swap(a.w_first, a.w_second);
      a.impulse = -a.impulse;
      return a;
    };
    expect_unchanged(e, exchange, back);
  });
}

TEST_F(Collide, SwappedAxesChangeNoBit) {
  for_each_encounter([](const Encounter& e, const Impact&) {
    const auto polar = [](Vec3d& a) { std::swap(a.x, a.y); };
    const auto axial = [](Vec3d& a) { a = {-a.y, -a.x, -a.z}; };
    const auto mirror = [&](Encounter& a) {
      for (Flight* needle : {&a.first, &a.second}) {
        polar(needle->v);
        axial(needle->w);
      }
      polar(a.contact.u_first);
      polar(a.contact.u_second);
      axial(a.contact.normal);
      a.side = -a.side;
    };
    const auto back = [&](Impact a) {
      for (Vec3d* v : {&a.impulse, &a.v_first, &a.v_second}) polar(*v);
      for (Vec3d* w : {&a.w_first, &a.w_second}) axial(*w);
      a.normal_velocity = -a.normal_velocity;
      return a;
    };
    expect_unchanged(e, mirror, back);
  });
}

TEST_F(Collide, PowersOfTwoScaleVelocitiesExactly) {
  for_each_encounter([](const Encounter& e, const Impact&) {
    for (const double factor : {0x1p-60, 0x1p60}) {
      const auto scale = [&](Encounter& a) {
        for (Flight* needle : {&a.first, &a.second}) {
          needle->v = needle->v * factor;
          needle->w = needle->w * factor;
        }
      };
      const auto back = [&](Impact a) {
        for (Vec3d* v : {&a.impulse, &a.v_first, &a.v_second, &a.w_first, &a.w_second}) {
          *v = *v * (1 / factor);
        }
        a.normal_velocity /= factor;
        a.energy_change /= factor * factor;
        return a;
      };
      expect_unchanged(e, scale, back);
    }
  });
}

TEST_F(Collide, WhatRoundingTakesForPartingIsNoNormalImpulse) {
  for_each_encounter([](Encounter e, const Impact&) {
    e.side = -e.side;
    const Impact impact = e.collide<true>();
    EXPECT_EQ(impact.normal_velocity, 0);
    EXPECT_EQ(impact.impulse, Vec3d());
    EXPECT_EQ(impact.v_first, e.first.v);
    EXPECT_EQ(impact.w_second, e.second.w);
    EXPECT_EQ(impact.energy_change, 0);
  });
}

Encounter crossed(double arm_first, double arm_second) {
  Encounter e;
  e.contact = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, 1, arm_first, arm_second};
  e.first = test::flight({}, {1, 0, 0}, {0, 0, -3}, {});
  e.second = test::flight({}, {0, 1, 0}, {}, {});
  e.side = 1;
  e.k = 2;
  return e;
}

// I = 1/4: 1/M = 1 / (2 + 4/4) and the impulse is 2 times 3 / 3.
TEST(CollideByHand, ATipSetsItsNeedleSpinning) {
  const Impact impact = crossed(0.5, 0).collide<true>();
  EXPECT_NEAR(impact.impulse.z, 2, 1e-15);
  EXPECT_NEAR(impact.v_first.z, -1, 1e-15);
  EXPECT_NEAR(impact.v_second.z, -2, 1e-15);
  // s12 / I = 2, u1 x dp = (1, 0, 0) x (0, 0, 2) = (0, -2, 0).
  EXPECT_NEAR(impact.w_first.y, -4, 1e-14);
}

// Along the first director the first needle does not turn: M_11 = 2 + (s21^2/I).
TEST(CollideByHand, ARoughContactReversesTheSliding) {
  Encounter e = crossed(0.5, 0.5);
  e.first.v = {1, 0, 0};
  e.restitution = {1, 1};
  const Impact impact = e.collide<false>();
  EXPECT_NEAR(impact.impulse.x, -2.0 / 3, 1e-15);
  EXPECT_NEAR(impact.impulse.y, 0, 1e-15);
  EXPECT_NEAR(impact.impulse.z, 0, 1e-15);
  EXPECT_NEAR(velocity_after(e, impact).x(), -1, 1e-15);
}

}  // namespace
}  // namespace needlework
