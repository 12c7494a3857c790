// Needles of similar length, for which one grid of cells will do.
//
// A search looks for partners as far away as the longest needle of a grid may reach. Among needles
// of very different lengths that is far for the short ones, and where these are many, there are
// many to look through. So species form classes, each with a grid of its own and with a bounding
// volume and sizes that suit it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "src/physics/gas.h"
#include "src/search/setup.h"

namespace needlework {

/// One class of needles and what the search chooses for it.
struct SizeClass {
  double longest = 0;     ///< largest extent of its needles [L]
  std::size_t count = 0;  ///< number of its needles
  BoundingVolume kind = BoundingVolume::cell;
  double cell_side = 0;       ///< wished for [L]
  double capsule_radius = 0;  ///< around the axis and its width; 0 for cells [L]
  double axis = 0;            ///< length of its longest axis [L]
  double diameter = 0;        ///< the largest one of its needles [L]
  /// Whether its capsules are balls, in which spheres stay through collisions.
  bool in_balls = false;
};

/// Index of the class of bodies of this extent [L]; the classes are listed from the longest on.
inline std::size_t class_of_extent(const std::vector<SizeClass>& classes, double extent) {
  std::size_t index = 0;
  while (index + 1 < classes.size() && extent <= classes[index + 1].longest) ++index;
  return index;
}

/// The classes of a gas, the longest first; at least one. If the setup gives a size, all needles
/// are in one class.
std::vector<SizeClass> size_classes(const Gas& gas, const SearchSetup& setup, BoundingVolume kind);

}  // namespace needlework
