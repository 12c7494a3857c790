// Makes text from outside safe to show in a message: without control characters, and not too long.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace needlework {

/// `text` with control characters, bidirectional marks and invalid UTF-8 replaced by escapes (\n,
/// \t, \x1b, \u202e). It is cut to at most `limit` bytes, the last three of which are then dots.
std::string printable(std::string_view text, std::size_t limit = std::string_view::npos);

/// Whether `text` is valid UTF-8 without anything that `printable` would escape.
bool is_printable(std::string_view text);

}  // namespace needlework
