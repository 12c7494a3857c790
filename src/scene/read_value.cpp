#include "src/scene/read_value.h"

#include <algorithm>

#include "src/scene/printable.h"

namespace needlework::from_value {

std::optional<double> number(const Value& value, const ValueRange& range) {
  std::optional<double> x;
  if (const auto* integer = value.as<std::int64_t>()) x = static_cast<double>(*integer);
  if (const auto* real = value.as<double>()) x = *real;
  return x && range.holds(*x) ? x : std::nullopt;
}

namespace {

template <std::size_t size>
std::optional<std::array<double, size>> numbers(const Value& value, const ValueRange& range) {
  const auto* components = value.as<Value::Array>();
  if (!components || components->size() != size) return std::nullopt;
  std::array<double, size> out{};
  for (std::size_t n = 0; n < size; ++n)
    if (!store(out[n], number((*components)[n], range))) return std::nullopt;
  return out;
}

}  // namespace

std::optional<std::array<double, 3>> three_numbers(const Value& value, const ValueRange& range) {
  return numbers<3>(value, range);
}

std::optional<std::array<double, 2>> two_numbers(const Value& value, const ValueRange& range) {
  return numbers<2>(value, range);
}

std::optional<std::uint64_t> whole_number(const Value& value, const ValueRange& range) {
  const auto* integer = value.as<std::int64_t>();
  if (!integer || *integer < 0 || !range.holds(static_cast<double>(*integer))) return std::nullopt;
  return static_cast<std::uint64_t>(*integer);
}

std::optional<bool> truth(const Value& value) {
  const auto* is = value.as<bool>();
  return is ? std::optional(*is) : std::nullopt;
}

std::optional<std::string> text(const Value& value) {
  const auto* string = value.as<std::string>();
  return string && is_printable(*string) ? std::optional(*string) : std::nullopt;
}

std::optional<std::string> one_of(const Value& value,
                                  std::initializer_list<std::string_view> names) {
  const auto name = text(value);
  const bool known = name && std::find(names.begin(), names.end(), *name) != names.end();
  return known ? name : std::nullopt;
}

}  // namespace needlework::from_value
