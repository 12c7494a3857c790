// Neighbourhoods made up for the filters of the SIMD kernels, and what the filters find there.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "kernels/near_needles.h"
#include "kernels/vec3.h"
#include "tests/support/random.h"

namespace needlework::kernels {

using test::Random;

/// Blocks of needles in cells around a seeker, with any contents.
struct Neighbourhood {
  std::vector<NeedleBlock> blocks;
  std::vector<std::uint32_t> next;
  std::vector<CellView> cells;
  Seeker seeker{};
  WordFormat format;

  Surroundings around() const {
    return {blocks.data(), next.data(), cells.data(), cells.size(), format};
  }
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

/// A needle to be entered into a block: its centre relative to the seeker's cell, and the velocity
/// or the director that goes with it.
struct BlockRow {
  Vec3d r;
  Vec3d vector;
  bool is_director = false;
  float time = 0;

  /// In the columns of a block, for a cell whose corner is at `offset`.
  std::array<std::uint32_t, 3> words(const WordFormat& format, const float (&offset)[3]) const {
    const auto word = [&](double centre, double component) {
      return is_director ? format.with_director(centre, component)
                         : format.with_velocity(centre, component);
    };
    return {word(r.x - offset[0], vector.x), word(r.y - offset[1], vector.y),
            word(r.z - offset[2], vector.z)};
  }
};

/// Fills cells with needles of ids from 1 on, some of them with chains of blocks, some empty; what
/// stands beyond the last needle of a block is not a number, and what follows one that is not full
/// is no block. The corners of the cells are up to `farthest` from that of the seeker's cell along
/// each axis.
inline Neighbourhood fill(Random& random, const Seeker& seeker, const WordFormat& format,
                          double farthest, const std::vector<BlockRow>& rows) {
  Neighbourhood out;
  out.seeker = seeker;
  out.format = format;
  std::size_t next = 0;
  while (next < rows.size()) {
    const auto first = static_cast<std::uint32_t>(out.blocks.size());
    CellView& cell = out.cells.emplace_back(CellView{first, {}});
    for (float& offset : cell.offset) {
      offset = static_cast<float>(random.uniform(-farthest, farthest));
    }
    for (int chained = random.below(3); chained >= 0; --chained) {
      NeedleBlock& block = out.blocks.emplace_back();
      constexpr float no_number = std::numeric_limits<float>::quiet_NaN();
      for (auto& words : block.word) {
        std::fill(std::begin(words), std::end(words), std::bit_cast<std::uint32_t>(no_number));
      }
      std::fill(std::begin(block.time), std::end(block.time), no_number);
      const auto size = chained > 0 ? block_size : random.below(block_size + 1);
      const auto taken = std::min<std::size_t>(size, rows.size() - next);
      const auto after = static_cast<std::uint32_t>(out.blocks.size());
      out.next.push_back(taken < block_size ? 12345u : chained > 0 ? after : NeedleBlock::none);
      for (std::size_t lane = 0; lane < taken; ++lane, ++next) {
        const auto words = rows[next].words(format, cell.offset);
        for (int axis = 0; axis < 3; ++axis) block.word[axis][lane] = words[axis];
        block.time[lane] = rows[next].time;
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

inline std::vector<std::pair<std::uint32_t, std::uint32_t>> near_capsules(
    const NearKernels& kernels, const Neighbourhood& near, float distance) {
  return found_by(near, [&](const Found& found) {
    return kernels.near_capsules(near.around(), near.seeker, distance, found);
  });
}

inline std::vector<std::pair<std::uint32_t, std::uint32_t>> near_paths(const NearKernels& kernels,
                                                                       const Neighbourhood& near,
                                                                       float distance) {
  return found_by(near, [&](const Found& found) {
    return kernels.near_paths(near.around(), near.seeker, distance, found);
  });
}

}  // namespace needlework::kernels
