// Bodies that have numbers of their own, and what is known of all those of a species.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "needlework/composition.h"
#include "src/composition/compensated_sum.h"

namespace needlework {

/// One body, where those of a species differ.
struct BodyNumbers {
  double length = 1;          ///< of the axis [L]
  double diameter = 0;        ///< [L]
  double mass = 1;            ///< [m]
  double inertia = 1.0 / 12;  ///< 0 for smooth spheres [m L^2]

  friend bool operator==(const BodyNumbers&, const BodyNumbers&) = default;
};

/// k of a needle or rod. [1]
inline double k_of(double mass, double length, double inertia) {
  return mass * (length * length) / (2 * inertia);
}
/// The moment of inertia of a needle or rod. [m L^2]
inline double inertia_of_rod(double mass, double length, double k) {
  return mass * (length * length) / (2 * k);
}
/// 4 I / (m D^2) of a sphere.
inline constexpr double q_of_homogeneous = 0.4;
/// The mass of a sphere is nowhere farther from its centre than its surface, but for rounding.
inline constexpr double least_q = 1e-9 * (1 - 1e-12), greatest_q = 2.0 / 3 * (1 + 1e-12);
inline double q_of(double mass, double diameter, double inertia) {
  Species out{.length = 0, .mass = mass, .diameter = diameter};
  out.set_inertia(inertia);
  return out.q;
}
/// The moment of inertia of a sphere. [m L^2]
inline double inertia_of(double q, double mass, double diameter) {
  return Species{.length = 0, .mass = mass, .diameter = diameter, .q = q}.inertia();
}

/// Adds up one number of bodies, none of them below 0.
class SpreadSums {
 public:
  void add(double x) {
    const bool first = count_++ == 0;
    if (first) unit_ = x > 0 ? x : 1;
    least_ = first ? x : std::min(least_, x);
    greatest_ = std::max(greatest_, x);
    sum_.add(x);
    // Apart from the first one, so that numbers close to each other keep their digits.
    const double apart = x / unit_ - 1;
    apart_.add(apart);
    squares_.add(apart * apart);
  }
  double mean() const { return sum_.value() / static_cast<double>(count_); }
  /// Zeros of no numbers.
  Spread spread() const {
    if (count_ == 0) return {};
    if (least_ == greatest_) return {mean(), 0, least_, greatest_};
    const double count = static_cast<double>(count_), apart = apart_.value() / count;
    const double variance = std::max(0.0, squares_.value() / count - apart * apart);
    return {mean(), std::sqrt(variance) / (1 + apart), least_, greatest_};
  }

 private:
  CompensatedSum sum_, apart_, squares_;
  double unit_ = 1, least_ = 0, greatest_ = 0;
  std::size_t count_ = 0;
};

/// Adds bodies up. Trajectories may depend on the means, so bodies are always added in order of id.
class SizesOfBodies {
 public:
  void add(const BodyNumbers& body) {
    const double extent = body.length + body.diameter, square = body.diameter * body.diameter;
    sizes_.least_extent = count_++ == 0 ? extent : std::min(sizes_.least_extent, extent);
    sizes_.greatest_extent = std::max(sizes_.greatest_extent, extent);
    length_.add(body.length);
    diameter_.add(body.diameter);
    mass_.add(body.mass);
    inertia_.add(body.inertia);
    if (body.length > 0) k_.add(k_of(body.mass, body.length, body.inertia));
    product_.add(body.length * body.diameter);
    square_.add(square);
    cube_.add(square * body.diameter);
    volume_.add(Species{.length = body.length, .diameter = body.diameter}.volume());
  }

  /// The species made of the bodies added, of which there is at least one.
  Species complete(Species species) const {
    Sizes sizes = sizes_;
    sizes.product = mean_of(product_);
    sizes.square = mean_of(square_);
    sizes.cube = mean_of(cube_);
    sizes.volume = mean_of(volume_);
    sizes.length = length_.spread();
    sizes.diameter = diameter_.spread();
    sizes.mass = mass_.spread();
    sizes.inertia = inertia_.spread();
    sizes.k = spread_of_k(species.k);
    species.length = sizes.length.mean;
    species.diameter = sizes.diameter.mean;
    species.mass = sizes.mass.mean;
    // That of fixed bodies, which moves nothing, is by the k or q of the species.
    if (!species.fixed) species.set_inertia(sizes.inertia.mean);
    species.given_inertia.reset();
    species.sizes = sizes;
    return species;
  }
  std::size_t count() const { return count_; }

 private:
  double mean_of(const CompensatedSum& sum) const {
    return sum.value() / static_cast<double>(count_);
  }
  // As given, where that of each body is so but for rounding.
  Spread spread_of_k(double given) const {
    constexpr double rounding = 1e-12;
    const Spread k = k_.spread();
    if (!(k.greatest - k.least <= rounding * k.greatest)) return k;
    const double one = std::abs(given - k.mean) <= rounding * given ? given : k.mean;
    return {one, 0, one, one};
  }

  Sizes sizes_;
  SpreadSums length_, diameter_, mass_, inertia_, k_;
  CompensatedSum product_, square_, cube_, volume_;
  std::size_t count_ = 0;
};

}  // namespace needlework
