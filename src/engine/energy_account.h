// The account of the energy of all needles: the energy at the start of a window, and the changes
// since then as whole numbers.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "kernels/double_double.h"
#include "kernels/power_of_two.h"

namespace needlework {

/// Changes of energy are counted in quanta, which are far smaller than the resolution of a double
/// at the total energy. Sums of whole numbers do not depend on their order. They are modulo 2^64,
/// in which those of all windows would overflow.
class EnergyAccount {
 public:
  /// Sources drive the gas towards this energy of all needles, from whatever it has. Follows from
  /// the scene, so that it is not saved.
  void expect(double usual) { usual_ = usual; }
  /// Begins with this energy of all needles, when changes have come to so many quanta.
  void open(double energy, std::uint64_t changes) {
    energy_ = energy;
    changes_ = changes;
    set_quantum();
  }
  /// Notes how far the account had come from the energy at which it has been opened again.
  void note_drift_from(double by_account) { drift_ += relative(energy_, by_account); }

  /// The energy when changes have come to so many quanta.
  double now(std::uint64_t changes) const {
    return energy_ + quantum_ * static_cast<double>(static_cast<std::int64_t>(changes - changes_));
  }
  /// An energy as a whole number of quanta. Rounded to the nearest, so that the account does not
  /// drift.
  std::uint64_t in_quanta(double energy) const {
    return static_cast<std::uint64_t>(
        static_cast<std::int64_t>(energy * per_quantum_ + (energy < 0 ? -0.5 : 0.5)));
  }
  /// So many quanta as an energy, exactly.
  DoubleDouble of_quanta(std::uint64_t quanta) const {
    const auto whole = static_cast<std::int64_t>(quanta);
    const double low = static_cast<double>(static_cast<std::uint32_t>(whole));
    const DoubleDouble sum = two_sum(static_cast<double>(whole >> 32) * 0x1p32, low);
    return {quantum_ * sum.hi, quantum_ * sum.lo};
  }
  /// The energy at which it was opened last.
  double at_opening() const { return energy_; }
  /// Sum of what has been noted, and what would be if this were the energy, relative to it.
  double drift(double energy, std::uint64_t changes) const {
    return drift_ + relative(energy, now(changes));
  }

  /// Saves or restores what does not follow from the rest.
  template <class A>
  void transfer(A& archive) {
    archive(energy_, changes_, drift_);
    if (archive.reads() && is_sound()) set_quantum();
  }
  bool is_sound() const { return std::isfinite(energy_) && std::isfinite(drift_); }

 private:
  static double relative(double energy, double by_account) {
    return energy > 0 ? (energy - by_account) / energy : 0;
  }
  // The energy of the gas is about 2^58 quanta, so that sums of many changes fit 64 bits.
  void set_quantum() {
    const double most = std::max(energy_, usual_);
    quantum_ = times_power_of_two(1, most > 0 ? exponent_of(most) - 58 : 0);
    per_quantum_ = 1 / quantum_;
  }

  double energy_ = 0, quantum_ = 1, per_quantum_ = 1;
  std::uint64_t changes_ = 0;
  double drift_ = 0, usual_ = 0;
};

}  // namespace needlework
