// The pairs that a search follows, in the columns of the SIMD kernels.
#pragma once

#include <cstddef>
#include <vector>

#include "kernels/near_needles.h"

namespace needlework {

/// Columns for pairs, used again by each search of a thread.
class PairTable {
 public:
  /// Fills in the pairs of the seeker with the first `count` needles that it has found, all columns
  /// but `from`. The columns last until the next call.
  kernels::PairColumns fill(const kernels::Seeker& seeker, const kernels::Motion* motions,
                            const kernels::CellView* cells, const kernels::Found& found,
                            std::size_t count);

 private:
  std::vector<float> storage_;
  std::size_t capacity_ = 0;
};

}  // namespace needlework
