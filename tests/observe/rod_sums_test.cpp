// The series of rods: their packing fraction, virial and pressure.
#include <cmath>

#include "src/observe/observation.h"
#include "tests/observe/observed.h"
#include "tests/support/rods.h"

namespace needlework::observe {
namespace {

TEST(RodSums, AreTheVirialAndThePressureBetweenSamples) {
  const Scene scene = test::rods_and_spheres(60, 11);
  Simulation gas(scene);
  Observation observation(scene);
  const std::vector<SeriesGroup> groups = observation.groups();
  const auto rods = std::find_if(groups.begin(), groups.end(),
                                 [](const SeriesGroup& group) { return group.name == "rods"; });
  ASSERT_NE(rods, groups.end());
  const double volume = std::pow(11, 3), count = 180;
  const double packing =
      60 * M_PI / 6 * std::pow(1.2, 3) + 120 * (M_PI / 4 * 0.64 * 2 + M_PI / 6 * std::pow(0.8, 3));
  ASSERT_EQ(rods->fields[0].values.size(), 1u);
  EXPECT_NEAR(rods->fields[0].values[0], packing / volume, 1e-12);

  double time = 0, virial = 0, t_tr_integral = 0;
  for (const double until : {0.0, 0.3, 0.7, 0.7, 1.5}) {
    gas.advance(test::until_time(until));
    SpeciesSums sums{gas.species_totals(), gas.collisions_by_pair()};
    sums.virial = gas.virial();
    sums.t_tr_integral = gas.t_tr_integral();
    const auto row = observation.sample(gas.copy(), gas.totals(), sums);
    // The last two values: no other group follows.
    const double found_virial = row[row.size() - 2], pressure = row[row.size() - 1];
    EXPECT_EQ(found_virial, gas.virial());
    if (until > time) {
      EXPECT_GT(gas.virial(), virial);
      EXPECT_NEAR(pressure * volume * (until - time),
                  count * (gas.t_tr_integral() - t_tr_integral) + (gas.virial() - virial) / 3,
                  1e-9);
    } else {
      EXPECT_TRUE(std::isnan(pressure));
    }
    time = until, virial = gas.virial(), t_tr_integral = gas.t_tr_integral();
  }
}

TEST(RodSums, AreThoseOfRodsAlone) {
  for (const SeriesGroup& group : Observation(test::scene_of(20, 5)).groups())
    EXPECT_NE(group.name, "rods");
}

}  // namespace
}  // namespace needlework::observe
