// Subdomains: parts of the box, one for each thread.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace needlework {

/// Numbers of cells along the axes, or the position of a cell. Cells are indexed with x running
/// fastest.
using CellCounts = std::array<std::int32_t, 3>;

/// Cuts the box [L] in two along its longest side, and the parts again, until there are
/// `subdomains` parts of about equal weight. Returns the subdomain of each cell.
std::vector<std::uint32_t> divide_box(const CellCounts& cells, const std::array<double, 3>& box,
                                      const std::vector<std::size_t>& weight,
                                      std::uint32_t subdomains);

/// Cell counts along the axes whose multiples divide_box can cut into equal shares.
CellCounts multiples_to_divide(const std::array<double, 3>& box, std::uint32_t subdomains);

/// For each cell: whether all cells within `distance` along each axis are in its subdomain.
std::vector<std::uint8_t> inner_cells(const CellCounts& cells,
                                      const std::vector<std::uint32_t>& subdomain,
                                      const std::array<std::int32_t, 3>& distance);

}  // namespace needlework
