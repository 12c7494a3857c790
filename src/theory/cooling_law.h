// Rates of change of the two temperatures of a Gaussian, homogeneous gas of needles: the
// right-hand side of the cooling equations.
#pragma once

#include "needlework/theory.h"
#include "src/theory/contact_integrals.h"

namespace needlework::theory {

/// The rates of the gas at one instant, per unit of tau.
struct Rates {
  Temperatures temperatures;  ///< d(T_tr, T_rot) / d tau
  double collisions;          ///< collisions of one needle
};

/// The cooling law of one gas, with tabulated integrals. Immutable, so threads may share it.
class CoolingLaw {
 public:
  /// Throws std::invalid_argument for numbers out of range.
  explicit CoolingLaw(const Gas& gas);

  /// Rates are homogeneous: multiplying both temperatures by x multiplies the changes of
  /// temperature by x^(3/2) and the collisions by x^(1/2).
  Rates rates(Temperatures now) const;

  /// The ratio q = T_rot / T_tr that is constant in time, to which every state tends.
  double stationary_q() const;

  /// Whether no collision loses energy.
  bool is_elastic() const;

 private:
  Gas gas_;
  ContactIntegrals integrals_;
};

}  // namespace needlework::theory
