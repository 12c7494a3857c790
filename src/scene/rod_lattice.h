// Lattices of parallel rods.
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
  std::array<double, 3> director{};             ///< along an axis of the box
  double clearance = 0;                         ///< least distance of two axes over the diameter
};

/// The lattice with the most room between `count` parallel rods of this length and diameter;
/// nothing if there is none in which they do not overlap. Columns of rods are hexagonal, side by
/// side or in gaps of the layer below, or square with every second layer in the gaps of the first,
/// which is the face-centred cubic lattice of spheres. Sites that are too many are left empty,
/// evenly.
std::optional<RodLattice> rod_lattice(const LatticeBox& box, double length, double diameter,
                                      std::size_t count);

}  // namespace needlework
