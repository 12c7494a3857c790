// Pistons: the force on a wall that moves in an undisturbed gas, and slow ones, which compress as
// thermodynamics has it.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <iostream>
#include <numbers>
#include <vector>

#include "tests/support/runs.h"
#include "tests/support/statistics.h"
#include "tests/support/wall.h"

namespace needlework::test {
namespace {

// Of bodies of unit mass and temperature that no collision has disturbed, per area and density of
// centres where bodies turn freely. A tip meets the wall as a body of mass 1 / K would,
// K = 1 + (k / 2) (1 - u^2), and directors are uniform: with s = V / sqrt(2 K), means over u from 0
// to 1 of sqrt(K / 2) (exp(-s^2) / sqrt(pi) + s (1 + erf s)) hits per time, and of
// ((1 + epsilon) / 2) ((1 + 2 s^2) (1 + erf s) + 2 s exp(-s^2) / sqrt(pi)) impulse.
struct AtAPiston {
  double hits = 0, force = 0;

  AtAPiston(double velocity, double half_k, double epsilon) {
    constexpr int points = 4000;
    for (int n = 0; n < points; ++n) {
      const double u = (n + 0.5) / points, mobility = 1 + half_k * (1 - u * u);
      const double s = velocity / std::sqrt(2 * mobility);
      const double bell = std::exp(-s * s) / std::sqrt(std::numbers::pi), step = 1 + std::erf(s);
      hits += std::sqrt(mobility / 2) * (bell + s * step) / points;
      force += 0.5 * (1 + epsilon) * ((1 + 2 * s * s) * step + 2 * s * bell) / points;
    }
  }
};

// A gas of bodies that do not meet each other, between walls that both advance. Rates at time 0 are
// those of two short times continued to there, as hit bodies soon hit again.
class UndisturbedGas {
 public:
  UndisturbedGas(bool spheres, double velocity, double epsilon, std::uint64_t count, int runs) {
    constexpr double side = 10, height = 3, step = 0.03;
    Scene scene = scene_of(0, side);
    scene.needles.box[2] = height;
    scene.species = {{.name = "ideal", .count = count}};
    if (spheres) {
      scene.species[0].length = 0;
      scene.species[0].diameter = 0.5;
    }
    scene.pairs = {{.between = {"ideal", "ideal"}, .epsilon = {}, .beta = {}, .meet = false}};
    scene.walls = {piston("z", "low", velocity, {}, epsilon),
                   piston("z", "high", -velocity, {}, epsilon)};
    const double unit = 2 * static_cast<double>(count) / (height - 0.5) * step;
    for (int seed = 1; seed <= runs; ++seed) {
      scene.needles.seed = static_cast<std::uint64_t>(seed);
      Simulation run(scene);
      std::array<double, 2> counted{}, pushed{};
      for (const std::size_t n : {0u, 1u}) {
        run.advance(until_time(step * static_cast<double>(n + 1)));
        for (const WallTotals& each : run.wall_totals()) {
          counted[n] += static_cast<double>(each.hits) / unit;
          pushed[n] += each.normal_impulse / unit;
        }
      }
      // Sums up to both times, of a rate that is straight at first.
      hits.add(2 * counted[0] - 0.5 * counted[1]);
      force.add(2 * pushed[0] - 0.5 * pushed[1]);
    }
  }
  Mean hits, force;
};

void expect_force_of_moving_wall(std::uint64_t count, int runs, double largest_error) {
  struct Case {
    double velocity, epsilon;
    bool spheres;
    double force;  // by quadrature of other hands
  };
  for (const Case& c : {Case{1, 1, false, 2.40987},
                        {-0.5, 1, false, 0.60438},
                        {3, 1, false, 8.81634},
                        {1, 1, true, 3.84932},
                        {-0.5, 1, true, 0.41928},
                        {3, 1, true, 19.9996},
                        {1, 0.5, false, 0.75 * 2.40987}}) {
    const AtAPiston exact(c.velocity, c.spheres ? 0 : 3, c.epsilon);
    EXPECT_NEAR(exact.force, c.force, 1e-5 * c.force);
    const UndisturbedGas found(c.spheres, c.velocity, c.epsilon, count, runs);
    EXPECT_TRUE(agrees(found.hits.measured(), exact.hits, 3.5)) << c.velocity << c.spheres;
    EXPECT_TRUE(agrees(found.force.measured(), exact.force, 3.5)) << c.velocity << c.spheres;
    // A wall that recedes is hit less.
    const double error = c.velocity < 0 ? 2 * largest_error : largest_error;
    EXPECT_LT(found.hits.measured().error, error * exact.hits);
    EXPECT_LT(found.force.measured().error, error * exact.force);
  }
}

TEST(PistonForce, IsThatOfAnUndisturbedGas) { expect_force_of_moving_wall(4000, 8, 0.08); }

TEST(PistonForce, IsThatOfAnUndisturbedGas_long) { expect_force_of_moving_wall(20000, 16, 0.03); }

// By how much the energy exceeds the adiabat's after the walls have come from one distance to
// another: `exponent` is that of the free height, which is the distance less `taken`.
struct Compression {
  Scene scene;
  double from, to, velocity;  // > 0; the high wall moves
  double taken, exponent, factor = 1;

