// "Did you mean": the known word nearest to an unknown one.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

namespace needlework {

/// Insertions, deletions, changes and swaps of neighbours that turn `a` into `b`; capital letters
/// equal small ones and '-' equals '_'.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The word nearest to `unknown`, the first of equals; empty when more than a third of the letters
/// (rounded, at least one) would have to change.
std::string_view nearest_word(std::string_view unknown, std::span<const std::string_view> known);

}  // namespace needlework
