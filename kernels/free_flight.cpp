#include "kernels/free_flight.h"

#include "kernels/inline.h"
#include "kernels/sine_cosine.h"

// Highway compiles this file once more for each of its instruction sets.
#include "kernels/targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/free_flight.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#if HWY_TARGET != HWY_SCALAR
#include "kernels/simd_double-inl.h"

#define NEEDLEWORK_TARGET HWY_ATTR
HWY_BEFORE_NAMESPACE();
namespace needlework::kernels::HWY_NAMESPACE {
#include "kernels/free_flight_body.h"
}  // namespace needlework::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#undef NEEDLEWORK_TARGET
#endif

#if HWY_ONCE

namespace needlework::kernels {

#define NEEDLEWORK_TARGET
namespace scalar {

using Doubles = double;
constexpr std::size_t doubles_at_once = 1;
inline double load_doubles(const double* p) { return *p; }
inline void store_doubles(double a, double* p) { *p = a; }
using sine_cosine_detail::turned;

#include "kernels/free_flight_body.h"

}  // namespace scalar

void fly(Isa isa, const FlightColumns& needles, std::size_t n) {
  switch (isa) {
#if HWY_TARGETS & HWY_SSE4
    case Isa::sse4:
      return N_SSE4::fly(needles, n);
#endif
#if HWY_TARGETS & HWY_AVX2
    case Isa::avx2:
      return N_AVX2::fly(needles, n);
#endif
#if HWY_TARGETS & HWY_AVX3
    case Isa::avx512:
      return N_AVX3::fly(needles, n);
#endif
    default:
      return scalar::fly(needles, n);
  }
}

}  // namespace needlework::kernels

#endif  // HWY_ONCE
