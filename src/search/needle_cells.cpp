#include "src/search/needle_cells.h"

namespace needlework {

using kernels::BlockLink;
using kernels::NeedleBlock;

NeedleCells::NeedleCells(std::size_t cells, std::size_t needles) {
  // With room for all that may ever be chained, as only full blocks have others after them: threads
  // must not find their blocks moved.
  const std::size_t most = cells + needles / kernels::block_size;
  blocks_.reserve(most);
  blocks_.resize(cells);
  links_.reserve(most);
  links_.resize(cells);
}

NeedleCells::Slot NeedleCells::enter(std::uint32_t cell) {
  std::uint32_t b = cell;
  std::size_t chain = 1;
  for (; links_[b].size == kernels::block_size; ++chain) {
    if (links_[b].next == BlockLink::none) {
      links_[b].next = take_free_block();
      // Several threads may raise it at once.
      std::size_t longest = longest_chain_;
      while (longest < chain + 1 && !longest_chain_.compare_exchange_weak(longest, chain + 1)) {
      }
    }
    b = links_[b].next;
  }
  return {b, links_[b].size++};
}

Needle NeedleCells::leave(std::uint32_t cell, const Slot& slot) {
  std::uint32_t last = cell, previous = BlockLink::none;
  while (links_[last].next != BlockLink::none) {
    previous = last;
    last = links_[last].next;
  }
  const std::uint32_t lane = --links_[last].size;
  if (last != slot.block || lane != slot.lane) {
    NeedleBlock& to = blocks_[slot.block];
    const NeedleBlock& from = blocks_[last];
    for (int column = 0; column < NeedleBlock::columns; ++column) {
      to.column[column][slot.lane] = from.column[column][lane];
    }
    to.needle[slot.lane] = from.needle[lane];
  }
  const std::uint32_t now_there = blocks_[slot.block].needle[slot.lane];
  if (links_[last].size == 0 && previous != BlockLink::none) {
    links_[previous].next = BlockLink::none;
    give_back(last);
  }
  return Needle(now_there);
}

void NeedleCells::renumber(const std::vector<Needle>& ranks) {
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    for (std::uint32_t lane = 0; lane < links_[b].size; ++lane) {
      std::uint32_t& needle = blocks_[b].needle[lane];
      needle = ranks[needle].index;
    }
  }
}

std::uint32_t NeedleCells::take_free_block() {
  const std::lock_guard alone(chaining_);
  if (free_blocks_.empty()) {
    free_blocks_.push_back(static_cast<std::uint32_t>(blocks_.size()));
    blocks_.emplace_back();
    links_.emplace_back();
  }
  const std::uint32_t out = free_blocks_.back();
  free_blocks_.pop_back();
  return out;
}

void NeedleCells::give_back(std::uint32_t block) {
  links_[block] = {};
  const std::lock_guard alone(chaining_);
  free_blocks_.push_back(block);
}

}  // namespace needlework
