// Where the bits set in a byte are: a table to pack the lanes of a vector.
#pragma once

#include <cstdint>

namespace needlework::kernels {

struct SetBits {
  std::uint8_t place[256][8] = {};  ///< of each, the lowest first; then 0
  std::uint8_t rank[256][8] = {};   ///< how many are set below each place
};

inline constexpr SetBits set_bits = [] {
  SetBits out;
  for (int bits = 0; bits < 256; ++bits) {
    for (int place = 0, n = 0; place < 8; ++place) {
      out.rank[bits][place] = static_cast<std::uint8_t>(n);
      if (bits >> place & 1) out.place[bits][n++] = static_cast<std::uint8_t>(place);
    }
  }
  return out;
}();

}  // namespace needlework::kernels
