// How far apart two bodies are that know nothing of each other.
#pragma once

#include <cstddef>
#include <vector>

#include "src/observe/observable.h"

namespace needlework::observe {

/// The distances of the centres of two bodies, one of each species, that are anywhere in the box:
/// along periodic axes everywhere alike, with the nearest image; along axes with walls where these
/// leave room for both ends, all directors being as likely. That is a density of centres that
/// grows from 0 at half a diameter from a wall, over half a length, to a constant; exact for a gas
/// of needles in equilibrium at every density. With walls along several axes each counts on its
/// own, which leaves out that a director along one wall is across another. An axis with one wall
/// counts as if the open side had one.
class IdealPairs {
 public:
  explicit IdealPairs(const GasSetting& gas) : IdealPairs(gas, gas.box.edges()) {}
  /// In a box with other edges, as walls have moved them.
  IdealPairs(const GasSetting& gas, const Vector& edges);

  /// Up to where distances are known [L]: half the shortest periodic edge, or without one the
  /// largest distance in the box.
  double reach() const;
  /// The shares of all pairs of species a and b in the bins between these borders, up to reach().
  std::vector<double> shares(std::size_t a, std::size_t b,
                             const std::vector<double>& borders) const;

 private:
  // Along one axis with walls: 0 up to low, then rising over a ramp, constant, and falling.
  struct Profile {
    double low, high, ramp;
    double at(double place) const;
  };
  Profile profile(std::size_t species, std::size_t axis) const;
  double overlap(const Profile& a, const Profile& b, double apart) const;
  double within(double square, std::size_t first, std::size_t a, std::size_t b) const;

  Composition composition_;
  Vector box_;
  std::vector<std::size_t> walled_, periodic_;  ///< axes
};

}  // namespace needlework::observe
