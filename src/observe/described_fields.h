// Fields of a series for the numbers of results, under the names that they have everywhere.
#pragma once

#include <concepts>
#include <cstddef>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "needlework/described.h"
#include "needlework/series.h"
#include "src/observe/observable.h"

namespace needlework::observe {

/// Takes every number of a result.
struct EveryNumber {
  bool operator()(std::string_view) const { return true; }
};

/// A field for each number whose name is `taken`, in their order; of this shape, where there is a
/// row of such numbers for each of several objects. An array has the extent `parts`.
template <class Sums, class Taken = EveryNumber>
std::vector<SeriesField> fields_of(const Sums& sums,
                                   const std::vector<SeriesField::Extent>& shape = {},
                                   Taken taken = {}, const char* parts = "") {
  std::vector<SeriesField> out;
  sums.for_each([&](const Described& number, const auto& value) {
    using Value = std::decay_t<decltype(value)>;
    if (!taken(number.name)) return;
    out.push_back({number.name, number.meaning, number.unit, shape});
    SeriesField& field = out.back();
    if constexpr (std::integral<Value>) {
      field.kind = SeriesField::Kind::count;
    } else if constexpr (!std::floating_point<Value>) {
      field.shape.push_back({parts, value.size()});
    }
  });
  return out;
}

/// Puts these numbers of each object into the row: all of the first name, then all of the second.
template <class Sums, class Taken = EveryNumber>
void put_numbers(Row& row, const std::vector<Sums>& objects, Taken taken = {}) {
  std::size_t names = 0;
  Sums{}.for_each([&](const Described&, const auto&) { ++names; });
  for (std::size_t wanted = 0; wanted < names; ++wanted) {
    for (const Sums& object : objects) {
      std::size_t n = 0;
      object.for_each([&](const Described& number, const auto& value) {
        if (n++ == wanted && taken(number.name)) row.put(static_cast<double>(value));
      });
    }
  }
}

/// Puts the numbers of a result into the row.
template <class Sums>
void put_numbers(Row& row, const Sums& sums) {
  sums.for_each([&](const Described&, const auto& value) {
    if constexpr (std::is_arithmetic_v<std::decay_t<decltype(value)>>) {
      row.put(static_cast<double>(value));
    } else {
      row.put_all(value);
    }
  });
}

}  // namespace needlework::observe
