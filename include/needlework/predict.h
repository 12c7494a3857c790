// The first contact of two needles, or of two rods of finite width: the definition that every
// faster kernel must reproduce.
#pragma once

#include <array>
#include <cstdint>

#include "needlework/accuracy.h"

namespace needlework {

/// A needle at time 0 for `predict`.
struct FreeNeedle {
  std::array<double, 3> position;          ///< centre [L]
  std::array<double, 3> orientation;       ///< director, normalised when read
  std::array<double, 3> velocity;          ///< [L / time]
  std::array<double, 3> angular_velocity;  ///< of which the part normal to the director is used [1
                                           ///< / time]
  double length = 1.0;                     ///< of the axis; 0 with a diameter: a sphere [L]
  double diameter = 0.0;                   ///< 0: a thin needle; above, a rod of finite width [L]
};

struct FirstContact {
  /// Infinity if there is no contact in (0, horizon]. 0 if two needles that have just collided
  /// return sooner than velocities in double can resolve, and if two rods touch at time 0 to within
  /// rounding and approach.
  double time;
  double arm_first;           ///< s12 [L], NaN without a contact
  double arm_second;          ///< s21 [L], NaN without a contact
  std::uint64_t evaluations;  ///< evaluations of the contact function in double
  std::uint64_t escalations;  ///< decisions passed on to double-double
};

/// The first contact of two needles in (0, horizon], without periodic images. `just_collided`
/// means that they have collided at time 0 and separate; that contact is not found again. Throws
/// InputError for positions beyond 1e150, velocities beyond 1e300, a director that is 0, a horizon
/// below 0, a length or diameter below 0 or beyond 1e150, neither of them above 0, a needle and a
/// rod, rods that overlap, an accuracy out of range, numbers that
/// are NaN, needles that come near each other so late that a double cannot tell where they are, and
/// a search that would take more than about a second, as for needles that turn near each other for
/// hundreds of thousands of radians without a contact.
FirstContact predict(const FreeNeedle& first, const FreeNeedle& second, double horizon,
                     bool just_collided, const Accuracy& accuracy = standard_accuracy);

}  // namespace needlework
