// `Floats`: a vector of floats of the instruction set that is being compiled, with the operators of
// a number, so that one source serves vectors and the scalar twin. Included once for each
// instruction set.
#if defined(NEEDLEWORK_SIMD_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef NEEDLEWORK_SIMD_INL
#undef NEEDLEWORK_SIMD_INL
#else
#define NEEDLEWORK_SIMD_INL
#endif

#include <hwy/highway.h>

#include <cstdint>

#include "kernels/lane_shares.h"
#include "kernels/set_bits.h"

HWY_BEFORE_NAMESPACE();
namespace needlework::kernels::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::CappedTag<float, 16>;

// Functions are defined outside of their classes: GCC compiles those defined inside after the end
// of the region that sets the instruction set.
struct Mask {
  hn::Mask<Tag> m;
};

HWY_INLINE Mask operator&(Mask a, Mask b) { return {hn::And(a.m, b.m)}; }
HWY_INLINE Mask operator|(Mask a, Mask b) { return {hn::Or(a.m, b.m)}; }
HWY_INLINE Mask operator!(Mask a) { return {hn::Not(a.m)}; }

struct Floats {
  hn::Vec<Tag> v;

  Floats() = default;
  HWY_ATTR HWY_INLINE Floats(hn::Vec<Tag> raw) : v(raw) {}
  HWY_ATTR HWY_INLINE Floats(float a) : v(hn::Set(Tag(), a)) {}
};

inline constexpr std::size_t floats_at_once = hn::MaxLanes(Tag());
HWY_INLINE Floats load_floats(const float* p) { return hn::LoadU(Tag(), p); }
HWY_INLINE void store_floats(Floats a, float* p) { hn::StoreU(a.v, Tag(), p); }
/// Holds for the first n lanes, or all of fewer.
HWY_INLINE Mask first_lanes(std::size_t n) { return {hn::FirstN(Tag(), n)}; }

HWY_INLINE Floats operator+(Floats a, Floats b) { return hn::Add(a.v, b.v); }
HWY_INLINE Floats operator-(Floats a, Floats b) { return hn::Sub(a.v, b.v); }
HWY_INLINE Floats operator*(Floats a, Floats b) { return hn::Mul(a.v, b.v); }
HWY_INLINE Floats operator/(Floats a, Floats b) { return hn::Div(a.v, b.v); }
/// a b + c, a b - c and c - a b, rounded once where the instruction set can.
HWY_INLINE Floats multiply_add(Floats a, Floats b, Floats c) { return hn::MulAdd(a.v, b.v, c.v); }
HWY_INLINE Floats multiply_subtract(Floats a, Floats b, Floats c) {
  return hn::MulSub(a.v, b.v, c.v);
}
HWY_INLINE Floats subtract_product(Floats c, Floats a, Floats b) {
  return hn::NegMulAdd(a.v, b.v, c.v);
}
HWY_INLINE Floats operator-(Floats a) { return hn::Neg(a.v); }
HWY_INLINE Mask operator<(Floats a, Floats b) { return {hn::Lt(a.v, b.v)}; }
HWY_INLINE Mask operator>(Floats a, Floats b) { return {hn::Gt(a.v, b.v)}; }
HWY_INLINE Mask operator<=(Floats a, Floats b) { return {hn::Le(a.v, b.v)}; }
HWY_INLINE Mask operator>=(Floats a, Floats b) { return {hn::Ge(a.v, b.v)}; }

// Of a NaN and a number, both give b, as the comparisons of the twin do.
HWY_INLINE Floats minimum(Floats a, Floats b) { return hn::Min(a.v, b.v); }
HWY_INLINE Floats maximum(Floats a, Floats b) { return hn::Max(a.v, b.v); }
HWY_INLINE Floats absolute(Floats a) { return hn::Abs(a.v); }
HWY_INLINE Floats square_root(Floats a) { return hn::Sqrt(a.v); }

