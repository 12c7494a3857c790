// The cooling rates against contacts drawn at random, with the collision rule written afresh.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>
#include <vector>

#include "needlework/diffusion.h"
#include "needlework/theory.h"

namespace needlework::theory {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

struct Needle {
  Vector3d director, velocity, angular_velocity;
};

struct Contact {
  Needle first, second;
  double s12, s21;

  Vector3d normal() const { return first.director.cross(second.director).normalized(); }

  Vector3d relative_velocity() const {
    return first.velocity - second.velocity + s12 * first.angular_velocity.cross(first.director) -
           s21 * second.angular_velocity.cross(second.director);
  }
};

double translational_energy(const Contact& contact) {
  return 0.5 * (contact.first.velocity.squaredNorm() + contact.second.velocity.squaredNorm());
}

double rotational_energy(const Contact& contact, double inertia) {
  return 0.5 * inertia *
         (contact.first.angular_velocity.squaredNorm() +
          contact.second.angular_velocity.squaredNorm());
}

void kick(Contact& contact, const Vector3d& impulse, double k) {
  const double inertia = 0.5 / k;
  Needle& first = contact.first;
  Needle& second = contact.second;
  first.velocity += impulse;
  second.velocity -= impulse;
  first.angular_velocity += contact.s12 / inertia * first.director.cross(impulse);
  second.angular_velocity -= contact.s21 / inertia * second.director.cross(impulse);
}

/// How the relative velocity of the contact points answers to an impulse, found by trying.
Matrix3d response(const Contact& contact, double k) {
  Matrix3d columns;
  for (int axis = 0; axis < 3; ++axis) {
    Contact probe = contact;
    kick(probe, Vector3d::Unit(axis), k);
    columns.col(axis) = probe.relative_velocity() - contact.relative_velocity();
  }
  return columns;
}

/// The contact after the collision: the impulse that gives the relative velocity its restitution.
Contact collided(Contact contact, const Gas& gas, const Eigen::PartialPivLU<Matrix3d>& response) {
  const Vector3d n = contact.normal();
  const Vector3d v = contact.relative_velocity();
  const Vector3d wanted_change =
      -(1.0 + gas.epsilon) * v.dot(n) * n - (1.0 + gas.beta) * (v - v.dot(n) * n);
  kick(contact, response.solve(wanted_change), gas.k);
  return contact;
}

class Sampler {
 public:
  Sampler(Temperatures temperatures, double k)
      : speed_(std::sqrt(temperatures.t_tr)), spin_(std::sqrt(temperatures.t_rot * 2.0 * k)) {}

  Contact draw() {
    return {.first = needle(), .second = needle(), .s12 = arm_(engine_), .s21 = arm_(engine_)};
  }

 private:
  Vector3d gaussian() { return {normal_(engine_), normal_(engine_), normal_(engine_)}; }

  Needle needle() {
    const Vector3d u = gaussian().normalized();
    const Vector3d w = gaussian();
    return {u, speed_ * gaussian(), spin_ * (w - w.dot(u) * u)};
  }

  double speed_, spin_;
  std::mt19937_64 engine_{20240229};
  std::normal_distribution<double> normal_;
  std::uniform_real_distribution<double> arm_{-0.5, 0.5};
};

/// Sample mean and its standard error.
class Mean {
 public:
  void add(double value) {
    ++count_;
    const double step = value - mean_;
    mean_ += step / count_;
    squares_ += step * (value - mean_);
  }
  double value() const { return mean_; }
  double error() const { return std::sqrt(squares_ / (count_ * (count_ - 1.0))); }

