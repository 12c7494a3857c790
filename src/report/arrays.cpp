#include "src/report/arrays.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "src/json/base64.h"

namespace needlework::report {

using Json = nlohmann::ordered_json;

Arrays::Arrays() = default;
Arrays::~Arrays() = default;

Json Arrays::add(std::span<const double> values, std::vector<std::size_t> shape) {
  return add_bytes("f64", std::as_bytes(values), shape);
}

Json Arrays::add(std::span<const float> values, std::vector<std::size_t> shape) {
  return add_bytes("f32", std::as_bytes(values), shape);
}

Json Arrays::add(std::span<const std::uint16_t> values, std::vector<std::size_t> shape) {
  return add_bytes("u16", std::as_bytes(values), shape);
}

Json Arrays::add(std::span<const std::int16_t> values, std::vector<std::size_t> shape) {
  return add_bytes("i16", std::as_bytes(values), shape);
}

Json Arrays::add_bytes(const char* type, std::span<const std::byte> bytes,
                       const std::vector<std::size_t>& shape) {
  const std::size_t number = blocks_.size();
  blocks_.push_back(fmt::format("<script type=\"text/plain\" id=\"array-{}\">{}</script>\n", number,
                                json::base64_of(bytes)));
  return {{"array", number}, {"type", type}, {"shape", shape}};
}

}  // namespace needlework::report
