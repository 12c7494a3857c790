// The account of the energy of all needles: the energy at the start of a window, and the changes
// since then as whole numbers.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "kernels/double_double.h"
#include "kernels/power_of_two.h"
#include "src/engine/quanta.h"

namespace needlework {

/// Changes of energy are counted in quanta, which are far smaller than the resolution of a double
/// at the total energy. Sums of whole numbers do not depend on their order.
class EnergyAccount {
 public:
  /// Sources drive the gas towards this energy of all needles, from whatever it has. Follows from
  /// the scene, so that it is not saved.
  void expect(double usual) { usual_ = usual; }
  /// Begins with this energy of all needles, of which so much is in their motion, when changes have
  /// come to so many quanta.
  void open(double energy, double of_motion, const Quanta& changes) {
    energy_ = energy;
    of_motion_ = of_motion;
    changes_ = changes;
    set_quantum();
  }
  /// Notes how far the account had come from the energy at which it has been opened again.
  void note_drift_from(double by_account) { drift_ += relative(energy_, by_account); }

  /// The energy when changes have come to so many quanta.
  double now(const Quanta& changes) const {
    return energy_ + quantum_ * (changes - changes_).value();
  }
  /// An energy as a whole number of quanta. Rounded to the nearest, so that the account does not
  /// drift.
  Quanta in_quanta(double energy) const { return Quanta::nearest(energy * per_quantum_); }
  /// So many quanta as an energy, exactly.
  DoubleDouble of_quanta(const Quanta& quanta) const {
    const DoubleDouble sum = quanta.exact();
    return {quantum_ * sum.hi, quantum_ * sum.lo};
  }
  /// The energy at which it was opened last.
  double at_opening() const { return energy_; }
  /// Sum of what has been noted, and what would be if this were the energy, relative to it.
  double drift(double energy, const Quanta& changes) const {
    return drift_ + relative(energy, now(changes));
  }

  /// Saves or restores what does not follow from the rest.
  template <class A>
  void transfer(A& archive) {
    archive(energy_, of_motion_, changes_, drift_);
    if (archive.reads() && is_sound()) set_quantum();
  }
  bool is_sound() const {
    return std::isfinite(energy_) && std::isfinite(of_motion_) && std::isfinite(drift_);
  }

 private:
  static double relative(double energy, double by_account) {
    return energy > 0 ? (energy - by_account) / energy : 0;
  }
  // The energy of the gas is about 2^58 quanta. In gravity what counts is that of the motion, as
  // heights may count from anywhere.
  void set_quantum() {
    const double most = std::max({std::abs(energy_), of_motion_, usual_});
    quantum_ = times_power_of_two(1, most > 0 ? exponent_of(most) - 58 : 0);
    per_quantum_ = 1 / quantum_;
  }

  double energy_ = 0, of_motion_ = 0, quantum_ = 1, per_quantum_ = 1;
  Quanta changes_;
  double drift_ = 0, usual_ = 0;
};

}  // namespace needlework
