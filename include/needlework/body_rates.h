// Collision rates of bodies of which each has numbers of its own. All functions throw
// std::invalid_argument, "NAME = VALUE: expected ...", for a number out of range or NaN.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "needlework/theory.h"

namespace needlework::theory {

/// A needle, rod or sphere, and the temperatures of its velocities, 0 of a fixed one.
struct Body {
  double length = 1;          ///< of the axis; 0: a sphere [L]
  double diameter = 0;        ///< 0: a needle [L]
  double mass = 1;            ///< [m]
  double inertia = 1.0 / 12;  ///< not asked for of spheres [m L^2]
  Temperatures now = {};
};

/// How often bodies of each two species meet whose velocities are Gaussian with given temperatures,
/// and whose places and directors know nothing of each other: exact for thin needles at every
/// density, for rods and spheres at low density. The sum over all pairs takes a time proportional
/// to the number of bodies, and has a relative error of at most 1e-7.
class BodyRates {
 public:
  /// Without bodies; who meets whom, and the width, are those of the composition.
  explicit BodyRates(const Composition& composition);

  void add(std::size_t species, const Body& body);

  /// Collisions of each two species per unit of time, by Composition::pair_index, of the bodies
  /// added, in a volume > 0 [L^3].
  std::vector<double> collisions(double volume) const;

  /// The same of spheres that are as often in contact as in an elastic fluid in equilibrium without
  /// order, by contact_values() of each two of them.
  std::vector<double> collisions_of_spheres(double volume) const;

 private:
  // What the contact value of spheres of diameters D and D' is, by powers of D D' / (D + D').
  struct Crowding {
    double constant = 1, linear = 0, square = 0;  // [1], [1 / L], [1 / L^2]
  };
  // The mean of exp(-t a) over the points of contact of a body: on its axis, and on its caps.
  struct Parts {
    double axis = 1, caps = 1;
  };
  // Bodies whose speeds are alike.
  struct Group {
    double flight = 0, turn = 0;  // sums of T_tr / m and T_rot L^2 / I [L^2 / time^2]
    double count = 0;
    double length = 0, length2 = 0, product = 0;                    // sums of L, L^2 and L D
    double diameter = 0, square = 0, diameter3 = 0, diameter4 = 0;  // of D, D^2, D^3 and D^4

    Parts parts(double t, bool has_caps) const;
  };
  // Sums over bodies, each times such a mean.
  struct Sums {
    double length = 0, product = 0;              // on axes: L, L D
    double count = 0, diameter = 0, square = 0;  // on caps: 1, D, D^2
  };
  static double pairs_of(const Sums& a, const Sums& b, const Crowding& crowding);
  static double selves_of(const Group& group, const Parts& parts, const Crowding& crowding);
  std::vector<double> pairs_at(double t, const Crowding& crowding) const;
  std::vector<double> integrated(double volume, const Crowding& crowding) const;

  Composition composition_;
  bool has_caps_;
  std::vector<std::vector<Group>> groups_;                             // by species
  std::vector<std::unordered_map<std::uint64_t, std::size_t>> known_;  // groups by speeds
  std::vector<std::uint64_t> added_;                                   // bodies by species
};

}  // namespace needlework::theory
