// Numbers of results in the structures of C, which tests/results/declare.py writes in the order
// of their lists: eight bytes each, and arrays of such.
#pragma once

#include <cstddef>
#include <cstring>
#include <numeric>
#include <stdexcept>
#include <type_traits>
#include <vector>

#include "needlework/described.h"

namespace needlework::c {

/// Copies the numbers of a result to the last members of a structure, those from `first` on; of an
/// array whose length is not fixed the sum.
template <class Sums, class Struct, class First>
void copy_numbers(const Sums& sums, Struct& to, First Struct::*first) {
  static_assert(std::is_trivially_copyable_v<Struct>);
  std::vector<unsigned char> bytes;
  const auto add = [&](const auto& value) {
    static_assert(sizeof(value) % 8 == 0);
    bytes.resize(bytes.size() + sizeof(value));
    std::memcpy(bytes.data() + bytes.size() - sizeof(value), &value, sizeof(value));
  };
  sums.for_each([&](const Described&, const auto& value) {
    if constexpr (std::is_trivially_copyable_v<std::decay_t<decltype(value)>>) {
      add(value);
    } else {
      add(std::accumulate(value.begin(), value.end(), 0.0));
    }
  });
  auto* const begin = reinterpret_cast<unsigned char*>(&to);
  auto* const at = reinterpret_cast<unsigned char*>(&(to.*first));
  if (at + bytes.size() != begin + sizeof(Struct)) {
    throw std::logic_error("needlework.h: expected the numbers of the result, in their order");
  }
  std::memcpy(at, bytes.data(), bytes.size());
}

}  // namespace needlework::c
