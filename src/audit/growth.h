// Bodies that grow as the audit knows it: all lengths of all bodies in proportion, linearly in
// time. Masses and moments of inertia stay.
#pragma once

#include <cstddef>
#include <cstdint>

#include "src/audit/flight.h"

namespace needlework::audit {

class Growth {
 public:
  /// All lengths are 1 + rate * time times those at the start. The run is one of so many bodies,
  /// over whose velocities and diameters the engine has summed to find the rate. [1 / epoch]
  Growth(const Quad& rate, std::size_t bodies)
      : rate_(rate), of_rate_(half_unit * (16 + static_cast<double>(bodies))) {}

  /// Present lengths, those at the start being 1.
  Quad scale_at(const Instant& now) const { return 1 + rate_ * elapsed<Quad>({}, now).middle; }
  /// What the scale grows by in a unit of time as a share of itself. [1 / epoch]
  Quad relative_rate_at(const Instant& now) const { return rate_ / scale_at(now); }

  /// To be called when the engine has counted the time of growth anew, which rounds the scale.
  void count_anew() { ++counted_anew_; }
  /// By which share of it the engine's scale may be off, where it is this.
  double off(double scale) const {
    const double roundings = 16 + 2 * static_cast<double>(counted_anew_);
    return half_unit * roundings + of_rate_ * (1 - 1 / scale);
  }
  /// The same of the relative rate.
  double off_rate(double scale) const { return of_rate_ + off(scale); }

 private:
  static constexpr double half_unit = 0x1p-53;

  Quad rate_;
  double of_rate_;
  std::uint64_t counted_anew_ = 0;
};

}  // namespace needlework::audit
