#include "src/serve/fields.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <string_view>

#include "src/json/base64.h"

namespace needlework::serve {

using json::bytes_of;
using json::rows_of;
namespace {

/// The value as messages quote it: a long one is cut off.
std::string shown(const Json& value) {
  constexpr std::size_t most = 60;
  const std::string text = value.dump(-1, ' ', false, Json::error_handler_t::replace);
  return text.size() <= most ? text : text.substr(0, most) + "...";
}

RequestError wrong(const char* field, const Json& value, std::string_view expected) {
  return RequestError(fmt::format("{} = {}: expected {}", field, shown(value), expected));
}

/// The array in a field, with rows as messages describe them.
template <class Row>
std::optional<std::vector<Row>> rows_in(const Json& request, const char* field, const char* row) {
  const std::optional<std::string> text = text_in(request, field);
  if (!text) return std::nullopt;
  try {
    return rows_of<Row>(*text, row);
  } catch (const std::invalid_argument& error) {
    throw RequestError(fmt::format("{} = {}: {}", field, shown(*text), error.what()));
  }
}

/// Null if the field is absent.
const Json* find(const Json& request, const char* field) {
  const auto found = request.find(field);
  return found == request.end() || found->is_null() ? nullptr : &*found;
}

}  // namespace

std::optional<double> number_in(const Json& request, const char* field) {
  const Json* value = find(request, field);
  if (!value) return std::nullopt;
  if (!value->is_number()) throw wrong(field, *value, "a number");
  return value->get<double>();
}

std::optional<std::uint64_t> count_in(const Json& request, const char* field) {
  const Json* value = find(request, field);
  if (!value) return std::nullopt;
  if (!value->is_number_unsigned()) throw wrong(field, *value, "a whole number >= 0");
  return value->get<std::uint64_t>();
}

std::optional<std::string> text_in(const Json& request, const char* field) {
  const Json* value = find(request, field);
  if (!value) return std::nullopt;
  if (!value->is_string()) throw wrong(field, *value, "a string");
  std::string text = value->get<std::string>();
  if (text.find('\0') != std::string::npos) throw wrong(field, *value, "text without zero bytes");
  return text;
}

bool flag_in(const Json& request, const char* field) {
  const Json* value = find(request, field);
  if (!value) return false;
  if (!value->is_boolean()) throw wrong(field, *value, "true or false");
  return value->get<bool>();
}

std::optional<std::vector<std::string>> names_in(const Json& request, const char* field,
                                                 std::span<const std::string_view> known) {
  const Json* value = find(request, field);
  if (!value) return std::nullopt;
  const auto is_known = [&](const Json& name) {
    return name.is_string() &&
           std::ranges::find(known, name.get_ref<const std::string&>()) != known.end();
  };
  if (!value->is_array() || value->empty() || !std::ranges::all_of(*value, is_known)) {
    throw wrong(field, *value, fmt::format("a list of some of {}", fmt::join(known, ", ")));
  }
  return value->get<std::vector<std::string>>();
}

std::optional<std::string> bytes_in(const Json& request, const char* field) {
  const std::optional<std::string> text = text_in(request, field);
  if (!text) return std::nullopt;
  try {
    const std::vector<std::byte> bytes = bytes_of(*text);
    return std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  } catch (const std::invalid_argument& error) {
    throw RequestError(fmt::format("{} = {}: {}", field, shown(*text), error.what()));
  }
}

std::optional<Bodies> bodies_in(const Json& request, const char* field) {
  const Json* value = find(request, field);
  if (!value) return std::nullopt;
  constexpr const char* expected = "an object of lists: name, length, diameter, mass, k, inertia";
  if (!value->is_object()) throw wrong(field, *value, expected);
  Bodies bodies;
  for (const auto& [key, list] : value->items()) {
    std::vector<double>* numbers = key == "length"     ? &bodies.length
                                   : key == "diameter" ? &bodies.diameter
                                   : key == "mass"     ? &bodies.mass
                                   : key == "k"        ? &bodies.k
                                   : key == "inertia"  ? &bodies.inertia
                                                       : nullptr;
    const bool are_names = key == "name";  // clang 14 captures no structured bindings
    const bool may_be_infinite = numbers == &bodies.mass || numbers == &bodies.inertia;
    const auto is_good = [&](const Json& each) {
      if (!numbers) return are_names && each.is_string();
      return each.is_number() || (may_be_infinite && each.is_null());
    };
    if (!list.is_array() || !std::ranges::all_of(list, is_good))
      throw wrong(field, *value, expected);
    if (numbers) {
      constexpr double infinity = std::numeric_limits<double>::infinity();
      for (const Json& each : list)
        numbers->push_back(each.is_null() ? infinity : each.get<double>());
    } else {
      bodies.names = list.get<std::vector<std::string>>();
    }
  }
  return bodies;
}

std::optional<std::vector<std::array<double, 3>>> vectors_in(const Json& request,
                                                             const char* field) {
  return rows_in<std::array<double, 3>>(request, field, "three numbers of 8 bytes");
}

std::optional<std::vector<std::array<std::int32_t, 3>>> images_in(const Json& request,
                                                                  const char* field) {
  return rows_in<std::array<std::int32_t, 3>>(request, field, "three whole numbers of 4 bytes");
}

std::optional<std::vector<std::uint32_t>> ids_in(const Json& request, const char* field) {
  return rows_in<std::uint32_t>(request, field, "one whole number of 4 bytes");
}

std::optional<std::vector<std::uint8_t>> species_in(const Json& request, const char* field) {
  return rows_in<std::uint8_t>(request, field, "one byte");
}

std::optional<std::vector<double>> numbers_in(const Json& request, const char* field,
                                              std::size_t count) {
  const Json* value = find(request, field);
  if (!value) return std::nullopt;
  if (value->is_number()) return std::vector<double>(count, value->get<double>());
  if (!value->is_string()) throw wrong(field, *value, "a number, or an array in base64");
  auto numbers = rows_in<double>(request, field, "one number of 8 bytes");
  if (numbers->size() != count)
    throw RequestError(fmt::format("{}: {} numbers: expected {}", field, numbers->size(), count));
  return numbers;
}

std::optional<std::array<double, 3>> three_in(const Json& request, const char* field) {
  const Json* value = find(request, field);
  if (!value) return std::nullopt;
  const auto is_number = [](const Json& each) { return each.is_number(); };
  if (!value->is_array() || value->size() != 3 || !std::ranges::all_of(*value, is_number))
    throw wrong(field, *value, "three numbers");
  return value->get<std::array<double, 3>>();
}

void require_only(const Json& request, std::initializer_list<const char*> fields,
                  std::span<const std::string_view> more) {
  for (const auto& [name, value] : request.items()) {
    if (name == "do" || name == "id") continue;
    if (std::find(fields.begin(), fields.end(), name) != fields.end()) continue;
    if (std::find(more.begin(), more.end(), name) != more.end()) continue;
    std::vector<std::string_view> all = {"do", "id"};
    all.insert(all.end(), fields.begin(), fields.end());
    all.insert(all.end(), more.begin(), more.end());
    throw RequestError(fmt::format("{} = {}: expected one of the fields {}", name, shown(value),
                                   fmt::join(all, ", ")));
  }
}

}  // namespace needlework::serve
