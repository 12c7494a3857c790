// The kinds of bounding volumes. What is not the same for all of them is in their files.
#pragma once

#include "src/search/in_capsules.h"
#include "src/search/in_cells.h"
#include "src/search/setup.h"

namespace needlework {

/// Calls act(InCells{}) or act(InCapsules{}): once for each search, never for a candidate.
template <class Act>
inline decltype(auto) with_volume(BoundingVolume kind, Act&& act) {
  return kind == BoundingVolume::capsule ? act(InCapsules{}) : act(InCells{});
}

}  // namespace needlework
