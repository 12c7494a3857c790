// The law that no event may break: rods of finite width never overlap but by rounding.
#pragma once

#include <cstdint>
#include <optional>

#include "kernels/isa.h"
#include "src/physics/gas.h"
#include "src/scene/rod_grid.h"

namespace needlework {

/// What needle i is now, as far as overlaps go.
RodShape shape_of(const Gas& gas, Needle i, Time now);

/// By how much rods may overlap at this time, which is what rounding explains: 1e-13 of the
/// smallest diameter, or radius where there are thin needles, what positions in this box do not
/// hold, and how far the fastest rods move while the clock does not. All records are from then or
/// earlier. [L]
double explained_overlap(const Gas& gas, Time at);

/// Two rods that overlap.
struct RodOverlap {
  std::uint32_t first, second;  ///< ids, the lower one first
  double depth;                 ///< [L]
};

/// Two rods that overlap by more than `tolerance` at this time, if there are any. All records are
/// from then or earlier.
std::optional<RodOverlap> find_overlap(const Gas& gas, Time at, kernels::Isa isa, double tolerance);

/// Throws InvalidStateError, which names two rods, if any overlap by more than `tolerance`.
void require_rods_apart(const Gas& gas, Time at, kernels::Isa isa, double tolerance);

}  // namespace needlework
