// Runs of gases whose bodies have numbers of their own, or are fixed, against exact results.
//
// Laws, for elastic thin needles at every density: the rate of collisions of needle i is
//
//   nu_i = sqrt(pi / 8) L_i sum_j (1 / V) L_j <sigma_ij>, sigma^2 = T (1/m_i + 1/m_j + s^2 / I_i +
//   s'^2 / I_j),
//
// with T = 2 E / (5 N - 3) and the factor of a fixed energy; T_rot of each is T, T_tr is T (1 - m_i
// / M). Among fixed needles T = 2 E / (5 N) is shared by those that move, if they meet each other,
// and otherwise each keeps its energy. Elastic spheres have the pressure of Mansoori, Carnahan,
// Starling and Leland with the moments of the diameters drawn. Tolerance: 3 standard errors of
// batches, spheres 1 % as well.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <iostream>
#include <string>
#include <vector>

#include "needlework/body_rates.h"
#include "needlework/parse.h"
#include "src/observe/observation.h"
#include "src/runs/exact_rates.h"
#include "src/scene/own_bodies.h"
#include "tests/support/pair_rates.h"
#include "tests/support/runs.h"
#include "tests/support/statistics.h"

namespace needlework {
namespace {

using test::Mean;

// Of lengths with a width of 0.6 and masses as long.
Scene gas_of_sizes(std::uint64_t count, double side) {
  return parse_scene("needles = { box = " + std::to_string(side) +
                         ", seed = 7 }\nuntil.time = 1\noutput.size_classes = 4\n"
                         "[[species]]\nname = \"a\"\ncount = " +
                         std::to_string(count) +
                         "\nlength.distribution = \"lognormal\"\nlength.mean = 1\n"
                         "length.width = 0.6\nmass.density = 1\n",
                     "sizes.toml");
}

constexpr std::size_t classes = 4;
using ByClass = std::array<double, classes>;

// The exact rate and mass, means over each class.
struct Expected {
  ByClass rate{}, mass{};
};

Expected expected_of(const Members& members, const std::vector<std::size_t>& class_of,
                     double volume, double t, double speed) {
  Expected out;
  const std::size_t count = members.size();
  const auto body = [&](std::size_t i) {
    const BodyNumbers its = members.body(i);
    return theory::Body{its.length, its.diameter, its.mass, its.inertia, {t, t}};
  };
  for (std::size_t i = 0; i < count; ++i) {
    double rate = 0;
    for (std::size_t j = 0; j < count; ++j) {
      if (j != i) rate += speed * test::rate_of_pair(body(i), body(j)) / volume;
    }
    const double share = classes / static_cast<double>(count);
    out.rate[class_of[i]] += share * rate;
    out.mass[class_of[i]] += share * members.body(i).mass;
  }
  return out;
}

// By rank of length.
std::vector<std::size_t> classes_by_length(const Members& members) {
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < members.size(); ++i) {
    std::size_t rank = 0;
    for (std::size_t j = 0; j < members.size(); ++j)
      rank += members.body(j).length < members.body(i).length;
    out.push_back(rank * classes / members.size());
  }
  return out;
}

TEST(Sizes, CollideAndMoveByTheirLengths) {
  constexpr std::size_t count = 60;
  const Scene scene = gas_of_sizes(count, 5);
  Simulation simulation(scene);
  const State start = simulation.copy();
  observe::Observation observation(scene, nullptr, {start.id, {}, start.own_bodies});
  simulation.on_collision([&](const Collision& c) { observation.collision(c); });
  const Members members = drawn_members(scene);
  const auto [t, speed] = theory::equilibrium_of(count, simulation.totals().energy * count);
  const Expected exact = expected_of(members, classes_by_length(members), 125, t, speed);
  double mass = 0;
  for (const double each : exact.mass) mass += each * count / classes;

  std::array<Mean, classes> rate, t_tr, t_rot;
  std::array<double, classes> before{};
  constexpr int batches = 60, samples = 20;
  const double step = simulation.mean_free_time();
  for (int batch = 0; batch < batches; ++batch) {
    ByClass tr{}, rot{}, collisions{};
    for (int n = 1; n <= samples; ++n) {
      simulation.advance(test::until_time((batch * samples + n) * step));
      const auto row = observation.sample(simulation.copy(), simulation.totals(), {});
      for (std::size_t each = 0; each < classes; ++each) {
        tr[each] += row[each] / samples;
        rot[each] += row[classes + each] / samples;
        collisions[each] = row[2 * classes + each];
      }
    }
    for (std::size_t each = 0; each < classes; ++each) {
      const double needles = static_cast<double>(count) / classes;
      rate[each].add((collisions[each] - before[each]) / (needles * samples * step));
      t_tr[each].add(tr[each]);
      t_rot[each].add(rot[each]);
    }
    before = collisions;
  }
  for (std::size_t each = 0; each < classes; ++each) {
    const double less = 1 - exact.mass[each] / mass;
    std::cout << "class " << each << ": rate / exact " << rate[each].measured() / exact.rate[each]
              << ", T_tr " << t_tr[each].measured() / (t * less) << ", T_rot "
              << t_rot[each].measured() / t << '\n';
    EXPECT_TRUE(test::agrees(rate[each].measured(), exact.rate[each], 3)) << each;
    EXPECT_LT(rate[each].measured().error, 0.03 * exact.rate[each]);
    EXPECT_TRUE(test::agrees(t_tr[each].measured(), t * less, 3)) << each;
    EXPECT_TRUE(test::agrees(t_rot[each].measured(), t, 3)) << each;
    EXPECT_LT(t_rot[each].measured().error, 0.03 * t);
  }
  EXPECT_GT(exact.rate[3], 2 * exact.rate[0]);
}

// The measured rate over the exact one, of batches of so many mean free times.
test::Measured ratio_to_exact(const Scene& scene, int batches, double length) {
  Simulation simulation(scene);
  const double exact = runs::equilibrium_rate(scene, simulation.totals().energy) *
                       static_cast<double>(simulation.needles()) / 2;
  Mean out;
  const double time = length * simulation.mean_free_time();
  std::uint64_t before = 0;
  for (int batch = 1; batch <= batches; ++batch) {
    simulation.advance(test::until_time(batch * time));
    out.add(static_cast<double>(simulation.collisions() - before) / (time * exact));
    before = simulation.collisions();
  }
  return out.measured();
}

void expect_exact(const Scene& scene, int batches, double length, double precision) {
  const test::Measured ratio = ratio_to_exact(scene, batches, length);
  std::cout << "rate / exact: " << ratio << '\n';
  EXPECT_TRUE(test::agrees(ratio, 1, 3));
  EXPECT_LT(ratio.error, precision);
}

TEST(Sizes, CollideAtTheExactRate) { expect_exact(gas_of_sizes(300, 10), 50, 8, 0.01); }

Scene needles_among_fixed(bool meet, std::uint64_t moving, std::uint64_t fixed) {
  return parse_scene(
      "needles = { box = 6, seed = 3 }\nuntil.time = 1\n[[species]]\nname = \"moving\"\ncount = " +
          std::to_string(moving) +
          "\n[[species]]\nname = \"still\"\nfixed = true\nlength.distribution = \"uniform\"\n"
          "length.mean = 0.8\nlength.width = 0.3\ncount = " +
          std::to_string(fixed) +
          (meet ? "\n" : "\n[[pairs]]\nbetween = [\"moving\", \"moving\"]\nmeet = false\n"),
      "fixed.toml");
}

TEST(FixedNeedles, AreHitAtTheExactRateByThoseThatKeepTheirEnergies) {
  expect_exact(needles_among_fixed(false, 40, 300), 100, 12, 0.01);
}
TEST(FixedNeedles, AreHitAtTheExactRateByThoseThatShareTheirEnergy) {
  expect_exact(needles_among_fixed(true, 60, 200), 50, 12, 0.01);
}
// In 5 dimensions, 1.0509 times that of Gaussian velocities.
TEST(FixedNeedles, AreHitAtTheExactRateByOne) {
  expect_exact(needles_among_fixed(true, 1, 300), 100, 100, 0.015);
}

TEST(SpheresOfSizes, HaveThePressureOfTheirFluid) {
  const Scene scene = parse_scene(
      "needles = { box = 5, seed = 5 }\nuntil.time = 1\n[[species]]\nname = \"a\"\ncount = 300\n"
      "length = 0\ndiameter.distribution = \"lognormal\"\ndiameter.mean = 0.57\n"
      "diameter.width = 0.3\nmass.density = 1\n",
      "spheres.toml");
  Simulation simulation(scene);
  simulation.advance(test::until_collisions(20));
  Mean z;
  double time = simulation.time(), virial = simulation.virial();
  const double step = 20 * simulation.mean_free_time();
  for (int batch = 0; batch < 20; ++batch) {
    simulation.advance(test::until_time(time + step));
    // Of N - 1 bodies, as the momentum is 0: N T is 2 E / 3 times N / (N - 1).
    const double t = simulation.totals().t_tr * 300 / 299;
    z.add(1 + (simulation.virial() - virial) / (3 * 300 * t * step));
    time += step;
    virial = simulation.virial();
  }
  const Composition composition = scene.composition();
  const double expected = theory::sphere_compressibility(composition, 125);
  std::cout << "packing " << composition.packing_fraction(125) << ", Z / fluid "
            << z.measured() / expected << '\n';
  EXPECT_NEAR(z.measured().value, expected, 3 * z.measured().error + 0.01 * expected);
  EXPECT_LT(z.measured().error, 0.01 * expected);
}

}  // namespace
}  // namespace needlework
