// Keeps from the TOML parser (toml++ 3.3) the text that it cannot read safely.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace needlework {

/// No scene needs more than two levels.
inline constexpr std::size_t max_nesting = 16;

/// Why a text must not be parsed.
struct TomlHazard {
  std::size_t line;    ///< from 1
  std::string reason;  ///< without control characters, "expected ..." in it
};

/// The first hazard in a text; none in text that is safe to parse, be it TOML or not. Text behind
/// the first syntax error does not matter, as the parser gives up there. Hazards are
/// - brackets or dotted keys more than `max_nesting` deep: the parser lets go of tables by
///   recursion, so that a key of some 100 kB full of dots overflows the stack;
/// - characters beyond ASCII outside quotes and comments, which are an error anyway, or after a
///   backslash that ends a line of a """string""", which is allowed: asked whether such a character
///   is white space, the parser reaches code that is marked as unreachable;
/// - anything but an end behind a value, which is an error anyway: behind what begins as a date and
///   its time the parser looks ahead, into strings as well.
std::optional<TomlHazard> find_toml_hazard(std::string_view toml);

}  // namespace needlework
