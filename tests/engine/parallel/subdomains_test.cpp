#include "src/engine/subdomains.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <numeric>

#include "src/search/cell_grid.h"
#include "tests/support/random.h"

namespace needlework {
namespace {

std::size_t size_of(const CellCounts& cells) {
  return static_cast<std::size_t>(cells[0]) * cells[1] * cells[2];
}

/// For cells of side 1.
std::array<double, 3> box_of(const CellCounts& cells) {
  return {static_cast<double>(cells[0]), static_cast<double>(cells[1]),
          static_cast<double>(cells[2])};
}

CellCounts place_of(std::size_t index, const CellCounts& cells) {
  const auto i = static_cast<std::int32_t>(index);
  return {i % cells[0], i / cells[0] % cells[1], i / cells[0] / cells[1]};
}

std::int32_t steps_between(std::int32_t a, std::int32_t b, std::int32_t n) {
  const std::int32_t d = std::abs(a - b);
  return std::min(d, n - d);
}

TEST(Subdomains, GetTheirShareOfTheNeedles) {
  test::Random random(1);
  for (const CellCounts cells : {CellCounts{12, 12, 12}, {40, 3, 7}, {1, 1, 64}}) {
    std::vector<std::size_t> weight(size_of(cells));
    for (auto& w : weight) w = 5 + random.below(10);
    const std::size_t total = std::accumulate(weight.begin(), weight.end(), std::size_t{0});
    for (const std::uint32_t subdomains : {1u, 2u, 3u, 8u}) {
      const std::vector<std::uint32_t> subdomain =
          divide_box(cells, box_of(cells), weight, subdomains);
      std::vector<std::size_t> share(subdomains);
      for (std::size_t c = 0; c < subdomain.size(); ++c) share.at(subdomain[c]) += weight[c];
      for (const std::size_t s : share) {
        EXPECT_NEAR(static_cast<double>(s) * subdomains / static_cast<double>(total), 1, 0.35)
            << subdomains << " subdomains of " << cells[0];
      }
    }
  }
}

// If subdomains can have equal numbers of cells, they do, to within one cell.
TEST(Subdomains, AreEqualWhereCellsAllowIt) {
  int seen = 0;
  for (const std::array<double, 3> box :
       {std::array{24.0, 24.0, 24.0}, {100, 4, 4}, {3, 50, 40}, {10, 20, 15}}) {
    for (const std::uint32_t subdomains : {1u, 2u, 3u, 4u, 5u, 6u, 8u, 12u}) {
      const CellCounts multiples = multiples_to_divide(box, subdomains);
      EXPECT_LE(*std::max_element(multiples.begin(), multiples.end()), 12);
      const double longest = *std::max_element(box.begin(), box.end());
      for (int along = 12; along <= 40; ++along) {
        const CellCounts cells = CellGrid(box, longest / along, 1000000, multiples).counts();
        bool rounded = true;
        for (int axis = 0; axis < 3; ++axis) rounded &= cells[axis] % multiples[axis] == 0;
        if (!rounded) continue;
        ++seen;
        const std::vector<std::uint32_t> subdomain =
            divide_box(cells, box, std::vector<std::size_t>(size_of(cells), 1), subdomains);
        for (std::uint32_t z = 0; z < subdomains; ++z) {
          ASSERT_EQ(static_cast<std::size_t>(std::count(subdomain.begin(), subdomain.end(), z)) *
                        subdomains,
                    subdomain.size())
              << subdomains << " subdomains of " << cells[0] << " x " << cells[1] << " x "
              << cells[2];
        }
      }
    }
  }
  EXPECT_GT(seen, 600);
  EXPECT_EQ(multiples_to_divide({9, 9, 9}, 2), (CellCounts{1, 1, 2}));
  EXPECT_EQ(multiples_to_divide({9, 9, 9}, 8), (CellCounts{2, 2, 2}));
  EXPECT_EQ(multiples_to_divide({900, 9, 9}, 7), (CellCounts{7, 1, 1}));
}

TEST(Subdomains, MayBeMoreThanTheCells) {
  const std::vector<std::uint32_t> subdomain = divide_box({1, 1, 2}, {1, 1, 2}, {1, 1}, 8);
  EXPECT_NE(subdomain[0], subdomain[1]);
  EXPECT_LT(subdomain[0], 8u);
  EXPECT_LT(subdomain[1], 8u);
}

TEST(Subdomains, KnowTheirInnerCells) {
  const CellCounts cells{9, 8, 10}, distance{2, 1, 3};
  const std::vector<std::uint32_t> subdomain =
      divide_box(cells, box_of(cells), std::vector<std::size_t>(size_of(cells), 1), 3);
  const std::vector<std::uint8_t> inner = inner_cells(cells, subdomain, distance);
  int count = 0;
  for (std::size_t a = 0; a < subdomain.size(); ++a) {
    bool alone = true;
    for (std::size_t b = 0; b < subdomain.size(); ++b) {
      const CellCounts x = place_of(a, cells), y = place_of(b, cells);
      bool close = true;
      for (int i = 0; i < 3; ++i) close &= steps_between(x[i], y[i], cells[i]) <= distance[i];
      alone &= !close || subdomain[a] == subdomain[b];
    }
    EXPECT_EQ(inner[a], alone) << a;
    count += inner[a];
  }
  EXPECT_GT(count, 0);
}

}  // namespace
}  // namespace needlework