// Rough operations, off by `rough_error` of the result at most and by the rounding of one product:
// for the instructions of SSE and AVX, 1.5 * 2^-12; of AVX-512, 2^-14 (and by none for the twin).
// Some processors take subnormal numbers for 0, and write 0 for them.
#if HWY_TARGET == HWY_AVX3
inline constexpr float rough_error = 0x1p-14f;
#else
inline constexpr float rough_error = 0x1.8p-12f;
#endif
/// a / b; 0, or not a number, of a b beyond 2^126, and infinite or not a number where b is 0 or
/// subnormal.
HWY_INLINE Floats rough_quotient(Floats a, Floats b) {
  return hn::Mul(a.v, hn::ApproximateReciprocal(b.v));
}
/// The root of a normal number; of 0 and of infinity it is not a number.
HWY_INLINE Floats rough_root(Floats a) { return hn::Mul(a.v, hn::ApproximateReciprocalSqrt(a.v)); }
/// 1 over the root; infinite of 0 and perhaps of subnormal numbers, and 0 of infinity.
HWY_INLINE Floats rough_inverse_root(Floats a) { return hn::ApproximateReciprocalSqrt(a.v); }
/// a^2, and 2^-100 more where rough_root() cannot take 0.
HWY_INLINE Floats rough_square(Floats a) { return hn::MulAdd(a.v, a.v, hn::Set(Tag(), 0x1p-100f)); }
HWY_INLINE Floats select(Mask m, Floats a, Floats b) { return hn::IfThenElse(m.m, a.v, b.v); }
HWY_INLINE bool any(Mask m) { return !hn::AllFalse(Tag(), m.m); }
HWY_INLINE std::size_t count_of(Mask m) { return hn::CountTrue(Tag(), m.m); }

/// Packs the lanes for which a mask holds to the front of a vector, in their order; the lanes
/// behind them hold anything. (GCC 12 copies the tables of Highway's Compress onto the stack at
/// each call.)
struct Packing {
#if HWY_TARGET == HWY_AVX3
  hn::Mask<Tag> chosen;
#else
  decltype(hn::IndicesFromVec(Tag(), hn::Zero(hn::RebindToUnsigned<Tag>()))) order;
#endif
  std::size_t count;
};
HWY_INLINE Packing packing_of(Mask m) {
#if HWY_TARGET == HWY_AVX3
  return {m.m, hn::CountTrue(Tag(), m.m)};
#else
  const hn::RebindToUnsigned<Tag> whole;
  std::uint8_t bits[8] = {};
  hn::StoreMaskBits(Tag(), m.m, bits);
  const hn::Rebind<std::uint8_t, Tag> bytes;
  const auto order = hn::PromoteTo(whole, hn::LoadU(bytes, set_bits.place[bits[0]]));
  return {hn::IndicesFromVec(Tag(), order), hn::CountTrue(Tag(), m.m)};
#endif
}
HWY_INLINE Floats packed(Floats a, const Packing& packing) {
#if HWY_TARGET == HWY_AVX3
  return hn::Compress(a.v, packing.chosen);
#else
  return hn::TableLookupLanes(a.v, packing.order);
#endif
}

/// Moves lanes of one vector, in their order, into lanes of another one, of which there are enough.
struct Filling {
  Mask filled;  ///< the lanes moved into: the first of those offered
#if HWY_TARGET == HWY_AVX3
  hn::Mask<Tag> chosen;
#else
  decltype(hn::IndicesFromVec(Tag(), hn::Zero(hn::RebindToUnsigned<Tag>()))) source;
#endif
};
HWY_INLINE Filling filling_of(Mask chosen, Mask offered) {
#if HWY_TARGET == HWY_AVX3
  const unsigned first = (1u << hn::CountTrue(Tag(), chosen.m)) - 1;
  return {{{static_cast<__mmask16>(_pdep_u32(first, offered.m.raw))}}, chosen.m};
#else
  const hn::RebindToUnsigned<Tag> whole;
  const hn::Rebind<std::uint8_t, Tag> bytes;
  std::uint8_t from[8] = {}, into[8] = {};
  hn::StoreMaskBits(Tag(), chosen.m, from);
  hn::StoreMaskBits(Tag(), offered.m, into);
  const auto order = hn::PromoteTo(whole, hn::LoadU(bytes, set_bits.place[from[0]]));
  const auto rank = hn::PromoteTo(whole, hn::LoadU(bytes, set_bits.rank[into[0]]));
  const auto count = hn::Set(whole, static_cast<std::uint32_t>(hn::CountTrue(Tag(), chosen.m)));
  const auto filled = hn::And(offered.m, hn::RebindMask(Tag(), hn::Lt(rank, count)));
  return {{filled},
          hn::IndicesFromVec(Tag(), hn::TableLookupLanes(order, hn::IndicesFromVec(whole, rank)))};
#endif
}
/// b, with lanes of a.
HWY_INLINE Floats filled(Floats a, const Filling& filling, Floats b) {
#if HWY_TARGET == HWY_AVX3
  return hn::Vec<Tag>{
      _mm512_mask_expand_ps(b.v.raw, filling.filled.m.raw, hn::Compress(a.v, filling.chosen).raw)};
#else
  return hn::IfThenElse(filling.filled.m, hn::TableLookupLanes(a.v, filling.source), b.v);
#endif
}

