#include "src/scene/nesting.h"

namespace needlework {
namespace {

// The position behind the string whose opening quote is at `begin`, or behind all the text.
std::size_t skip_string(std::string_view toml, std::size_t begin) {
  const char quote = toml[begin];
  const bool escapes = quote == '"';
  const bool triple =
      begin + 2 < toml.size() && toml[begin + 1] == quote && toml[begin + 2] == quote;
  std::size_t quotes = 0;  // in a row
  for (std::size_t i = begin + (triple ? 3 : 1); i < toml.size(); ++i) {
    if (escapes && toml[i] == '\\') {
      ++i;
      quotes = 0;
    } else if (toml[i] == quote) {
      ++quotes;
      if (!triple) return i + 1;
      // Up to two quotes may stand directly before the closing three.
      const bool more = i + 1 < toml.size() && toml[i + 1] == quote;
      if (quotes >= 3 && (!more || quotes == 5)) return i + 1;
    } else {
      quotes = 0;
      if (toml[i] == '\n' && !triple) return i;
    }
  }
  return toml.size();
}

}  // namespace

std::optional<std::size_t> line_nested_too_deep(std::string_view toml) {
  std::size_t line = 1;
  std::size_t brackets = 0;
  std::size_t dots = 0;  // since the last character that ends a key
  for (std::size_t i = 0; i < toml.size();) {
    const std::size_t begin = i++;
    switch (toml[begin]) {
      case '#':
        while (i < toml.size() && toml[i] != '\n') ++i;
        break;
      case '"':
      case '\'':
        i = skip_string(toml, begin);
        for (const char c : toml.substr(begin, i - begin)) line += c == '\n';
        break;
      case '.':
        ++dots;
        break;
      case '\n':
        ++line;
        dots = 0;
        break;
      case '[':
      case '{':
        ++brackets;
        dots = 0;
        break;
      case ']':
      case '}':
        if (brackets > 0) --brackets;
        dots = 0;
        break;
      case ',':
      case '=':
        dots = 0;
        break;
      default:
        break;
    }
    if (brackets > max_nesting || dots > max_nesting) return line;
  }
  return std::nullopt;
}

}  // namespace needlework
