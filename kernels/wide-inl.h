// Lanes of double of the instruction set that is being compiled, with what free flight needs of a
// number. Included once for each instruction set; see lanes-inl.h.
#if defined(NEEDLEWORK_WIDE_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef NEEDLEWORK_WIDE_INL
#undef NEEDLEWORK_WIDE_INL
#else
#define NEEDLEWORK_WIDE_INL
#endif

#include <hwy/highway.h>

#include <cstdint>

#include "kernels/sine_cosine.h"

HWY_BEFORE_NAMESPACE();
namespace needlework::kernels::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using WideTag = hn::CappedTag<double, 8>;

struct Wide {
  hn::Vec<WideTag> v;

  Wide() = default;
  HWY_ATTR HWY_INLINE Wide(hn::Vec<WideTag> raw) : v(raw) {}
  HWY_ATTR HWY_INLINE explicit Wide(double a) : v(hn::Set(WideTag(), a)) {}
};

inline constexpr std::size_t wide_at_once = hn::MaxLanes(WideTag());
HWY_INLINE Wide load_wide(const double* p) { return hn::LoadU(WideTag(), p); }
HWY_INLINE void store_wide(const Wide& a, double* p) { hn::StoreU(a.v, WideTag(), p); }

HWY_INLINE Wide operator+(const Wide& a, const Wide& b) { return hn::Add(a.v, b.v); }
HWY_INLINE Wide operator-(const Wide& a, const Wide& b) { return hn::Sub(a.v, b.v); }
HWY_INLINE Wide operator*(const Wide& a, const Wide& b) { return hn::Mul(a.v, b.v); }

/// Turned by the quarters of a circle that the last bits of `shifted` tell.
HWY_INLINE SineCosine<Wide> turned(const Wide& shifted, const Wide& sine, const Wide& cosine) {
  const hn::RebindToUnsigned<WideTag> whole;
  const auto q = hn::BitCast(whole, shifted.v), one = hn::Set(whole, 1), two = hn::Set(whole, 2);
  const auto s = hn::BitCast(whole, sine.v), c = hn::BitCast(whole, cosine.v);
  const auto odd = hn::Sub(hn::Zero(whole), hn::And(q, one));
  const auto exchange = hn::And(hn::Xor(s, c), odd);
  const auto sign_of_sine = hn::ShiftLeft<62>(hn::And(q, two));
  const auto sign_of_cosine = hn::ShiftLeft<62>(hn::And(hn::Add(q, one), two));
  return {hn::BitCast(WideTag(), hn::Xor(hn::Xor(s, exchange), sign_of_sine)),
          hn::BitCast(WideTag(), hn::Xor(hn::Xor(c, exchange), sign_of_cosine))};
}

}  // namespace needlework::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // toggle
