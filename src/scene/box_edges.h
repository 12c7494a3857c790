// How long the edges of a box may be.
#pragma once

namespace needlework {

/// Least edge of a box [L] for needles of this length. Only in boxes of at least twice the needle
/// length is the nearest image the one in contact.
constexpr double least_edge(double length) { return 2.01 * length; }

/// In larger boxes positions could not resolve a needle. [L]
inline constexpr double largest_edge = 1e9;

}  // namespace needlework
