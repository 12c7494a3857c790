// Sums over the motions of all needles: the same bits in any order, and so on any number of
// threads.
#pragma once

#include <array>
#include <atomic>
#include <vector>

#include "src/memory/large_array.h"
#include "src/physics/record.h"

namespace needlework {

/// Sums over all needles of v^2, w^2 and the components of v; infinite where a term is.
struct MotionSums {
  double v2 = 0, w2 = 0;
  std::array<double, 3> v{};
};

/// Computes these sums. A term is rounded to a grid that depends on the largest one
/// (exact_sum.h). The grids of the last sums are nearly always those of the next, so that one pass
/// over the records does; else there is a second one.
class MotionSummation {
 public:
  /// `threads`: how many share the work, if it is enough for them. May be called by several threads
  /// at once.
  MotionSums of(const LargeArray<Record>& records, int threads) const;

 private:
  static constexpr std::size_t terms = 5;
  struct Part;

  mutable std::array<std::atomic<double>, terms> largest_{};  ///< terms of the last sums
};

}  // namespace needlework
