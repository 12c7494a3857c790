#include "kernels/near_needles.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include "kernels/inline.h"

// Highway compiles this file once more for each of its instruction sets.
#include "kernels/targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/near_needles.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#if HWY_TARGET != HWY_SCALAR
#include "kernels/simd-inl.h"

#define NEEDLEWORK_TARGET HWY_ATTR
HWY_BEFORE_NAMESPACE();
namespace needlework::kernels::HWY_NAMESPACE {
#include "kernels/near_needles_body.h"
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
#include "kernels/near_needles_body.h"
}  // namespace scalar

namespace {

#define NEEDLEWORK_NEAR_KERNELS(isa, space, target)               \
  constexpr NearKernels isa##_kernels = {Isa::isa,                \
                                         space::floats_at_once,   \
                                         space::overlapping,      \
                                         space::approaching,      \
                                         space::near_capsules,    \
                                         space::near_paths,       \
                                         space::contact_function, \
                                         space::bracket,          \
                                         space::bracket_rods,     \
                                         space::bracket_spheres};
NEEDLEWORK_NEAR_KERNELS(scalar, scalar, )
NEEDLEWORK_FOR_EACH_SIMD(NEEDLEWORK_NEAR_KERNELS)
#undef NEEDLEWORK_NEAR_KERNELS

}  // namespace

std::string_view name_of(Isa isa) {
  switch (isa) {
    case Isa::sse4:
      return "sse4";
    case Isa::avx2:
      return "avx2";
    case Isa::avx512:
      return "avx512";
    default:
      return "scalar";
  }
}

std::vector<Isa> available() {
  std::vector<Isa> out{Isa::scalar};
  [[maybe_unused]] const auto supported = hwy::SupportedTargets();
#define NEEDLEWORK_ADD(isa, space, target) \
  if (supported & target) out.push_back(Isa::isa);
  NEEDLEWORK_FOR_EACH_SIMD(NEEDLEWORK_ADD)
#undef NEEDLEWORK_ADD
  return out;
}

const NearKernels& near_kernels(Isa isa) {
  switch (isa) {
#define NEEDLEWORK_KERNELS(isa, space, target) \
  case Isa::isa:                               \
    return isa##_kernels;
    NEEDLEWORK_FOR_EACH_SIMD(NEEDLEWORK_KERNELS)
#undef NEEDLEWORK_KERNELS
    default:
      return scalar_kernels;
  }
}

}  // namespace needlework::kernels

#endif  // HWY_ONCE
