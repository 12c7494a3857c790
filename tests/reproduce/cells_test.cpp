// Flow and density of fields that are known.
#include "src/reproduce/cells.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace needlework::reproduce {
namespace {

constexpr std::size_t side = 10;

CellFields at_rest() {
  CellFields fields;
  fields.cells = {side, side, side};
  fields.box = {12, 12, 12};
  fields.excess.assign(side * side * side, 0.0);
  fields.flow.assign(side * side * side, {0, 0, 0});
  return fields;
}

double wave(std::size_t place, double number) {
  return std::sin(2 * std::numbers::pi * number * static_cast<double>(place) / side);
}

TEST(ShearWave, OfOneWaveIsThatWaveWithAllTheEnergy) {
  CellFields fields = at_rest();
  for_each_cell(fields.cells, [&](const std::array<std::size_t, 3>& place) {
    fields.flow[fields.index(place)] = {0, 0, 0.2 * wave(place[1], 1)};
  });
  const ShearWave found = strongest_shear_wave(fields);
  EXPECT_EQ(found.gradient, 1u);
  EXPECT_EQ(found.along, 2u);
  EXPECT_EQ(found.number, 1u);
  EXPECT_NEAR(found.share, 1, 1e-12);
}

TEST(ShearWave, IsTheStrongerOfTwoWithItsShare) {
  CellFields fields = at_rest();
  for_each_cell(fields.cells, [&](const std::array<std::size_t, 3>& place) {
    fields.flow[fields.index(place)] = {wave(place[2], 2), 0.5 * wave(place[0], 1), 0};
  });
  const ShearWave found = strongest_shear_wave(fields);
  EXPECT_EQ(found.gradient, 2u);
  EXPECT_EQ(found.along, 0u);
  EXPECT_EQ(found.number, 2u);
  EXPECT_NEAR(found.share, 1 / 1.25, 1e-12);
}

TEST(ShearWave, OfTheShortestWaveHasAllItsEnergyToo) {
  CellFields fields = at_rest();
  for_each_cell(fields.cells, [&](const std::array<std::size_t, 3>& place) {
    fields.flow[fields.index(place)] = {0, place[0] % 2 ? 1.0 : -1.0, 0};
  });
  const ShearWave found = strongest_shear_wave(fields);
  EXPECT_EQ(found.number, 5u);
  EXPECT_NEAR(found.share, 1, 1e-12);
}

TEST(ShearWave, LeavesOutCompression) {
  CellFields fields = at_rest();
  for_each_cell(fields.cells, [&](const std::array<std::size_t, 3>& place) {
    fields.flow[fields.index(place)] = {wave(place[0], 1), 0, 0.1 * wave(place[0], 3)};
  });
  const ShearWave found = strongest_shear_wave(fields);
  EXPECT_EQ(found.along, 2u);
  EXPECT_EQ(found.number, 3u);
}

TEST(DenseShare, CountsCellsAboveOneAndAHalfOfTheMean) {
  CellFields fields = at_rest();
  fields.excess[3] = 0.51;
  fields.excess[4] = 0.5;
  fields.excess[5] = -0.9;
  EXPECT_EQ(dense_share(fields), 1e-3);
}

TEST(DensityFlowCorrelation, IsOneWhereTheDenseFlows) {
  CellFields fields = at_rest();
  for (std::size_t cell = 0; cell < fields.flow.size(); ++cell) {
    const bool dense = cell % 2;
    fields.excess[cell] = dense ? 0.4 : -0.4;
    fields.flow[cell] = {0, dense ? -2.0 : 0.5, 0};
  }
  EXPECT_NEAR(density_flow_correlation(fields), 1, 1e-12);
  for (double& excess : fields.excess) excess = -excess;
  EXPECT_NEAR(density_flow_correlation(fields), -1, 1e-12);
}

}  // namespace
}  // namespace needlework::reproduce
