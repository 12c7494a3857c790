// What a run asks of its search.
#pragma once

#include <optional>

#include "kernels/isa.h"

namespace needlework {

struct SearchSetup {
  kernels::Isa isa = kernels::Isa::scalar;
  std::optional<double> cell_side;       ///< least side of cells; absent: the search chooses [L]
  std::optional<double> capsule_radius;  ///< absent: the search chooses [L]
  bool float_filter = true;              ///< see kernels/accuracy.h
};

}  // namespace needlework