  Mean excess(int runs) const {
    Mean out;
    for (int seed = 1; seed <= runs; ++seed) {
      Scene each = scene;
      each.needles.seed = static_cast<std::uint64_t>(seed);
      each.needles.box[2] = from;
      const double v = to < from ? -velocity : velocity;
      each.walls = {wall("z", "low"), piston("z", "high", v, to)};
      Simulation run(each);
      const double before = run.totals().energy;
      run.advance(until_time((to - from) / v));
      out.add(run.totals().energy / before /
                  (factor * std::pow((from - taken) / (to - taken), exponent)) -
              1);
    }
    return out;
  }
};

// E (H - L / 2)^(2 N / (5 N - 2)) is the same along a slow way, as momentum along the walls stays
// 0. What remains is dissipation, some 0.07 of the wall's velocity over the thermal one.
Compression of_needles(double velocity, bool expands) {
  constexpr double count = 200;
  return {.scene = scene_of(200, 4),
          .from = expands ? 10.0 : 20.0,
          .to = expands ? 20.0 : 10.0,
          .velocity = velocity,
          .taken = 0.5,
          .exponent = 2 * count / (5 * count - 2)};
}

TEST(SlowPiston, CompressesNeedlesAlongTheirAdiabat) {
  const Measured excess = of_needles(0.1, false).excess(6).measured();
  EXPECT_LT(excess.error, 0.003);
  EXPECT_TRUE(agrees(excess, 0.007, 3)) << "of a height that needles do not leave free, 1 % less";
}

TEST(SlowPiston, CompressesNeedlesAlongTheirAdiabat_long) {
  const Measured excess = of_needles(0.1, false).excess(24).measured();
  std::cout << "at 0.1: " << excess << '\n';
  EXPECT_LT(excess.error, 0.001);
  EXPECT_LT(std::abs(excess.value), 0.01);
  const Measured slow = of_needles(0.03, false).excess(24).measured();
  std::cout << "at 0.03: " << slow << '\n';
  EXPECT_LT(slow.error, 0.0008);
  EXPECT_TRUE(agrees(slow, 0.0021, 3));
  const Measured back = of_needles(0.03, true).excess(24).measured();
  std::cout << "expanding: " << back << '\n';
  EXPECT_LT(back.error, 0.0008);
  EXPECT_TRUE(agrees(back, 0.0021, 3));
}

// Of spheres there is their pressure beside: E (H - D)^(2 N / (3 N - 2)) exp(-(8 / 3) phi) is the
// same, with the packing phi of the room of their centres, whose height is h = H - D. As exactly as
// is measured here, phi is less by the pairs that walls take away, 3 D / (8 h) of all, and
// 10 phi^2 / 3 comes beside. Viscosity eta heats: (8 / 9) eta v ln(h / h') A / N, to first order.
TEST(SlowPiston, CompressesSpheresAlongTheirAdiabat) {
  constexpr double count = 200, area = 520, from = 20, to = 11, velocity = 0.004;
  const auto pressed = [](double height) {
    const double packing = count * std::numbers::pi / 6 / (area * height);
    return 8.0 / 3 * packing * (1 - 0.375 / height) + 10.0 / 3 * packing * packing;
  };
  Compression spheres{.scene = scene_of(0, std::sqrt(area)),
                      .from = from,
                      .to = to,
                      .velocity = velocity,
                      .taken = 1,
                      .exponent = 2 * count / (3 * count - 2),
                      .factor = std::exp(pressed(to - 1) - pressed(from - 1))};
  spheres.scene.species = {{.name = "spheres", .count = 200, .length = 0, .diameter = 1}};
  const double heated = 8.0 / 9 * 0.179 * velocity * std::log((from - 1) / (to - 1)) * area / count;
  const Measured excess = spheres.excess(8).measured();
  EXPECT_LT(excess.error, 0.002);
  EXPECT_TRUE(agrees(excess, heated, 3)) << "without their pressure 2.6 % more";
}

}  // namespace
}  // namespace needlework::test
