#include "src/picture/needle_values.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <stdexcept>

#include "tests/picture/states.h"

namespace needlework::picture {
namespace {

std::vector<double> values(const std::string& quantity, const State& state) {
  return values_of(quantity, state, true).values;
}

TEST(NeedleValues, AreOneForEachNeedleWhateverTheQuantity) {
  for (const std::size_t count : {0, 1, 3}) {
    State state = needles_at(3, std::vector<std::array<double, 3>>(count, {1, 1, 1}));
    for (const std::string& quantity : quantities()) {
      const NeedleValues result = values_of(quantity, state, false);
      EXPECT_EQ(result.values.size(), count) << quantity;
      for (const double value : result.values) EXPECT_TRUE(std::isfinite(value)) << quantity;
      EXPECT_LT(result.range.low, result.range.high);
      EXPECT_EQ(result.label.empty(), quantity == "none");
    }
  }
  EXPECT_THROW(values("mass", needles_at(3, {})), std::invalid_argument);
}

TEST(NeedleValues, OfSpeedAndSpinAreMultiplesOfTheRootMeanSquare) {
  State state = needles_at(3, {{0, 0, 0}, {1, 1, 1}});
  state.velocity = {{0, 3, 4}, {0, 0, 5}};
  state.angular_velocity = {{0, 0, 0}, {0, 0, 2}};
  const NeedleValues speed = values_of("speed", state, true);
  EXPECT_EQ(speed.values, (std::vector{1.0, 1.0}));
  EXPECT_EQ(speed.label, "speed / 5 (rms)");
  EXPECT_NEAR(values("spin", state)[1], std::sqrt(2), 1e-12);
  EXPECT_NEAR(values("vy", state)[0], std::sqrt(2), 1e-12);
  EXPECT_NEAR(values("vy", state)[1], 0, 1e-12);
}

TEST(NeedleValues, OfSpeedsAreMultiplesOfThoseOfNeedlesThatMove) {
  State state = needles_at(3, {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}});
  state.velocity = {{0, 3, 4}, {0, 0, 0}, {0, 0, 5}};
  constexpr double fixed = std::numeric_limits<double>::infinity();
  state.own_bodies.mass = {1, fixed, 2};
  EXPECT_EQ(values("speed", state), (std::vector{1.0, 0.0, 1.0}));
  state.own_bodies = {};
  state.species = {0, 1, 0};
  state.bodies.mass = {1, fixed};
  EXPECT_EQ(values("speed", state), (std::vector{1.0, 0.0, 1.0}));
  EXPECT_EQ(values_of("flow-z", state, true).label, "flow-z / 2.89 (thermal)");
}

TEST(NeedleValues, OfAlignmentAreTwoAlongTheVelocityAndMinusOneAcross) {
  State state = needles_at(3, {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}});
  state.velocity = {{-2, 0, 0}, {0, 1, 5}, {0, 0, 0}};
  const std::vector<double> q = values("alignment", state);
  EXPECT_NEAR(q[0], 2, 1e-12);
  EXPECT_NEAR(q[1], -1, 1e-12);
  EXPECT_NEAR(q[2], 0, 1e-12);  // at rest
}

TEST(NeedleValues, OfSpeciesAreTheirNumbers) {
  State state = needles_at(3, {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}});
  EXPECT_EQ(values("species", state), (std::vector{0.0, 0.0, 0.0}));
  state.species = {2, 0, 1};
  const NeedleValues species = values_of("species", state, true);
  EXPECT_EQ(species.values, (std::vector{2.0, 0.0, 1.0}));
  EXPECT_EQ(species.range.high, 2);
}

TEST(NeedleValues, OfOrientationAreAnglesToTheAxisOfOrder) {
  State state = needles_at(3, {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {1, 2, 1}});
  // An ordered gas has no direction: -u is u.
  state.orientation = {{0, 0.6, 0.8}, {0, -0.6, -0.8}, {0, 0.6, 0.8}, {1, 0, 0}};
  const std::vector<double> angles = values("orientation", state);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(angles[i], 0, 1e-5);
  EXPECT_NEAR(angles[3], 90, 1e-5);
}

