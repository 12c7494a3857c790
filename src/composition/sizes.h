// Bodies that have numbers of their own, and what is known of all those of a species.
#pragma once

#include <algorithm>
#include <cstddef>

#include "needlework/composition.h"
#include "src/composition/compensated_sum.h"

namespace needlework {

/// One body, where those of a species differ.
struct BodyNumbers {
  double length = 1;          ///< of the axis [L]
  double diameter = 0;        ///< [L]
  double mass = 1;            ///< [m]
  double inertia = 1.0 / 12;  ///< 0 for spheres [m L^2]

  friend bool operator==(const BodyNumbers&, const BodyNumbers&) = default;
};

/// Adds bodies up. Trajectories may depend on the means, so bodies are always added in order of id.
class SizesOfBodies {
 public:
  void add(const BodyNumbers& body) {
    const double volume = Species{.length = body.length, .diameter = body.diameter}.volume();
    const double extent = body.length + body.diameter;
    const double square = body.diameter * body.diameter;
    const double terms[] = {
        body.length, body.diameter,          body.mass, body.inertia, body.length * body.diameter,
        square,      square * body.diameter, volume};
    for (std::size_t n = 0; n < number_of_sums; ++n) sums_[n].add(terms[n]);
    const bool first = count_++ == 0;
    const auto least = [&](double& to, double by) { to = first ? by : std::min(to, by); };
    const auto greatest = [](double& to, double by) { to = std::max(to, by); };
    least(sizes_.least_extent, extent);
    least(sizes_.least_diameter, body.diameter);
    least(sizes_.least_mass, body.mass);
    least(sizes_.least_inertia, body.inertia);
    greatest(sizes_.greatest_extent, extent);
    greatest(sizes_.greatest_length, body.length);
    greatest(sizes_.greatest_diameter, body.diameter);
  }

  /// The species made of the bodies added, of which there is at least one.
  Species complete(Species species) const {
    species.length = mean(0);
    species.diameter = mean(1);
    species.mass = mean(2);
    if (species.turns())
      species.k = species.mass * (species.length * species.length) / (2 * mean(3));
    species.given_inertia.reset();
    species.sizes = sizes_;
    species.sizes->product = mean(4);
    species.sizes->square = mean(5);
    species.sizes->cube = mean(6);
    species.sizes->volume = mean(7);
    return species;
  }
  std::size_t count() const { return count_; }

 private:
  static constexpr std::size_t number_of_sums = 8;
  double mean(std::size_t n) const { return sums_[n].value() / static_cast<double>(count_); }

  Sizes sizes_;
  CompensatedSum sums_[number_of_sums];
  std::size_t count_ = 0;
};

}  // namespace needlework
