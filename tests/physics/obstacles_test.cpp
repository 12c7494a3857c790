// Bodies among fixed spheres against exact results. Those that move pass through each other, so
// that each keeps its energy for ever.
//
// Fixed spheres that may overlap are placed independently: a body that is at a random place in the
// volume that they leave free, averaged over places of the spheres, has been told nothing of any of
// them but that it is not there. So its rate of collisions is that of low density at every density,
// a point's free paths are exponential from anywhere, also from a collision on, and only successive
// paths are correlated. N spheres in a volume V in place of a Poisson process are denser by a
// factor of 1 - V_ex/V, V_ex the volume that one of them excludes. R is the sum of the radii.
//
// Tolerance: 3.5 standard errors of draws, each with its own spheres.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <numbers>
#include <vector>

#include "needlework/initial_state.h"
#include "needlework/simulation.h"
#include "tests/support/random.h"
#include "tests/support/runs.h"
#include "tests/support/statistics.h"

namespace needlework {
namespace {

using std::numbers::pi;
using test::agrees;
using test::Mean;

constexpr std::size_t moving = 0, still = 1;  // species

Scene among_spheres(const Species& body, std::uint64_t spheres, double diameter, double edge,
                    std::uint64_t seed) {
  Scene scene = test::scene_of(0, edge, seed);
  scene.species = {body,
                   {.name = "still",
                    .count = spheres,
                    .length = 0,
                    .diameter = diameter,
                    .fixed = true,
                    .overlap = true}};
  scene.species[moving].name = "moving";
  scene.pairs = {{.between = {"moving", "moving"}, .epsilon = {}, .beta = {}, .meet = false}};
  scene.initial.packing = "insertion";
  return scene;
}

double square(const std::array<double, 3>& a) { return a[0] * a[0] + a[1] * a[1] + a[2] * a[2]; }

// Of needle i, with I = 1 / 12.
double energy_of(const State& state, std::size_t i) {
  return (square(state.velocity[i]) + square(state.angular_velocity[i]) / 12) / 2;
}

// Needles of L = m = 1, k = 6 at T = 1 meet n fixed spheres per volume at the rate
//
//   nu / n = (2 pi R L <sqrt(1 + 2 k x^2)> + 4 pi R^2 <sqrt(1 + (k / 2) (1 - c^2))>) / sqrt(2 pi),
//
// x uniform on +-1/2 and c on +-1, and 1.0509358 times that of T = 2 E / 5 where their energy is E.
struct NeedleCase {
  const char* name;
  double radius, rate;
};

constexpr NeedleCase needle_cases[] = {{"R005", 0.05, 0.194400673},
                                       {"R01", 0.1, 0.431644626},
                                       {"R02", 0.2, 1.034662371},
                                       {"R05", 0.5, 3.871954323}};

test::Measured needle_rate_over_exact(const NeedleCase& which, double density_excluded, int draws,
                                      double hits) {
  constexpr std::uint64_t needles = 1500, spheres = 2000;
  const double r = which.radius, excluded = pi * r * r * (1 + 4.0 / 3 * r);
  const double volume = spheres * excluded / density_excluded, edge = std::cbrt(volume);
  const double n = spheres / volume / (1 - excluded / volume);
  Mean ratio;
  for (int draw = 0; draw < draws; ++draw) {
    const Scene scene =
        among_spheres({.count = needles}, spheres, 2 * r, edge, 40 + std::uint64_t(draw));
    const State start = draw_initial_state(scene);
    double exact = 0;
    for (std::size_t i = 0; i < needles; ++i)
      exact += 1.0509358 * n * which.rate * std::sqrt(0.4 * energy_of(start, i));
    Simulation gas(scene, start);
    const double time = hits * needles / exact;
    gas.advance(test::until_time(time));
    ratio.add(static_cast<double>(gas.collisions()) / (exact * time));
  }
  std::cout << which.name << ", n V_ex = " << density_excluded << ": rate / exact "
            << ratio.measured() << '\n';
  return ratio.measured();
}

class NeedlesAmongSpheresOfRadius : public testing::TestWithParam<NeedleCase> {
 protected:
  static void expect_exact(int draws, double hits, double largest_error) {
    for (const double density_excluded : {0.05, 1.2}) {
      const auto ratio = needle_rate_over_exact(GetParam(), density_excluded, draws, hits);
      EXPECT_TRUE(agrees(ratio, 1, 3.5)) << "n V_ex = " << density_excluded;
      EXPECT_LT(ratio.error, largest_error) << "n V_ex = " << density_excluded;
    }
  }
};

TEST_P(NeedlesAmongSpheresOfRadius, CollideAtTheExactRate) { expect_exact(6, 3.5, 0.015); }

TEST_P(NeedlesAmongSpheresOfRadius, CollideAtTheExactRateToSomeThousandths_long) {
  expect_exact(60, 8, 0.004);
}

INSTANTIATE_TEST_SUITE_P(Fixed, NeedlesAmongSpheresOfRadius, testing::ValuesIn(needle_cases),
                         [](const auto& test) { return std::string(test.param.name); });

// Each exchanges energy between translation and rotation only.
TEST(NeedlesAmongFixedSpheres, KeepTheirEnergies) {
  constexpr std::size_t needles = 100;
  const Scene scene = among_spheres({.count = needles}, 1000, 0.2, 5, 3);
  const State start = draw_initial_state(scene);
  Simulation gas(scene, start);
  gas.advance(test::until_time(10));
  EXPECT_GT(gas.collisions(), 20 * needles);
  const State now = gas.copy();
  Mean of_flight, changed;
  for (std::size_t i = 0; i < needles; ++i) {
    const double energy = energy_of(start, i);
    EXPECT_NEAR(energy_of(now, i), energy, 1e-12 * energy) << i;
    of_flight.add(square(now.velocity[i]) / 2 / energy);
    changed.add(std::abs(square(now.velocity[i]) - square(start.velocity[i])) / 2 / energy);
  }
  EXPECT_TRUE(agrees(of_flight.measured(), 0.6, 3.5));
  EXPECT_GT(changed.measured().value, 0.1);
  for (std::size_t i = needles; i < now.size(); ++i) {
    ASSERT_EQ(now.position[i], start.position[i]);
    ASSERT_EQ(square(now.velocity[i]) + square(now.angular_velocity[i]), 0);
  }
}

// Points are spheres that move: R is the sum of the radii, here 1, of which they have 0.2.
constexpr double point_diameter = 0.4, obstacle_diameter = 1.6, volume_of_one = 4 * pi / 3;

struct Points {
  Scene scene;
  State start;
  double path = 0;  // the exact mean, in infinite space

