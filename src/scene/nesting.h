// Guards the TOML parser's stack: it recurses into nested values and, when it lets go of a table,
// into dotted keys, so that a hostile file of some 100 kB could overflow it.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace needlework {

/// No scene needs more than two levels.
inline constexpr std::size_t max_nesting = 16;

/// The line (from 1) at which brackets are open, or a dotted key has dots, more than `max_nesting`
/// deep; none for text that is safe to parse. Looks at TOML up to its first syntax error and says
/// nothing about the text behind it.
std::optional<std::size_t> line_nested_too_deep(std::string_view toml);

}  // namespace needlework
