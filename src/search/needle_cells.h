// The needles of each cell of a grid, in blocks that the SIMD kernels read.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <vector>

#include "kernels/near_needles.h"
#include "src/memory/large_array.h"
#include "src/physics/gas.h"

namespace needlework {

/// Cell c owns block c. When that is full, further blocks are chained to it, so that only the last
/// block of a chain has free slots. Several threads may use different cells at once.
class NeedleCells {
 public:
  /// Where a needle is stored.
  struct Slot {
    std::uint32_t block = kernels::NeedleBlock::none;
    std::uint32_t lane = 0;
  };

  /// `differ`: needles have reaches of their own.
  NeedleCells(std::size_t cells, std::size_t needles, bool differ);

  /// Gives a needle the next free slot of a cell.
  Slot enter(std::uint32_t cell, Needle i);
  /// Frees a slot of a cell; the last needle of the cell is moved there. Returns which needle the
  /// slot holds afterwards: that one or, where the slot was the last, the one that has left.
  Needle leave(std::uint32_t cell, const Slot& slot);
  /// Says how far the needle in a slot reaches, where needles differ. [unit of length]
  void set_reach(const Slot& slot, float reach) { reaches_[slot.block].reach[slot.lane] = reach; }
  bool differ() const { return !reaches_.empty(); }
  const kernels::BlockReaches* reaches() const { return differ() ? reaches_.data() : nullptr; }
  /// Needle i has become needle ranks[i].
  void renumber(const std::vector<Needle>& ranks);

  kernels::NeedleBlock& operator[](std::uint32_t block) { return blocks_[block]; }
  const kernels::NeedleBlock& operator[](std::uint32_t block) const { return blocks_[block]; }
  const kernels::NeedleBlock* blocks() const { return blocks_.data(); }
  /// For each block, the next one of its cell, or none; only full blocks have one.
  const std::uint32_t* next() const { return next_.data(); }
  /// The most blocks that a cell has ever had.
  std::size_t longest_chain() const { return longest_chain_; }

 private:
  std::uint32_t take_free_block();
  void give_back(std::uint32_t block);

  LargeArray<kernels::NeedleBlock> blocks_;    ///< first those of the cells, then those chained
  LargeArray<kernels::BlockReaches> reaches_;  ///< of each block; empty where needles are alike
  LargeArray<std::uint32_t> next_;
  std::vector<std::uint32_t> free_blocks_;
  std::mutex chaining_;  ///< held while blocks are taken from or given back to the free ones
  std::atomic<std::size_t> longest_chain_ = 1;
};

}  // namespace needlework
