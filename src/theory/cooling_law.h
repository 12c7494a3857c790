// How fast a Gaussian, homogeneous gas of needles changes its two temperatures: the right-hand side
// of the cooling equations, for one gas.
#pragma once

#include "needlework/theory.h"
#include "src/theory/contact_integrals.h"

namespace needlework::theory {

/// The rates of the gas at one instant, per unit of tau.
struct Rates {
  Temperatures temperatures;  ///< d(T_tr, T_rot) / d tau
  double collisions;          ///< that one needle takes part in
};

/// The cooling law of one gas, with its integrals tabulated. Immutable, so threads may share it.
class CoolingLaw {
 public:
  /// Throws std::invalid_argument for numbers out of range.
  explicit CoolingLaw(const Gas& gas);

  /// Rates are homogeneous: multiplying both temperatures by x multiplies the changes of
  /// temperature by x^(3/2) and the collisions by x^(1/2).
  Rates rates(Temperatures now) const;

  /// The q = T_rot / T_tr that no longer changes, and that every state tends to.
  double stationary_q() const;

  /// No collision loses energy.
  bool is_elastic() const;

 private:
  Gas gas_;
  ContactIntegrals integrals_;
};

}  // namespace needlework::theory