  Points(std::uint64_t count, std::uint64_t spheres, double density, std::uint64_t seed) {
    const double volume = static_cast<double>(spheres) / density;
    scene = among_spheres({.count = count, .length = 0, .diameter = point_diameter}, spheres,
                          obstacle_diameter, std::cbrt(volume), seed);
    start = draw_initial_state(scene);
    for (std::size_t i = 0; i < count; ++i) {
      const double speed = std::sqrt(square(start.velocity[i]));
      for (double& component : start.velocity[i]) component /= speed;
    }
    path = (1 - volume_of_one / volume) / (pi * density);
  }
};

// Law: n pi R^2 v; paths exp(-n pi R^2 l), of which the means of l and l^2 and the share beyond the
// mean are compared: the first of each, and those from collisions on that are in one window of
// time. So many from each body would be too long: in a spacious place a body has fewer of them per
// time. The run goes on until all have ended, as those cut by its end would be missing.
void expect_exponential_paths(int draws, std::uint64_t count, double largest_error) {
  constexpr double window = 6, longest = 14;  // in mean free times
  for (const double density : {0.02, 0.3}) {
    Mean rate, first, mean, square, beyond;
    for (int draw = 0; draw < draws; ++draw) {
      const Points points(count, 10000, density, 60 + std::uint64_t(draw));
      std::vector<std::vector<double>> times(count);
      Simulation gas(points.scene, points.start);
      gas.on_collision([&](const Collision& c) { times[c.first].push_back(c.time / points.path); });
      gas.advance(test::until_time((window + longest) * points.path));
      const auto all = static_cast<double>(count);
      rate.add(static_cast<double>(gas.collisions()) / (all * (window + longest)));
      double of_first = 0, paths = 0, sum = 0, squares = 0, longer = 0;
      for (const std::vector<double>& hits : times) {
        ASSERT_FALSE(hits.empty());
        of_first += hits[0] / all;
        for (std::size_t n = 0; hits[n] < window; ++n) {
          ASSERT_LT(n + 1, hits.size());
          const double length = hits[n + 1] - hits[n];
          ++paths;
          sum += length;
          squares += length * length / 2;
          if (length > 1) longer += std::numbers::e;
        }
      }
      first.add(of_first), mean.add(sum / paths), square.add(squares / paths);
      beyond.add(longer / paths);
    }
    std::cout << "n R^3 = " << density << ": rate / exact " << rate.measured() << ", first path "
              << first.measured() << ", others " << mean.measured() << ", their squares "
              << square.measured() << ", beyond the mean " << beyond.measured() << '\n';
    for (const auto& [each, errors] :
         {std::pair(&rate, 1), {&mean, 1}, {&beyond, 1}, {&square, 3}, {&first, 4}}) {
      EXPECT_TRUE(agrees(each->measured(), 1, 3.5)) << "n R^3 = " << density;
      EXPECT_LT(each->measured().error, errors * largest_error) << "n R^3 = " << density;
    }
  }
}

TEST(PointsAmongFixedSpheres, HaveExponentialFreePathsAtEveryDensity) {
  expect_exponential_paths(4, 1500, 0.02);
}
TEST(PointsAmongFixedSpheres, HaveExponentialFreePathsToThousandths_long) {
  expect_exponential_paths(12, 6000, 0.005);
}

// Diffusion, over v l / 3 with l = 1 / (n pi R^2), from the mean square displacement between 8 and
// 16 mean free times. Measured by another program, 250000 paths each: 0.9737(30), 0.9343(29) and
// 0.8667(27) at n R^3 = 0.02, 0.05 and 0.1.
test::Measured diffusion_over_dilute(double density, int draws, std::uint64_t count,
                                     std::uint64_t spheres) {
  Mean ratio;
  for (int draw = 0; draw < draws; ++draw) {
    const Points points(count, spheres, density, 80 + std::uint64_t(draw));
    const double path = 1 / (pi * density);
    Simulation gas(points.scene, points.start);
    std::array<double, 2> squares{};
    for (std::size_t n = 0; n < 2; ++n) {
      gas.advance(test::until_time((n == 0 ? 8 : 16) * path));
      const State now = gas.copy();
      for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
          const double way = now.position[i][axis] + now.image[i][axis] * now.box[axis] -
                             points.start.position[i][axis];
          squares[n] += way * way / static_cast<double>(count);
        }
      }
    }
    ratio.add((squares[1] - squares[0]) / (6 * 8 * path) / (path / 3));
  }
  std::cout << "n R^3 = " << density << ": D / D_0 " << ratio.measured() << '\n';
  return ratio.measured();
}

