// Alignment, distributions and moments of velocities, where they are known.
#include <cmath>
#include <vector>

#include "tests/observe/observed.h"
#include "tests/support/statistics.h"

namespace needlework::observe {
namespace {

const Vector directions_box{5, 5, 5};
constexpr std::size_t q_bins = 60;

Scene random_gas(const std::string& observable) {
  Scene scene = test::scene_of(20000, 12, 5);
  scene.output.observables = {observable};
  return scene;
}

TEST(Alignment, OfParallelNeedlesIsComplete) {
  State state = resting(10, directions_box);  // along z
  for (Vector& v : state.velocity) v = {0, 0, -3};
  state.velocity[0] = {1, 0, 0};
  state.velocity[1] = {0, 0, 0};
  Values values = Observed(scene_with("alignment", 10, directions_box)).sample(state);
  std::vector<double> across(q_bins), along(q_bins);
  across.front() = 10;
  along.back() = 10;
  std::vector<double> axes = across;
  axes.insert(axes.end(), across.begin(), across.end());
  axes.insert(axes.end(), along.begin(), along.end());
  EXPECT_EQ(values["along_axes"], axes);
  EXPECT_EQ(values["along_velocity"].front(), 1);
  EXPECT_EQ(values["along_velocity"].back(), 8) << "the needle at rest has no direction";
  EXPECT_EQ(values["order_tensor"], (std::vector{-0.5, 0.0, 0.0, 0.0, -0.5, 0.0, 0.0, 0.0, 1.0}));
}

// Q = 3 x^2 - 1 with |x| uniform: Q is below q with probability sqrt((q + 1) / 3).
TEST(Alignment, OfRandomNeedlesFollowsTheLaw) {
  const Scene scene = random_gas("alignment");
  Values values = Observed(scene).sample(draw_initial_state(scene));
  std::vector<double> histograms = values["along_axes"];
  histograms.insert(histograms.end(), values["along_velocity"].begin(),
                    values["along_velocity"].end());
  for (std::size_t first = 0; first < histograms.size(); first += q_bins) {
    double chi_square = 0;
    for (std::size_t bin = 0; bin < q_bins; ++bin) {
      const auto below = [&](std::size_t border) {
        return std::sqrt((values["borders"][border] + 1) / 3);
      };
      const double expected = 20000 * (below(bin + 1) - below(bin));
      chi_square += std::pow(histograms[first + bin] - expected, 2) / expected;
    }
    const double degrees = q_bins - 1;
    EXPECT_LT(std::abs(chi_square - degrees), 4 * std::sqrt(2 * degrees)) << first;
  }
}

TEST(Distributions, CountWhatLiesInEachBin) {
  State state = resting(4, directions_box);
  state.position = {{1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {4, 1, 1}};
  for (Vector& v : state.velocity) v = {2, 0, 0};  // T_tr = 4/3, energy 1.5 T_tr, v = sqrt(3)
  for (Vector& w : state.angular_velocity) w = {0, 1, 0};
  Values values = Observed(scene_with("distributions", 4, directions_box, {2, 2, 1})).sample(state);
  ASSERT_EQ(values["needles_in_cell"].size(), 21u);
  EXPECT_EQ(values["needles_in_cell"][0], 2);
  EXPECT_EQ(values["needles_in_cell"][1], 1);
  EXPECT_EQ(values["needles_in_cell"][3], 1);
  EXPECT_EQ(sum(values["needles_in_cell"]), 4);
  const auto bin_of = [&](const char* borders, double x) {
    const auto& b = values[borders];
    return static_cast<std::size_t>(std::upper_bound(b.begin(), b.end(), x) - b.begin()) - 1;
  };
  EXPECT_EQ(values["velocity"][bin_of("velocity_borders", std::sqrt(3))], 4);
  EXPECT_EQ(values["velocity"][120 + 60], 4) << "y";
  EXPECT_EQ(sum(values["velocity"]), 12);
  // 1.5 and 1 are borders, where rounding decides between two bins.
  const std::size_t tr = bin_of("energy_borders", 1.45), rot = bin_of("energy_borders", 0.95);
  EXPECT_EQ(values["energy_tr"][tr] + values["energy_tr"][tr + 1], 4);
  EXPECT_EQ(values["energy_rot"][rot] + values["energy_rot"][rot + 1], 4);
}

TEST(Distributions, OfADrawnGasAreGaussian) {
  const Scene scene = random_gas("distributions");
  Values values = Observed(scene).sample(draw_initial_state(scene));
  const auto& borders = values["energy_borders"];
  double chi_square = 0, degrees = 0;
  for (std::size_t bin = 0; bin < borders.size() - 1; ++bin) {
    const double expected = 20000 * (std::exp(-borders[bin]) - std::exp(-borders[bin + 1]));
    if (expected < 20) break;
    chi_square += std::pow(values["energy_rot"][bin] - expected, 2) / expected;
    ++degrees;
  }
  EXPECT_LT(std::abs(chi_square - degrees), 4 * std::sqrt(2 * degrees));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double within = 0;  // one standard deviation
    for (std::size_t bin = 50; bin < 70; ++bin) within += values["velocity"][120 * axis + bin];
    const double p = std::erf(std::sqrt(0.5));
    EXPECT_NEAR(within, 20000 * p, 4 * std::sqrt(20000 * p * (1 - p))) << axis;
  }
}

TEST(Distributions, WithoutMotionAreEmpty) {
  Values values =
      Observed(scene_with("distributions", 4, directions_box)).sample(resting(4, directions_box));
  EXPECT_EQ(sum(values["velocity"]) + sum(values["energy_tr"]) + sum(values["energy_rot"]), 0);
}

TEST(VelocityMoments, OfEqualSpeedsAreThoseOfAShell) {
  State state = resting(6, directions_box);
  for (std::size_t i = 0; i < 6; ++i) {
    state.velocity[i] = {0, 0, i % 2 ? 2.0 : -2.0};  // along the needles
    state.angular_velocity[i] = {3, 0, 0};
  }
  Values values = Observed(scene_with("velocity_moments", 6, directions_box)).sample(state);
  EXPECT_DOUBLE_EQ(values["cumulant_v"][0], -0.4);
  EXPECT_DOUBLE_EQ(values["cumulant_w"][0], -0.5);
  EXPECT_DOUBLE_EQ(values["speeds"][0], 0);
  EXPECT_DOUBLE_EQ(values["velocity_spin"][0], -0.5);
  EXPECT_DOUBLE_EQ(values["velocity_director"][0], 1);
  for (Vector& v : state.velocity) v = {1, 0, 0};  // along the angular velocity
  values = Observed(scene_with("velocity_moments", 6, directions_box)).sample(state);
  EXPECT_DOUBLE_EQ(values["velocity_spin"][0], 1);
  EXPECT_DOUBLE_EQ(values["velocity_director"][0], -0.5);
}

TEST(VelocityMoments, SeeThatFastNeedlesRotateFast) {
  State state = resting(2, directions_box);
  state.velocity = {{1, 0, 0}, {0, 0, 0}};
  state.angular_velocity = {{1, 0, 0}, {0, 0, 0}};
  EXPECT_DOUBLE_EQ(
      Observed(scene_with("velocity_moments", 2, directions_box)).sample(state)["speeds"][0], 1);
}

// Standard errors over 16 gases, each of which estimates the five numbers.
TEST(VelocityMoments, VanishForADrawnGas) {
  std::map<std::string, test::Mean> means;
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    Scene scene = test::scene_of(2000, 12, seed);
    scene.output.observables = {"velocity_moments"};
    for (const auto& [name, value] : Observed(scene).sample(draw_initial_state(scene))) {
      means[name].add(value[0]);
    }
  }
  // Fixed mean squares lower fourth moments by a relative 2/(3 N) and 1/N.
  for (const auto& [name, mean] : means) EXPECT_TRUE(test::agrees(mean.measured(), 0, 4)) << name;
  EXPECT_EQ(means.size(), 5u);
}

}  // namespace
}  // namespace needlework::observe
