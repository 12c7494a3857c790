#include "src/observe/forecast.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "needlework/simulation.h"

namespace needlework {
namespace {

constexpr theory::Gas cooling{.k = 6, .epsilon = 0.8, .beta = -1};
constexpr theory::Gas elastic{.k = 6, .epsilon = 1, .beta = -1};

Scene::Until until_energy(double ratio) {
  Scene::Until until;
  until.energy_ratio = ratio;
  return until;
}

// E/E(0) = 1e-11 is reached at tau = 1.087e7 after 352.9 collisions per needle: the dilute gas of
// the profiles.
TEST(Forecast, KnowsTheEndOfTheDiluteCoolingGas) {
  const double density = 10000 / std::pow(24.0, 3);
  const auto result = forecast(cooling, {1, 0}, density, until_energy(1e-11));
  ASSERT_TRUE(result);
  EXPECT_EQ(result->stop, Stop::energy);
  EXPECT_NEAR(result->time * theory_time_scale(density) / 1.087e7, 1, 1e-3);
  EXPECT_NEAR(result->collisions_per_needle, 352.9, 0.1);
  EXPECT_NEAR(result->energy_ratio, 1e-11, 1e-15);
}

TEST(Forecast, EndsAtTheTimeAskedFor) {
  Scene::Until until;
  until.time = 20;
  const double density = 0.7;
  const auto result = forecast(elastic, {1, 1}, density, until);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->stop, Stop::time);
  EXPECT_DOUBLE_EQ(result->time, 20);
  EXPECT_NEAR(result->collisions_per_needle, 20 * theory::collision_rate(density, {1, 1}, 6), 1e-6);
  EXPECT_NEAR(result->energy_ratio, 1, 1e-12);
}

TEST(Forecast, AgreesWithTheCurveWhereverItEnds) {
  const double density = 3;
  for (const double collisions : {1e-6, 0.01, 1.0, 30.0, 500.0}) {
    Scene::Until until;
    until.collisions_per_needle = collisions;
    const auto result = forecast(cooling, {1, 0.3}, density, until);
    ASSERT_TRUE(result) << collisions;
    EXPECT_EQ(result->stop, Stop::collisions);
    const std::vector<double> taus{result->time * theory_time_scale(density)};
    EXPECT_NEAR(theory::collisions_per_needle(cooling, {1, 0.3}, taus)[0] / collisions, 1, 2e-3);
    const double energy = theory::cooling_curve(cooling, {1, 0.3}, taus)[0].energy();
    EXPECT_NEAR(result->energy_ratio / (energy / 1.8), 1, 2e-3) << collisions;
  }
}

TEST(Forecast, TakesTheFirstConditionMet) {
  Scene::Until until = until_energy(0.5);
  until.collisions_per_needle = 1000;
  until.time = 1e9;
  EXPECT_EQ(forecast(cooling, {1, 1}, 1, until)->stop, Stop::energy);
  until.time = 1e-3;
  EXPECT_EQ(forecast(cooling, {1, 1}, 1, until)->stop, Stop::time);
  until.collisions_per_needle = 1e-5;
  EXPECT_EQ(forecast(cooling, {1, 1}, 1, until)->stop, Stop::collisions);
}

TEST(Forecast, SaysNothingOfWhatNeverHappens) {
  EXPECT_FALSE(forecast(elastic, {1, 1}, 1, until_energy(0.5)));
  Scene::Until until;
  until.collisions_per_needle = 1;
  EXPECT_FALSE(forecast(cooling, {0, 0}, 1, until));
  until = {};
  until.wall_s = 10;
  EXPECT_FALSE(forecast(cooling, {1, 1}, 1, until));
}

// At tau = 1e20 there have been some thousand collisions per needle: Haff's law continues from
// there.
TEST(Forecast, GoesOnBeyondTheCurveByHaffsLaw) {
  Scene::Until until;
  until.collisions_per_needle = 5000;
  const auto far = forecast(cooling, {1, 1}, 1, until);
  ASSERT_TRUE(far);
  EXPECT_EQ(far->stop, Stop::collisions);
  EXPECT_DOUBLE_EQ(far->collisions_per_needle, 5000);
  const double tau = far->time * theory_time_scale(1);
  const double collisions =
      theory::collisions_per_needle(cooling, {1, 1}, std::vector<double>{tau})[0];
  EXPECT_NEAR(collisions / 5000, 1, 1e-6);

  const auto cold = forecast(cooling, {1, 1}, 1, until_energy(1e-100));
  ASSERT_TRUE(cold);
  EXPECT_EQ(cold->stop, Stop::energy);
  EXPECT_NEAR(cold->energy_ratio / 1e-100, 1, 1e-9);
  EXPECT_LT(cold->collisions_per_needle, 5000);

  until.collisions_per_needle = 1e6;
  EXPECT_TRUE(std::isinf(forecast(cooling, {1, 1}, 1, until)->time));
}

TEST(Forecast, KnowsWhatIsMetFromTheStart) {
  EXPECT_EQ(forecast(cooling, {1, 1}, 1, until_energy(1))->time, 0);
  Scene::Until until;
  until.time = 0;
  EXPECT_EQ(forecast(cooling, {1, 1}, 1, until)->collisions_per_needle, 0);
  until = {};
  until.collisions_per_needle = 0;
  EXPECT_EQ(forecast(cooling, {1, 1}, 1, until)->time, 0);
}

TEST(Forecast, OfAGasAtRestIsItsEndTime) {
  Scene::Until until;
  until.time = 7;
  const auto result = forecast(cooling, {0, 0}, 1, until);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->time, 7);
  EXPECT_EQ(result->collisions_per_needle, 0);
}