void expect_diffusion(double density, double expected, double its_error, int draws,
                      std::uint64_t count, double largest_error) {
  const auto ratio = diffusion_over_dilute(density, draws, count, 6000);
  EXPECT_TRUE(agrees({ratio.value, std::hypot(ratio.error, its_error)}, expected, 3.5));
  EXPECT_LT(ratio.error, largest_error);
}

TEST(PointsAmongFixedSpheres, DiffuseMoreSlowlyThanByIndependentCollisions) {
  expect_diffusion(0.1, 0.8667, 0.0027, 8, 3000, 0.015);
}
TEST(PointsAmongFixedSpheres, DiffuseMoreSlowlyAtEachDensityToHalfAPercent_long) {
  expect_diffusion(0.02, 0.9737, 0.0030, 16, 12000, 0.005);
  expect_diffusion(0.05, 0.9343, 0.0029, 16, 12000, 0.005);
  expect_diffusion(0.1, 0.8667, 0.0027, 16, 12000, 0.005);
}

// The volume that spheres of R = 1 around the fixed ones leave free, and their surface that is
// exposed, by random points.
struct Union {
  double free_volume = 0, surface = 0;

  Union(const State& state, std::size_t first, int points) {
    test::Random random(5);
    const std::array<double, 3>& edge = state.box;
    const auto is_free = [&](const std::array<double, 3>& at, std::size_t but) {
      for (std::size_t j = first; j < state.size(); ++j) {
        double square = 0;
        for (std::size_t axis = 0; axis < 3 && square < 1; ++axis) {
          const double way = std::abs(at[axis] - state.position[j][axis]);
          const double nearest = std::min(way, std::abs(edge[axis] - way));
          square += nearest * nearest;
        }
        if (j != but && square < 1) return false;
      }
      return true;
    };
    const double volume = edge[0] * edge[1] * edge[2];
    for (int n = 0; n < points; ++n) {
      std::array<double, 3> at{};
      for (std::size_t axis = 0; axis < 3; ++axis) at[axis] = edge[axis] * random.uniform();
      if (is_free(at, state.size())) free_volume += volume / points;
      const auto spheres = static_cast<int>(state.size() - first);
      const std::size_t on = first + static_cast<std::size_t>(random.below(spheres));
      const auto& centre = state.position[on];
      const auto normal = random.direction();
      for (std::size_t axis = 0; axis < 3; ++axis) at[axis] = centre[axis] + normal[axis];
      if (is_free(at, on)) surface += spheres * 4 * pi / points;
    }
  }
};

