// How long the edges of a box may be.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>

namespace needlework {

/// Least edge of a box [L] for needles of this length. Only in boxes of at least twice the needle
/// length is the nearest image the one in contact.
constexpr double least_edge(double length) { return 2.01 * length; }

/// Largest edge of a box [L] for needles of this length: in larger ones positions could not resolve
/// a needle.
constexpr double largest_edge(double length) { return length < 1 ? 1e9 * length : 1e9; }

inline bool has_room(const std::array<double, 3>& box, double length) {
  return std::ranges::all_of(
      box, [&](double edge) { return edge >= least_edge(length) && edge <= largest_edge(length); });
}

/// Whether two needles or more have so much room that a mean free time, in which the clock counts,
/// is too long to resolve the time in which a needle flies its own length.
inline bool is_too_sparse(const std::array<double, 3>& box, double count, double length) {
  const double per_cube = count * (length / box[0]) * (length / box[1]) * (length / box[2]);
  return count >= 2 && per_cube < 1e-13;
}
inline constexpr const char* not_too_sparse =
    "a smaller one: at least 1e-13 needles per cube of their length";

/// What messages expect of a box that has none for needles of this length.
inline std::string expected_room(const std::array<double, 3>& box, double length) {
  const double least = least_edge(length), most = largest_edge(length);
  if (std::ranges::any_of(box, [&](double edge) { return edge < least; }))
    return fmt::format("edges of at least {:.10g} (2.01 needle lengths)", least);
  return fmt::format("edges of at most {:.10g} (1e9 needle lengths)", most);
}

}  // namespace needlework
