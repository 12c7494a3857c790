// Thin needles among spheres: first contacts against an oracle, and exact rates.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "needlework/predict.h"
#include "needlework/theory.h"
#include "src/physics/director.h"
#include "tests/support/random.h"
#include "tests/support/rod_oracle.h"
#include "tests/support/runs.h"
#include "tests/support/statistics.h"

namespace needlework {
namespace {

using test::agrees;
using test::Mean;

FreeNeedle free_body(const kernels::Flight& flight, double length, double diameter) {
  const auto array = [](const Vec3d& a) { return std::array{a.x, a.y, a.z}; };
  return {.position = array(flight.r),
          .orientation = array(flight.u),
          .velocity = array(flight.v),
          .angular_velocity = array(flight.w),
          .length = length,
          .diameter = diameter};
}

// A thin needle of length 1 and a sphere with R from 1e-3 to 2 that are apart, with velocities of a
// gas; at some later time they are about as near as at a contact.
test::RodCase needle_and_sphere(test::Random& random) {
  const auto vector = [&](double sigma) {
    const auto a = random.normal_vector(sigma);
    return Vec3d{a[0], a[1], a[2]};
  };
  test::RodCase out;
  out.pair.half_first = 0.5;
  out.pair.half_second = 0;
  out.pair.distance = random.log_uniform(1e-3, 2);
  const double reach = 0.5 + out.pair.distance;
  for (kernels::Flight* each : {&out.first, &out.second}) {
    each->v = vector(1);
    each->u = normalised(vector(1));
  }
  out.first.w = project_out(vector(std::sqrt(12)), out.first.u);
  kernels::set_rotation(out.first);
  out.horizon = 3 * reach;
  do {
    const double near = random.uniform(0, out.horizon), arm = random.uniform(-0.5, 0.5);
    const Vec3d from_axis = normalised(vector(1)) * (out.pair.distance * random.uniform(0, 1.3));
    out.first.r = vector(reach);
    out.second.r = kernels::centre_after(out.first, near) +
                   kernels::director_after(out.first, near) * arm + from_axis - out.second.v * near;
  } while (test::rod_distance(out, 0) < out.pair.distance * 1.001);
  return out;
}

void expect_none_missed(int pairs) {
  test::Random random(20);
  int contacts = 0, undecided = 0;
  for (int n = 0; n < pairs; ++n) {
    const test::RodCase both = needle_and_sphere(random);
    auto truth = test::quick_rod_contact(both);
    if (!truth) truth = test::first_rod_contact(both);
    if (truth->undecided) {
      ++undecided;
      continue;
    }
    const double diameter = 2 * both.pair.distance;
    const FirstContact found = predict(free_body(both.first, 1, 0),
                                       free_body(both.second, 0, diameter), both.horizon, false);
    ASSERT_EQ(std::isfinite(found.time), truth->contact) << n;
    if (!truth->contact) continue;
    ++contacts;
    ASSERT_NEAR(found.time / static_cast<double>(truth->time), 1, 2e-6) << n;
    ASSERT_LE(std::abs(found.arm_first), 0.5);
    ASSERT_EQ(found.arm_second, 0);
  }
  EXPECT_LE(undecided, pairs / 1000);
  EXPECT_GT(contacts, pairs / 2);
}

TEST(NeedleAndSphere, MeetAsTheOracleSays) { expect_none_missed(20000); }

TEST(NeedleAndSphere, MeetAsTheOracleSaysInManyPairs_long) { expect_none_missed(200000); }

/// Of a needle with L = 1, m = 1 and k = 6 among n spheres per volume of mass M, all at T = 1:
/// n / sqrt(2 pi) [2 pi R L <sqrt(1 + 1/M + 2 k x^2)> + 4 pi R^2 <sqrt(1 + 1/M + k (1 - c^2) /
/// 2)>], x uniform on the needle and c in [-1, 1].
double exact_rate(double radius, double mass, double density) {
  constexpr double k = 6, pi = std::numbers::pi;
  constexpr int steps = 20000;
  double side = 0, ends = 0;
  for (int n = 0; n < steps; ++n) {
    const double c = (n + 0.5) / steps, x = 0.5 * c;
    side += std::sqrt(1 + 1 / mass + 2 * k * x * x) / steps;
    ends += std::sqrt(1 + 1 / mass + 0.5 * k * (1 - c * c)) / steps;
  }
  return density / std::sqrt(2 * pi) * (2 * pi * radius * side + 4 * pi * radius * radius * ends);
}

/// Needles and spheres, each of which pass through their own kind, so that what a third body does
/// to the rate is of second order in the share of the volume that is excluded.
Scene ideal_needles_and_spheres(double radius, double mass, double share, std::uint64_t seed) {
  constexpr std::uint64_t needles = 100, spheres = 60;
  const double excluded =
      std::numbers::pi * radius * radius * (1 + 4.0 / 3 * radius);  // by one for the other
  const double edge = std::max(2.02 * std::max(1.0, 2 * radius),
                               std::cbrt(static_cast<double>(needles) * excluded / share));
  Scene scene = test::scene_of(0, edge, seed);
  scene.species = {
      {.name = "needles", .count = needles},
      {.name = "spheres", .count = spheres, .length = 0, .mass = mass, .diameter = 2 * radius}};
  for (const char* name : {"needles", "spheres"})
    scene.pairs.push_back({.between = {name, name}, .epsilon = {}, .beta = {}, .meet = false});
  return scene;
}

// Law: the rate above at T = 2 E / (5 N + 3 N_s - 3). Tolerance: 3.5 standard errors of runs.
void expect_exact_rates_of_spheres(int runs, double collisions, double largest_error) {
  for (const auto& [radius, mass] : {std::pair(0.3, 5.0), {0.02, 0.5}, {1.0, 20.0}}) {
    Mean rate;
    for (int run = 0; run < runs; ++run) {
      const Scene scene = ideal_needles_and_spheres(radius, mass, 0.03, 70 + std::uint64_t(run));
      const double edge = scene.needles.box[0], volume = edge * edge * edge;
      const double count = static_cast<double>(scene.species[0].count),
                   spheres = static_cast<double>(scene.species[1].count);
      Simulation gas(scene);
      const double degrees = 5 * count + 3 * spheres - 3;
      const double t = 2 * gas.totals().energy * (count + spheres) / degrees;
      gas.advance(test::until_collisions(collisions));
      const double exact = exact_rate(radius, mass, spheres / volume) * std::sqrt(t);
      const theory::Temperatures now[] = {{t, t}, {t, 0}};
      EXPECT_NEAR(
          theory::mixture_rates(scene.composition(), volume, now).collisions[1] / count / exact, 1,
          1e-6);
      EXPECT_NEAR(static_cast<double>(gas.collisions_by_pair()[1]), double(gas.collisions()), 0);
      rate.add(static_cast<double>(gas.collisions()) / (count * gas.time()) / exact);
    }
    EXPECT_TRUE(agrees(rate.measured(), 1, 3.5)) << "R = " << radius;
    EXPECT_LT(rate.measured().error, largest_error) << "R = " << radius;
  }
}

TEST(NeedlesAmongSpheres, CollideAtTheExactRate) { expect_exact_rates_of_spheres(8, 25, 0.02); }

TEST(NeedlesAmongSpheres, CollideAtTheExactRateToSomeThousandths_long) {
  expect_exact_rates_of_spheres(12, 120, 0.006);
}

// The same where all meet, by theory::mixture_rates, at low density.
void expect_exact_rates_of_all(int runs, double collisions, double largest_error) {
  Scene scene = test::scene_of(0, 12);
  scene.species = {{.name = "needles", .count = 150},
                   {.name = "spheres", .count = 60, .length = 0, .mass = 3, .diameter = 0.3}};
  const Composition composition = scene.composition();
  std::vector<Mean> rates(3);
  for (int run = 0; run < runs; ++run) {
    scene.needles.seed = 300 + std::uint64_t(run);
    Simulation gas(scene);
    const double t = 2 * gas.totals().energy * 210 / (5.0 * 150 + 3 * 60 - 3);
    gas.advance(test::until_collisions(collisions));
    const theory::Temperatures now[] = {{t, t}, {t, 0}};
    const auto expected = theory::mixture_rates(composition, 12 * 12 * 12, now).collisions;
    const auto found = gas.collisions_by_pair();
    for (std::size_t n = 0; n < 3; ++n)
      rates[n].add(static_cast<double>(found[n]) / (expected[n] * gas.time()));
  }
  for (std::size_t n = 0; n < 3; ++n) {
    EXPECT_TRUE(agrees(rates[n].measured(), 1, 3.5)) << "pair " << n;
    EXPECT_LT(rates[n].measured().error, largest_error * (n == 2 ? 8 : 1)) << "pair " << n;
  }
}

TEST(NeedlesAmongSpheres, AllCollideAtTheExactRates) { expect_exact_rates_of_all(8, 30, 0.02); }

TEST(NeedlesAmongSpheres, AllCollideAtTheExactRatesToSomeThousandths_long) {
  expect_exact_rates_of_all(14, 200, 0.008);
}

}  // namespace
}  // namespace needlework