// In one box, whatever is in it, points have the rate S v / (4 V_free).
double rate_in_box(const Scene& scene, const State& start, std::uint64_t count, double time) {
  Simulation gas(scene, start);
  gas.advance(test::until_time(time));
  return static_cast<double>(gas.collisions()) / (static_cast<double>(count) * time);
}

TEST(PointsAmongFixedSpheres, CollideInEachBoxByItsSurfaceAndFreeVolume) {
  constexpr std::uint64_t count = 1000;
  Mean over_surface, over_poisson;
  for (std::uint64_t draw = 0; draw < 6; ++draw) {
    const Points points(count, 60, 0.3, 20 + draw);
    const Union around(points.start, count, 30000);
    const double rate = rate_in_box(points.scene, points.start, count, 40 * points.path);
    over_surface.add(rate * 4 * around.free_volume / around.surface);
    over_poisson.add(rate * points.path);
  }
  std::cout << "rate over S v / (4 V_free) " << over_surface.measured() << ", over n pi R^2 v "
            << over_poisson.measured() << '\n';
  EXPECT_TRUE(agrees(over_surface.measured(), 1, 3.5));
  EXPECT_LT(over_surface.measured().error, 0.01);
  // Boxes differ by more, so that this is a test of each.
  EXPECT_GT(over_poisson.measured().error, 3 * over_surface.measured().error);
}

// Where no two of the spheres of R overlap, S = 4 pi R^2 N and V_free = V - (4 pi / 3) R^3 N.
TEST(PointsAmongFixedSpheres, CollideMoreOftenWhereSpheresAreApart) {
  constexpr std::uint64_t count = 1500;
  constexpr double spheres = 150, share = 0.2;
  const double volume = spheres * volume_of_one / share;
  const double exact = spheres * 4 * pi / (4 * volume * (1 - share));
  Mean ratio;
  for (std::uint64_t draw = 0; draw < 6; ++draw) {
    Points points(count, std::uint64_t(spheres), share / volume_of_one, 30 + draw);
    // Points among spheres of radius 1, which do not overlap.
    Scene apart = points.scene;
    apart.species[moving].diameter = 1e-6;
    apart.species[still].diameter = 2;
    apart.species[still].overlap = false;
    points.start.position = draw_initial_state(apart).position;
    ratio.add(rate_in_box(points.scene, points.start, count, 40 / exact) / exact);
  }
  std::cout << "rate / exact " << ratio.measured() << '\n';
  EXPECT_TRUE(agrees(ratio.measured(), 1, 3.5));
  EXPECT_LT(ratio.measured().error, 0.004);
}

}  // namespace
}  // namespace needlework
