// Rates of bodies that have numbers of their own, against sums over all pairs and known values.
#include "needlework/body_rates.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "needlework/distribution.h"
#include "src/composition/sizes.h"
#include "tests/support/pair_rates.h"

namespace needlework::theory {
namespace {

using test::rate_of_pair;

struct Member {
  std::size_t species;
  Body body;
};

std::vector<double> summed(const Composition& composition, const std::vector<Member>& members) {
  std::vector<double> out(composition.pairs());
  for (std::size_t i = 0; i < members.size(); ++i) {
    for (std::size_t j = i + 1; j < members.size(); ++j) {
      const Member &a = members[i], &b = members[j];
      if (!composition.meets(a.species, b.species)) continue;
      out[composition.pair_index(a.species, b.species)] += rate_of_pair(a.body, b.body);
    }
  }
  return out;
}

std::vector<double> found(const Composition& composition, const std::vector<Member>& members,
                          double volume = 1) {
  BodyRates rates(composition);
  for (const Member& each : members) rates.add(each.species, each.body);
  return rates.collisions(volume);
}

// The number of a distribution with this share of smaller ones.
double quantile(const Distribution& distribution, double share) {
  return Quantiles(distribution)(static_cast<std::uint64_t>(share * 0x1p53));
}
double lognormal(double width, std::size_t n, std::size_t of) {
  return quantile({.shape = Distribution::Shape::lognormal, .mean = 1, .width = width},
                  (static_cast<double>(n) + 0.5) / static_cast<double>(of));
}

Body needle(double length, double mass, double k, Temperatures now = {1, 1}) {
  return {length, 0, mass, mass * length * length / (2 * k), now};
}

TEST(BodyRates, AreThoseOfTheSumOverAllPairsOfNeedles) {
  const Composition composition({{.name = "a", .count = 30}, {.name = "b", .count = 12}}, {});
  std::vector<Member> members;
  for (std::size_t n = 0; n < 30; ++n) {
    // Masses, lengths and k that do not follow from each other, and a factor of 1000 among masses.
    const double mass = std::pow(10, 3 * std::fmod(0.618 * static_cast<double>(n), 1) - 1.5);
    const double k = 2 + static_cast<double>(n % 5);
    members.push_back({0, needle(lognormal(0.6, n, 30), mass, k, {1, 0.4})});
  }
  for (std::size_t n = 0; n < 12; ++n)
    members.push_back({1, needle(lognormal(0.3, n, 12), 2, 6, {0.3, 2})});
  const auto expected = summed(composition, members), rates = found(composition, members, 4);
  for (std::size_t pair = 0; pair < 3; ++pair)
    EXPECT_NEAR(4 * rates[pair], expected[pair], 1e-9 * expected[pair]) << pair;
}

TEST(BodyRates, AreThoseOfTheSumOverAllPairsOfRodsAndSpheres) {
  const Composition composition({{.name = "rods", .count = 20, .diameter = 0.2},
                                 {.name = "spheres", .count = 10, .length = 0, .diameter = 1}},
                                {});
  std::vector<Member> members;
  for (std::size_t n = 0; n < 20; ++n) {
    const double size = lognormal(0.4, n, 20);
    members.push_back(
        {0, {size, 0.3 * lognormal(0.2, 19 - n, 20), 1.5 * size, size * size / 9, {1, 1.3}}});
  }
  for (std::size_t n = 0; n < 10; ++n) {
    const double size = lognormal(0.3, n, 10);
    members.push_back({1, {0, size, size * size * size, 0, {0.7, 0}}});
  }
  const auto expected = summed(composition, members), rates = found(composition, members);
  for (std::size_t pair = 0; pair < 3; ++pair)
    EXPECT_NEAR(rates[pair], expected[pair], 1e-9 * expected[pair]) << pair;
}

// Of fixed ones, with rotation alone, and where nothing moves.
TEST(BodyRates, AreThoseOfTheSumWhereSomeAreAtRest) {
  Composition composition({{.name = "a", .count = 6}, {.name = "b", .count = 5}}, {});
  composition.set_meets(1, 1, false);
  for (const Temperatures at : {Temperatures{1, 1}, {1, 0}, {0, 1}, {0, 0}}) {
    std::vector<Member> members;
    for (std::size_t n = 0; n < 6; ++n)
      members.push_back({0, needle(lognormal(0.5, n, 6), 1, 6, at)});
    for (std::size_t n = 0; n < 5; ++n)
      members.push_back({1, needle(lognormal(0.5, n, 5), 1, 6, {0, 0})});
    const auto expected = summed(composition, members), rates = found(composition, members);
    for (std::size_t pair = 0; pair < 3; ++pair)
      EXPECT_NEAR(rates[pair], expected[pair], 1e-6 * expected[pair]) << at.t_tr << at.t_rot;
  }
}

// A body does not meet itself.
TEST(BodyRates, AreThoseOfAlikeBodiesByTheRatesOfSpecies) {
  for (const std::uint64_t count : {std::uint64_t{1}, std::uint64_t{2}, std::uint64_t{50}}) {
    for (const Species& each :
         {Species{.count = count, .length = 2, .mass = 3, .k = 4},
          Species{.count = count, .length = 2, .mass = 3, .k = 4, .diameter = 0.5},
          Species{.count = count, .length = 0, .mass = 3, .diameter = 0.5}}) {
      const Composition composition({each}, {});
      const Temperatures at{0.7, each.turns() ? 1.2 : 0};
      const Body body{each.length, each.diameter, each.mass, each.inertia(), at};
      const std::vector<Member> members(count, Member{0, body});
      const double expected = mixture_rates(composition, 30, std::span(&at, 1)).collisions[0];
      EXPECT_NEAR(found(composition, members, 30)[0], expected, 1e-9 * expected) << count;
    }
  }
}

// nu / (n mu^2 sqrt(T / m)) of lengths with a lognormal distribution and masses as long, in the
// limit of many needles, by an integral that is one-dimensional in their ratio.
TEST(BodyRates, AreThoseOfLognormalLengths) {
  struct Known {
    double width, k, rate;
  };
  for (const auto& [width, k, rate] : {Known{0.1, 6, 1.236823825},
                                       {0.3, 6, 1.230324774},
                                       {0.6, 6, 1.210812006},
                                       {0.3, 2, 1.014473612},
                                       {0.6, 2, 0.999106115}}) {
    constexpr std::size_t count = 20000;
    const Composition composition({{.count = count}}, {});
    BodyRates rates(composition);
    for (std::size_t n = 0; n < count; ++n) {
      const double length = lognormal(width, n, count);
      rates.add(0, needle(length, length, k));
    }
    // Each needle meets N - 1.
    const double of_one = 2 * rates.collisions(count)[0] / count;
    EXPECT_NEAR(of_one, rate, 2e-4 * rate) << width << ' ' << k;
  }
}

// Those that are close to each other count as alike.
TEST(BodyRates, AreThoseOfTheSumOverAllPairsOfMany) {
  constexpr std::size_t count = 300;
  const Composition composition({{.count = count}}, {});
  for (const double width : {0.002, 0.3}) {
    std::vector<Member> members;
    for (std::size_t n = 0; n < count; ++n) {
      const double length = lognormal(width, n, count);
      members.push_back({0, needle(length, length, 6)});
    }
    const double expected = summed(composition, members)[0];
    EXPECT_NEAR(found(composition, members)[0], expected, 1e-7 * expected) << width;
  }
}

// Spheres of lognormal diameters, k of n quantiles, at a packing fraction.
Composition spheres(double width, std::size_t count) {
  Species species{.count = count, .length = 0, .mass = 1};
  SizesOfBodies sizes;
  for (std::size_t n = 0; n < count; ++n) {
    const double diameter = width > 0 ? lognormal(width, n, count) : 1;
    sizes.add({0, diameter, diameter * diameter * diameter, 0});
  }
  return Composition({sizes.complete(species)}, {});
}
double volume_for(const Composition& composition, double packing) {
  return composition.packing_fraction(1) / packing;
}

// p V / (N T) of lognormal diameters in the limit of many.
TEST(SphereCompressibility, IsThatOfTheMomentsOfDiameters) {
  struct Known {
    double width, packing, z;
  };
  for (const auto& [width, packing, z] : {Known{0, 0.1, 1.521262},
                                          {0, 0.45, 9.384673},
                                          {0.1, 0.3, 3.916734},
                                          {0.3, 0.1, 1.453562},
                                          {0.3, 0.3, 3.521571},
                                          {0.3, 0.45, 7.971051}}) {
    const Composition gas = spheres(width, 20000);
    EXPECT_NEAR(sphere_compressibility(gas, volume_for(gas, packing)), z, 2e-4 * z)
        << width << ' ' << packing;
  }
}

// The virial theorem: Z = 1 + (2 pi / 3) n <D^3 g> over all pairs.
TEST(ContactValues, OfSpheresThatDifferGiveTheirPressure) {
  constexpr std::size_t count = 60;
  const Composition gas = spheres(0.4, count);
  const double volume = volume_for(gas, 0.35), density = count / volume;
  const double room = 1 - 0.35, xi = std::numbers::pi / 6 * density * gas[0].square();
  const auto contact = [&](double d) {
    return 1 / room + 3 * xi * d / (room * room) + 2 * xi * xi * d * d / (room * room * room);
  };
  double virial = 0, mean = 0, weights = 0;
  for (std::size_t n = 0; n < count; ++n) {
    for (std::size_t m = 0; m < count; ++m) {
      const double a = lognormal(0.4, n, count), b = lognormal(0.4, m, count), both = (a + b) / 2;
      const double g = contact(a * b / (a + b));
      virial += both * both * both * g / (count * count);
      mean += both * both * g;
      weights += both * both;
    }
  }
  const double z = 1 + 2 * std::numbers::pi / 3 * density * virial;
  EXPECT_NEAR(sphere_compressibility(gas, volume), z, 1e-10 * z);
  EXPECT_NEAR(contact_values(gas, volume)[0], mean / weights, 1e-10);
}

TEST(BodyRates, OfSpheresInAFluidAreThoseOfTheirContactValues) {
  constexpr std::size_t count = 40;
  const Composition gas = spheres(0.4, count);
  const double volume = volume_for(gas, 0.3);
  BodyRates rates(gas);
  std::vector<Body> bodies;
  for (std::size_t n = 0; n < count; ++n) {
    const double d = lognormal(0.4, n, count);
    bodies.push_back({0, d, d * d * d, 0, {2, 0}});
    rates.add(0, bodies.back());
  }
  const double room = 0.7, xi = std::numbers::pi / 6 * count / volume * gas[0].square();
  double expected = 0;
  for (std::size_t n = 0; n < count; ++n) {
    for (std::size_t m = n + 1; m < count; ++m) {
      const Body &a = bodies[n], &b = bodies[m];
      const double d = a.diameter * b.diameter / (a.diameter + b.diameter);
      const double g =
          1 / room + 3 * xi * d / (room * room) + 2 * xi * xi * d * d / (room * room * room);
      expected += g * rate_of_pair(a, b) / volume;
    }
  }
  EXPECT_NEAR(rates.collisions_of_spheres(volume)[0], expected, 1e-9 * expected);
}

// Of each two bodies, 2 D (pi / 4) L L' and so on.
TEST(SecondVirial, IsTheMeanOverBodiesThatDiffer) {
  SizesOfBodies sizes;
  std::vector<Species> bodies;
  for (std::size_t n = 0; n < 12; ++n) {
    const double length = lognormal(0.5, n, 12), diameter = 0.3 * lognormal(0.3, 11 - n, 12);
    sizes.add({length, diameter, 1, 0.1});
    bodies.push_back({.count = 1000000, .length = length, .diameter = diameter});
  }
  const Composition one({sizes.complete({.count = 12000000})}, {}), all(bodies, {});
  EXPECT_NEAR(second_virial(one), second_virial(all), 1e-12);
}

}  // namespace
}  // namespace needlework::theory
