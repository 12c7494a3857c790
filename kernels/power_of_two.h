// Exact scaling by powers of two, without the calls that std::ldexp and std::ilogb are.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

namespace needlework {

/// std::ilogb of finite a > 0.
inline int exponent_of(double a) {
  const int biased = static_cast<int>(std::bit_cast<std::uint64_t>(a) >> 52 & 0x7ff);
  return biased != 0 ? biased - 1023 : std::ilogb(a);
}

/// std::ldexp(a, exponent).
inline double times_power_of_two(double a, int exponent) {
  if (exponent < -1022 || exponent > 1023) return std::ldexp(a, exponent);
  return a * std::bit_cast<double>(static_cast<std::uint64_t>(exponent + 1023) << 52);
}

}  // namespace needlework
