// How files hold the sums over all needles.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

#include "needlework/totals.h"
#include "src/io/hdf5.h"

namespace needlework::io {

/// What a pointer to a member of Totals points to.
template <class Value>
Value value_of(Value Totals::*);
template <class Member>
using ValueOf = decltype(value_of(std::declval<Member>()));

/// The type of the numbers of a value in files, and the shape of a row.
template <class Value>
struct InFile {
  static_assert(std::is_arithmetic_v<Value>);
  // Counts are signed, because NumPy converts uint64 and int64 in one expression to floating point.
  using Number = std::conditional_t<std::is_integral_v<Value>, std::int64_t, double>;
  static hdf5::Shape shape() { return {}; }
};
template <class Each, std::size_t size>
struct InFile<std::array<Each, size>> {
  using Number = typename InFile<Each>::Number;
  static hdf5::Shape shape() { return {size}; }
};

/// Totals::for_each_sum() for those that change with velocities, which counts do not.
template <class Visit>
void for_each_of_velocities(const Visit& visit) {
  Totals::for_each_sum([&](const Described& sum, auto member) {
    if constexpr (!std::is_integral_v<ValueOf<decltype(member)>>) visit(sum, member);
  });
}

}  // namespace needlework::io
