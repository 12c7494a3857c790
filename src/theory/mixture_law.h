// Rates of a mixture with Gaussian velocities: how often needles of each two species collide, and
// how fast the temperatures of each species change.
#pragma once

#include <span>
#include <vector>

#include "needlework/theory.h"
#include "src/theory/graded_rule.h"

namespace needlework::theory {

/// The integrals over the contacts of each two species. What does not depend on temperatures is
/// tabulated once. Immutable, so threads may share it.
class MixtureLaw {
 public:
  /// Needs a volume > 0 [L^3]. `contact`: see MixtureCurve.
  MixtureLaw(const Composition& composition, double volume, std::vector<double> contact = {});

  MixtureRates rates(std::span<const Temperatures> now) const;
  /// The same once, without memory for all pairs at the same time.
  static MixtureRates rates_once(const Composition& composition, double volume,
                                 std::span<const Temperatures> now);
  const Composition& composition() const { return composition_; }

 private:
  // One node of the quadrature over the arms s and s' of a pair of species; the directors are
  // averaged over. Of an impulse along a direction e, M is the inverse mass e.M e.
  struct Contact {
    double weight;         // of the collision rate, without sigma, per pair of needles
    double first, second;  // s^2 / I, s'^2 / I' [1 / m]
    double normal;         // M along the normal [1 / m]
    // s^2 / I along the surface. Of spheres, whose spin moves the contact only along it, their
    // radii are in the place of s.
    double first_along, second_along;
  };
  // Means of traces in the plane of the directors, with P and P' the projections off each director,
  // which are 1 for spheres:
  // of M^-1 X and of M^-1 Y M^-1 X, for X in {1, P, P'} and Y in {1, P, P'}.
  struct Traces {
    double once[3] = {}, twice[3][3] = {};
  };
  struct Pair {
    std::size_t first, second;
    std::vector<Contact> contacts;
    std::vector<Traces> traces;  // of each contact; empty if the two are smooth
  };

  struct WithoutPairs {};
  MixtureLaw(const Composition& composition, double volume, WithoutPairs);
  Pair tabulated(std::size_t first, std::size_t second) const;
  MixtureRates no_rates(std::span<const Temperatures> now) const;
  void tabulate(Pair& pair) const;
  void tabulate(Pair& pair, std::span<const Node> first, std::span<const Node> second,
                double unit) const;
  static Traces traces_of_spheres(const Contact& contact, double masses);
  void add(const Pair& pair, std::span<const Temperatures> now, MixtureRates& out) const;
  template <bool rough>
  void add(const Pair& pair, std::span<const Temperatures> now, MixtureRates& out) const;

  Composition composition_;
  double volume_;
  std::vector<double> contact_;  ///< by pair; empty for 1
  std::vector<Pair> pairs_;
};

}  // namespace needlework::theory
