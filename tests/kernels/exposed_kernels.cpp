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

// Calls a function of the namespace of an instruction set.
#define NEEDLEWORK_CASE(isa, space, target) \
  case Isa::isa:                            \
    return space::shown::NEEDLEWORK_CALL;
#define NEEDLEWORK_SWITCH                     \
  switch (isa) {                              \
    NEEDLEWORK_FOR_EACH_SIMD(NEEDLEWORK_CASE) \
    default:                                  \
      return scalar::shown::NEEDLEWORK_CALL;  \
  }

ExposedStep exposed_step(Isa isa, const Seeker& seeker, const PairColumns& pairs, float s, float h){
#define NEEDLEWORK_CALL step_of(seeker, pairs, s, h)
    NEEDLEWORK_SWITCH
#undef NEEDLEWORK_CALL
}

RoughResults rough_results(Isa isa, float a, float b){
#define NEEDLEWORK_CALL rough_of(a, b)
    NEEDLEWORK_SWITCH
#undef NEEDLEWORK_CALL
}

ExposedIntervals exposed_spread(Isa isa, const ExposedIntervals& all){
#define NEEDLEWORK_CALL spread_of(all)
    NEEDLEWORK_SWITCH
#undef NEEDLEWORK_CALL
}

ExposedIntervals exposed_add(Isa isa, const ExposedIntervals& all, const ExposedIntervals& more) {
#define NEEDLEWORK_CALL added(all, more)
  NEEDLEWORK_SWITCH
#undef NEEDLEWORK_CALL
}

#undef NEEDLEWORK_SWITCH
#undef NEEDLEWORK_CASE

}  // namespace needlework::kernels

#endif  // HWY_ONCE
#pragma GCC diagnostic pop
