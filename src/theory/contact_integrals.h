// Integrals over all configurations in which two needles touch, for Gaussian velocities. Collision
// rate and cooling rates are linear in them.
#pragma once

#include <vector>

#include "needlework/theory.h"

namespace needlework::theory {

/// Seen along one direction e of the relative velocity of the contact points, a pair of needles is
/// two point masses, joined by an inverse mass e.M e = 2 (1 + mu): 2 from the translation and 2 mu
/// from the rotation. The shares say how an impulse along e divides between them. [1]
struct Shares {
  double translation = 0.0;  ///< 1 / (1 + mu)^2: loss of the translation by itself
  double exchange = 0.0;     ///< mu / (1 + mu)^2: exchange between translation and rotation
  double rotation = 0.0;     ///< mu^2 / (1 + mu)^2: loss of the rotation by itself
};

/// Sums over the collisions at given temperatures. Each is an integral over the unit square of
/// arms with the weight g = sqrt(T_tr + T_rot k r^2), which is proportional to the rate of
/// contacts.
struct ContactSums {
  double flux = 0.0;  ///< integral of g
  Shares normal;      ///< integral of g times the shares along the normal, mu = k r^2
  Shares tangential;  ///< integral of g times the shares along both principal directions of the
                      ///< plane of the needles, averaged over the angle between them
};

/// The integrals for one k. All factors but g are tabulated once, and g depends on r alone, so
/// sums() costs a few hundred square roots. Immutable, so threads may share it.
class ContactIntegrals {
 public:
  /// Without `tangential` the tangential sums stay 0; smooth needles (beta = -1) do not need them.
  /// Needs k > 0.
  ContactIntegrals(double k, bool tangential);

  /// Either temperature may be 0. Accurate to rounding for any ratio of the two.
  ContactSums sums(Temperatures temperatures) const;

 private:
  /// All contacts at one distance r of (s12, s21) from the centres of the needles.
  struct Ring {
    double k_r2;    ///< k r^2
    double weight;  ///< area of the ring
    Shares normal;
    Shares tangential;
  };

  void add_ring(double r, double least_angle, double weight, bool tangential);

  double k_;
  std::vector<Ring> rings_;
};

}  // namespace needlework::theory
