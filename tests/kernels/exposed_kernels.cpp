#include "tests/kernels/exposed_kernels.h"

#include <algorithm>
#include <limits>
#include <type_traits>

#include "kernels/inline.h"
#include "kernels/targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/kernels/exposed_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// Apart from what the library holds; the tests do not use all of it.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"

#if HWY_TARGET != HWY_SCALAR
#include "kernels/simd-inl.h"

#define NEEDLEWORK_TARGET HWY_ATTR
HWY_BEFORE_NAMESPACE();
namespace needlework::kernels::HWY_NAMESPACE {
namespace {
namespace shown {
#include "kernels/near_needles_body.h"
#include "tests/kernels/exposed_kernels_body.h"
}  // namespace shown
}  // namespace
}  // namespace needlework::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#undef NEEDLEWORK_TARGET
#endif

#if HWY_ONCE

#include "kernels/simd_isas.h"
#include "kernels/simd_scalar.h"

namespace needlework::kernels {

#define NEEDLEWORK_TARGET
namespace scalar {
namespace {
namespace shown {
#include "kernels/near_needles_body.h"
#include "tests/kernels/exposed_kernels_body.h"
}  // namespace shown
}  // namespace
}  // namespace scalar
#undef NEEDLEWORK_TARGET

ExposedStep exposed_step(Isa isa, const Seeker& seeker, const PairColumns& pairs, float s,
                         float h) {
  switch (isa) {
#define NEEDLEWORK_STEP(isa, space, target) \
  case Isa::isa:                            \
    return space::shown::step_of(seeker, pairs, s, h);
    NEEDLEWORK_FOR_EACH_SIMD(NEEDLEWORK_STEP)
#undef NEEDLEWORK_STEP
    default:
      return scalar::shown::step_of(seeker, pairs, s, h);
  }
}

RoughResults rough_results(Isa isa, float a, float b) {
  switch (isa) {
#define NEEDLEWORK_ROUGH(isa, space, target) \
  case Isa::isa:                             \
    return space::shown::rough_of(a, b);
    NEEDLEWORK_FOR_EACH_SIMD(NEEDLEWORK_ROUGH)
#undef NEEDLEWORK_ROUGH
    default:
      return scalar::shown::rough_of(a, b);
  }
}

}  // namespace needlework::kernels

#endif  // HWY_ONCE
#pragma GCC diagnostic pop
