// What is read from the files of other programs.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "needlework/state.h"
#include "src/io/formats/material.h"

namespace needlework::io {

/// Needles have numbers of 32 bits.
inline constexpr std::int64_t most_needles = std::numeric_limits<std::uint32_t>::max();

/// What rounded numbers in a file have done: directors that were not quite unit vectors, and
/// angular velocities that were not quite normal to them, are projected.
struct Roundings {
  std::size_t needles = 0;  ///< that were projected
  double largest = 0;       ///< deviation that a projection has removed [1]

  void add(double deviation) {
    ++needles;
    largest = std::max(largest, deviation);
  }
};

/// Needles at one instant, in the units of their file: nothing is rescaled.
struct Configuration {
  Material material;
  State state;
  Roundings roundings;
  std::optional<double> contact_time = {};  ///< of the t_c rule, if the file says it [time]
  std::vector<std::string> notes = {};      ///< what a user should know of it
};

}  // namespace needlework::io
