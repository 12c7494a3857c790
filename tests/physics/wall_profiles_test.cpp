// Profiles, pressure and centre of mass, as files hold them, of elastic gases in equilibrium, whose
// positions and directors are those of an ideal gas: p(z, u) is exp(-m g z / T) wherever both tips
// are inside. At the distance d < L/2 from a wall directors have |u_z| < x = 2 d / L, so that the
// density is x times what it would be, and <u_z^2> = x^2 / 3.
//
// Tolerance: 3 standard errors of a mean, 4 of the worst slab of many, from the scatter of the
// runs, each with a seed of its own.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "src/observe/observation.h"
#include "tests/support/runs.h"
#include "tests/support/statistics.h"

namespace needlework {
namespace {

using test::agrees;
using test::Mean;

using Rows = std::map<std::string, std::vector<double>>;  // by "OBSERVABLE/FIELD"

Rows rows_of(observe::Observation& observation, const Simulation& simulation) {
  observe::SpeciesSums sums;
  sums.walls = simulation.wall_totals();
  sums.energy = simulation.energy_budget();
  auto row = observation.sample(simulation.copy(), simulation.totals(), sums);
  Rows out;
  for (const SeriesGroup& group : observation.groups()) {
    for (const SeriesField& field : group.fields) {
      std::vector<double>& values = out[group.name + "/" + field.name];
      if (field.kind == SeriesField::Kind::constant) {
        values = field.values;
        continue;
      }
      values.assign(row.begin(), row.begin() + static_cast<std::ptrdiff_t>(field.width()));
      row = row.subspan(field.width());
    }
  }
  return out;
}

// Means over slabs, weighted by the density, and over samples.
struct Averages {
  std::vector<double> density, t_tr, t_rot, t_normal, p2, cos2;
  double pressure = 0, centre = 0, temperature = 0;
};

Averages averages_of(const Scene& scene, double relaxed, double every, int samples) {
  Simulation gas(scene);
  observe::Observation observation(scene);
  gas.advance(test::until_time(relaxed));
  rows_of(observation, gas);
  Averages out;
  std::map<std::string, std::vector<double>> sums;
  for (int n = 1; n <= samples; ++n) {
    gas.advance(test::until_time(relaxed + every * n));
    Rows rows = rows_of(observation, gas);
    const std::vector<double>& density = rows["wall_profiles/density"];
    for (const char* name : {"density", "t_tr", "t_rot", "t_normal", "p2", "cos2"}) {
      sums[name].resize(density.size());
      for (std::size_t slab = 0; slab < density.size(); ++slab) {
        if (density[slab] == 0) continue;
        const bool is_weight = std::string(name) == "density";
        sums[name][slab] += is_weight
                                ? density[slab]
                                : density[slab] * rows[std::string("wall_profiles/") + name][slab];
      }
    }
    out.pressure += rows["walls/pressure"][0] / samples;
    out.centre += rows["centre_of_mass/position"][0] / samples;
    const Totals totals = gas.totals();
    out.temperature += (1.5 * totals.t_tr + totals.t_rot) / 2.5 / samples;
  }
  out.density = sums["density"];
  for (double& density : out.density) density /= samples;
  const auto mean = [&](const char* name) {
    std::vector<double> values = sums[name];
    for (std::size_t n = 0; n < values.size(); ++n) values[n] /= sums["density"][n];
    return values;
  };
  out.t_tr = mean("t_tr");
  out.t_rot = mean("t_rot");
  out.t_normal = mean("t_normal");
  out.p2 = mean("p2");
  out.cos2 = mean("cos2");
  return out;
}

TEST(WallProfilesOfAnElasticGas, AreExactBetweenWalls_long) {
  constexpr double count = 300, side = 6, height = 3;
  constexpr std::size_t slabs = 24, half = slabs / 2;
  constexpr double room = height - 0.5, temperature = 5 * count / (5 * count - 2);
  std::vector<Mean> density(half), p2(half), cos2(half), t_tr(half), t_rot(half), t_normal(half);
  Mean pressure;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    Scene scene = test::scene_of(count, side, seed);
    scene.needles.box[2] = height;
    scene.walls = {{.axis = "z", .side = "both"}};
    scene.output.observables = {"wall_profiles", "centre_of_mass"};
    const Averages found = averages_of(scene, 2, 0.5, 60);
    ASSERT_EQ(found.density.size(), slabs);
    // Both halves are alike.
    const auto add = [&](std::vector<Mean>& to, const std::vector<double>& values) {
      for (std::size_t n = 0; n < half; ++n) to[n].add((values[n] + values[slabs - 1 - n]) / 2);
    };
    add(density, found.density);
    add(p2, found.p2);
    add(cos2, found.cos2);
    add(t_tr, found.t_tr);
    add(t_rot, found.t_rot);
    add(t_normal, found.t_normal);
    pressure.add(found.pressure);
  }
  const double far = count / (side * side * room);
  for (std::size_t n = 0; n < half; ++n) {
    SCOPED_TRACE(n);
    const double a = std::min(1.0, 0.25 * static_cast<double>(n));
    const double b = std::min(1.0, 0.25 * static_cast<double>(n + 1));
    const double expected = far * (a + b) / 2;
    EXPECT_TRUE(agrees(density[n].measured(), expected, 4));
    EXPECT_LT(density[n].measured().error, (n == 0 ? 0.06 : 0.025) * expected);
    // Weighted by the density, <x^2> = (a^2 + b^2) / 2.
    EXPECT_TRUE(agrees(p2[n].measured(), ((a * a + b * b) / 2 - 1) / 2, 4));
    EXPECT_LT(p2[n].measured().error, 0.01);
    EXPECT_TRUE(agrees(cos2[n].measured(), (a * a + b * b) / 6, 4));
    EXPECT_TRUE(agrees(t_tr[n].measured(), temperature, 4));
    EXPECT_TRUE(agrees(t_rot[n].measured(), temperature, 4));
    EXPECT_TRUE(agrees(t_normal[n].measured(), temperature, 4));
    EXPECT_LT(t_tr[n].measured().error, 0.05);
  }
  const double exact = count * temperature / room / (side * side);
  EXPECT_TRUE(agrees(pressure.measured(), exact, 3));
  EXPECT_LT(pressure.measured().error, 0.01 * exact);
}

// Above a floor, where the force on it is N m g, and no needle is lost above the box.
TEST(WallProfilesOfAnElasticGas, AreExactAboveAFloor_long) {
  constexpr double count = 300, side = 9, pull = 1;
  constexpr std::size_t low = 16;  // slabs compared one by one
  std::vector<Mean> density(low);
  Mean above, pressure, centre;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    Scene scene = test::scene_of(count, side, seed);
    scene.needles.box[2] = 4;
    scene.walls = {{.axis = "z", .side = "low"}};
    scene.forces.gravity = {0, 0, -pull};
    scene.output.observables = {"wall_profiles", "centre_of_mass"};
    const Averages found = averages_of(scene, 15, 1.5, 60);
    ASSERT_EQ(found.density.size(), 96u);
    const double scale = found.temperature / pull, e = std::exp(-0.5 / scale);
    // Integrals of min(1, 2 z) exp(-z / scale) from z on, and with z, where z is 1/2 or more.
    const auto above_half = [&](double z) { return scale * std::exp(-z / scale); };
    const auto below_half = [&](double z) {
      return 2 * scale * ((z + scale) * std::exp(-z / scale) - (0.5 + scale) * e);
    };
    const auto from = [&](double z) {
      return z < 0.5 ? below_half(z) + above_half(0.5) : above_half(z);
    };
    for (std::size_t n = 0; n < low; ++n) {
      const double z = static_cast<double>(n) / 8;
      density[n].add(found.density[n] * (side * side / 8 / count) /
                     ((from(z) - from(z + 0.125)) / from(0)));
    }
    double high = 0;
    for (std::size_t n = low; n < 96; ++n) high += found.density[n] * (side * side / 8);
    above.add(high / count / ((from(2) - from(12)) / from(0)));
    const double s2 = scale * scale;
    const double low_z = 2 * (2 * s2 * scale - e * (2 * s2 * scale + 2 * s2 * 0.5 + scale * 0.25));
    centre.add(found.centre / ((low_z + e * (s2 + scale * 0.5)) / from(0)));
    pressure.add(found.pressure / (count * pull / (side * side)));
  }
  for (std::size_t n = 0; n < low; ++n) {
    EXPECT_TRUE(agrees(density[n].measured(), 1, 4)) << n;
    EXPECT_LT(density[n].measured().error, n == 0 ? 0.08 : 0.04) << n;
  }
  EXPECT_TRUE(agrees(above.measured(), 1, 3));
  EXPECT_TRUE(agrees(centre.measured(), 1, 3));
  EXPECT_LT(centre.measured().error, 0.02);
  EXPECT_TRUE(agrees(pressure.measured(), 1, 3));
  EXPECT_LT(pressure.measured().error, 0.005);
}

