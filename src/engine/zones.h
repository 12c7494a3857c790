// Zones: parts of the box, one for each thread.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace needlework {

/// A grid of cells, numbered with x running fastest.
using CellCounts = std::array<std::int32_t, 3>;

/// Cuts the box [L] in two along its longest side, and the parts again, until there are so many
/// zones; each gets about its share of the weight. Returns the zone of each cell.
std::vector<std::uint32_t> divide_box(const CellCounts& cells, const std::array<double, 3>& box,
                                      const std::vector<std::size_t>& weight, std::uint32_t zones);

/// Counts of cells along the axes whose multiples divide_box can cut in equal shares.
CellCounts multiples_to_divide(const std::array<double, 3>& box, std::uint32_t zones);

/// Of each cell, whether all within `distance` cells of it along the axes are of its zone.
std::vector<std::uint8_t> inner_cells(const CellCounts& cells,
                                      const std::vector<std::uint32_t>& zone,
                                      const std::array<std::int32_t, 3>& distance);

}  // namespace needlework
