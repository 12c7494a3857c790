// Arrays as text in JSON: their bytes, little endian, in base64 (RFC 4648, with padding).
#pragma once

#include <cstddef>
#include <cstring>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace needlework::json {

std::string base64_of(std::span<const std::byte> bytes);
/// Throws std::invalid_argument if the text is not base64.
std::vector<std::byte> bytes_of(std::string_view base64);

template <class Row>
std::string text_of(const std::vector<Row>& rows) {
  return base64_of(std::as_bytes(std::span(rows)));
}

/// Throws std::invalid_argument, "expected ROW for each needle, in base64", if the text is not
/// base64 of whole rows.
template <class Row>
std::vector<Row> rows_of(std::string_view base64, std::string_view row) {
  const std::vector<std::byte> bytes = bytes_of(base64);
  if (bytes.size() % sizeof(Row) != 0) {
    throw std::invalid_argument("expected " + std::string(row) + " for each needle, in base64");
  }
  std::vector<Row> rows(bytes.size() / sizeof(Row));
  if (!rows.empty()) std::memcpy(rows.data(), bytes.data(), bytes.size());
  return rows;
}

}  // namespace needlework::json
