// The two numbers by which a needle is known: its place in storage, and its id.
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>

namespace needlework {

/// Place of a needle in storage, an index into every array of all needles. It changes when the
/// storage is sorted. Made from a number only explicitly, so that an id is never taken for a place.
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

/// The place of no needle.
inline constexpr Needle no_needle{};

/// What a needle is called, from its first state to every output. It never changes; neither the
/// numbers nor their order have to do with the storage.
struct Id {
  std::uint32_t value = 0;

  friend constexpr bool operator==(Id, Id) = default;
  friend constexpr auto operator<=>(Id, Id) = default;
};

/// Boxes added to a needle's recorded centre, per axis.
using Shift = std::array<std::int32_t, 3>;
/// a == b, without a call to memcmp.
inline bool same(const Shift& a, const Shift& b) {
  return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}
inline Shift operator-(const Shift& a) { return {-a[0], -a[1], -a[2]}; }
inline Shift operator-(const Shift& a, const Shift& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline Shift operator+(const Shift& a, const Shift& b) { return a - (-b); }

}  // namespace needlework
