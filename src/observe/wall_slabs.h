// Slabs across the axes that have walls.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "needlework/scene.h"

namespace needlework::observe {

/// Equal slabs across one axis.
struct Slabs {
  std::size_t axis = 0;
  std::size_t count = 1;
  double begin = 0, thickness = 1;  ///< [L]

  /// The one that a place along the axis is in, if it is in any.
  std::optional<std::size_t> of(double place) const {
    const double number = (place - begin) / thickness;
    if (!(number >= 0 && number < static_cast<double>(count))) return std::nullopt;
    return static_cast<std::size_t>(number);
  }
  double middle(std::size_t slab) const {
    return begin + thickness * (static_cast<double>(slab) + 0.5);
  }
};

/// Of each axis with walls, in the order of the axes, as many slabs. Between two walls they fill
/// the room that the surfaces leave at any time of their motion. Over one wall they begin at its
/// surface, at its farthest from the gas, and go up to three edges of the box from where it is at
/// rest: needles fly as high as they get, and a gas that is drawn in the box comes to rest within
/// less. They are as many as output.grid has cells along the axis with walls where it has most;
/// without output.grid an eighth of the longest needle is as thick as they become, but they are 300
/// at most.
std::vector<Slabs> wall_slabs(const Scene& scene);

}  // namespace needlework::observe
