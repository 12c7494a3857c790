// The columns in which kernels, or a list, put the needles that they have found.
#pragma once

#include <cstdint>
#include <vector>

#include "kernels/near_needles.h"

namespace needlework {

class FoundColumns {
 public:
  /// Has room for so many needles, and the block more that kernels write.
  void make_room(std::size_t needles) {
    const std::size_t room = needles + kernels::block_size;
    if (2 * room > columns_.size()) columns_.resize(4 * room);
  }
  kernels::Found from(std::size_t begin) {
    return {columns_.data() + begin, columns_.data() + columns_.size() / 2 + begin};
  }

  const std::uint32_t* cells() const { return columns_.data() + columns_.size() / 2; }

 private:
  std::vector<std::uint32_t> columns_;  ///< needles, then their views, each in one half
};

}  // namespace needlework
