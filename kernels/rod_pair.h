// Two rods of finite width in free flight, and what does not depend on which of them comes first.
#pragma once

#include <limits>
#include <optional>

#include "kernels/contact_function.h"
#include "kernels/inline.h"

namespace needlework::kernels {

/// Two rods and one periodic image. Half lengths of 0 are spheres; one of the two may be a thin
/// needle, as only the sum of the radii counts. Exchanging the rods and negating
/// `shift` changes no bit of any result.
struct RodPair : Pair {
  double distance = 1;  ///< of the axes at contact, the sum of the radii, above 0 [L]
  /// Both bodies grow in proportion, linearly in time: half lengths and distance are those at
  /// s = 0, and 1 + growth s times as large at s. [1 / time]
  double growth = 0;
};

/// Makes a frame comoving.
template <class T>
void let_grow(Frame<T>& frame, double growth);

/// The pair in scaled lengths and time. Of bodies that grow, lengths are comoving: divided by
/// 1 + growth s, so that the bodies keep their sizes and directors turn as ever. The centres then
/// move along the straight line r + v s', with s' = s / (1 + growth s) and v less growth r in place
/// of the velocity.
template <class T>
Frame<T> rod_frame(const RodPair& pair, const PairScale& scale) {
  Frame<T> out = make_frame<T>(pair, scale);
  if (pair.growth > 0) [[unlikely]]
    let_grow(out, pair.growth * scale.per_rate);
  return out;
}

/// s of s'; infinite from s' = 1 / growth on.
template <class T>
T time_of_comoving(const Frame<T>& frame, const T& comoving) {
  if (!(frame.growth > 0)) return comoving;
  const T left = T(1.0) - T(frame.growth) * comoving;
  if (!(to_double(left) > 0)) return T(std::numeric_limits<double>::infinity());
  return comoving / left;
}
/// r at s, and its rate of change, which becomes no larger.
template <class T>
struct Centres {
  Vec3<T> r, v;
};
/// `grows` is whether bodies do, so that the code of others does not ask.
template <bool grows, class T>
NEEDLEWORK_INLINE Centres<T> centres_at(const Frame<T>& frame, const T& s) {
  if constexpr (!grows) return {frame.r + frame.v * s, frame.v};
  const T shrunk = T(1.0) / (T(1.0) + T(frame.growth) * s);
  return {frame.r + frame.v * (s * shrunk), frame.v * (shrunk * shrunk)};
}

/// Powers of two that scale a pair so that the largest distance of the centres at a contact lies in
/// [1, 2) and the rods move by about 1 in a time of 1.
PairScale rod_scale_of(const RodPair& pair);

/// Times in double are refined in double-double where the bound of their error is above this share
/// of the time since s = 0. The bounds are at least three times the error, and fifty times what it
/// is mostly; that of spheres is just above the largest error.
inline constexpr double rod_polish_above = 0x1p-42;

/// How far rounding of the records may have moved the rods. [L]
double rod_allowance_of(const RodPair& pair);

/// A pair whose rods are in an order that does not depend on which of them is given first.
class OrderedRods {
 public:
  explicit OrderedRods(const RodPair& pair);
  OrderedRods(const OrderedRods&) = delete;
  OrderedRods& operator=(const OrderedRods&) = delete;

  const RodPair& pair() const { return *pair_; }
  bool is_exchanged() const { return other_.has_value(); }

 private:
  std::optional<RodPair> other_;
  const RodPair* pair_;
};

}  // namespace needlework::kernels
