// Which needles share a grid, and what each class gets.
#include "src/search/size_classes.h"

#include <gtest/gtest.h>

#include "src/search/bounding_volumes.h"
#include "src/search/choice.h"
#include "src/search/lengths.h"
#include "tests/search/gas_drive.h"

namespace needlework::test {
namespace {

Gas gas_with(const std::vector<double>& lengths, std::size_t count, double edge) {
  Random random(3);
  return random_gas(random, count, {edge, edge, edge}, {}, lengths);
}

const SearchSetup by_class{.density = {}, .cell_side = {}, .capsule_radius = {}, .by_class = true};

std::vector<SizeClass> classes_of(const Gas& gas, const SearchSetup& setup = {}) {
  return size_classes(gas, setup, BoundingVolume::cell);
}

TEST(SizeClasses, HoldNeedlesOfSimilarLength) {
  std::vector<double> lengths{1, 20, 5, 5, 5};
  lengths.insert(lengths.end(), 12, 1.5);
  const std::vector<SizeClass> classes =
      classes_of(gas_with(lengths, 340, 60));  // 20 of each species
  ASSERT_EQ(classes.size(), 3u);
  std::vector<std::uint8_t> expected{2, 0, 1, 1, 1};
  expected.insert(expected.end(), 12, 2);
  std::vector<std::uint8_t> found;
  found.reserve(lengths.size());
  for (const double length : lengths)
    found.push_back(static_cast<std::uint8_t>(class_of_extent(classes, length)));
  EXPECT_EQ(found, expected);
  EXPECT_EQ(classes[0].longest, 20);
  EXPECT_EQ(classes[1].longest, 5);
  EXPECT_EQ(classes[2].longest, 1.5);
  EXPECT_EQ(classes[0].count, 20u);
  EXPECT_EQ(classes[1].count, 60u);
  EXPECT_EQ(classes[2].count, 260u);
}

// Few short needles among long ones do not pay for a grid of their own.
TEST(SizeClasses, AreOneIfNeedlesAreLongOnAverage) {
  EXPECT_EQ(classes_of(gas_with({1, 20}, 80, 60)).size(), 1u);
  EXPECT_EQ(classes_of(gas_with({1, 1, 20}, 90, 60)).size(), 2u);
}

// Whatever is chosen for one species is chosen for species of one length.
TEST(SizeClasses, OfOneLengthAreOneWithTheSizesOfOneSpecies) {
  for (const double edge : {30.0, 5.0}) {
    for (const auto kind : {BoundingVolume::cell, BoundingVolume::capsule}) {
      const std::vector<SizeClass> one = size_classes(gas_with({2}, 900, edge), {}, kind);
      const std::vector<SizeClass> two = size_classes(gas_with({2, 2}, 900, edge), {}, kind);
      ASSERT_EQ(two.size(), 1u);
      EXPECT_EQ(two[0].cell_side, one[0].cell_side);
      EXPECT_EQ(two[0].capsule_radius, one[0].capsule_radius);
      EXPECT_EQ(two[0].count, 900u);
    }
  }
}

TEST(SizeClasses, AreOneIfASizeIsGiven) {
  const Gas gas = gas_with({1, 1, 20}, 90, 60);
  for (const auto& setup : {SearchSetup{.density = {}, .cell_side = 3, .capsule_radius = {}},
                            SearchSetup{.density = {}, .cell_side = {}, .capsule_radius = 0.5}}) {
    const std::vector<SizeClass> classes = size_classes(gas, setup, BoundingVolume::capsule);
    ASSERT_EQ(classes.size(), 1u);
    EXPECT_EQ(classes[0].longest, 20);
    EXPECT_EQ(classes[0].count, 90u);
  }
}

// Long needles collide often where short ones hardly do.
TEST(SizeClasses, HaveTheBoundingVolumeThatSuitsThem) {
  const Gas gas = gas_with({1, 1, 20}, 1200, 60);
  const std::vector<SizeClass> mixed = classes_of(gas, by_class);
  ASSERT_EQ(mixed.size(), 2u);
  EXPECT_EQ(mixed[0].kind, BoundingVolume::capsule);
  EXPECT_GT(mixed[0].capsule_radius, 0);
  EXPECT_EQ(mixed[1].kind, BoundingVolume::cell);
  for (const SizeClass& each : classes_of(gas)) EXPECT_EQ(each.kind, BoundingVolume::cell);
}

// A common grid of the cells that few needles would fill could not be divided among threads.
TEST(SizeClasses, OfFewNeedlesHaveCellsNoLongerThanTheLongestNeedle) {
  std::vector<double> lengths(200, 1.0);
  lengths.front() = 20;
  const Gas gas = gas_with(lengths, 5000, 60);
  for (const auto kind : {BoundingVolume::cell, BoundingVolume::capsule}) {
    const BoundingVolumes volumes(gas, by_class, kind);
    ASSERT_EQ(volumes.classes.size(), 2u);
    EXPECT_LE(size_classes(gas, by_class, kind)[0].cell_side, 20);
    EXPECT_LT(volumes.grid.sides()[0], 26);
  }
}

// Threads lock cells of the common grid.
TEST(SizeClasses, HaveCellsThatAreEachInOneOfTheCommonGrid) {
  std::vector<double> of_three_classes{20, 5, 5, 5};
  of_three_classes.insert(of_three_classes.end(), 13, 1);
  for (const double edge : {45.0, 130.0}) {
    const Gas gas = gas_with(of_three_classes, 5100, edge);
    for (const auto kind : {BoundingVolume::cell, BoundingVolume::capsule}) {
      BoundingVolumes volumes(gas, by_class, kind);
      ASSERT_EQ(volumes.classes.size(), 3u);
      for (const auto& each : volumes.classes) {
        for (int axis = 0; axis < 3; ++axis) {
          EXPECT_EQ(each->grid.counts()[axis] % volumes.grid.counts()[axis], 0);
        }
        EXPECT_GE(volumes.drift, each->overlap);
        EXPECT_GE(volumes.drift, each->radius);
        EXPECT_GE(volumes.radius, each->radius);
        EXPECT_GE(volumes.radius, each->ahead);
      }
      for (Needle i{0}; i < gas.size(); ++i) {
        volumes.place(i, {}, BodyLengths{gas}.half_length(i));
        const Cell& cell = volumes.places[i].cell;
        const CellGrid& grid = volumes.class_of(i).grid;
        const Cell around = volumes.common_cell_of(i);
        const Vec3d low = volumes.grid.corner(around), corner = grid.corner(cell);
        for (int axis = 0; axis < 3; ++axis) {
          const double above = component(corner, axis) - component(low, axis);
          const double rounding = 1e-9 * edge;
          ASSERT_GE(above, -rounding);
          ASSERT_LE(above + grid.sides()[axis], volumes.grid.sides()[axis] + rounding);
        }
      }
    }
  }
}

}  // namespace
}  // namespace needlework::test
