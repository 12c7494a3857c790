// `Doubles`: a vector of doubles of the instruction set that is being compiled, with the operators
// that free flight needs. Included once for each instruction set; see simd-inl.h.
#if defined(NEEDLEWORK_SIMD_DOUBLE_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef NEEDLEWORK_SIMD_DOUBLE_INL
#undef NEEDLEWORK_SIMD_DOUBLE_INL
#else
#define NEEDLEWORK_SIMD_DOUBLE_INL
#endif

#include <hwy/highway.h>

#include <cstdint>

#include "kernels/sine_cosine.h"

HWY_BEFORE_NAMESPACE();
namespace needlework::kernels::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using DoubleTag = hn::CappedTag<double, 8>;

struct Doubles {
  hn::Vec<DoubleTag> v;

  Doubles() = default;
  HWY_ATTR HWY_INLINE Doubles(hn::Vec<DoubleTag> raw) : v(raw) {}
  HWY_ATTR HWY_INLINE explicit Doubles(double a) : v(hn::Set(DoubleTag(), a)) {}
};

inline constexpr std::size_t doubles_at_once = hn::MaxLanes(DoubleTag());
HWY_INLINE Doubles load_doubles(const double* p) { return hn::LoadU(DoubleTag(), p); }
HWY_INLINE void store_doubles(const Doubles& a, double* p) { hn::StoreU(a.v, DoubleTag(), p); }

HWY_INLINE Doubles operator+(const Doubles& a, const Doubles& b) { return hn::Add(a.v, b.v); }
HWY_INLINE Doubles operator-(const Doubles& a, const Doubles& b) { return hn::Sub(a.v, b.v); }
HWY_INLINE Doubles operator*(const Doubles& a, const Doubles& b) { return hn::Mul(a.v, b.v); }

/// Turned by the quarters of a circle that the last bits of `shifted` count.
HWY_INLINE SineCosine<Doubles> turned(const Doubles& shifted, const Doubles& sine,
                                      const Doubles& cosine) {
  const hn::RebindToUnsigned<DoubleTag> whole;
  const auto q = hn::BitCast(whole, shifted.v), one = hn::Set(whole, 1), two = hn::Set(whole, 2);
  const auto s = hn::BitCast(whole, sine.v), c = hn::BitCast(whole, cosine.v);
  const auto odd = hn::Sub(hn::Zero(whole), hn::And(q, one));
  const auto exchange = hn::And(hn::Xor(s, c), odd);
  const auto sign_of_sine = hn::ShiftLeft<62>(hn::And(q, two));
  const auto sign_of_cosine = hn::ShiftLeft<62>(hn::And(hn::Add(q, one), two));
  return {hn::BitCast(DoubleTag(), hn::Xor(hn::Xor(s, exchange), sign_of_sine)),
          hn::BitCast(DoubleTag(), hn::Xor(hn::Xor(c, exchange), sign_of_cosine))};
}

}  // namespace needlework::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // toggle
