// Rejects text that the TOML parser (toml++ 3.3) cannot read safely.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace needlework {

/// No scene needs more than two levels.
inline constexpr std::size_t max_nesting = 16;

/// The reason why a text must not be parsed.
struct TomlHazard {
  std::size_t line;    ///< counted from 1
  std::string reason;  ///< contains "expected ..." and no control characters
};

/// The first hazard in a text, or nothing if the text is safe to parse, valid TOML or not. Text
/// after the first syntax error does not matter, because the parser stops there. Hazards are:
/// - Brackets or dotted keys more than `max_nesting` deep. The parser destroys tables recursively,
///   so that a key of some 100 kB of dots overflows the stack.
/// - Characters beyond ASCII outside quotes and comments, which are an error anyway, or after a
///   backslash that ends a line of a """string""", which is allowed. Deciding whether such a
///   character is white space, the parser runs into code that is marked as unreachable.
/// - Anything but an end after a value, which is an error anyway. After what begins like a date
///   with a time the parser looks ahead, even into strings.
std::optional<TomlHazard> find_toml_hazard(std::string_view toml);

}  // namespace needlework
