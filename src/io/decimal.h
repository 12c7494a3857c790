// Decimal numbers in text, read without rounding twice.
#pragma once

#include <charconv>
#include <cmath>
#include <string_view>
#include <system_error>

namespace needlework::io {

/// Sets `value` to the double nearest to the number that is the whole of `text`. Returns
/// invalid_argument if the text is not a finite number, and result_out_of_range if a double cannot
/// hold it.
inline std::errc read_decimal(std::string_view text, double& value) {
  // from_chars knows no leading plus.
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc()) return error;
  return stop == end && std::isfinite(value) ? std::errc() : std::errc::invalid_argument;
}

/// Whether a text is infinity, as programs write it.
inline bool is_infinite(std::string_view text) {
  return text == "inf" || text == "Inf" || text == "INF" || text == "+inf" || text == "Infinity";
}

}  // namespace needlework::io