 private:
  double count_ = 0.0, mean_ = 0.0, squares_ = 0.0;
};

// Law: needles with random directors meet at arms s12, s21 at a rate of density, sin(theta) |V_n|
// per area of arms, for one needle and all partners. Tolerance: 4 standard errors.
TEST(ContactSampling, GivesTheCoolingRates) {
  const int samples = 20000;
  const double gamma = 2.0 / 3.0 * std::sqrt(std::numbers::pi);  // density 1
  struct Case {
    double k;
    Temperatures temperatures;
  };
  for (const Case& scene : {Case{6.0, {1.0, 0.3}}, Case{6.0, {0.5, 2.0}}, Case{2.0, {1.0, 0.0}}}) {
    const std::vector<Gas> gases = {
        {scene.k, 0.8, 0.5}, {scene.k, 0.3, -0.4}, {scene.k, 1.0, 1.0}, {scene.k, 0.6, -1.0}};
    std::vector<Mean> t_tr(gases.size()), t_rot(gases.size());
    Mean rate;
    Sampler sampler(scene.temperatures, scene.k);
    for (int sample = 0; sample < samples; ++sample) {
      const Contact before = sampler.draw();
      const double flux = before.first.director.cross(before.second.director).norm() *
                          std::abs(before.relative_velocity().dot(before.normal()));
      rate.add(flux);
      const Eigen::PartialPivLU<Matrix3d> solver(response(before, scene.k));
      for (std::size_t i = 0; i < gases.size(); ++i) {
        const Contact after = collided(before, gases[i], solver);
        const double inertia = 0.5 / scene.k;
        const double gain = translational_energy(after) - translational_energy(before);
        const double spin_up =
            rotational_energy(after, inertia) - rotational_energy(before, inertia);
        t_tr[i].add(flux / gamma * gain / 3.0);
        t_rot[i].add(flux / gamma * spin_up / 2.0);
      }
    }
    EXPECT_NEAR(rate.value(), collision_rate(1.0, scene.temperatures, scene.k), 4.0 * rate.error());
    for (std::size_t i = 0; i < gases.size(); ++i) {
      const Temperatures expected = cooling_rates(gases[i], scene.temperatures);
      SCOPED_TRACE(testing::Message()
                   << "k " << scene.k << " t_rot " << scene.temperatures.t_rot << " epsilon "
                   << gases[i].epsilon << " beta " << gases[i].beta);
      EXPECT_NEAR(t_tr[i].value(), expected.t_tr, 4.0 * t_tr[i].error());
      EXPECT_NEAR(t_rot[i].value(), expected.t_rot, 4.0 * t_rot[i].error());
      EXPECT_LT(t_tr[i].error(), 0.03 * (std::abs(expected.t_tr) + std::abs(expected.t_rot)));
    }
  }
}

// Law: in equilibrium <v(0).v(t)> and <w(0).w(t)> change by <v.dv> and <w.dw> of each collision at
// first. Tolerance: 4 standard errors.
TEST(ContactSampling, GivesTheDecayOfVelocities) {
  for (const double k : {2.0, 6.0}) {
    const double temperature = 1.7;
    Sampler sampler({temperature, temperature}, k);
    Mean velocity, angular_velocity;
    for (int sample = 0; sample < 50000; ++sample) {
      const Contact before = sampler.draw();
      const double flux = before.first.director.cross(before.second.director).norm() *
                          std::abs(before.relative_velocity().dot(before.normal()));
      const Contact after =
          collided(before, {k, 1.0, -1.0}, Eigen::PartialPivLU<Matrix3d>(response(before, k)));
      const Vector3d dv = after.first.velocity - before.first.velocity;
      const Vector3d dw = after.first.angular_velocity - before.first.angular_velocity;
      velocity.add(-flux * before.first.velocity.dot(dv) / (3 * temperature));
      angular_velocity.add(-flux * before.first.angular_velocity.dot(dw) / (4 * k * temperature));
    }
    const Transport expected = uncorrelated_transport(1.0, temperature, k);
    EXPECT_NEAR(velocity.value(), expected.velocity_decay, 4.0 * velocity.error());
    EXPECT_NEAR(angular_velocity.value(), expected.angular_velocity_decay,
                4.0 * angular_velocity.error());
    EXPECT_LT(velocity.error(), 0.02 * expected.velocity_decay);
    EXPECT_LT(angular_velocity.error(), 0.02 * expected.angular_velocity_decay);
    EXPECT_DOUBLE_EQ(expected.diffusion, temperature / expected.velocity_decay);
    EXPECT_DOUBLE_EQ(expected.rotational_diffusion,
                     2 * k * temperature / expected.angular_velocity_decay);
  }
  EXPECT_EQ(uncorrelated_transport(0, 1, 6).velocity_decay, 0);
  EXPECT_TRUE(std::isinf(uncorrelated_transport(0, 1, 6).diffusion));
  EXPECT_THROW(uncorrelated_transport(-1, 1, 6), std::invalid_argument);
  EXPECT_THROW(uncorrelated_transport(1, 0, 6), std::invalid_argument);
  EXPECT_THROW(uncorrelated_transport(1, 1, 0), std::invalid_argument);
}

}  // namespace
}  // namespace needlework::theory
