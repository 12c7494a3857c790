#include "src/search/needle_cells.h"

namespace needlework {

using kernels::NeedleBlock;

NeedleCells::NeedleCells(std::size_t cells, std::size_t needles, bool differ) {
  // With room for all that may ever be chained, as only full blocks have others after them: threads
  // must not find their blocks moved.
  const std::size_t most = cells + needles / kernels::block_size;
  blocks_.reserve(most);
  blocks_.resize(cells);
  next_.reserve(most);
  next_.resize(cells, NeedleBlock::none);
  if (differ) reaches_.resize(most);
}

NeedleCells::Slot NeedleCells::enter(std::uint32_t cell, Needle i) {
  std::uint32_t b = cell;
  std::size_t chain = 1;
  for (; blocks_[b].is_full(); ++chain) {
    if (next_[b] == NeedleBlock::none) {
      next_[b] = take_free_block();
      // Several threads may raise it at once.
      std::size_t longest = longest_chain_;
      while (longest < chain + 1 && !longest_chain_.compare_exchange_weak(longest, chain + 1)) {
      }
    }
    b = next_[b];
  }
  const std::uint32_t lane = blocks_[b].size();
  blocks_[b].needle[lane] = i.index;
  return {b, lane};
}

Needle NeedleCells::leave(std::uint32_t cell, const Slot& slot) {
  std::uint32_t last = cell, previous = NeedleBlock::none;
  while (next_[last] != NeedleBlock::none) {
    previous = last;
    last = next_[last];
  }
  NeedleBlock& from = blocks_[last];
  NeedleBlock& to = blocks_[slot.block];
  const std::uint32_t lane = from.size() - 1;
  const Needle now_there(from.needle[lane]);
  if (last != slot.block || lane != slot.lane) {
    for (int axis = 0; axis < 3; ++axis) to.word[axis][slot.lane] = from.word[axis][lane];
    to.time[slot.lane] = from.time[lane];
    to.needle[slot.lane] = from.needle[lane];
    if (differ()) set_reach(slot, reaches_[last].reach[lane]);
  }
  from.needle[lane] = NeedleBlock::none;
  if (lane == 0 && previous != NeedleBlock::none) {
    next_[previous] = NeedleBlock::none;
    give_back(last);
  }
  return now_there;
}

void NeedleCells::renumber(const std::vector<Needle>& ranks) {
  for (NeedleBlock& block : blocks_) {
    for (std::uint32_t& needle : block.needle) {
      if (needle != NeedleBlock::none) needle = ranks[needle].index;
    }
  }
}

std::uint32_t NeedleCells::take_free_block() {
  const std::lock_guard alone(chaining_);
  if (free_blocks_.empty()) {
    free_blocks_.push_back(static_cast<std::uint32_t>(blocks_.size()));
    blocks_.emplace_back();
    next_.push_back(NeedleBlock::none);
  }
  const std::uint32_t out = free_blocks_.back();
  free_blocks_.pop_back();
  return out;
}

void NeedleCells::give_back(std::uint32_t block) {
  const std::lock_guard alone(chaining_);
  free_blocks_.push_back(block);
}

}  // namespace needlework
