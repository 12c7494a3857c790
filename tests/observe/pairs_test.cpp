// Pair correlations and structure factors of states where they are known.
#include <cmath>
#include <numbers>

#include "src/observe/ideal_pairs.h"
#include "tests/observe/observed.h"
#include "tests/support/random.h"

namespace needlework::observe {
namespace {

const Vector pairs_box{8, 9, 10};
constexpr std::size_t bins = 60;

TEST(PairCorrelation, OfTwoNeedlesIsAtTheirDistance) {
  State state = resting(2, pairs_box);
  state.position = {{0.5, 1, 1}, {7.5, 1, 2.01}};  // sqrt(1 + 1.01^2) across the border
  state.orientation[1] = {0, 0.6, 0.8};
  Values values = Observed(scene_with("pair_correlation", 2, pairs_box)).sample(state);
  const auto& borders = values["borders"];
  EXPECT_DOUBLE_EQ(borders.back(), 3);
  const auto bin = static_cast<std::size_t>(std::hypot(1, 1.01) / 3 * bins);
  for (std::size_t n = 0; n < bins; ++n) {
    const double shell =
        4 * std::numbers::pi / 3 * (std::pow(borders[n + 1], 3) - std::pow(borders[n], 3));
    EXPECT_NEAR(values["g"][n], n == bin ? 8 * 9 * 10 / shell : 0, 1e-9) << n;
    if (n == bin) {
      EXPECT_DOUBLE_EQ(values["p2"][n], 1.5 * 0.64 - 0.5);
    } else {
      EXPECT_TRUE(std::isnan(values["p2"][n])) << n;
    }
  }
}

TEST(PairCorrelation, EndsAtHalfTheShortestPeriodicEdge) {
  Values values =
      Observed(scene_with("pair_correlation", 0, {5, 4, 9})).sample(resting(0, pairs_box));
  EXPECT_DOUBLE_EQ(values["borders"].back(), 2);
}

// Between walls there are no images, and above an open side needles are far from those below.
TEST(PairCorrelation, EndsAtWalls) {
  Scene scene = scene_with("pair_correlation", 3, pairs_box);
  scene.walls = {{.axis = "z", .side = "low"}, {.axis = "x", .side = "both"}};
  scene.forces.gravity[2] = -1;
  State state = resting(3, pairs_box);
  state.periodic = scene.periodic();
  state.position = {{0.5, 1, 1}, {7.5, 1, 1}, {0.5, 1, 12.5}};  // 2 apart, were x periodic
  Values values = Observed(scene).sample(state);
  for (const double g : values["g"]) EXPECT_EQ(g, 0);
  state.position[1] = {1.5, 1, 12.5};
  values = Observed(scene).sample(state);
  for (std::size_t n = 0; n < bins; ++n) EXPECT_EQ(values["g"][n] > 0, n == 20) << n;
}

// Independent of how pairs are found: those of each box that has cells, counted one by one.
TEST(PairCorrelation, CountsEveryPairOnce) {
  for (const double edge : {8.9, 9.1, 13.0}) {  // two cells along each axis or less, three, four
    Scene scene = test::scene_of(400, edge, 7);
    scene.output.observables = {"pair_correlation"};
    const State state = draw_initial_state(scene);
    Values values = Observed(scene).sample(state);
    const double reach = values["borders"].back();
    std::vector<double> pairs(bins);
    for (std::size_t i = 0; i < state.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) {
        double square = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
          const double d = std::abs(state.position[i][axis] - state.position[j][axis]);
          square += std::pow(std::min(d, edge - d), 2);
        }
        if (square < reach * reach) {
          ++pairs[static_cast<std::size_t>(std::sqrt(square) / reach * bins)];
        }
      }
    for (std::size_t n = 0; n < bins; ++n) {
      const double shell =
          4 * std::numbers::pi / 3 *
          (std::pow(values["borders"][n + 1], 3) - std::pow(values["borders"][n], 3));
      EXPECT_NEAR(values["g"][n] * 400 * 399 / 2 * shell / (edge * edge * edge), pairs[n], 1e-6)
          << edge << " " << n;
    }
  }
}

// In a slit as high as two needles fit in; the range is that of the periodic axes. Drawn states are
// those of equilibrium, and their pairs are nearly independent.
TEST(PairCorrelation, OfNeedlesBetweenWallsIsOne) {
  Scene scene = scene_with("pair_correlation", 400, {8, 7, 1.2});
  scene.walls = {{.axis = "z", .side = "both"}};
  std::vector<double> sums(bins);
  Values values;
  constexpr int draws = 40;
  for (int draw = 0; draw < draws; ++draw) {
    scene.needles.seed = static_cast<std::uint64_t>(100 + draw);
    values = Observed(scene).sample(draw_initial_state(scene));
    for (std::size_t n = 0; n < bins; ++n) sums[n] += values["g"][n] / draws;
  }
  EXPECT_DOUBLE_EQ(values["borders"].back(), 3);
  const std::vector<double> shares = IdealPairs(setting_of(scene)).shares(0, 0, values["borders"]);
  double square = 0;
  for (std::size_t n = 0; n < bins; ++n) {
    const double error = 1 / std::sqrt(0.5 * draws * 400 * 399 * shares[n]);
    EXPECT_NEAR(sums[n], 1, 4.5 * error) << n;
    square += std::pow((sums[n] - 1) / error, 2);
  }
  EXPECT_LT(square, 60 + 4 * std::sqrt(2 * 60));
}

// Points in a box of which any axes have walls, counted pair by pair.
TEST(IdealPairs, AreThoseOfPointsAnywhere) {
  const Vector box{1.7, 4, 2.6};
  test::Random random(5);
  for (const char* walls : {"", "x", "y", "xz", "xyz"}) {
    Scene scene = scene_with("pair_correlation", 0, box);
    scene.species = {{.name = "spheres", .count = 2, .length = 0, .diameter = 1e-9}};
    for (const char* axis = walls; *axis; ++axis)
      scene.walls.push_back({.axis = std::string(1, *axis), .side = "both"});
    const std::array<bool, 3> periodic = scene.periodic();
    const IdealPairs ideal(setting_of(scene));
    const double reach = std::min(ideal.reach(), 3.0);
    constexpr std::size_t few = 8;
    std::vector<double> borders, counts(few);
    for (std::size_t n = 0; n <= few; ++n) borders.push_back(reach * double(n) / few);
    constexpr int pairs = 200000;
    for (int n = 0; n < pairs; ++n) {
      double square = 0;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double d = std::abs(random.uniform(0, box[axis]) - random.uniform(0, box[axis]));
        square += std::pow(periodic[axis] ? std::min(d, box[axis] - d) : d, 2);
      }
      const double place = std::sqrt(square) / reach * few;
      if (place < few) ++counts[static_cast<std::size_t>(place)];
    }
    const std::vector<double> shares = ideal.shares(0, 0, borders);
    for (std::size_t n = 0; n < few; ++n) {
      EXPECT_NEAR(counts[n] / pairs, shares[n], 4.5 * std::sqrt(shares[n] / pairs) + 1e-9)
          << walls << " " << n;
    }
  }
}

