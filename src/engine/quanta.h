// Whole numbers of quanta of energy.
#pragma once

#include <cmath>
#include <cstdint>

#include "kernels/double_double.h"

namespace needlework {

/// A whole number modulo 2^128, of which half are negative. Sums do not depend on their order, and
/// hold changes of energy however much a wall, say, has put in since the quantum was chosen.
class Quanta {
 public:
  Quanta() = default;
  /// The nearest one, where |x| < 2^126; beyond, one as large.
  static Quanta nearest(double x) {
    Quanta out;
    const double rounded = x + (x < 0 ? -0.5 : 0.5);
    if (std::abs(rounded) < 0x1p63) {
      const auto whole = static_cast<std::int64_t>(rounded);
      out.low_ = static_cast<std::uint64_t>(whole);
      out.high_ = whole < 0 ? ~std::uint64_t{0} : 0;
      return out;
    }
    const double within = std::abs(x) < 0x1p126 ? x : std::copysign(0x1p126, x);
    const double high = std::floor(within * 0x1p-64);
    out.low_ = static_cast<std::uint64_t>(within - high * 0x1p64);
    out.high_ = static_cast<std::uint64_t>(static_cast<std::int64_t>(high));
    return out;
  }

  Quanta& operator+=(const Quanta& other) {
    low_ += other.low_;
    high_ += other.high_ + (low_ < other.low_ ? 1 : 0);
    return *this;
  }
  Quanta& operator-=(const Quanta& other) {
    high_ -= other.high_ + (low_ < other.low_ ? 1 : 0);
    low_ -= other.low_;
    return *this;
  }
  friend Quanta operator-(Quanta a, const Quanta& b) { return a -= b; }

  /// Rounded.
  double value() const {
    if (fits_64_bits()) return static_cast<double>(static_cast<std::int64_t>(low_));
    return static_cast<double>(static_cast<std::int64_t>(high_)) * 0x1p64 +
           static_cast<double>(low_);
  }
  /// Exact below 2^106.
  DoubleDouble exact() const {
    const auto digits = [](std::uint64_t number) {  // of 32 bits
      return static_cast<double>(static_cast<std::uint32_t>(number));
    };
    if (fits_64_bits()) {
      const auto whole = static_cast<std::int64_t>(low_);
      return two_sum(static_cast<double>(whole >> 32) * 0x1p32, digits(low_));
    }
    const DoubleDouble upper =
        two_sum(static_cast<double>(static_cast<std::int64_t>(high_)) * 0x1p64,
                digits(low_ >> 32) * 0x1p32);
    return upper + DoubleDouble(digits(low_));
  }

  template <class Archive>
  friend void transfer(Archive& archive, Quanta& quanta) {
    archive(quanta.low_, quanta.high_);
  }

 private:
  bool fits_64_bits() const { return high_ == (low_ >> 63 ? ~std::uint64_t{0} : 0); }

  std::uint64_t low_ = 0, high_ = 0;
};

}  // namespace needlework
