#include "src/engine/cell_box.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <limits>
#include <set>

#include "tests/support/random.h"

namespace needlework {
namespace {

using Indices = std::multiset<std::uint32_t>;

std::int32_t steps_between(std::int32_t a, std::int32_t b, std::int32_t n) {
  const std::int32_t d = std::abs(a - b);
  return std::min(d, n - d);
}

Indices cells_in(const CellBox& box, const CellCounts& cells) {
  Indices out;
  EXPECT_FALSE(any_in(box, cells, [&](std::uint32_t cell) {
    out.insert(cell);
    return false;
  }));
  return out;
}

TEST(CellBoxes, AreNearWhenAnyOfTheirCellsAre) {
  test::Random random(2);
  const CellCounts cells{7, 5, 11};
  const auto box = [&] {
    CellBox out;
    for (int i = 0; i < 3; ++i) {
      out.low[i] = static_cast<std::int32_t>(random.below(cells[i]));
      out.more[i] = static_cast<std::int32_t>(random.below(3));
    }
    return out;
  };
  int nears = 0;
  for (int n = 0; n < 5000; ++n) {
    const CellBox a = box(), b = box();
    const CellCounts distance{static_cast<std::int32_t>(random.below(3)),
                              static_cast<std::int32_t>(random.below(2)), 1};
    bool expected = true;
    for (int i = 0; i < 3; ++i) {
      bool close = false;
      for (std::int32_t x = 0; x <= a.more[i]; ++x) {
        for (std::int32_t y = 0; y <= b.more[i]; ++y) {
          close |= steps_between((a.low[i] + x) % cells[i], (b.low[i] + y) % cells[i], cells[i]) <=
                   distance[i];
        }
      }
      expected &= close;
    }
    ASSERT_EQ(near(a, b, cells, distance), expected);
    ASSERT_EQ(near(b, a, cells, distance), expected);
    nears += expected;
  }
  EXPECT_GT(nears, 500);
  EXPECT_LT(nears, 4500);
}

TEST(CellBoxes, AreVisitedOnceThroughBorders) {
  const CellCounts cells{4, 3, 2};
  // x: 3, 0; y: 2; z: 1, 0.
  EXPECT_EQ(cells_in({{3, 2, 1}, {1, 0, 1}}, cells), (Indices{23, 20, 11, 8}));
  Indices all;
  for (std::uint32_t cell = 0; cell < 24; ++cell) all.insert(cell);
  EXPECT_EQ(cells_in({{2, 1, 1}, {3, 2, 1}}, cells), all);
}

TEST(CellBoxes, AreLeftAtTheFirstHit) {
  int visits = 0;
  EXPECT_TRUE(any_in({{3, 0, 0}, {2, 0, 0}}, {4, 3, 2}, [&](std::uint32_t cell) {
    ++visits;
    return cell == 0;
  }));
  EXPECT_EQ(visits, 2);
}

// Sides are 1.
const CellGrid grid({8, 5, 3}, 1, 1000);

TEST(CellsAround, ReachAsFarAsTheDistanceAndNoFarther) {
  ASSERT_EQ(grid.counts(), (CellCounts{8, 5, 3}));
  const CellBox in_one = cells_around(grid, {2.3, 2.5, 1.9}, 0.29);
  EXPECT_EQ(in_one.low, (CellCounts{2, 2, 1}));
  EXPECT_EQ(in_one.more, (CellCounts{0, 0, 1}));
  const CellBox in_two = cells_around(grid, {2.3, 2.5, 1.9}, 0.31);
  EXPECT_EQ(in_two.low, (CellCounts{1, 2, 1}));
  EXPECT_EQ(in_two.more, (CellCounts{1, 0, 1}));
}

TEST(CellsAround, GoThroughBorders) {
  const CellBox low = cells_around(grid, {0.1, 0.1, 0.1}, 0.2);
  EXPECT_EQ(low.low, (CellCounts{7, 4, 2}));
  EXPECT_EQ(low.more, (CellCounts{1, 1, 1}));
  const CellBox high = cells_around(grid, {7.9, 4.9, 2.9}, 0.2);
  EXPECT_EQ(high.low, (CellCounts{7, 4, 2}));
  EXPECT_EQ(high.more, (CellCounts{1, 1, 1}));
  const CellBox beyond = cells_around(grid, {8.5, -0.5, 3.5}, 0.1);
  EXPECT_EQ(beyond.low, (CellCounts{0, 4, 0}));
  const CellBox all = cells_around(grid, {4, 2.5, 1.5}, 100);
  EXPECT_EQ(all.more, (CellCounts{7, 4, 2}));
}

TEST(CellsAround, TakeOneMoreInOnEitherSide) {
  const CellBox before = cells_around(grid, {2.5, 2.5, 1.5}, 0.1, Cell{1, 1, 1});
  EXPECT_EQ(before.low, (CellCounts{1, 1, 1}));
  EXPECT_EQ(before.more, (CellCounts{1, 1, 0}));
  const CellBox after = cells_around(grid, {7.5, 2.5, 1.5}, 0.1, Cell{8, 2, 1});
  EXPECT_EQ(after.low, (CellCounts{7, 2, 1}));
  EXPECT_EQ(after.more, (CellCounts{1, 0, 0}));
}

TEST(CellsWithin, CoverADistanceFromAnywhereInACell) {
  EXPECT_EQ(cells_within(grid, 0.99), (CellCounts{1, 1, 1}));
  EXPECT_EQ(cells_within(grid, 1.01), (CellCounts{2, 2, 2}));
  EXPECT_EQ(cells_within(grid, 100), grid.counts());
}

// A point of one cell and a point of another may be nearer than the distance.
TEST(CellBall, HoldsTheCellsThatComeNearer) {
  test::Random random(3);
  for (const CellGrid& of :
       {grid, CellGrid({9, 9, 9}, 0.4, 100000), CellGrid({2.1, 2.1, 20}, 1, 100)}) {
    const CellCounts cells = of.counts();
    for (const double distance : {0.4, 1.0, 1.5}) {
      const CellBall ball(of, distance);
      CellCounts centre;
      for (int axis = 0; axis < 3; ++axis) centre[axis] = random.below(cells[axis]);
      std::set<std::uint32_t> seen;
      ball.any_row(centre, [&](std::uint32_t first, std::uint32_t end) {
        for (std::uint32_t cell = first; cell < end; ++cell) seen.insert(cell);
        return false;
      });
      for (std::uint32_t cell = 0; cell < of.size(); ++cell) {
        const auto index = static_cast<std::int32_t>(cell);
        const CellCounts place = {index % cells[0], index / cells[0] % cells[1],
                                  index / cells[0] / cells[1]};
        double squares = 0;
        for (int axis = 0; axis < 3; ++axis) {
          const std::int32_t steps = steps_between(place[axis], centre[axis], cells[axis]);
          const double gap = std::max(0, steps - 1) * of.sides()[axis];
          squares += gap * gap;
          if (seen.contains(cell)) {
            EXPECT_LE(steps, ball.extent()[axis]);
          }
        }
        EXPECT_EQ(seen.contains(cell), squares < distance * distance) << cell << " of " << distance;
      }
    }
  }
}

// A cell comes near if any point of it does; of the nearest point each coordinate is as near as may
// be.
TEST(CellBall, KnowsWhichCellsComeNearAPosition) {
  test::Random random(4);
  int near = 0, tries = 0;
  for (const CellGrid& of :
       {grid, CellGrid({9, 9, 9}, 0.4, 100000), CellGrid({2.1, 2.1, 20}, 1, 9)}) {
    const CellCounts cells = of.counts();
    std::array<double, 3> box;
    for (int axis = 0; axis < 3; ++axis) box[axis] = of.sides()[axis] * cells[axis];
    const CellBall ball(of, 1.3);
    for (int n = 0; n < 3000; ++n) {
      std::array<double, 3> r;
      CellCounts cell;
      double squares = 0;
      for (int axis = 0; axis < 3; ++axis) {
        r[axis] = (3 * random.uniform() - 1) * box[axis];  // not always in the box
        cell[axis] = random.below(cells[axis]);
        double gap = std::numeric_limits<double>::infinity();
        for (int image = -2; image <= 2; ++image) {
          const double low = cell[axis] * of.sides()[axis] + image * box[axis];
          const double high = low + of.sides()[axis];
          gap = std::min(gap, std::max({0.0, low - r[axis], r[axis] - high}));
        }
        squares += gap * gap;
      }
      EXPECT_EQ(ball.comes_near(of.in_sides({r[0], r[1], r[2]}), cell), squares < 1.3 * 1.3);
      near += squares < 1.3 * 1.3;
      ++tries;
    }
  }
  EXPECT_GT(near, tries / 50);
  EXPECT_LT(near, tries / 2);
}

}  // namespace
}  // namespace needlework
