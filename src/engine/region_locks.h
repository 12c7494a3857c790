// Region locks: the part of space that each thread works in, so that no two threads access the same
// needles.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <optional>
#include <vector>

#include "src/engine/backoff.h"
#include "src/engine/cell_box.h"

namespace needlework {

/// One lock per thread: up to two boxes of cells to which the thread writes. It reads no farther
/// than `distance` cells from them. When two threads lock boxes so close that one would read what
/// the other writes, at least one of them sees the conflict, because each publishes its lock
/// before it looks at the others.
class RegionLocks {
 public:
  RegionLocks(const CellCounts& cells, const CellCounts& distance, std::size_t threads)
      : cells_(cells), distance_(distance), locks_(threads) {}

  enum Part { owner, partner };

  /// Part of the lock of another thread, as it was when it was in the way.
  struct Conflict {
    std::size_t thread;
    Part part;
    std::uint64_t bits;
  };

  /// Sets or enlarges one part of a thread's lock, and waits until no other lock conflicts. If a
  /// thread of lower number is in conflict, releases the whole lock and returns the conflict.
  [[nodiscard]] std::optional<Conflict> acquire(std::size_t thread, Part part, const CellBox& box) {
    std::atomic<std::uint64_t>& mine = locks_[thread].part[part];
    if (mine.load(std::memory_order_relaxed) == packed(box)) return {};
    mine.store(packed(box), std::memory_order_seq_cst);
    random_pause();
    for (std::size_t other = 0; other < locks_.size(); ++other) {
      if (other == thread) continue;
      Backoff backoff(32);
      while (const auto conflict = conflict_with(other, box)) {
        if (other < thread) {
          release(thread);
          return conflict;
        }
        backoff.wait();
      }
    }
    return {};
  }
  /// Whether that part of the other thread's lock is as it was. It may have been released and set
  /// to the same cells again.
  bool lasts(const Conflict& conflict) const {
    const auto& part = locks_[conflict.thread].part[conflict.part];
    return part.load(std::memory_order_relaxed) == conflict.bits;
  }
  void release(std::size_t thread) {
    for (auto& part : locks_[thread].part) part.store(nothing, std::memory_order_release);
  }

 private:
  static constexpr std::uint64_t nothing = ~std::uint64_t{0};
  static constexpr int low_bits = 17, more_bits = 4;
  static constexpr std::int32_t all = (1 << more_bits) - 1;  ///< stands for the whole length of an
                                                             ///< axis

 public:
  static constexpr std::int32_t most_cells = 1 << low_bits;  ///< along an axis

 private:
  struct alignas(128) Lock {
    std::atomic<std::uint64_t> part[2] = {nothing, nothing};
    Lock() = default;
    Lock(Lock&&) noexcept {}
  };

  static std::uint64_t packed(const CellBox& box) {
    std::uint64_t out = 0;
    for (int axis = 0; axis < 3; ++axis) {
      out = out << low_bits | static_cast<std::uint64_t>(box.low[axis]);
      out = out << more_bits | static_cast<std::uint64_t>(std::min(box.more[axis], all));
    }
    return out;
  }
  CellBox unpacked(std::uint64_t bits) const {
    CellBox out;
    for (int axis = 2; axis >= 0; --axis) {
      out.more[axis] = static_cast<std::int32_t>(bits & all);
      if (out.more[axis] == all) out.more[axis] = cells_[axis];
      bits >>= more_bits;
      out.low[axis] = static_cast<std::int32_t>(bits & (most_cells - 1));
      bits >>= low_bits;
    }
    return out;
  }
  std::optional<Conflict> conflict_with(std::size_t other, const CellBox& box) const {
    for (const Part part : {owner, partner}) {
      const std::uint64_t bits = locks_[other].part[part].load(std::memory_order_seq_cst);
      if (bits != nothing && near(unpacked(bits), box, cells_, distance_)) {
        return Conflict{other, part, bits};
      }
    }
    return {};
  }

  CellCounts cells_, distance_;
  std::vector<Lock> locks_;
};

}  // namespace needlework
