// "Did you mean": the known word closest to an unknown one.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

namespace needlework {

/// Number of insertions, deletions, changes and swaps of neighbours that turn `a` into `b`. Case
/// is ignored, and '-' equals '_'.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The word closest to `unknown`, or the first of several. Empty if more than a third of the
/// letters (rounded, at least one) would have to change.
std::string_view nearest_word(std::string_view unknown, std::span<const std::string_view> known);

}  // namespace needlework
