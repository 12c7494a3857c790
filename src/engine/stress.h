// The pressure tensor, as sums over a run: what needles carry in flight, and what collisions hand
// over between centres.
#pragma once

#include <array>
#include <cstddef>

#include "kernels/vec3.h"
#include "src/trajectory/exact_total.h"

namespace needlework {

/// Nine numbers, [transport][momentum].
using Tensor = std::array<std::array<double, 3>, 3>;

/// The integral of c c over a flight of duration `t`, of a velocity that is c at its start and
/// changes by `gain` per time.
inline Tensor carried(const Vec3d& c, const Vec3d& gain, double t) {
  const double v[] = {c.x, c.y, c.z}, a[] = {gain.x, gain.y, gain.z};
  Tensor out;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      out[i][j] = t * (v[i] * v[j] +
                       t * (0.5 * (v[i] * a[j] + a[i] * v[j]) + t * (a[i] * a[j] * (1.0 / 3))));
    }
  }
  return out;
}

/// Of a whole run, divided by volume and time the pressure tensor. [energy time]
struct StressSums {
  Tensor kinetic{}, collisional{};
};

/// Sums of a thread, which do not depend on their order: divided by volume and time they are the
/// pressure tensor. [energy time], [energy time]
struct StressTally {
  std::array<std::array<SignedExactTotal, 3>, 3> kinetic;      ///< sum of m c c t over flights
  std::array<std::array<SignedExactTotal, 3>, 3> collisional;  ///< of r12 dp over collisions

  void add_flight(double mass, const Tensor& cc) {
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = i; j < 3; ++j) kinetic[i][j].add(mass * cc[i][j]);
    }
  }
  /// r12 is from the centre of the second needle to that of the first, dp the impulse on the first.
  void add_collision(const Vec3d& r12, const Vec3d& dp) {
    const double r[] = {r12.x, r12.y, r12.z}, p[] = {dp.x, dp.y, dp.z};
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) collisional[i][j].add(r[i] * p[j]);
    }
  }
  void take(StressTally& other) {
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) {
        kinetic[i][j].take(other.kinetic[i][j]);
        collisional[i][j].take(other.collisional[i][j]);
      }
    }
  }

  template <class Archive>
  friend void transfer(Archive& archive, StressTally& tally) {
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) {
        if (j >= i) archive(tally.kinetic[i][j]);
        archive(tally.collisional[i][j]);
      }
    }
  }
};

}  // namespace needlework
