// The steady state of uniformly sheared gases: temperatures, stresses and order, against
// simulations of the Boltzmann and Enskog equations, of encounters, and of other event-driven
// programs. Errors given are one standard deviation, of theirs and of ours.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "needlework/simulation.h"
#include "tests/support/by_build.h"
#include "tests/support/runs.h"

namespace needlework::steady_shear {
namespace {

struct Mean {
  double value, error;
};

// What a run has in its steady state, in units of m, L (or d) and the rate: means over batches.
struct Steady {
  Mean t_tr, ratio, p_xx, p_yy, p_zz, p_xy, c_xy, rate, angle;
};

Mean mean_of(const std::vector<double>& batches) {
  double sum = 0, squares = 0;
  for (const double x : batches) {
    sum += x;
    squares += x * x;
  }
  const auto n = static_cast<double>(batches.size());
  return {sum / n, std::sqrt(std::max(0.0, squares / n - sum / n * (sum / n)) / (n - 1))};
}

// Starts at this temperature, forgets the start, and runs so many collisions per body.
Steady steady(Scene scene, double t_tr, double t_rot, double to_forget, double collisions) {
  scene.shear = Scene::Shear{1, 0};
  if (scene.species.empty()) {
    scene.initial.t_tr = t_tr;
    scene.initial.t_rot = t_rot;
  } else {
    scene.species.front().t_tr = t_tr;
  }
  constexpr int batches = 20, samples = 25;
  Simulation gas(scene);
  gas.advance(test::until_collisions(to_forget));
  const double n = static_cast<double>(gas.needles()), volume = std::pow(scene.needles.box[0], 3);
  std::vector<double> all[9];
  for (int batch = 0; batch < batches; ++batch) {
    const StressSums before = *gas.stress_sums();
    const Totals start = gas.totals();
    double t = 0, ratio = 0, q_xx = 0, q_yy = 0, q_xy = 0;
    for (int sample = 1; sample <= samples; ++sample) {
      const double share = (batch + static_cast<double>(sample) / samples) / batches;
      gas.advance(test::until_collisions(to_forget + collisions * share));
      const Totals now = gas.totals();
      t += now.t_tr / samples;
      ratio += now.t_rot / samples;
      for (const auto& u : gas.copy().orientation) {
        q_xx += 1.5 * u[0] * u[0];
        q_yy += 1.5 * u[1] * u[1];
        q_xy += 1.5 * u[0] * u[1];
      }
    }
    const Totals end = gas.totals();
    const double time = end.time - start.time;
    const StressTotals stress =
        StressTotals::between(before, *gas.stress_sums(), time, volume, {true, true, true}, 1);
    // Of the mean temperature by the flights themselves.
    const auto &k = stress.kinetic, &c = stress.collisional;
    const double nt = (k[0][0] + k[1][1] + k[2][2]) / 3, t_mean = nt * volume / n;
    const double values[] = {t_mean,
                             ratio / t,
                             k[0][0] / nt,
                             k[1][1] / nt,
                             k[2][2] / nt,
                             k[0][1] / nt,
                             0.5 * (c[0][1] + c[1][0]) / nt,
                             2 * static_cast<double>(end.collisions - start.collisions) /
                                 (n * time * (n / volume) * std::sqrt(t_mean)),
                             0.5 * std::atan2(2 * q_xy, q_xx - q_yy) * 57.29577951308232};
    for (std::size_t i = 0; i < 9; ++i) all[i].push_back(values[i]);
  }
  return {mean_of(all[0]), mean_of(all[1]), mean_of(all[2]), mean_of(all[3]), mean_of(all[4]),
          mean_of(all[5]), mean_of(all[6]), mean_of(all[7]), mean_of(all[8])};
}

// Within four standard errors; those of batches shorter than the memory of the gas are too small.
void expect_near(const Mean& got, const Mean& expected, const char* what) {
  const double error = std::hypot(1.5 * got.error, expected.error);
  EXPECT_LE(std::abs(got.value - expected.value), 4 * error)
      << what << ": " << got.value << " +- " << got.error << ", expected " << expected.value
      << " +- " << expected.error;
  EXPECT_LE(got.error, 0.04 * std::abs(expected.value) + 4 * expected.error) << what;
}

Scene spheres(std::uint64_t count, double density, double epsilon) {
  Scene scene = test::scene_of(count, std::cbrt(static_cast<double>(count) / density), 7);
  scene.species = {{.name = "spheres",
                    .count = count,
                    .length = 0,
                    .mass = 1,
                    .k = 6,
                    .t_tr = 1,
                    .t_rot = 0,
                    .diameter = 1}};
  scene.collisions.epsilon = epsilon;
  return scene;
}

Scene needles(std::uint64_t count, double side, double epsilon, double tc) {
  Scene scene = test::scene_of(count, side, 7);
  scene.collisions.epsilon = epsilon;
  scene.collisions.tc = tc;
  return scene;
}

// Spheres at n d^3 = 0.1 in a box of the size of others: temperature, stresses and rate.
struct OfSpheres {
  double epsilon;
  Mean t_tr, p_xx, p_yy, p_zz, p_xy, c_xy, rate;
};

void expect_spheres(const OfSpheres& expected, std::uint64_t count, double collisions) {
  const Steady got = steady(spheres(count, 0.1, expected.epsilon), expected.t_tr.value, 0, 100,
                            collisions / test::by_build(1, 20));
  expect_near(got.t_tr, expected.t_tr, "T");
  expect_near(got.p_xx, expected.p_xx, "P_xx");
  expect_near(got.p_yy, expected.p_yy, "P_yy");
  expect_near(got.p_zz, expected.p_zz, "P_zz");
  expect_near(got.p_xy, expected.p_xy, "P_xy");
  expect_near(got.c_xy, expected.c_xy, "P_xy by collisions");
  expect_near(got.rate, expected.rate, "collisions");
}

TEST(SteadyShear, OfSpheres) {
  expect_spheres({0.9,
                  {21.4, 0.2},
                  {1.142, 0.003},
                  {0.919, 0.002},
                  {0.939, 0.004},
                  {-0.328, 0.002},
                  {-0.0408, 0.0005},
                  {8.04, 0.02}},
                 125, 2500);
  expect_spheres({0.7,
                  {6.33, 0.06},
                  {1.403, 0.003},
                  {0.778, 0.002},
                  {0.819, 0.003},
                  {-0.507, 0.001},
                  {-0.0590, 0.0004},
                  {7.98, 0.03}},
                 125, 2500);
}

// The Boltzmann equation by direct simulation: F = T n^2 d^4 / (m rate^2).
TEST(SteadyShear, OfDiluteSpheres_long) {
  struct {
    double epsilon;
    Mean f, p_xx, p_yy, p_zz, p_xy, rate;
  } const all[] = {{0.9,
                    {0.2350, 0.0002},
                    {1.1554, 0.0003},
                    {0.9132, 0.0003},
                    {0.9314, 0.0003},
                    {-0.3319, 0.0003},
                    {7.047, 0.002}},
                   {0.7,
                    {0.06970, 0.00005},
                    {1.4278, 0.0005},
                    {0.7636, 0.0004},
                    {0.8085, 0.0004},
                    {-0.5046, 0.0003},
                    {6.961, 0.003}}};
  constexpr double density = 1e-3;
  for (const auto& expected : all) {
    const double unit = 1 / (density * density);
    const Steady got = steady(spheres(1000, density, expected.epsilon), expected.f.value * unit, 0,
                              80, 1500 / test::by_build(1.0, 20.0));
    expect_near({got.t_tr.value / unit, got.t_tr.error / unit}, expected.f, "F");
    expect_near(got.p_xx, expected.p_xx, "P_xx");
    expect_near(got.p_yy, expected.p_yy, "P_yy");
    expect_near(got.p_zz, expected.p_zz, "P_zz");
    expect_near(got.p_xy, expected.p_xy, "P_xy");
    expect_near(got.rate, expected.rate, "collisions");
  }
}

struct OfNeedles {
  double epsilon, side, tc;
  Mean t_tr, ratio, p_xx, p_yy, p_zz, p_xy, angle;
};

void expect_needles(const OfNeedles& expected, double collisions) {
  // The contact time counts in units of the thermal speed.
  const double t = expected.t_tr.value;
  const Steady got =
      steady(needles(1000, expected.side, expected.epsilon, expected.tc / std::sqrt(t)), t,
             expected.ratio.value * t, 100, collisions / test::by_build(1, 20));
  expect_near(got.t_tr, expected.t_tr, "T_tr");
  expect_near(got.ratio, expected.ratio, "T_rot/T_tr");
  expect_near(got.p_xx, expected.p_xx, "P_xx");
  expect_near(got.p_yy, expected.p_yy, "P_yy");
  expect_near(got.p_zz, expected.p_zz, "P_zz");
  expect_near(got.p_xy, expected.p_xy, "P_xy");
  EXPECT_LE(std::abs(got.angle.value - expected.angle.value),
            4 * std::hypot(1.5 * got.angle.error, expected.angle.error))
      << "angle " << got.angle.value << " +- " << got.angle.error;
}

// n L^3 = 1, against another event-driven program.
constexpr OfNeedles at_one[] = {{0.9,
                                 10,
                                 8e-4,
                                 {13.63, 0.07},
                                 {0.887, 0.002},
                                 {1.240, 0.002},
                                 {0.871, 0.001},
                                 {0.889, 0.002},
                                 {-0.3984, 0.0009},
                                 {-32.7, 0.6}},
                                {0.7,
                                 10,
                                 8e-4,
                                 {4.84, 0.05},
                                 {0.708, 0.003},
                                 {1.597, 0.003},
                                 {0.682, 0.002},
                                 {0.722, 0.003},
                                 {-0.556, 0.002},
                                 {-24.3, 0.8}}};

TEST(SteadyShear, OfNeedles) { expect_needles(at_one[0], 120); }
TEST(SteadyShear, OfNeedlesAtOne_long) {
  for (const OfNeedles& each : at_one) expect_needles(each, 1000);
}
// n L^3 = 0.1: encounters, as at low density, 13.52(5) and 4.714(10) by F.
TEST(SteadyShear, OfDiluteNeedles_long) {
  expect_needles({0.9,
                  21.544,
                  8e-3,
                  {1352, 5},
                  {0.8873, 0.0007},
                  {1.2407, 0.0006},
                  {0.8713, 0.0006},
                  {0.8880, 0.0008},
                  {-0.3995, 0.0007},
                  {-32.8, 0.4}},
                 800);
  expect_needles({0.7,
                  21.544,
                  8e-3,
                  {471.4, 1.0},
                  {0.7161, 0.0010},
                  {1.595, 0.001},
                  {0.6841, 0.0007},
                  {0.7205, 0.0008},
                  {-0.5598, 0.0007},
                  {-24.8, 0.4}},
                 600);
}

}  // namespace
}  // namespace needlework::steady_shear
