// Four floats at once, as every x86-64 has them and compilers know them without intrinsics.
#pragma once

#include <cstdint>
#include <cstring>

namespace needlework::kernels {

using Four [[gnu::vector_size(16)]] = float;
using FourInts [[gnu::vector_size(16)]] = std::int32_t;

inline Four four(float a) { return Four{a, a, a, a}; }
/// From any object of 16 bytes or more; its parts need not be floats.
inline Four load_four(const void* p) {
  Four out;
  std::memcpy(&out, p, sizeof out);
  return out;
}
inline void store_four(const Four& a, void* p) { std::memcpy(p, &a, sizeof a); }
inline void store_four(const FourInts& a, void* p) { std::memcpy(p, &a, sizeof a); }

inline Four larger(const Four& a, const Four& b) { return a > b ? a : b; }

/// Rows become columns.
inline void transpose(Four (&a)[4]) {
  const Four low_01 = __builtin_shufflevector(a[0], a[1], 0, 4, 1, 5);
  const Four high_01 = __builtin_shufflevector(a[0], a[1], 2, 6, 3, 7);
  const Four low_23 = __builtin_shufflevector(a[2], a[3], 0, 4, 1, 5);
  const Four high_23 = __builtin_shufflevector(a[2], a[3], 2, 6, 3, 7);
  a[0] = __builtin_shufflevector(low_01, low_23, 0, 1, 4, 5);
  a[1] = __builtin_shufflevector(low_01, low_23, 2, 3, 6, 7);
  a[2] = __builtin_shufflevector(high_01, high_23, 0, 1, 4, 5);
  a[3] = __builtin_shufflevector(high_01, high_23, 2, 3, 6, 7);
}

}  // namespace needlework::kernels
