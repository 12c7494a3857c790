#include "src/search/sizing.h"

#include <limits>
#include <vector>

#include "src/search/cell_grid.h"

namespace needlework {
namespace {

// Sizes for another density than this times that in use, or its inverse, are worth the time that it
// takes to place all needles anew: that of a third of a collision for each.
constexpr double worth_it = 2;
// Fewer needles may come together by chance, and are soon searched anyhow.
constexpr std::size_t fewest = 64;
// Side of the cells in which needles are counted. [L]
constexpr double side = 2;

// Others near a needle, per L^3, on average over all needles.
double density_around(const Gas& gas) {
  const CellGrid grid(gas.box, side, gas.size());
  std::vector<std::uint32_t> count(grid.size());
  for (const Record& record : gas.records) ++count[grid.index_of(grid.cell_of(record.flight.r))];
  double pairs = 0;
  for (const double n : count) pairs += n * (n - 1);
  return pairs / static_cast<double>(gas.size()) / grid.cell_volume();
}

}  // namespace

Sizing::Sizing(const Gas& gas) : needles_(gas.size()), density_(gas.density()) {
  if (needles_ < fewest) {
    next_ = std::numeric_limits<std::uint64_t>::max();
  } else {
    take(density_around(gas));
  }
}

bool Sizing::take(double density) {
  if (density < worth_it * density_ && density * worth_it > density_) return false;
  density_ = density;
  return true;
}

bool Sizing::look(std::uint64_t collisions, const Counters& counters, double cell_volume) {
  next_ = collisions + needles_;
  // A needle is found in its own cell, too.
  const double found = static_cast<double>(counters.candidates - candidates_) -
                       static_cast<double>(counters.searches - searches_);
  const double volume = cell_volume * static_cast<double>(counters.cells - cells_);
  searches_ = counters.searches;
  candidates_ = counters.candidates;
  cells_ = counters.cells;
  return volume > 0 && found > 0 && take(found / volume);
}

}  // namespace needlework
