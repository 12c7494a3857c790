// Included in the namespace of each number type, which has minimum, maximum, select, multiply_add,
// multiply_subtract, and rough_quotient(a, b): a / b, good to 2^-11.

/// Half the lengths of two segments, and the same with the other sign.
template <class T>
struct HalfLengths {
  T first, second, minus_first, minus_second;
};

template <class T>
NEEDLEWORK_INLINE HalfLengths<T> half_lengths(const T& first, const T& second) {
  const T zero(0.0);
  return {first, second, zero - first, zero - second};
}

/// From the second to the first of two segments, where they are nearest: directors u1 and u2,
/// x = u1 x u2 and xx = x . x, r the first centre less the second, half their lengths. T is a
/// number or a vector of them. Each point on one segment is the best for the point on the other, so
/// what rounding and nearly parallel directors do to the first guess matters in second order: an
/// error d of it adds at most d^2 xx to the square of the distance. Directors parallel within 2^-20
/// start from the middle, which adds up to 2^-20 of the half length of the first to the distance.
template <class T>
NEEDLEWORK_INLINE Vec3<T> segment_gap(const Vec3<T>& r, const Vec3<T>& u1, const Vec3<T>& u2,
                                      const Vec3<T>& x, const T& xx, const HalfLengths<T>& half) {
  const T zero(0.0), least(0x1p-40);
  const auto on_first = [&](const T& a) {
    return minimum(maximum(a, half.minus_first), half.first);
  };
  const auto on_second = [&](const T& a) {
    return minimum(maximum(a, half.minus_second), half.second);
  };
  const T b = dot(u1, u2), r1 = dot(r, u1), r2 = dot(r, u2);
  const T guess =
      select(xx > least, rough_quotient(dot(cross(u2, r), x), maximum(xx, least)), zero);
  const T t = on_second(multiply_add(on_first(guess), b, r2));
  const T s = on_first(multiply_subtract(t, b, r1));
  return subtract_scaled(add_scaled(r, u1, s), u2, t);
}

/// Square of the distance of these segments.
template <class T>
NEEDLEWORK_INLINE T segment_distance_squared(const Vec3<T>& r, const Vec3<T>& u1, const Vec3<T>& u2,
                                             const Vec3<T>& x, const T& xx,
                                             const HalfLengths<T>& half) {
  const Vec3<T> gap = segment_gap(r, u1, u2, x, xx, half);
  return dot(gap, gap);
}
