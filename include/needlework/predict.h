// First contact of one pair of needles: the definition that every faster kernel must equal.
#pragma once

#include <array>
#include <cstdint>

#include "needlework/accuracy.h"

namespace needlework {

/// A needle at time 0 for `predict`. L = 1.
struct FreeNeedle {
  std::array<double, 3> position;          ///< centre [L]
  std::array<double, 3> orientation;       ///< director; normalised on reading
  std::array<double, 3> velocity;          ///< [L / time]
  std::array<double, 3> angular_velocity;  ///< projected on the plane normal to the director
};

struct FirstContact {
  /// Infinity when there is no contact in (0, horizon]; 0 when a pair that has just collided comes
  /// back sooner than velocities in double can tell.
  double time;
  double arm_first;           ///< s12 [L], NaN without contact
  double arm_second;          ///< s21 [L]
  std::uint64_t evaluations;  ///< of the contact function in double
  std::uint64_t escalations;  ///< decisions handed to double-double
};

/// The first contact of two needles in (0, horizon], no periodic images. `just_collided`: the pair
/// has collided at time 0 and separates; that contact is not found again.
/// Throws InputError for places beyond 1e150, velocities beyond 1e300, a director that is 0, and
/// for needles that turn by more than 2^22 radians near each other without a contact.
FirstContact predict(const FreeNeedle& first, const FreeNeedle& second, double horizon,
                     bool just_collided, const Accuracy& accuracy = standard_accuracy);

}  // namespace needlework
