// The two numbers of a needle: its place in storage, and its id.
#pragma once

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

}  // namespace needlework
