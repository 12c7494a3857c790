// How many things share the lanes of a vector: tables to give each of them as many.
#pragma once

#include <cstddef>
#include <cstdint>

namespace needlework::kernels {

struct LaneShares {
  static constexpr std::size_t most = 16;
  /// For so many things: which of them a lane has, and which part of that.
  std::uint32_t thing[most + 1][most] = {};
  float part[most + 1][most] = {};
};

inline constexpr LaneShares lane_shares = [] {
  LaneShares out;
  for (std::uint32_t count = 1; count <= LaneShares::most; ++count) {
    for (std::uint32_t lane = 0; lane < LaneShares::most; ++lane) {
      out.thing[count][lane] = lane % count;
      out.part[count][lane] = static_cast<float>(lane / count);
    }
  }
  return out;
}();

}  // namespace needlework::kernels
