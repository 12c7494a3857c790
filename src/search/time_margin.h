// Rounding of times in the floats of the SIMD kernels.
#pragma once

namespace needlework {

/// Twice what the roundings of times in blocks and motions amount to; see near_needles_body.h. More
/// is added to the ends of searches, which may be far ahead. [unit of time]
inline constexpr double time_margin = 0x1p-18;

}  // namespace needlework
