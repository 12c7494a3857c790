// Kicks: white noise in steps, which changes the velocities of all needles at one instant.
#pragma once

#include <cstdint>
#include <vector>

#include "src/physics/gas.h"

namespace needlework {

/// When kicks are and what they do to each needle: a function of the seed, the needle's id and the
/// number of the kick.
class Kicks {
 public:
  struct Parameters {
    double every = 1;          ///< [time]
    double translational = 0;  ///< xi: a component of a velocity changes by a variance xi^2 every
    double rotational = 0;     ///< the same for those of an angular velocity
    std::uint64_t seed = 1;
  };
  explicit Kicks(const Parameters& parameters) : parameters_(parameters) {}

  double every() const { return parameters_.every; }
  /// Of kick number n, from 1 on: n times the interval, rounded to a double.
  Time time(const Clock& clock, std::uint64_t n) const;

  struct Change {
    Vec3d velocity, angular_velocity;
  };
  /// Of a body with this director, at kick number n.
  Change change(Id id, std::uint64_t n, const Body& body, const Vec3d& director) const;

  /// All numbers on which they depend.
  std::vector<double> parameters() const;

 private:
  Parameters parameters_;
};

}  // namespace needlework
