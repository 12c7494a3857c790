// Values separated by commas, as spreadsheets read them.
#pragma once

#include <string>

namespace needlework::cli {

/// A field as it is, or in quotation marks where it has a sign that would end it.
inline std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == text.npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + '"';
}

}  // namespace needlework::cli
