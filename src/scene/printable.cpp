#include "src/scene/printable.h"

#include <fmt/format.h>

#include <cstdint>

namespace needlework {
namespace {

struct CodePoint {
  std::uint32_t value;  // set only if valid
  std::size_t bytes;    // 1 if invalid
  bool valid;
};

// The first code point of a text that is not empty. Overlong forms and surrogates are invalid.
CodePoint first_code_point(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const CodePoint invalid{0, 1, false};
  const unsigned lead = byte(0);
  if (lead < 0x80) return {lead, 1, true};
  const std::size_t bytes = lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : 2;
  if (lead < 0xc2 || lead > 0xf4 || text.size() < bytes) return invalid;
  std::uint32_t value = lead & (0x7fu >> bytes);
  for (std::size_t i = 1; i < bytes; ++i) {
    if ((byte(i) & 0xc0u) != 0x80u) return invalid;
    value = value << 6 | (byte(i) & 0x3fu);
  }
  const std::uint32_t least = bytes == 4 ? 0x10000 : bytes == 3 ? 0x800 : 0x80;
  const bool surrogate = value >= 0xd800 && value < 0xe000;
  if (value < least || value > 0x10ffff || surrogate) return invalid;
  return {value, bytes, true};
}

// Whether it is a control character, a line separator or a mark that changes the direction of the
// text.
bool needs_escape(std::uint32_t c) {
  return c < 0x20 || (c >= 0x7f && c < 0xa0) || (c >= 0x2028 && c <= 0x202e) ||
         (c >= 0x2066 && c <= 0x2069) || c == 0xfeff;
}

std::string escaped(CodePoint c, unsigned char first_byte) {
  if (!c.valid || c.value < 0x80) {
    if (first_byte == '\n') return "\\n";
    if (first_byte == '\r') return "\\r";
    if (first_byte == '\t') return "\\t";
    return fmt::format("\\x{:02x}", first_byte);
  }
  return fmt::format("\\u{:04x}", c.value);
}

}  // namespace

std::string printable(std::string_view text, std::size_t limit) {
  constexpr std::string_view dots = "...";
  std::string out;
  std::size_t cut = 0;  // length to which `out` is cut if dots have to follow
  while (!text.empty()) {
    const CodePoint c = first_code_point(text);
    if (c.valid && !needs_escape(c.value))
      out += text.substr(0, c.bytes);
    else
      out += escaped(c, static_cast<unsigned char>(text[0]));
    text.remove_prefix(c.bytes);
    if (out.size() > limit) return out.substr(0, cut) + std::string(dots);
    if (out.size() + dots.size() <= limit) cut = out.size();
  }
  return out;
}

bool is_printable(std::string_view text) {
  while (!text.empty()) {
    const CodePoint c = first_code_point(text);
    if (!c.valid || needs_escape(c.value)) return false;
    text.remove_prefix(c.bytes);
  }
  return true;
}

}  // namespace needlework
