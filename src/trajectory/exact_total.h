// Exact sums of numbers of any size, which do not depend on the order of their terms.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "kernels/power_of_two.h"
#include "src/trajectory/exact_sum.h"

namespace needlework {

/// A sum of fewer than 2^64 finite terms, none of them negative, without any error: a whole number
/// of the smallest double. Unlike ExactSum it need not be told how large terms will become, and
/// takes half a kilobyte.
class ExactTotal {
 public:
  void add(double term) {
    const auto raw = std::bit_cast<std::uint64_t>(term);
    constexpr int fraction_bits = 52;
    const auto exponent = static_cast<std::size_t>(raw >> fraction_bits);
    const std::uint64_t fraction = raw & ((std::uint64_t{1} << fraction_bits) - 1);
    const std::uint64_t mantissa =
        exponent ? fraction | std::uint64_t{1} << fraction_bits : fraction;
    const std::size_t place = exponent ? exponent - 1 : 0;  // of its last bit
    const UnsignedInt128 shifted = static_cast<UnsignedInt128>(mantissa) << place % digit_bits;
    std::uint64_t* digit = &digits_[place / digit_bits];
    digit[0] += static_cast<std::uint32_t>(shifted);
    digit[1] += static_cast<std::uint32_t>(shifted >> digit_bits);
    digit[2] += static_cast<std::uint32_t>(shifted >> 2 * digit_bits);
    if (++terms_ == most_terms) carry();
  }
  void take(ExactTotal& other) {
    if (terms_ + other.terms_ >= most_terms) {
      carry();
      other.carry();
    }
    for (std::size_t n = 0; n < digits_.size(); ++n) digits_[n] += other.digits_[n];
    terms_ += other.terms_;
  }
  /// The sum, rounded once.
  double value() const {
    ExactTotal whole = *this;
    whole.carry();
    std::size_t top = digits_.size() - 1;
    while (top > 2 && whole.digits_[top] == 0) --top;
    UnsignedInt128 leading = 0;
    for (std::size_t n = top + 1; n-- > top - 2;)
      leading = leading << digit_bits | whole.digits_[n];
    // The three digits have 65 bits or more, unless there are no others; so this rounds correctly.
    for (std::size_t n = 0; n < top - 2; ++n) leading |= whole.digits_[n] != 0;
    const int exponent = static_cast<int>((top - 2) * digit_bits) + least_exponent;
    return times_power_of_two(static_cast<double>(leading), exponent);
  }

  /// Passes the sum to an archive (src/archive/archive.h).
  template <class Archive>
  friend void transfer(Archive& archive, ExactTotal& total) {
    total.carry();
    archive(total.digits_);
    total.terms_ = 1;
    for (const std::uint64_t digit : total.digits_) archive.require(digit >> digit_bits == 0);
  }

 private:
  static constexpr int digit_bits = 32;
  static constexpr int least_exponent = -1074;  // of a double
  static constexpr std::uint64_t most_terms = std::uint64_t{1} << 31;

  // Makes each digit smaller than 2^32, as one term does.
  void carry() {
    std::uint64_t over = 0;
    for (std::uint64_t& digit : digits_) {
      digit += over;
      over = digit >> digit_bits;
      digit &= ~std::uint32_t{0};
    }
    terms_ = 1;
  }

  // The largest double ends in digit 65; sums of 2^64 of them have two more.
  std::array<std::uint64_t, 68> digits_{};
  std::uint64_t terms_ = 0;  // no digit is larger than this times 2^32
};

/// The same for terms of either sign: a sum of the positive ones less one of the others.
class SignedExactTotal {
 public:
  void add(double term) { term < 0 ? below_.add(-term) : above_.add(std::abs(term)); }
  void take(SignedExactTotal& other) {
    above_.take(other.above_);
    below_.take(other.below_);
  }
  double value() const { return above_.value() - below_.value(); }

  template <class Archive>
  friend void transfer(Archive& archive, SignedExactTotal& total) {
    archive(total.above_, total.below_);
  }

 private:
  ExactTotal above_, below_;
};

}  // namespace needlework
