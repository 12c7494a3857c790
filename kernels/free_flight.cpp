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
#include "kernels/simd_isas.h"

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
#define NEEDLEWORK_FLY(isa, space, target) \
  case Isa::isa:                           \
    return space::fly(needles, n);
    NEEDLEWORK_FOR_EACH_SIMD(NEEDLEWORK_FLY)
#undef NEEDLEWORK_FLY
    default:
      return scalar::fly(needles, n);
  }
}

}  // namespace needlework::kernels

#endif  // HWY_ONCE
