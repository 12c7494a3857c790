// What is read from the files of other programs.
#pragma once

#include <cstdint>
#include <limits>

#include "needlework/state.h"
#include "src/io/formats/material.h"

namespace needlework::io {

/// Needles have numbers of 32 bits.
inline constexpr std::int64_t most_needles = std::numeric_limits<std::uint32_t>::max();

/// Needles at one instant, in the units of their file: nothing is rescaled.
struct Configuration {
  Material material;
  State state;
};

}  // namespace needlework::io
