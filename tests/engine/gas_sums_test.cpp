// Sums over needles take masses and moments of inertia from the bodies of needles, and from species
// only the units in which they count.
#include "src/engine/gas_sums.h"

#include <gtest/gtest.h>

#include "tests/support/kernel_pair.h"

namespace needlework {
namespace {

// Three needles with bodies of this species.
Gas gas_of(const Species& species) {
  Gas gas;
  gas.resize(3);
  gas.box = std::array<double, 3>{4, 4, 4};
  gas.set_composition(Composition({species}, {}));
  for (std::uint32_t i = 0; i < 3; ++i) {
    gas.ids[i] = Id{i};
    gas.records[i].flight = test::flight({1, 1, 1.0 + i}, {1, 0, 0}, {0.5, 1, 2.0 * i}, {0, 0, 1});
  }
  return gas;
}

struct Weighed {
  Totals totals;
  double of_gravity;
};

Weighed weighed(Gas& gas, int threads) {
  Weighed out{totals_of(gas, gas.records[0].time, threads), 0};
  gas.gravity = {0, 0, -0.5};
  gas.falls = true;
  const auto sums = sums_of_squares(gas, gas.records[0].time, threads);
  out.of_gravity = energy_of(gas, sums) - energy_of_motion(gas, sums);
  gas.falls = false;
  return out;
}

// Bodies four times as heavy as their species says, and with five times its moment of inertia.
TEST(GasSums, WeighBodiesRatherThanSpecies) {
  const Species light{.count = 3, .mass = 0.7, .k = 6};
  const Species heavy{.count = 3, .mass = 2.8, .k = 4.8};
  for (const int threads : {1, 2}) {
    Gas plain = gas_of(light), bodies = gas_of(heavy), both = gas_of(heavy);
    both.composition = Composition({light}, {});
    const Weighed expected = weighed(bodies, threads), found = weighed(both, threads);
    const Weighed of_light = weighed(plain, threads);
    const auto near = [](double a, double b) { EXPECT_NEAR(a, b, 1e-14 * std::abs(b)); };
    near(found.totals.t_tr, expected.totals.t_tr);
    near(found.totals.t_rot, expected.totals.t_rot);
    near(found.totals.energy, expected.totals.energy);
    near(found.of_gravity, expected.of_gravity);
    for (int axis = 0; axis < 3; ++axis)
      near(found.totals.momentum[axis], expected.totals.momentum[axis]);
    near(found.totals.t_tr, 4 * of_light.totals.t_tr);
    near(found.totals.t_rot, 5 * of_light.totals.t_rot);
    near(found.of_gravity, 4 * of_light.of_gravity);
    EXPECT_GT(of_light.totals.t_tr, 0);
    EXPECT_GT(of_light.totals.t_rot, 0);
    EXPECT_GT(of_light.of_gravity, 0);
  }
}

// So that no trajectory depends on how sums are weighed.
TEST(GasSums, HaveTheBitsOfPlainOnesWhereNeedlesAreAlike) {
  for (const Species& species :
       {Species{}, Species{.count = 3, .length = 0.3, .mass = 0.7, .k = 3.3},
        Species{.count = 3, .length = 0, .mass = 1.1, .diameter = 0.3}}) {
    const Gas gas = gas_of(species);
    const Weight weight = weight_of(gas, Needle(1));
    EXPECT_EQ(weight.mass, 1);
    EXPECT_EQ(weight.inertia, 1);
    EXPECT_TRUE(gas.bodies_are_of(0));
  }
}

}  // namespace
}  // namespace needlework