// Unsigned integers in the bits of floats.
HWY_INLINE Floats load_numbers(const std::uint32_t* p) {
  return hn::BitCast(Tag(), hn::LoadU(hn::RebindToUnsigned<Tag>(), p));
}
HWY_INLINE void store_numbers(Floats a, std::uint32_t* p) {
  const hn::RebindToUnsigned<Tag> whole;
  hn::StoreU(hn::BitCast(whole, a.v), whole, p);
}
HWY_INLINE Floats number(std::uint32_t a) {
  return hn::BitCast(Tag(), hn::Set(hn::RebindToUnsigned<Tag>(), a));
}
/// The numbers of the lanes: 0, 1, 2 and so on.
HWY_INLINE Floats numbers_of_lanes() {
  return hn::BitCast(Tag(), hn::Iota(hn::RebindToUnsigned<Tag>(), 0));
}
/// In each lane, what `a` has in the lane of this number.
HWY_INLINE Floats permuted(Floats a, Floats numbers) {
  const hn::RebindToUnsigned<Tag> whole;
  return hn::TableLookupLanes(a.v, hn::IndicesFromVec(Tag(), hn::BitCast(whole, numbers.v)));
}
HWY_INLINE Mask same_numbers(Floats a, Floats b) {
  const hn::RebindToUnsigned<Tag> whole;
  return {hn::RebindMask(Tag(), hn::Eq(hn::BitCast(whole, a.v), hn::BitCast(whole, b.v)))};
}

/// Floats whose bits where `mask` has ones are those of the numbers; there `a` must have zeros.
HWY_INLINE Floats with_bits(Floats a, Floats numbers, Floats mask) {
  const hn::RebindToUnsigned<Tag> whole;
  return hn::BitCast(Tag(), hn::OrAnd(hn::BitCast(whole, a.v), hn::BitCast(whole, numbers.v),
                                      hn::BitCast(whole, mask.v)));
}
/// The numbers, read as signed ones.
HWY_INLINE Floats signed_numbers(Floats numbers) {
  return hn::ConvertTo(Tag(), hn::BitCast(hn::RebindToSigned<Tag>(), numbers.v));
}

/// Turns (cosine, sine) by k quarters of a circle, k in the last bits of `shifted`, which is
/// 1.5 * 2^23 + k.
HWY_INLINE void turn(Floats shifted, Floats& cosine, Floats& sine) {
  const hn::RebindToSigned<Tag> whole;
  const auto q = hn::BitCast(whole, shifted.v);
  const auto odd = hn::MaskFromVec(
      hn::BitCast(Tag(), hn::VecFromMask(whole, hn::TestBit(q, hn::Set(whole, 1)))));
  const auto sign_of_sine = hn::BitCast(Tag(), hn::ShiftLeft<30>(hn::And(q, hn::Set(whole, 2))));
  const auto sign_of_cosine = hn::BitCast(
      Tag(), hn::ShiftLeft<30>(hn::And(hn::Add(q, hn::Set(whole, 1)), hn::Set(whole, 2))));
  const auto c = hn::IfThenElse(odd, sine.v, cosine.v);
  const auto s = hn::IfThenElse(odd, cosine.v, sine.v);
  cosine = hn::Xor(c, sign_of_cosine);
  sine = hn::Xor(s, sign_of_sine);
}

}  // namespace needlework::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // toggle
