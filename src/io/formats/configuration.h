// What is read from the files of other programs.
#pragma once

#include "needlework/state.h"
#include "src/io/formats/material.h"

namespace needlework::io {

/// Needles at one instant, in the units of their file: nothing is rescaled.
struct Configuration {
  Material material;
  State state;
};

}  // namespace needlework::io
