// The two numbers of a needle: its place in storage, and its id.
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>

namespace needlework {

/// The place of a needle in storage, which is an index into every array of all needles. It changes
/// when the storage is sorted. Conversion from a number is explicit, so that an id is never used
/// as a place.
struct Needle {
  std::uint32_t index = 0xffffffff;

  constexpr Needle() = default;
  constexpr explicit Needle(std::size_t place) : index(static_cast<std::uint32_t>(place)) {}

  constexpr operator std::size_t() const { return index; }
  constexpr Needle& operator++() {
    ++index;
    return *this;
  }
  friend constexpr bool operator==(Needle, Needle) = default;
  friend constexpr auto operator<=>(Needle, Needle) = default;
};

/// Stands for no needle.
inline constexpr Needle no_needle{};

/// The permanent number of a needle, from its first state to every output. Ids need not be
/// consecutive, and their order is independent of the storage.
struct Id {
  std::uint32_t value = 0;

  friend constexpr bool operator==(Id, Id) = default;
  friend constexpr auto operator<=>(Id, Id) = default;
};

/// Number of boxes added to a needle's recorded centre along each axis.
using Shift = std::array<std::int32_t, 3>;
/// a == b, without a call of memcmp.
inline bool same(const Shift& a, const Shift& b) {
  return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}
inline Shift operator-(const Shift& a) { return {-a[0], -a[1], -a[2]}; }
inline Shift operator-(const Shift& a, const Shift& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline Shift operator+(const Shift& a, const Shift& b) { return a - (-b); }

}  // namespace needlework