// A needle on end bounces on a floor in motion and always hits it at its highest, where it is at
// rest: an orbit with the period of the floor, stable as A w^2 < g. So its height is known at each
// phase.
TEST(PhaseOfAWall, IsThatOfTheOrbitOfABouncingNeedle) {
  constexpr double amplitude = 0.005, pull = 1, pi = 3.14159265358979323846;
  Scene scene = test::scene_of(1, 3);
  scene.walls = {{.axis = "z", .side = "low"}};
  scene.walls[0].motion = {.amplitude = amplitude, .frequency = 1, .phase = -pi / 2};
  scene.forces.gravity = {0, 0, -pull};
  scene.output.observables = {"centre_of_mass"};
  State state = draw_initial_state(scene);
  state.position = {{1, 1, 0.5 + amplitude + pull / 8}};
  state.velocity = {{0, 0, 0}};
  state.orientation = {{0, 0, 1}};
  state.angular_velocity = {{0, 0, 0}};
  Simulation simulation(scene, state);
  observe::Observation observation(scene);
  for (int n = 0; n <= 400; ++n) {
    simulation.advance(test::until_time(0.0625 * n));
    Rows rows = rows_of(observation, simulation);
    const double phase = rows["walls/phase"][0];
    EXPECT_GE(phase, 0);
    EXPECT_LT(phase, 2 * pi);
    double turns = (phase - pi / 2) / (2 * pi);  // since the hit
    turns -= std::floor(turns + 1e-9);
    const double height = 0.5 + amplitude + pull * turns / 2 - pull * turns * turns / 2;
    EXPECT_NEAR(rows["centre_of_mass/position"][0], height, 1e-9) << n;
  }
  EXPECT_EQ(simulation.wall_totals()[0].hits, 25u);
}

}  // namespace
}  // namespace needlework
