// Included in the namespace of each number type, which has turned(); see sine_cosine.h.

/// Sine and cosine of a double, or of a vector of them.
template <class T>
NEEDLEWORK_INLINE SineCosine<T> sine_cosine_of(const T& x) {
  // 2^52 + 2^51: adding it rounds to an integer, whose low bits are then those of the sum.
  const T round_magic(0x1.8p52), one(1.0);
  const T shifted = x * T(0x1.45f306dc9c883p-1) + round_magic;
  const T n = shifted - round_magic;
  // pi/2 = part1 + part2 + part3: 40 + 40 + 53 bits, so that n times the first two is exact up to
  // |n| = 2^13.
  const T a = x - n * T(0x1.921fb54442000p+0);
  const T nb = n * T(0x1.a308d31318000p-41);
  const T b = a - nb;
  const T b_rest = (a - b) - nb;
  const T c = b_rest - n * T(0x1.8a2e03707344ap-81);
  const T r = b + c;
  const T r_low = (b - r) + c;

  const T z = r * r;
  const T ps =
      z * (T(0x1.1111111111111p-7) +
           z * (T(-0x1.a01a01a01a01ap-13) +
                z * (T(0x1.71de3a556c734p-19) +
                     z * (T(-0x1.ae64567f544e4p-26) +
                          z * (T(0x1.6124613a86d09p-33) +
                               z * (T(-0x1.ae7f3e733b81fp-41) + z * T(0x1.952c77030ad4ap-49)))))));
  const T pc =
      z * (T(0x1.5555555555555p-5) +
           z * (T(-0x1.6c16c16c16c17p-10) +
                z * (T(0x1.a01a01a01a01ap-16) +
                     z * (T(-0x1.27e4fb7789f5cp-22) +
                          z * (T(0x1.1eed8eff8d898p-29) +
                               z * (T(-0x1.93974a8c07c9dp-37) + z * T(0x1.ae7f3e733b81fp-45)))))));
  const T half = T(0.5) * z;
  // sin(r + r_low) and cos(r + r_low) to first order in r_low.
  const T sine = r + (r * (z * T(-0x1.5555555555555p-3) + z * ps) + r_low * (one - half));
  const T w = one - half;
  const T cosine = w + (((one - w) - half) + (z * pc - r * r_low));
  return turned(shifted, sine, cosine);
}
