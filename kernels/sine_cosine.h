// Sine and cosine of our own, so that they are the same bits on every machine and in every lane.
//
// The argument is reduced by the nearest multiple of pi/2, taken off in three parts; what is left,
// |r| <= pi/4, goes through the Taylor series, whose first neglected terms are below 2^-57 (double)
// and 2^-110 (double-double).
#pragma once

#include <bit>
#include <cstdint>

#include "kernels/double_double.h"

namespace needlework {

template <class T>
struct SineCosine {
  T sine, cosine;
};

namespace sine_cosine_detail {

// x = 2^52 + 2^51: adding it rounds to an integer, whose low bits are then those of the sum.
inline constexpr double round_magic = 0x1.8p52;
inline constexpr double two_over_pi = 0x1.45f306dc9c883p-1;

template <class T>
SineCosine<T> rotate_by_quadrant(std::uint64_t quadrant, T s, T c) {
  if (quadrant & 1) {
    const T swap = s;
    s = c;
    c = -swap;
  }
  if (quadrant & 2) return {-s, -c};
  return {s, c};
}

// Without branches: no processor can foretell the quadrant.
inline SineCosine<double> rotate_by_quadrant(std::uint64_t quadrant, double s, double c) {
  const std::uint64_t s_bits = std::bit_cast<std::uint64_t>(s);
  const std::uint64_t c_bits = std::bit_cast<std::uint64_t>(c);
  const std::uint64_t exchange = (s_bits ^ c_bits) & (0 - (quadrant & 1));
  return {std::bit_cast<double>(s_bits ^ exchange ^ (quadrant & 2) << 62),
          std::bit_cast<double>(c_bits ^ exchange ^ ((quadrant + 1) & 2) << 62)};
}

}  // namespace sine_cosine_detail

/// Sine and cosine of x. For |x| <= 2^12 within 0.8 ulp (tested against quad precision); beyond, up
/// to 2^40, within |x| 2^-52.
inline SineCosine<double> sine_cosine(double x) {
  using namespace sine_cosine_detail;
  const double shifted = x * two_over_pi + round_magic;
  const double n = shifted - round_magic;
  // pi/2 = part1 + part2 + part3: 40 + 40 + 53 bits, so that n times the first two is exact up to
  // |n| = 2^13.
  const double a = x - n * 0x1.921fb54442000p+0;
  const double nb = n * 0x1.a308d31318000p-41;
  const double b = a - nb;
  const double b_rest = (a - b) - nb;
  const double c = b_rest - n * 0x1.8a2e03707344ap-81;
  const double r = b + c;
  const double r_low = (b - r) + c;

  const double z = r * r;
  const double ps =
      z * (0x1.1111111111111p-7 +
           z * (-0x1.a01a01a01a01ap-13 +
                z * (0x1.71de3a556c734p-19 +
                     z * (-0x1.ae64567f544e4p-26 +
                          z * (0x1.6124613a86d09p-33 +
                               z * (-0x1.ae7f3e733b81fp-41 + z * 0x1.952c77030ad4ap-49))))));
  const double pc =
      z * (0x1.5555555555555p-5 +
           z * (-0x1.6c16c16c16c17p-10 +
                z * (0x1.a01a01a01a01ap-16 +
                     z * (-0x1.27e4fb7789f5cp-22 +
                          z * (0x1.1eed8eff8d898p-29 +
                               z * (-0x1.93974a8c07c9dp-37 + z * 0x1.ae7f3e733b81fp-45))))));
  const double half = 0.5 * z;
  // sin(r + r_low) and cos(r + r_low) to first order in r_low.
  const double sine = r + (r * (z * -0x1.5555555555555p-3 + z * ps) + r_low * (1.0 - half));
  const double w = 1.0 - half;
  const double cosine = w + (((1.0 - w) - half) + (z * pc - r * r_low));
  return rotate_by_quadrant(std::bit_cast<std::uint64_t>(shifted), sine, cosine);
}

/// Sine and cosine of x within 2^-100 (1 + |x|), |x| <= 2^40.
SineCosine<DoubleDouble> sine_cosine(const DoubleDouble& x);

}  // namespace needlework
