// Included in the namespace of each number type, which has minimum, maximum and select.

/// From the second to the first of two segments of length 1, where they are nearest: directors u1
/// and u2, x = u1 x u2 and xx = x . x, r the first centre less the second. T is a number or lanes
/// of them.
/// Each point on one segment is the best for the point on the other, so what rounding and nearly
/// parallel directors do to the first guess matters in second order: an error d of it adds d^2 xx.
/// Directors parallel within 2^-20 start from the middle, which adds up to 2^-21 to the distance.
template <class T>
NEEDLEWORK_INLINE Vec3<T> segment_gap(const Vec3<T>& r, const Vec3<T>& u1, const Vec3<T>& u2,
                                      const Vec3<T>& x, const T& xx) {
  const T half(0.5), zero(0.0), least(0x1p-40);
  const auto clamped = [&](const T& a) { return minimum(maximum(a, zero - half), half); };
  const T b = dot(u1, u2), r1 = dot(r, u1), r2 = dot(r, u2);
  const T guess = select(xx > least, dot(cross(u2, r), x) / maximum(xx, least), zero);
  const T t = clamped(r2 + clamped(guess) * b);
  const T s = clamped(t * b - r1);
  return r + u1 * s - u2 * t;
}

/// Square of the distance of these segments.
template <class T>
NEEDLEWORK_INLINE T segment_distance_squared(const Vec3<T>& r, const Vec3<T>& u1, const Vec3<T>& u2,
                                             const Vec3<T>& x, const T& xx) {
  const Vec3<T> gap = segment_gap(r, u1, u2, x, xx);
  return dot(gap, gap);
}
