// What a page holds, read back from its text.
#pragma once

#include <cstring>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "src/json/base64.h"
#include "tests/support/whole_file.h"

namespace needlework::test {

/// A page that `needlework report` has written.
class PageData {
 public:
  explicit PageData(const std::string& path) {
    text_ = bytes_of(path);
    json = nlohmann::json::parse(block("data"));
  }

  nlohmann::json json;
  const std::string& text() const { return text_; }

  /// What stands in the script block of this id, up to where a parser of HTML ends it.
  std::string block(const std::string& id) const {
    const auto head = text_.find("id=\"" + id + "\">");
    if (head == text_.npos) throw std::runtime_error("no block " + id);
    const auto begin = text_.find('>', head) + 1;
    return text_.substr(begin, text_.find("</script", begin) - begin);
  }

  /// The numbers of an array that JSON refers to.
  template <class Number>
  std::vector<Number> numbers(const nlohmann::json& reference) const {
    const auto bytes = json::bytes_of(block("array-" + reference.at("array").dump()));
    std::vector<Number> values(bytes.size() / sizeof(Number));
    std::memcpy(values.data(), bytes.data(), bytes.size());
    return values;
  }

 private:
  std::string text_;
};

}  // namespace needlework::test
