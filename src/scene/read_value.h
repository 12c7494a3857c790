// Reads values of TOML into members of a scene: nothing if a value has another type, or is out of
// range.
#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "src/scene/entry.h"
#include "src/scene/section.h"

namespace needlework::from_value {

/// Stores a value that was read. Returns false if there is none.
template <typename T, typename U>
bool store(T& target, std::optional<U> value) {
  if (!value) return false;
  target = static_cast<T>(*std::move(value));
  return true;
}

std::optional<double> number(const Value& value, const ValueRange& range);
std::optional<std::array<double, 3>> three_numbers(const Value& value, const ValueRange& range);
std::optional<std::array<double, 2>> two_numbers(const Value& value, const ValueRange& range);
std::optional<std::uint64_t> whole_number(const Value& value, const ValueRange& range);
std::optional<bool> truth(const Value& value);
std::optional<std::string> text(const Value& value);
std::optional<std::string> one_of(const Value& value,
                                  std::initializer_list<std::string_view> names);

}  // namespace needlework::from_value
