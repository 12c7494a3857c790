// Arrays as text in JSON: their bytes, little endian, in base64 (RFC 4648, with padding).
#pragma once

#include <array>
#include <cstddef>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace needlework::serve {

std::string base64_of(std::span<const std::byte> bytes);
/// Throws std::invalid_argument if the text is not base64.
std::vector<std::byte> bytes_of(std::string_view base64);

template <class Row>
std::string text_of(const std::vector<Row>& rows) {
  return base64_of(std::as_bytes(std::span(rows)));
}

/// Throws std::invalid_argument if the text is not base64 of whole rows.
std::vector<std::array<double, 3>> rows_of(std::string_view base64);

}  // namespace needlework::serve
