// How long the edges of a box may be.
#pragma once

#include <array>

namespace needlework {

/// Least edge of a periodic box [L] for needles of this length. Only in boxes of at least twice the
/// needle length is the nearest image the one in contact.
constexpr double least_edge(double length) { return 2.01 * length; }

/// What lengths count as where needles slide on each other: those in contact are found within a
/// little more than their lengths (most_departure in src/physics/slides.h).
inline constexpr double length_with_sliding = 1.0625;

/// Largest edge of a box [L] for needles of this length: in larger ones positions could not resolve
/// a needle.
constexpr double largest_edge(double length) { return length < 1 ? 1e9 * length : 1e9; }

/// Whether two needles or more have so much room that a mean free time, in which the clock counts,
/// is too long to resolve the time in which a needle flies its own length.
inline bool is_too_sparse(const std::array<double, 3>& box, double count, double length) {
  const double per_cube = count * (length / box[0]) * (length / box[1]) * (length / box[2]);
  return count >= 2 && per_cube < 1e-13;
}
inline constexpr const char* not_too_sparse =
    "a smaller one: at least 1e-13 needles per cube of their length";

}  // namespace needlework
