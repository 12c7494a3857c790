// Time that keeps its precision in long runs: a number of whole epochs and an offset into the
// present one.
#pragma once

#include <cmath>
#include <compare>
#include <cstdint>

#include "kernels/double_double.h"

namespace needlework {

/// The time epoch * (epoch length) + offset, with 0 <= offset < epoch length. Times are
/// normalised, so that comparing the members in order compares the times.
struct Time {
  std::int64_t epoch = 0;
  double offset = 0;

  /// Later than any event, but finite, so that differences from it are finite.
  static constexpr Time never() { return {std::int64_t{1} << 62, 0}; }
  friend constexpr auto operator<=>(const Time&, const Time&) = default;
};

/// Arithmetic with times. The epoch length is a power of two near the mean free time at the start,
/// so that scaling all times by a power of two changes no bit.
class Clock {
 public:
  Clock() = default;
  explicit Clock(double near) : length_(power_of_two(near)) {}

  double epoch_length() const { return length_; }
  /// Spacing between representable times. [time]
  double resolution() const { return length_ * 0x1p-52; }

  /// t + dt for dt >= 0, rounded to the nearest time at the resolution or finer. From 2^62 epochs
  /// on the result is `never`.
  Time add(Time t, double dt) const {
    const double epochs = dt / length_;
    if (!(epochs < 0x1p62)) return Time::never();
    const double whole = std::floor(epochs);
    const double offset = t.offset + (epochs - whole) * length_;
    const bool carry = offset >= length_;
    const std::int64_t epoch = t.epoch + static_cast<std::int64_t>(whole) + carry;
    if (epoch >= Time::never().epoch) return Time::never();
    return {epoch, carry ? offset - length_ : offset};
  }

  /// frequency (time since the start), in turns less whole ones; good to 2^-100 of a turn at any
  /// age, for frequencies [1 / time] that turn less than 2^50 times in an epoch.
  DoubleDouble turns(Time t, double frequency) const;

  /// a - b.
  double difference(Time a, Time b) const {
    return static_cast<double>(a.epoch - b.epoch) * length_ + (a.offset - b.offset);
  }

  /// a - b for times less than 2^53 epochs apart; exact for offsets on the grid of the resolution,
  /// else within 2^-104 relative.
  DoubleDouble exact_difference(Time a, Time b) const {
    const DoubleDouble offsets = two_sum(a.offset, -b.offset);
    if (a.epoch == b.epoch) return offsets;
    return DoubleDouble(static_cast<double>(a.epoch - b.epoch) * length_) + offsets;
  }

  /// Time since time 0, as a double.
  double since_start(Time t) const { return difference(t, {}); }

 private:
  static double power_of_two(double near) {
    return std::isfinite(near) && near > 0 ? std::ldexp(1.0, std::ilogb(near)) : 1.0;
  }
  double length_ = 1;
};

}  // namespace needlework