TEST(NeedleValues, OfDensityAndFlowAreThoseOfTheNeighboursAcrossTheBorders) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> anywhere(-8, 16);  // outside of the box too
  for (const std::size_t count : {2, 10, 300}) {
    std::vector<std::array<double, 3>> centres(count), velocities(count);
    double square = 0;
    for (std::size_t i = 0; i < count; ++i) {
      for (double& x : centres[i]) x = anywhere(random);
      for (double& v : velocities[i]) v = anywhere(random), square += v * v;
    }
    State state = needles_at(4, centres);
    state.box = {4, 6, 8};
    state.velocity = velocities;
    const double thermal = std::sqrt(square / (3 * static_cast<double>(count)));
    // The ball that holds 30 others in the mean, or the largest that fits.
    const double others = static_cast<double>(count) - 1, volume = 4 * 6 * 8;
    const double ball = 4 * std::numbers::pi / 3;
    const double radius = std::min(std::cbrt(30 * volume / (others * ball)), 2.0);
    const std::vector<double> densities = values("density", state);
    const std::vector<double> flows[] = {values("flow-x", state), values("flow-y", state),
                                         values("flow-z", state)};
    for (std::size_t i = 0; i < count; ++i) {
      double near = 0;
      std::array<double, 3> velocity = velocities[i];
      for (std::size_t j = 0; j < count; ++j) {
        double squared = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
          const double d = std::remainder(centres[i][axis] - centres[j][axis], state.box[axis]);
          squared += d * d;
        }
        if (i == j || squared >= radius * radius) continue;
        ++near;
        for (std::size_t axis = 0; axis < 3; ++axis) velocity[axis] += velocities[j][axis];
      }
      for (std::size_t axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(flows[axis][i], velocity[axis] / (near + 1) / thermal, 1e-9);
      }
      const double mean = others * ball * std::pow(radius, 3) / volume;
      EXPECT_NEAR(densities[i], near / mean, 1e-9) << count << " " << i;
    }
  }
}

// A gas in a uniform flow, some of whose needles are stored as images of those in the box.
TEST(NeedleValues, OfShearedGasesAreThoseOfPeculiarVelocitiesWhicheverImageIsStored) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> share(0, 1), component(-1, 1);
  std::uniform_int_distribution<int> boxes(-1, 1);
  constexpr double rate = 3, slide = 9.5;
  constexpr std::size_t count = 300;
  State state = needles_at(4, std::vector<std::array<double, 3>>(count));
  state.box = {24, 6, 4};  // cells that have slid past more than their neighbours
  state.slide = slide;
  state.shear_rate = rate;
  std::vector<std::array<double, 3>> peculiar(count);
  State images = state;
  double square = 0;
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      state.position[i][axis] = share(random) * state.box[axis];
      peculiar[i][axis] = component(random);
      square += peculiar[i][axis] * peculiar[i][axis];
    }
    state.velocity[i] = peculiar[i];
    state.velocity[i][0] += rate * state.position[i][1];
    const int x = boxes(random), y = boxes(random), z = boxes(random);
    images.position[i] = state.position[i];
    images.position[i][0] += 24 * x + slide * y;
    images.position[i][1] += 6 * y;
    images.position[i][2] += 4 * z;
    images.velocity[i] = state.velocity[i];
    images.velocity[i][0] += rate * 6 * y;
  }
  State given = images;  // as copies of a run have it
  given.peculiar_velocity = peculiar;
  const double thermal = std::sqrt(square / (3 * count));
  for (const std::string& quantity : quantities()) {
    const std::vector<double> expected = values(quantity, state);
    const std::vector<double> of_images = values(quantity, images),
                              of_given = values(quantity, given);
    EXPECT_EQ(values_of(quantity, images, true).label, values_of(quantity, state, true).label);
    for (std::size_t i = 0; i < count; ++i) {
      EXPECT_NEAR(of_images[i], expected[i], 1e-9) << quantity;
      EXPECT_NEAR(of_given[i], expected[i], 1e-9) << quantity;
    }
  }
  EXPECT_NEAR(values("vx", state)[5] / peculiar[5][0], values("vx", state)[6] / peculiar[6][0],
              1e-9);

  constexpr double radius = 2;  // the largest that fits into the box
  const std::vector<double> flow = values("flow-x", state);
  for (std::size_t i = 0; i < count; ++i) {
    double sum = 0, near = 0;
    for (std::size_t j = 0; j < count; ++j) {
      std::array<double, 3> apart;
      for (std::size_t axis = 0; axis < 3; ++axis)
        apart[axis] = state.position[i][axis] - state.position[j][axis];
      const double rows = std::nearbyint(apart[1] / 6);
      const double distance = std::hypot(std::remainder(apart[0] - slide * rows, 24.0),
                                         apart[1] - 6 * rows, std::remainder(apart[2], 4.0));
      if (distance >= radius) continue;
      sum += peculiar[j][0];
      ++near;
    }
    EXPECT_NEAR(flow[i], sum / near / thermal, 1e-9) << i;
  }
}

}  // namespace
}  // namespace needlework::picture
