// Own sine and cosine, which give the same bits on every machine and in every vector.
//
// The argument is reduced by the nearest multiple of pi/2, subtracted in three parts. The rest,
// |r| <= pi/4, goes through the Taylor series, whose first neglected terms are below 2^-57 (double)
// and 2^-110 (double-double).
#pragma once

#include <bit>
#include <cstdint>

#include "kernels/double_double.h"
#include "kernels/inline.h"

namespace needlework {

template <class T>
struct SineCosine {
  T sine, cosine;
};

namespace sine_cosine_detail {

// Without branches: no processor can predict the quadrant.
inline SineCosine<double> turned(double shifted, double s, double c) {
  const std::uint64_t quadrant = std::bit_cast<std::uint64_t>(shifted);
  const std::uint64_t s_bits = std::bit_cast<std::uint64_t>(s);
  const std::uint64_t c_bits = std::bit_cast<std::uint64_t>(c);
  const std::uint64_t exchange = (s_bits ^ c_bits) & (0 - (quadrant & 1));
  return {std::bit_cast<double>(s_bits ^ exchange ^ (quadrant & 2) << 62),
          std::bit_cast<double>(c_bits ^ exchange ^ ((quadrant + 1) & 2) << 62)};
}

#include "kernels/sine_cosine_body.h"

}  // namespace sine_cosine_detail

/// Sine and cosine of x. For |x| <= 2^12 within 0.8 ulp (tested against quad precision); beyond, up
/// to 2^40, within |x| 2^-52.
inline SineCosine<double> sine_cosine(double x) { return sine_cosine_detail::sine_cosine_of(x); }

/// Sine and cosine of x within 2^-100 (1 + |x|), |x| <= 2^40.
SineCosine<DoubleDouble> sine_cosine(const DoubleDouble& x);

}  // namespace needlework
