// The kernels of near_needles.h for one kind of Floats. Included in the namespace of each
// instruction set, which has Floats and Mask.
//
// Margins. A float carries 24 bits, so each operation is off by 2^-24 of its result. Where a fused
// one rounds once, the product in it is off by nothing, so that what is derived for two roundings
// holds; nothing relies on equal products to cancel. Needles are no longer than the unit of length,
// and centres are within a few units (the caller's margin grows with its cells). What words round
// is said where they are read. Directors of motions come from sines and cosines good to 2^-20 and
// phases good to 2^-23 of themselves; times are good to 2^-20 and enter by the speeds. Lengths
// below are off by less than `margin` of SimdBounds, which has a reserve of more than four.
// Rounding does not shrink with the needles: where a margin or an error contains a length, it is
// the unit.
//
// Rough roots and quotients are off by up to `rough_error`. Where a bound grows with one, a
// constant puts it on the safe side of that error and of the roundings beside it; elsewhere it is a
// guess, of which any will do or whose error has a margin. For the twin, `rough_error` and these
// margins are 0. What is not a number must rule nothing out: a bound that may be none is the second
// argument of minimum() or maximum(), so that it is their result.

#include "kernels/vec3_body.h"

using V3 = Vec3<Floats>;

// Sums of products, rounded once where the instruction set can.
NEEDLEWORK_INLINE Floats dot(const V3& a, const V3& b) {
  return multiply_add(a.z, b.z, multiply_add(a.y, b.y, a.x * b.x));
}
NEEDLEWORK_INLINE V3 cross(const V3& a, const V3& b) {
  return {subtract_product(a.y * b.z, a.z, b.y), subtract_product(a.z * b.x, a.x, b.z),
          subtract_product(a.x * b.y, a.y, b.x)};
}
NEEDLEWORK_INLINE V3 add_scaled(const V3& a, const V3& b, Floats s) {
  return {multiply_add(b.x, s, a.x), multiply_add(b.y, s, a.y), multiply_add(b.z, s, a.z)};
}
NEEDLEWORK_INLINE V3 subtract_scaled(const V3& a, const V3& b, Floats s) {
  return {subtract_product(a.x, b.x, s), subtract_product(a.y, b.y, s),
          subtract_product(a.z, b.z, s)};
}

/// What is rough is not too small times 1 + rough_spare, nor too large times 1 - rough_spare, with
/// a quarter of this left for roundings.
constexpr float rough_spare = 4 * rough_error / 3;

/// Not less than the length of a vector, by roundings; not a number if its square is infinite.
NEEDLEWORK_INLINE Floats rough_length(const V3& a) {
  const Floats squares = multiply_add(a.z, a.z, multiply_add(a.y, a.y, rough_square(a.x)));
  return rough_root(squares) * Floats(1 + rough_spare);
}

#include "kernels/closest_approach_body.h"

inline V3 broadcast(const float (&a)[3]) { return {Floats(a[0]), Floats(a[1]), Floats(a[2])}; }

inline Floats norm_1(const V3& a) { return absolute(a.x) + absolute(a.y) + absolute(a.z); }

#include "kernels/bracket_body.h"
#include "kernels/near_filters_body.h"
