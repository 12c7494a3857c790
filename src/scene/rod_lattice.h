// Lattices of parallel rods, alone and in blocks that are crossed.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

namespace needlework {

/// Where rods may be: between the walls along axes that are not periodic.
struct LatticeBox {
  std::array<double, 3> low{}, high{};  ///< [L]
  std::array<bool, 3> periodic{true, true, true};
};

struct RodLattice {
  std::vector<std::array<double, 3>> position;  ///< centres [L]
  std::vector<std::array<double, 3>> director;  ///< along an axis of the box, of each rod
  double clearance = 0;                         ///< least distance of two axes over the diameter
};

/// The lattice with the most room between `count` parallel rods of this length and diameter;
/// nothing if there is none in which they do not overlap. Columns of rods are hexagonal, side by
/// side or in gaps of the layer below, or square with every second layer in the gaps of the first.
/// Spheres for which these have no room are on a face-centred cubic lattice with its axes along
/// those of the box, or in hexagonal layers. Sites that are too many are left empty, evenly. The
/// rods lie along `along`, an axis of the box, or along the best of them.
std::optional<RodLattice> rod_lattice(const LatticeBox& box, double length, double diameter,
                                      std::size_t count,
                                      std::optional<std::size_t> along = std::nullopt);

/// The box cut into eight blocks or more of about 16 rods or more, into which rods of any direction
/// fit, each with a lattice of parallel rods, which lie along x, y and z in turn. Blocks have the
/// same number of rods or one more. The order of all rods is small: 1/16 of eight blocks. Nothing
/// if the box is too small for that, or where rods overlap.
std::optional<RodLattice> crossed_rods(const LatticeBox& box, double length, double diameter,
                                       std::size_t count);

}  // namespace needlework
