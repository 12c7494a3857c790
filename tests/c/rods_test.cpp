// Rods of finite width in C: first contacts of bodies of any size, shapes, packing and pressure.
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "tests/c/c_simulation.h"

namespace needlework {
namespace {

using test::CSimulation;

/// Pairs of which the second falls along z onto the first, their directors across each other.
struct FallingPairs {
  std::vector<double> r1, u1, rest, r2, u2, v2, horizon;

  explicit FallingPairs(std::size_t count) : rest(3 * count), horizon(count, 10) {
    for (std::size_t n = 0; n < count; ++n) {
      for (const double x : {0., 0., 0.}) r1.push_back(x);
      for (const double x : {1., 0., 0.}) u1.push_back(x);
      for (const double x : {.25, .125, 2.}) r2.push_back(x);
      for (const double x : {0., 1., 0.}) u2.push_back(x);
      for (const double x : {0., 0., -1.}) v2.push_back(x);
    }
  }
  needlework_pairs pairs() const {
    const auto rows = [](const std::vector<double>& from) {
      return needlework_const_vectors{from.data(), 0, 0};
    };
    needlework_pairs out{};
    out.count = horizon.size();
    out.r1 = rows(r1), out.u1 = rows(u1), out.v1 = out.w1 = out.w2 = rows(rest);
    out.r2 = rows(r2), out.u2 = rows(u2), out.v2 = rows(v2);
    out.horizon = horizon.data();
    return out;
  }
};

TEST(CRods, MeetWhenTheirAxesAreHalfTheSumOfTheirDiametersApart) {
  const FallingPairs falling(4);
  const needlework_pairs pairs = falling.pairs();
  // Needles, rods on each other's sides, a sphere beside a rod's axis, and a rod too short to meet.
  const double length1[] = {1, 3, 3, 0.125}, length2[] = {1, 2, 0, 1};
  const double diameter1[] = {0, 0.5, 0.5, 0.0625}, diameter2[] = {0, 0.25, 0.75, 0.0625};
  const needlework_pair_sizes sizes{length1, length2, diameter1, diameter2};
  double time[4], s12[4], s21[4];
  needlework_error error;
  ASSERT_EQ(needlework_predict_with_sizes(&pairs, &sizes, time, s12, s21, &error), NEEDLEWORK_OK)
      << error.message;
  EXPECT_EQ(time[0], 2);
  EXPECT_NEAR(time[1], 2 - 0.375, 1e-15);
  // The sphere is 0.125 beside the axis: its centre is at a height of sqrt(0.625^2 - 0.125^2).
  EXPECT_NEAR(time[2], 2 - std::sqrt(0.375), 1e-15);
  EXPECT_EQ(time[3], std::numeric_limits<double>::infinity());
  EXPECT_NEAR(s12[1], 0.25, 1e-15);
  EXPECT_NEAR(s21[1], -0.125, 1e-15);
  EXPECT_NEAR(s12[2], 0.25, 1e-15);
  EXPECT_EQ(s21[2], 0);
  EXPECT_TRUE(std::isnan(s12[3]));

  // What is not given is a needle of length 1, which is what needlework_predict() takes all for.
  double of_needles[4], of_none[4];
  const needlework_pair_sizes none{};
  EXPECT_EQ(needlework_predict(&pairs, of_needles, nullptr, nullptr, nullptr), NEEDLEWORK_OK);
  EXPECT_EQ(needlework_predict_with_sizes(&pairs, &none, of_none, nullptr, nullptr, nullptr),
            NEEDLEWORK_OK);
  for (std::size_t n = 0; n < 4; ++n) {
    EXPECT_EQ(of_needles[n], 2);
    EXPECT_EQ(of_none[n], 2);
  }
}

TEST(CRods, SayWhichPairOverlaps) {
  FallingPairs falling(2);
  const needlework_pairs pairs = falling.pairs();
  double time[2];
  needlework_error error;
  const auto message = [&](const double* diameter1, const double* diameter2,
                           const double* length = nullptr) {
    const needlework_pair_sizes sizes{length, length, diameter1, diameter2};
    EXPECT_EQ(needlework_predict_with_sizes(&pairs, &sizes, time, nullptr, nullptr, &error),
              NEEDLEWORK_INPUT);
    return std::string(error.message);
  };
  const double thin[] = {0.5, 0.5}, thick[] = {0.5, 4}, none[] = {0.5, 0};
  EXPECT_EQ(message(thin, thick),
            "pair 1: the rods overlap: their axes are 2 apart, less than 2.25");
  const double of_spheres[] = {0, 0};
  for (double& velocity : falling.v2) velocity = 0;
  EXPECT_EQ(message(thin, thick),
            "pair 1: the rods overlap: their axes are 2 apart, less than 2.25");
  EXPECT_EQ(message(thin, thick, of_spheres),
            "pair 1: the rods overlap: their axes are 2.019436803 apart, less than 2.25");
}

TEST(CRods, HaveShapesRoomAndPressure) {
  const CSimulation gas(
      "needles.box = 6\n[[species]]\nname = 'rod'\ncount = 20\nlength = 1\ndiameter = 0.5\n"
      "inertia = 0.25\n[[species]]\nname = 'ball'\ncount = 30\nlength = 0\ndiameter = 1\n");
  ASSERT_NE(static_cast<needlework_simulation*>(gas), nullptr) << gas.error.message;
  needlework_rods rods{};
  ASSERT_EQ(needlework_get_rods(gas, &rods), NEEDLEWORK_OK) << gas.message();
  EXPECT_TRUE(std::isnan(rods.pressure));
  EXPECT_EQ(rods.virial, 0);
  const double pi = std::numbers::pi;
  const double volume = 20 * (pi / 16 + pi / 48) + 30 * pi / 6;
  EXPECT_NEAR(rods.packing_fraction, volume / 216, 1e-15);
  // T_tr changes at collisions alone; the engine looks at it about once in a mean free time.
  double t_tr_integral = 0;
  for (std::uint64_t n = 1; n <= 500; ++n) {
    const needlework_totals before = gas.totals();
    gas.run_to(n);
    t_tr_integral += before.t_tr * (gas.totals().time - before.time);
  }
  ASSERT_EQ(needlework_get_rods(gas, &rods), NEEDLEWORK_OK) << gas.message();
  EXPECT_GT(rods.virial, 0);
  EXPECT_NEAR(rods.pressure, (50 * t_tr_integral + rods.virial / 3) / (216 * gas.totals().time),
              0.03 * rods.pressure);

  double diameter = -1, inertia = -1;
  EXPECT_EQ(needlework_get_species_shape(gas, 0, &diameter, &inertia), NEEDLEWORK_OK);
  EXPECT_EQ(diameter, 0.5);
  EXPECT_NEAR(inertia, 0.25, 1e-16);
  EXPECT_EQ(needlework_get_species_shape(gas, 1, &diameter, nullptr), NEEDLEWORK_OK);
  EXPECT_EQ(diameter, 1);
  EXPECT_EQ(needlework_get_species_shape(gas, 1, nullptr, &inertia), NEEDLEWORK_OK);
  EXPECT_EQ(inertia, 0);
  EXPECT_EQ(needlework_get_species_shape(gas, 2, &diameter, &inertia), NEEDLEWORK_USAGE);
  EXPECT_EQ(gas.message(), "index = 2: expected an index of a species, below 2");
  EXPECT_EQ(needlework_get_rods(gas, nullptr), NEEDLEWORK_USAGE);
  EXPECT_EQ(gas.message(), "rods is NULL: expected a pointer");

  const CSimulation needles(test::cooling);
  EXPECT_EQ(needlework_get_rods(needles, &rods), NEEDLEWORK_OK);
  EXPECT_EQ(rods.packing_fraction, 0);
  EXPECT_EQ(needlework_get_species_shape(needles, 0, &diameter, &inertia), NEEDLEWORK_OK);
  EXPECT_EQ(diameter, 0);
  EXPECT_NEAR(inertia, 1. / 12, 1e-16);
}

}  // namespace
}  // namespace needlework
