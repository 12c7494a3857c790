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

#include "kernels/simd_scalar.h"

namespace needlework::kernels {

#define NEEDLEWORK_TARGET
namespace scalar {
#include "kernels/near_needles_body.h"
}  // namespace scalar

namespace {

#define NEEDLEWORK_NEAR_KERNELS(isa, name)                          \
  constexpr NearKernels isa##_kernels = {                           \
      Isa::isa,          name::floats_at_once,   name::overlapping, \
      name::approaching, name::contact_function, name::bracket}

NEEDLEWORK_NEAR_KERNELS(scalar, scalar);
#if HWY_TARGETS & HWY_SSE4
NEEDLEWORK_NEAR_KERNELS(sse4, N_SSE4);
#endif
#if HWY_TARGETS & HWY_AVX2
NEEDLEWORK_NEAR_KERNELS(avx2, N_AVX2);
#endif
#if HWY_TARGETS & HWY_AVX3
NEEDLEWORK_NEAR_KERNELS(avx512, N_AVX3);
#endif

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
#if HWY_TARGETS & HWY_SSE4
  if (supported & HWY_SSE4) out.push_back(Isa::sse4);
#endif
#if HWY_TARGETS & HWY_AVX2
  if (supported & HWY_AVX2) out.push_back(Isa::avx2);
#endif
#if HWY_TARGETS & HWY_AVX3
  if (supported & HWY_AVX3) out.push_back(Isa::avx512);
#endif
  return out;
}

const NearKernels& near_kernels(Isa isa) {
  switch (isa) {
#if HWY_TARGETS & HWY_SSE4
    case Isa::sse4:
      return sse4_kernels;
#endif
#if HWY_TARGETS & HWY_AVX2
    case Isa::avx2:
      return avx2_kernels;
#endif
#if HWY_TARGETS & HWY_AVX3
    case Isa::avx512:
      return avx512_kernels;
#endif
    default:
      return scalar_kernels;
  }
}

}  // namespace needlework::kernels

#endif  // HWY_ONCE
