// Instruction sets that the SIMD kernels are built for, chosen at run time.
#pragma once

#include <string_view>
#include <vector>

namespace needlework::kernels {

/// scalar is the twin: the same source with vectors of one number.
enum class Isa { scalar, sse4, avx2, avx512 };

std::string_view name_of(Isa isa);
/// Those that this processor has and this build contains, widest last; scalar always.
std::vector<Isa> available();

}  // namespace needlework::kernels
