// A needle that another one might meet.
#pragma once

#include <cstdint>

#include "src/physics/ids.h"

namespace needlework {

struct Candidate {
  double from;  ///< does not meet it before, as a time from now [time]
  Needle needle;
  std::uint32_t view;  ///< of the cell in which it was found
  Shift shift;
};

}  // namespace needlework
