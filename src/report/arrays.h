// The arrays of numbers of a page, each in a script block of its own beside the JSON that refers to
// them, so that the page decodes an array when it shows it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

namespace needlework::report {

class Arrays {
 public:
  Arrays();
  ~Arrays();
  Arrays(const Arrays&) = delete;
  Arrays& operator=(const Arrays&) = delete;

  /// Keeps the numbers and returns what JSON says of them, {"array": NUMBER, "type": "f64",
  /// "shape": [...]}. The product of `shape` is the number of values.
  nlohmann::ordered_json add(std::span<const double> values, std::vector<std::size_t> shape);
  nlohmann::ordered_json add(std::span<const float> values, std::vector<std::size_t> shape);
  nlohmann::ordered_json add(std::span<const std::uint16_t> values, std::vector<std::size_t> shape);
  nlohmann::ordered_json add(std::span<const std::int16_t> values, std::vector<std::size_t> shape);

  /// A script block for each array, in base64, little endian: <script type="text/plain"
  /// id="array-NUMBER">.
  const std::vector<std::string>& blocks() const { return blocks_; }

 private:
  nlohmann::ordered_json add_bytes(const char* type, std::span<const std::byte> bytes,
                                   const std::vector<std::size_t>& shape);

  std::vector<std::string> blocks_;
};

}  // namespace needlework::report
