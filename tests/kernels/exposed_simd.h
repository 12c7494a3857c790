// The parts of the scalar twin that near_needles.h does not show, for tests of them alone.
#pragma once

#include <limits>
#include <type_traits>

#include "kernels/near_needles.h"
#include "kernels/simd_scalar.h"

// Apart from the twin that the library holds, and once in each file that includes this; few tests
// use all of it.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#define NEEDLEWORK_TARGET
namespace needlework::kernels::scalar {
namespace {
namespace exposed {
#include "kernels/near_needles_body.h"
}  // namespace exposed
}  // namespace
}  // namespace needlework::kernels::scalar
#undef NEEDLEWORK_TARGET
#pragma GCC diagnostic pop