// Bodies of one species or two, and how many collisions of each they really have.
double counted_over_expected(const std::vector<Species>& species, double packing) {
  Scene scene;
  scene.species = species;
  double volume = 0;
  for (const Species& each : species) volume += static_cast<double>(each.count) * each.volume();
  const double edge = std::cbrt(volume / packing);
  scene.needles.box = {edge, edge, edge};
  Simulation gas(scene);
  Scene::Until until;
  until.collisions_per_needle = 10;  // from what insertion or a lattice leaves
  gas.advance(until);
  const double before = gas.time(), collisions = static_cast<double>(gas.collisions());
  until.collisions_per_needle = 30;
  gas.advance(until);
  const Composition composition = scene.composition();
  Scene::Until span;
  span.time = gas.time() - before;
  const std::vector<theory::Temperatures> start(species.size(), {1, 1});
  const auto expected = forecast(composition, edge * edge * edge, start, span);
  return 2 * (static_cast<double>(gas.collisions()) - collisions) /
         static_cast<double>(composition.count()) / expected->collisions_per_needle;
}

// The values of contact are those of fluids, good to a few percent; of so few bodies the rates
// scatter by one.
TEST(Forecast, CountsTheCollisionsOfDenseFluids) {
  const auto rods = [](std::uint64_t count, double length, double width, double mass = 1) {
    return Species{.name = "rods" + std::to_string(width),
                   .count = count,
                   .length = length,
                   .mass = mass,
                   .k = length > 0 ? homogeneous_k(length, width) : 6,
                   .diameter = width};
  };
  EXPECT_NEAR(counted_over_expected({rods(250, 0, 1)}, 0.1), 1, 0.05);
  EXPECT_NEAR(counted_over_expected({rods(250, 0, 1)}, 0.4), 1, 0.05);
  EXPECT_NEAR(counted_over_expected({rods(250, 1, 1)}, 0.3), 1, 0.08);
  EXPECT_NEAR(counted_over_expected({rods(150, 5, 1)}, 0.3), 1, 0.1);
  EXPECT_NEAR(counted_over_expected({rods(200, 0, 0.5), rods(50, 0, 1, 8)}, 0.35), 1, 0.07);
  EXPECT_NEAR(counted_over_expected({rods(100, 2, 0.8), rods(50, 0, 1.5, 2)}, 0.3), 1, 0.1);
}

// One species, told as two, is forecast to end where that one does.
TEST(Forecast, OfAMixtureIsThatOfItsSpecies_long) {
  const std::uint64_t many = std::uint64_t{1} << 40;
  const Composition composition({{.name = "a", .count = many}, {.name = "b", .count = 2 * many}},
                                {0.8, -1});
  const double density = 0.7, volume = 3 * static_cast<double>(many) / density;
  const std::vector<theory::Temperatures> initial(2, {1, 0.5});
  Scene::Until time, collisions, both;
  time.time = 40;
  collisions.collisions_per_needle = 400;
  both = until_energy(1e-3);
  both.time = 1e9;
  Scene::Until never;
  never.wall_s = 1;
  for (const Scene::Until& until :
       {time, collisions, until_energy(1e-11), until_energy(1e-60), both}) {
    const auto found = forecast(composition, volume, initial, until);
    const auto expected = forecast(cooling, {1, 0.5}, density, until);
    ASSERT_TRUE(found && expected);
    EXPECT_EQ(found->stop, expected->stop);
    EXPECT_NEAR(found->time / expected->time, 1, 1e-3);
    EXPECT_NEAR(found->collisions_per_needle / expected->collisions_per_needle, 1, 1e-4);
    EXPECT_NEAR(std::log(found->energy_ratio) / std::log(expected->energy_ratio), 1, 1e-4);
  }
  EXPECT_FALSE(forecast(Composition(composition.species(), {1, -1}), volume, initial, never));
  const std::vector<theory::Temperatures> rest(2, {0, 0});
  EXPECT_FALSE(forecast(composition, volume, rest, until_energy(0.5)));
  EXPECT_EQ(forecast(composition, volume, rest, time)->time, 40);
}

}  // namespace
}  // namespace needlework
