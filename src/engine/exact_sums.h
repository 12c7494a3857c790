// Sums over all needles: the same bits in any order, and so on any number of threads.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <mutex>
#include <tuple>

#include "kernels/in_parallel.h"
#include "src/memory/large_array.h"
#include "src/physics/record.h"
#include "src/trajectory/exact_sum.h"

namespace needlework {

/// Sums over all records of terms(record), an array of numbers; infinite where a term is. The
/// threads share the work. Takes two passes, the first of which finds the largest terms.
template <class Terms>
auto exact_sums(const LargeArray<Record>& records, int threads, const Terms& terms) {
  using Numbers = decltype(terms(records[0]));
  std::mutex joining;
  // Calls add(part, terms of a record) for a copy of `empty` on each thread, then join(part).
  const auto pass = [&](const auto& empty, const auto& add, const auto& join) {
    kernels::in_parallel(records.size(), threads, [&](std::size_t begin, std::size_t end) {
      auto part = empty;
      for (std::size_t i = begin; i < end; ++i) add(part, terms(records[i]));
      const std::lock_guard lock(joining);
      join(part);
    });
  };
  Numbers largest{};
  const auto enlarge = [](Numbers& to, const Numbers& by) {
    for (std::size_t n = 0; n < to.size(); ++n) to[n] = std::max(to[n], std::abs(by[n]));
  };
  pass(Numbers{}, enlarge, [&](const Numbers& part) { enlarge(largest, part); });

  std::array<ExactSum, std::tuple_size_v<Numbers>> sums;
  for (std::size_t n = 0; n < sums.size(); ++n) sums[n] = ExactSum(largest[n]);
  const auto no_sums = sums;
  pass(
      no_sums,
      [largest](auto& to, const Numbers& by) {
        for (std::size_t n = 0; n < to.size(); ++n) {
          if (std::isfinite(largest[n])) to[n].add(by[n]);
        }
      },
      [&](const auto& part) {
        for (std::size_t n = 0; n < sums.size(); ++n) sums[n].take(part[n]);
      });
  Numbers out;
  for (std::size_t n = 0; n < out.size(); ++n) {
    out[n] = std::isfinite(largest[n]) ? sums[n].value() : largest[n];
  }
  return out;
}

}  // namespace needlework