TEST(PairCorrelation, OfParallelNeedlesHasFullOrder) {
  Scene scene = test::scene_of(400, 9.1, 7);
  scene.output.observables = {"pair_correlation"};
  State state = draw_initial_state(scene);
  std::fill(state.orientation.begin(), state.orientation.end(), Vector{0, 0, 1});
  Values values = Observed(scene).sample(state);
  for (std::size_t n = 10; n < bins; ++n) EXPECT_EQ(values["p2"][n], 1) << n;
}

TEST(StructureFactor, OfADensityWaveIsAPeak) {
  State state = resting(40, pairs_box);
  for (std::size_t i = 0; i < 40; ++i) {
    // Four planes across x, ten positions along y, one plane across z.
    const std::size_t plane = i % 4, row = i / 4;
    state.position[i] = {2.0 * double(plane), 0.9 * double(row), 5};
  }
  Values values = Observed(scene_with("structure_factor", 40, pairs_box)).sample(state);
  for (std::size_t n = 1; n <= 16; ++n) {
    EXPECT_NEAR(values["s"][n - 1], n % 4 == 0 ? 40 : 0, 1e-10) << n;
    EXPECT_NEAR(values["s"][16 + n - 1], n % 10 == 0 ? 40 : 0, 1e-10) << n;
    EXPECT_NEAR(values["s"][32 + n - 1], 40, 1e-10) << n;
    EXPECT_DOUBLE_EQ(values["k"][16 + n - 1], 2 * std::numbers::pi * double(n) / 9);
  }
}

// Exponentially distributed: the mean of 48 values has the standard error 1 / sqrt(48).
TEST(StructureFactor, OfRandomPositionsIsOneOnAverage) {
  Scene scene = test::scene_of(5000, 12, 2);
  scene.output.observables = {"structure_factor"};
  Values values = Observed(scene).sample(draw_initial_state(scene));
  EXPECT_NEAR(sum(values["s"]) / 48, 1, 4 / std::sqrt(48));
}

}  // namespace
}  // namespace needlework::observe
