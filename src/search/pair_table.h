// The pairs that a search follows, in the columns of the SIMD kernels.
#pragma once

#include <cstddef>
#include <vector>

#include "kernels/near_needles.h"

namespace needlework {

/// Columns for pairs, used again by each search of a thread.
class PairTable {
 public:
  /// Columns for so many pairs. They last until the next call.
  const kernels::PairColumns& columns_for(std::size_t count) {
    if (count >= capacity_) grow(count);
    return columns_;
  }
  /// Fills in the pairs of the seeker with the needles from number `begin` on, up to `end`, that it
  /// has found, all columns but `from`. May write to the columns of up to three pairs after these.
  static void fill(const kernels::PairColumns& pairs, const kernels::Seeker& seeker,
                   const kernels::Motion* motions, const kernels::CellView* cells,
                   const kernels::Found& found, std::size_t begin, std::size_t end);

 private:
  void grow(std::size_t count);

  std::vector<float> storage_;
  kernels::PairColumns columns_{};
  std::size_t capacity_ = 0;  ///< of pairs
};

}  // namespace needlework
