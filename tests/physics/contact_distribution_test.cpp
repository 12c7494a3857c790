// How needles meet in elastic equilibrium: angle, arms and speed have exact distributions.
//
// Laws, for random centres and directors and microcanonical velocities (N needles, momentum 0,
// energy E, D = 5 N - 3 degrees of freedom), contacts being weighted with their flux
// |u1 x u2| |V_n|:
// - the angle theta between the directors has density (2/pi) sin^2 theta on [0, pi];
// - the arms (s12, s21) have density proportional to sqrt(1 + k (s12^2 + s21^2)) on the square;
// - |V_n| at given arms is Rayleigh for infinitely many needles; for N of them, the energy
//   V_n^2 / (4 (1 + k (s12^2 + s21^2))) exceeds e with probability (1 - e / E)^((D - 1) / 2).
// Contacts lost near the parallel configuration, near a tip or near grazing leave a dent at
// sin theta -> 0, |s| -> 1/2 or |V_n| -> 0, so bins are fine there.
// A pair that grazes (|V_n| -> 0) either separates or, in half of all cases by time reversal, is
// driven together again: then it meets about 1 / |V_n| times. A few such pairs make up half of all
// contacts at the smallest |V_n|, and no run is long enough to estimate their scatter. So below a
// probability of 0.01 the number of contacts is only bounded from below by the pairs that separate,
// which are half of the law's. Tolerance: chi-square with a probability of at least 0.0027 (3
// standard errors). The variances are those that the batches of the run show, because a pair that
// has met often meets again.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <iostream>
#include <numbers>

#include "needlework/theory.h"
#include "tests/support/parameter_name.h"
#include "tests/support/runs.h"
#include "tests/support/statistics.h"

namespace needlework {
namespace {

using test::BatchHistogram;
using Edges = std::vector<double>;

constexpr int batches = 100;

// Probabilities of bins from the law's distribution function at their upper ends.
template <class Function>
std::vector<double> probabilities(const Edges& ends, Function&& below) {
  std::vector<double> out;
  double before = 0;
  for (const double end : ends) {
    out.push_back(below(end) - before);
    before += out.back();
  }
  return out;
}

void print(const char* name, const BatchHistogram& histogram) {
  std::cout << name << ": " << histogram.chi_square() << '\n';
  for (const std::size_t bin : {std::size_t{0}, histogram.bins() - 1}) {
    std::cout << "  bin " << bin << ": " << histogram.counted(bin) << ", expected "
              << histogram.expected(bin) << ", variance " << histogram.excess(bin) << '\n';
  }
}

// sin theta, folded: theta and pi - theta are the same.
class AngleHistogram {
 public:
  void add(const Collision& c) { histogram_.add(test::bin_of(c.sin_angle, ends_)); }
  BatchHistogram& histogram() { return histogram_; }

 private:
  static double below(double sine) {
    const double theta = std::asin(sine);
    return 2 / std::numbers::pi * (theta - sine * std::cos(theta));
  }

  Edges ends_{0.05, 0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.85, 0.9, 0.95, 0.98, 0.995, 1};
  BatchHistogram histogram_{probabilities(ends_, below)};
};

// The larger of |s12| and |s21|: squares around the middle, the law's integral known for each.
class OuterArmHistogram {
 public:
  explicit OuterArmHistogram(double k)
      : histogram_(probabilities(ends_, [k](double arm) {
          const double side = 2 * arm;
          return side * side * theory::collision_integral(1, k * side * side) /
                 theory::collision_integral(1, k);
        })) {}
  void add(const Collision& c) {
    histogram_.add(test::bin_of(std::max(std::abs(c.arm_first), std::abs(c.arm_second)), ends_));
  }
  BatchHistogram& histogram() { return histogram_; }

 private:
  Edges ends_{0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.35, 0.4, 0.45, 0.49, 0.499, 0.4999, 0.5};
  BatchHistogram histogram_;
};

// Both arms with their signs, on a coarse grid; integrals by the midpoint rule.
class ArmsHistogram {
 public:
  explicit ArmsHistogram(double k) : histogram_(grid(k)) {}
  void add(const Collision& c) {
    histogram_.add(test::bin_of(c.arm_first, ends_) * ends_.size() +
                   test::bin_of(c.arm_second, ends_));
  }
  BatchHistogram& histogram() { return histogram_; }

 private:
  std::vector<double> grid(double k) const {
    constexpr int points = 1000;  // multiple of 20, so that none lies on an edge
    std::vector<double> out(ends_.size() * ends_.size());
    double sum = 0;
    for (int i = 0; i < points; ++i) {
      for (int j = 0; j < points; ++j) {
        const double x = (i + 0.5) / points - 0.5, y = (j + 0.5) / points - 0.5;
        const double density = std::sqrt(1 + k * (x * x + y * y));
        out[test::bin_of(x, ends_) * ends_.size() + test::bin_of(y, ends_)] += density;
        sum += density;
      }
    }
    for (double& p : out) p /= sum;
    return out;
  }

