// What a run asks of its search.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "kernels/isa.h"

namespace needlework {

/// The region in which a needle stays for a while: its cell and some space around it, or a capsule
/// around the needle.
enum class BoundingVolume { cell, capsule };

struct SearchSetup {
  kernels::Isa isa = kernels::Isa::scalar;
  /// Needles per cube of the longest one, by which the search chooses what follows; absent: that of
  /// the gas in its box.
  std::optional<double> density;
  std::optional<double> cell_side;       ///< least side of cells; absent: the search chooses [L]
  std::optional<double> capsule_radius;  ///< absent: the search chooses [L]
  /// Whether each size class of a mixture has the bounding volume that suits it, and not all the
  /// same.
  bool by_class = false;
  bool float_filter = true;  ///< see needlework/accuracy.h
  /// Whether a search that suits it may keep lists of neighbours. They are those of one thread.
  bool keep_lists = false;
  /// Where the search chooses its cells, their counts along the axes are multiples of these if
  /// near.
  std::array<std::int32_t, 3> count_multiples = {1, 1, 1};
};

}  // namespace needlework
