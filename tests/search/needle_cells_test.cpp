// The blocks of cells against a plain list: who is in which cell.
#include "src/search/needle_cells.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <vector>

#include "tests/support/random.h"

namespace needlework {
namespace {

using kernels::block_size;
using kernels::NeedleBlock;
using test::Random;

struct Stored {
  std::uint32_t cell;
  NeedleCells::Slot slot;
};

/// Every needle is where its slot says; only the last block of a cell has free slots, and it is not
/// empty unless it is the only one.
void expect_consistent(const NeedleCells& cells, std::size_t count,
                       const std::map<std::uint32_t, Stored>& stored) {
  std::size_t seen = 0;
  std::set<std::uint32_t> blocks;
  for (std::uint32_t cell = 0; cell < count; ++cell) {
    std::size_t chain = 0;
    for (std::uint32_t b = cell; b != NeedleBlock::none; b = cells.next()[b]) {
      ASSERT_TRUE(blocks.insert(b).second) << "block " << b << " is in two chains";
      const NeedleBlock& block = cells[b];
      const std::uint32_t size = block.size();
      ASSERT_TRUE(b == cell || size > 0);
      ASSERT_EQ(block.is_full(), size == block_size);
      if (cells.next()[b] != NeedleBlock::none) {
        ASSERT_TRUE(block.is_full());
      }
      for (std::uint32_t lane = 0; lane < size; ++lane, ++seen) {
        const std::uint32_t needle = block.needle[lane];
        ASSERT_TRUE(stored.contains(needle));
        const Stored& its = stored.at(needle);
        ASSERT_EQ(its.cell, cell);
        ASSERT_EQ(its.slot.block, b);
        ASSERT_EQ(its.slot.lane, lane);
        for (std::uint32_t axis = 0; axis < 3; ++axis) {
          ASSERT_EQ(block.word[axis][lane], needle + axis);
        }
        ASSERT_EQ(block.time[lane], static_cast<float>(needle));
      }
      ++chain;
    }
    ASSERT_LE(chain, cells.longest_chain());
  }
  ASSERT_EQ(seen, stored.size());
}

TEST(NeedleCells, HoldNeedlesByCell) {
  Random random(33);
  constexpr std::uint32_t count = 4, needles = 400;
  NeedleCells cells(count, needles, false);
  std::map<std::uint32_t, Stored> stored;
  const kernels::NeedleBlock* const first = cells.blocks();
  for (int n = 0; n < 20000; ++n) {
    const auto i = static_cast<std::uint32_t>(random.below(needles));
    if (const auto it = stored.find(i); it != stored.end()) {
      const NeedleCells::Slot slot = it->second.slot;
      const auto moved = cells.leave(it->second.cell, slot).index;
      stored.erase(it);
      if (moved != i) stored.at(moved).slot = slot;
    }
    // Cells fill up and empty in turn.
    if (random.below(n / 1000 % 2 ? 8 : 2) == 0) continue;
    const auto cell = static_cast<std::uint32_t>(random.below(n / 3000 % 2 ? 1 : count));
    const NeedleCells::Slot slot = cells.enter(cell, Needle(i));
    NeedleBlock& block = cells[slot.block];
    for (std::uint32_t axis = 0; axis < 3; ++axis) block.word[axis][slot.lane] = i + axis;
    block.time[slot.lane] = static_cast<float>(i);
    stored[i] = {cell, slot};
    if (n % 16 == 0) {
      ASSERT_NO_FATAL_FAILURE(expect_consistent(cells, count, stored));
    }
  }
  EXPECT_GT(cells.longest_chain(), 8u);
  EXPECT_EQ(cells.blocks(), first) << "blocks have moved";
}

}  // namespace
}  // namespace needlework
