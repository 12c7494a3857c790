#include "src/search/sizing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "src/search/box_cells.h"
#include "src/search/lengths.h"

namespace needlework {
namespace {

// Sizes for a density larger or smaller than that in use by this factor are worth the time that it
// takes to place all needles again: that of a third of a collision for each.
constexpr double worth_it = 2;
// Collisions per needle from one count to the next. A count takes as long as a few percent of one,
// so the number grows from the first to the second of these while densities differ by less than a
// tenth.
constexpr std::uint64_t least_apart = 2, most_apart = 8;
constexpr double hardly_changed = 0.1;
// Fewer pairs may have come together by chance.
constexpr double fewest_pairs = 50;
// About the side of the cells in which needles are counted, in lengths of the longest one.
constexpr double side_in_lengths = 2;

// Others near a needle, per cube of the longest one, on average over all needles. Counted by
// sorting, not in a grid, so that a box of any size will do.
double density_around(const Gas& gas, Time now) {
  const double length = gas.longest, side = side_in_lengths * length;
  double volume = 1;
  std::array<double, 3> count;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    count[axis] = std::clamp(std::floor(gas.box.edge(axis) / side), 1.0, 0x1p20);
    volume *= gas.box.edge(axis) / length / count[axis];
  }
  std::vector<std::uint64_t> cells = keys_of_cells(
      gas, now, count, [](const BoxCell& cell) { return cell[0] << 42 | cell[1] << 21 | cell[2]; });
  std::sort(cells.begin(), cells.end());
  double pairs = 0, before = 0;  // in this cell
  for (std::size_t n = 1; n < cells.size(); ++n) {
    before = cells[n] == cells[n - 1] ? before + 1 : 0;
    pairs += before;
  }
  if (pairs < fewest_pairs) return reduced_density(gas);
  return 2 * pairs / static_cast<double>(gas.size()) / volume;
}

}  // namespace

Sizing::Sizing(const Gas& gas, Time now) : density_(reduced_density(gas)) { look(0, gas, now); }

bool Sizing::look(std::uint64_t collisions, const Gas& gas, Time now) {
  const double density = density_around(gas, now);
  const bool changes = std::abs(density - last_count_) > hardly_changed * last_count_;
  apart_ = changes ? least_apart : std::min(2 * apart_, most_apart);
  last_count_ = density;
  next_ = collisions + std::max<std::uint64_t>(1, apart_ * gas.size() / 2);
  if (density < worth_it * density_ && density * worth_it > density_) return false;
  density_ = density;
  return true;
}

}  // namespace needlework
