// Makes text from outside fit to be shown in a message: no control characters, not too long.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace needlework {

/// `text` with control characters, bidirectional marks and bytes that are no UTF-8 as escapes
/// (\n, \t, \x1b, \u202e), cut to at most `limit` bytes, the last three of which then are dots.
std::string printable(std::string_view text, std::size_t limit = std::string_view::npos);

/// Whether `text` is UTF-8 without anything that `printable` would escape.
bool is_printable(std::string_view text);

}  // namespace needlework
