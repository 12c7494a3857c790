#include "src/json/base64.h"

#include <bit>
#include <boost/archive/iterators/base64_from_binary.hpp>
#include <boost/archive/iterators/binary_from_base64.hpp>
#include <boost/archive/iterators/dataflow_exception.hpp>
#include <boost/archive/iterators/transform_width.hpp>

namespace needlework::json {
namespace {

namespace iterators = boost::archive::iterators;
using ToText = iterators::base64_from_binary<iterators::transform_width<const char*, 6, 8>>;
using ToBytes = iterators::transform_width<iterators::binary_from_base64<const char*>, 8, 6>;

static_assert(std::endian::native == std::endian::little);

}  // namespace

std::string base64_of(std::span<const std::byte> bytes) {
  // Whole groups of three only: a partial one would be read beyond its end.
  std::vector<char> padded(bytes.size() + (3 - bytes.size() % 3) % 3);
  if (!bytes.empty()) std::memcpy(padded.data(), bytes.data(), bytes.size());
  std::string text(ToText(padded.data()), ToText(padded.data() + padded.size()));
  const std::size_t padding = padded.size() - bytes.size();
  text.replace(text.size() - padding, padding, padding, '=');
  return text;
}

std::vector<std::byte> bytes_of(std::string_view base64) {
  std::size_t padding = 0;
  while (padding < 2 && padding < base64.size() && base64[base64.size() - 1 - padding] == '=') {
    ++padding;
  }
  if (base64.size() % 4 != 0) throw std::invalid_argument("expected base64 with padding");
  std::string text(base64);
  text.replace(text.size() - padding, padding, padding, 'A');
  // Boost would take it for zero everywhere.
  if (text.find('=') != std::string::npos) throw std::invalid_argument("expected base64");
  try {
    const std::string bytes(ToBytes(text.data()), ToBytes(text.data() + text.size()));
    std::vector<std::byte> out(bytes.size() - padding);
    if (!out.empty()) std::memcpy(out.data(), bytes.data(), out.size());
    return out;
  } catch (const iterators::dataflow_exception&) {
    throw std::invalid_argument("expected base64");
  }
}

}  // namespace needlework::json
