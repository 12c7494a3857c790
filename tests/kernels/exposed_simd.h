// The parts of the scalar twin that near_needles.h does not show, for tests of them alone.
#pragma once

#include <limits>
#include <type_traits>

#include "kernels/near_needles.h"
#include "kernels/simd_scalar.h"

#define NEEDLEWORK_TARGET
// Apart from the twin that the library holds.
namespace needlework::kernels::scalar::exposed {
#include "kernels/near_needles_body.h"
}  // namespace needlework::kernels::scalar::exposed
#undef NEEDLEWORK_TARGET
