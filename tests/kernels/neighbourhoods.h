// Neighbourhoods made up for the filters of the SIMD kernels, and what the filters find there.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "kernels/near_needles.h"
#include "tests/support/random.h"

namespace needlework::kernels {

using test::Random;

/// Blocks of needles in cells around a seeker, with any contents.
struct Neighbourhood {
  std::vector<NeedleBlock> blocks;
  std::vector<std::uint32_t> next;
  std::vector<CellView> cells;
  Seeker seeker{};

  Surroundings around() const { return {blocks.data(), next.data(), cells.data(), cells.size()}; }
};

/// What a kernel finds around a seeker; `apply` calls it. What it leaves behind the last one does
/// not matter.
template <class Apply>
std::vector<std::pair<std::uint32_t, std::uint32_t>> found_by(const Neighbourhood& near,
                                                              Apply&& apply) {
  const std::size_t room = (near.blocks.size() + 1) * block_size;
  std::vector<std::uint32_t> needles(room), cells(room);
  const Scan scan = apply(Found{needles.data(), cells.data()});
  std::vector<std::pair<std::uint32_t, std::uint32_t>> out;
  for (std::size_t n = 0; n < scan.found; ++n) out.push_back({needles[n], cells[n]});
  return out;
}

/// Numbers for one needle in a block.
using BlockRow = std::array<float, NeedleBlock::columns>;

/// Fills cells with needles of ids from 1 on, some of them with chains of blocks, some empty; what
/// stands beyond the last needle of a block is not a number, and what follows one that is not full
/// is no block.
inline Neighbourhood fill(Random& random, const Seeker& seeker, const std::vector<BlockRow>& rows) {
  Neighbourhood out;
  out.seeker = seeker;
  std::size_t next = 0;
  while (next < rows.size()) {
    const auto first = static_cast<std::uint32_t>(out.blocks.size());
    out.cells.push_back({first, {}});
    for (int chained = random.below(3); chained >= 0; --chained) {
      NeedleBlock& block = out.blocks.emplace_back();
      for (auto& column : block.column) {
        std::fill(std::begin(column), std::end(column), std::numeric_limits<float>::quiet_NaN());
      }
      const auto size = chained > 0 ? block_size : random.below(block_size + 1);
      const auto taken = std::min<std::size_t>(size, rows.size() - next);
      const auto after = static_cast<std::uint32_t>(out.blocks.size());
      out.next.push_back(taken < block_size ? 12345u : chained > 0 ? after : NeedleBlock::none);
      for (std::size_t lane = 0; lane < taken; ++lane, ++next) {
        for (int c = 0; c < NeedleBlock::columns; ++c) block.column[c][lane] = rows[next][c];
        block.needle[lane] = static_cast<std::uint32_t>(next + 1);
      }
    }
  }
  return out;
}

inline std::vector<std::pair<std::uint32_t, std::uint32_t>> overlapping(const NearKernels& kernels,
                                                                        const Neighbourhood& near,
                                                                        float radius) {
  return found_by(near, [&](const Found& found) {
    return kernels.overlapping(near.around(), near.seeker, radius, found);
  });
}

inline std::vector<std::pair<std::uint32_t, std::uint32_t>> approaching(const NearKernels& kernels,
                                                                        const Neighbourhood& near) {
  return found_by(near, [&](const Found& found) {
    return kernels.approaching(near.around(), near.seeker, found);
  });
}

}  // namespace needlework::kernels