  Edges ends_{-0.45, -0.3, -0.15, 0, 0.15, 0.3, 0.45, 0.5};
  BatchHistogram histogram_;
};

// The distribution function of |V_n| at the collision's arms, uniform on [0, 1].
class SpeedHistogram {
 public:
  SpeedHistogram(double k, double count, double energy)
      : k_(k), energy_(energy), power_((5 * count - 4) / 2) {}
  void add(const Collision& c) {
    const double r2 = c.arm_first * c.arm_first + c.arm_second * c.arm_second;
    const double mode = c.normal_velocity * c.normal_velocity / (4 * (1 + k_ * r2));
    const double u = -std::expm1(power_ * std::log1p(-mode / energy_));
    histogram_.add(test::bin_of(u, ends_));
    if (u < grazing_ends_.back()) ++grazing_[test::bin_of(u, grazing_ends_)];
  }
  BatchHistogram& histogram() { return histogram_; }

  // Few enough contacts at |V_n| -> 0 for some to have been lost?
  void expect_grazing() const {
    double samples = 0;
    for (std::size_t bin = 0; bin < histogram_.bins(); ++bin) samples += histogram_.counted(bin);
    for (std::size_t bin = 0; bin < grazing_.size(); ++bin) {
      const double parting =
          samples * (grazing_ends_[bin] - (bin ? grazing_ends_[bin - 1] : 0)) / 2;
      std::cout << "  |V_n| up to probability " << grazing_ends_[bin] << ": " << grazing_[bin]
                << ", of which part " << parting << '\n';
      EXPECT_GT(grazing_[bin], parting - 3 * std::sqrt(parting)) << "bin " << bin;
    }
  }

 private:
  double k_, energy_, power_;
  const Edges grazing_ends_{1e-4, 1e-3, 0.01};
  std::array<double, 3> grazing_{};
  Edges ends_{0.01, 0.05, 0.1, 0.2,  0.3,  0.4,   0.5,    0.6,
              0.7,  0.8,  0.9, 0.95, 0.99, 0.999, 0.9999, 1};
  BatchHistogram histogram_{probabilities(ends_, [](double u) { return u; })};
};

struct EquilibriumGas {
  double k;
  double density;
  std::uint64_t seed;
};

std::ostream& operator<<(std::ostream& out, const EquilibriumGas& gas) {
  return out << "k " << gas.k << ", density " << gas.density << ", seed " << gas.seed;
}

class ContactDistribution : public testing::TestWithParam<EquilibriumGas> {};

TEST_P(ContactDistribution, IsExactInEquilibrium) {
  const EquilibriumGas gas = GetParam();
  SCOPED_TRACE(gas);
  const double count = 500;
  Scene scene = test::scene_of(500, std::cbrt(count / gas.density), gas.seed);
  scene.needles.k = gas.k;
  Simulation simulation(scene);
  Scene::Until until;
  until.collisions_per_needle = 2;  // the temperatures find their balance
  simulation.advance(until);

  AngleHistogram angle;
  OuterArmHistogram outer_arm(gas.k);
  ArmsHistogram arms(gas.k);
  SpeedHistogram speed(gas.k, count, simulation.totals().energy * count);
  bool both_signs[2] = {false, false};
  simulation.on_collision([&](const Collision& c) {
    angle.add(c);
    outer_arm.add(c);
    arms.add(c);
    speed.add(c);
    both_signs[c.normal_velocity > 0] = true;
  });
  for (int batch = 0; batch < batches; ++batch) {
    *until.collisions_per_needle += 16;
    simulation.advance(until);
    for (BatchHistogram* histogram :
         {&angle.histogram(), &outer_arm.histogram(), &arms.histogram(), &speed.histogram()}) {
      histogram->end_batch();
    }
  }

  print("angle", angle.histogram());
  print("outer arm", outer_arm.histogram());
  print("arms", arms.histogram());
  print("speed", speed.histogram());
  EXPECT_GT(angle.histogram().chi_square().probability(), 0.0027);
  EXPECT_GT(outer_arm.histogram().chi_square().probability(), 0.0027);
  EXPECT_GT(arms.histogram().chi_square().probability(), 0.0027);
  EXPECT_GT(speed.histogram().chi_square().probability(), 0.0027);
  speed.expect_grazing();
  EXPECT_TRUE(both_signs[0] && both_signs[1]);
}

std::string equilibrium_name(const testing::TestParamInfo<EquilibriumGas>& info) {
  return test::parameter_name({{"k", info.param.k}, {"n", info.param.density}});
}

INSTANTIATE_TEST_SUITE_P(Elastic, ContactDistribution, testing::Values(EquilibriumGas{6, 0.72, 21}),
                         equilibrium_name);
INSTANTIATE_TEST_SUITE_P(Elastic_long, ContactDistribution,
                         testing::Values(EquilibriumGas{20, 3, 22}), equilibrium_name);

}  // namespace
}  // namespace needlework
