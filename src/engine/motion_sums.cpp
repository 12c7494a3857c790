#include "src/engine/motion_sums.h"

#include <algorithm>
#include <cmath>

#include "kernels/in_parallel.h"
#include "src/memory/prefetch.h"
#include "src/physics/vectors.h"
#include "src/trajectory/exact_sum.h"

namespace needlework {

// The sums over some of the needles.
struct MotionSummation::Part {
  using Terms = std::array<double, terms>;

  explicit Part(const Terms& expected_largest) {
    for (std::size_t n = 0; n < terms; ++n) sums[n] = ExactSum(expected_largest[n]);
  }

  void add(const Record& record) {
    const Vec3d& v = record.flight.v;
    const Terms term{dot(v, v), dot(record.flight.w, record.flight.w), v.x, v.y, v.z};
    for (std::size_t n = 0; n < terms; ++n) {
      largest[n] = std::max(largest[n], std::abs(term[n]));
      if (sums[n].holds(term[n])) sums[n].add(term[n]);
    }
  }
  void take(const Part& other) {
    for (std::size_t n = 0; n < terms; ++n) {
      largest[n] = std::max(largest[n], other.largest[n]);
      sums[n].take(other.sums[n]);
    }
  }
  // Whether the terms were rounded to the grids on which they should be.
  bool is_on_its_grids() const {
    for (std::size_t n = 0; n < terms; ++n) {
      if (std::isfinite(largest[n]) && !sums[n].has_grid_of(largest[n])) return false;
    }
    return true;
  }
  double sum(std::size_t n) const {
    return std::isfinite(largest[n]) ? sums[n].value() : largest[n];
  }

  Terms largest{};
  std::array<ExactSum, terms> sums;
};

MotionSums MotionSummation::of(const LargeArray<Record>& records, int threads) const {
  // Needles between that being added and that being prefetched.
  constexpr std::size_t ahead = 24;
  const auto pass = [&](const Part::Terms& expected_largest) {
    Part all(expected_largest);
    kernels::in_parallel(records.size(), threads, [&](std::size_t begin, std::size_t end) {
      Part part(expected_largest);
      for (std::size_t i = begin; i < end; ++i) {
        prefetch(&records[std::min(i + ahead, end - 1)].flight);
        part.add(records[i]);
      }
#pragma omp critical(needlework_motion_sums)
      all.take(part);
    });
    return all;
  };
  Part::Terms expected;
  for (std::size_t n = 0; n < terms; ++n) expected[n] = largest_[n].load(std::memory_order_relaxed);
  Part all = pass(expected);
  if (!all.is_on_its_grids()) all = pass(all.largest);
  for (std::size_t n = 0; n < terms; ++n) {
    largest_[n].store(all.largest[n], std::memory_order_relaxed);
  }
  return {all.sum(0), all.sum(1), {all.sum(2), all.sum(3), all.sum(4)}};
}

}  // namespace needlework
