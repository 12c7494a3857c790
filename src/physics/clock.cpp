#include "src/physics/clock.h"

namespace needlework {

// Whole numbers of 2^-128 turns, modulo 2^128: their multiples lose whole turns and nothing else.
DoubleDouble Clock::turns(Time t, double frequency) const {
  __extension__ using Fraction = unsigned __int128;
  const double of_epoch = frequency * length_;  // exact, as the length is a power of two
  int exponent;
  const double mantissa = std::frexp(of_epoch - std::floor(of_epoch), &exponent);
  const auto bits = static_cast<std::uint64_t>(std::ldexp(mantissa, 53));
  const int shift = exponent - 53 + 128;
  const Fraction in_epoch = shift >= 0    ? Fraction{bits} << shift
                            : shift > -64 ? Fraction{bits >> -shift}
                                          : 0;
  const Fraction in_all = in_epoch * static_cast<std::uint64_t>(t.epoch);
  const auto high = static_cast<double>(static_cast<std::uint64_t>(in_all >> 75));
  constexpr Fraction low_bits = (Fraction{1} << 75) - 1;
  const auto low = static_cast<double>(static_cast<std::uint64_t>((in_all & low_bits) >> 22));
  const DoubleDouble after = two_prod(frequency, t.offset);
  const DoubleDouble sum =
      DoubleDouble(high * 0x1p-53, low * 0x1p-106) + (after - DoubleDouble(std::floor(after.hi)));
  const double whole = std::floor(to_double(sum));
  return sum - DoubleDouble(whole);
}

}  // namespace needlework
