// What a gas is made of: species of needles or of rods, and how those of each two species collide.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "needlework/distribution.h"

namespace needlework {

/// How numbers of bodies are drawn that differ within a species, by seed and id. What is absent is
/// the number of the species.
struct DrawnSizes {
  std::optional<Distribution> length = {}, diameter = {}, mass = {}, k = {}, inertia = {};
  std::optional<double> density = {};  ///< the mass: of thin needles per length [m / L], of rods
                                       ///< and spheres per volume [m / L^3]
  std::optional<double> aspect = {};   ///< the diameter: length over diameter
  bool homogeneous = false;  ///< k of rods follows from their shapes, whatever the species
                             ///< says; of thin needles it is that of the species

  friend bool operator==(const DrawnSizes&, const DrawnSizes&) = default;
};

/// How a number differs among the bodies of a species, as they are.
struct Spread {
  double mean = 0;
  double width = 0;  ///< standard deviation over mean [1]
  double least = 0, greatest = 0;

  bool is_one() const { return least == greatest; }
  friend bool operator==(const Spread&, const Spread&) = default;
};

/// What bodies of a species are whose sizes differ: means over them, and how far they reach.
struct Sizes {
  double product = 0;                            ///< of length and diameter, the mean [L^2]
  double square = 0;                             ///< of the diameter [L^2]
  double cube = 0;                               ///< of the diameter [L^3]
  double volume = 0;                             ///< the mean; so that of all is exact [L^3]
  double least_extent = 0, greatest_extent = 0;  ///< from end to end [L]
  Spread length, diameter;                       ///< [L]
  Spread mass, inertia;                          ///< [m], [m L^2]
  Spread k;  ///< one number where all differ from it by rounding alone; zeros of spheres [1]

  friend bool operator==(const Sizes&, const Sizes&) = default;
};

/// One species of infinitely thin needles or, with a diameter, of rods of finite width: cylinders
/// with spherical caps. A rod of length 0 is a sphere, whose rotation counts only if it is rough.
struct Species {
  std::string name = {};    ///< any text; names must differ
  std::uint64_t count = 0;  ///< number of needles
  double length = 1.0;      ///< of the axis, without the caps [L]
  double mass = 1.0;        ///< [m]
  double k = 6.0;           ///< m L^2 / (2 I) > 0; 6: uniform needle, 2: mass at the tips; see
                            ///< homogeneous_k() for rods; without meaning for spheres
  double t_tr = 1.0;        ///< translational temperature of a drawn state
  double t_rot = 1.0;       ///< rotational temperature of a drawn state
  double diameter = 0.0;    ///< 0: a needle [L]
  /// The moment of inertia as a scene gives it in place of k, which then follows. [m L^2]
  std::optional<double> given_inertia = {};
  double q = 0;  ///< 4 I / (m D^2) of rough spheres, at most 2/3; 0 of smooth ones, whose rotation
                 ///< nothing changes; without meaning for others

  DrawnSizes drawn = {};
  bool fixed = false;    ///< of infinite mass: they stay where they are, and do not meet each other
  bool overlap = false;  ///< fixed ones may overlap each other
  /// Where each body has numbers of its own, what else is known of all: length, diameter and mass
  /// are then means, and k is that of the mean moment of inertia.
  std::optional<Sizes> sizes = {};

  bool has_axis() const { return length > 0; }  ///< whether it is no sphere
  /// Whether collisions change its rotation.
  bool turns() const { return has_axis() || q > 0; }
  /// Rotational degrees of freedom: 2, 3 of rough spheres, 0 of smooth ones.
  int rotations() const { return has_axis() ? 2 : q > 0 ? 3 : 0; }
  /// Moment of inertia about an axis through the centre, normal to the needle; 0 for smooth
  /// spheres, whose rotation nothing changes. [m L^2]
  double inertia() const {
    return has_axis() ? mass * (length * length) / (2 * k) : q * mass * (diameter * diameter) / 4;
  }
  /// Gives it this moment of inertia: by k or, of a sphere, q. [m L^2]
  void set_inertia(double inertia) {
    if (has_axis())
      k = mass * (length * length) / (2 * inertia);
    else
      q = 4 * inertia / (mass * (diameter * diameter));
  }
  /// The mean square of the angular velocity at this rotational temperature. [1 / time^2]
  double w2_at(double its_t_rot) const {
    if (has_axis()) return 4 * k * its_t_rot / (mass * (length * length));
    return turns() ? 3 * its_t_rot / inertia() : 0;
  }
  double extent() const { return length + diameter; }  ///< from end to end; the mean [L]
  /// Of the largest body. [L]
  double greatest_extent() const { return sizes ? sizes->greatest_extent : extent(); }
  double greatest_diameter() const { return sizes ? sizes->diameter.greatest : diameter; }
  double greatest_length() const { return sizes ? sizes->length.greatest : length; }
  /// The mass as files and other programs have it: infinite of fixed ones. [m]
  double mass_or_infinity() const { return fixed ? std::numeric_limits<double>::infinity() : mass; }
  /// The moment of inertia likewise; 0 of smooth spheres. [m L^2]
  double inertia_or_infinity() const { return fixed && turns() ? mass_or_infinity() : inertia(); }
  double volume() const;  ///< the mean [L^3]
  /// The means of length times diameter, and of the diameter squared. [L^2]
  double product() const { return sizes ? sizes->product : length * diameter; }
  double square() const { return sizes ? sizes->square : diameter * diameter; }
  /// The mean of the diameter cubed. [L^3]
  double cube() const { return sizes ? sizes->cube : diameter * diameter * diameter; }
};

/// k of a homogeneous rod of this length and diameter, both >= 0 and not both 0.
double homogeneous_k(double length, double diameter);

/// Index of a species in Composition::species.
using SpeciesIndex = std::uint8_t;
inline constexpr std::size_t most_species = 255;
/// Limit of the number of needles of all species together: ids are 32 bits wide.
inline constexpr std::uint64_t most_needles = (std::uint64_t{1} << 32) - 2;

/// Parameters of the collision rule.
struct Restitution {
  double epsilon = 1;  ///< normal, [0, 1]
  double beta = -1;    ///< tangential, [-1, 1]; -1 is smooth

  bool is_rough() const { return beta != -1; }
  friend bool operator==(const Restitution&, const Restitution&) = default;
};

/// All species of a gas, in the order of the scene, and the collision rule of each two of them.
/// There is at least one species.
class Composition {
 public:
  /// One species of length 1 and mass 1.
  Composition() : Composition({Species{}}, {}) {}
  /// All pairs collide by the same rule.
  Composition(std::vector<Species> all, const Restitution& rule)
      : species_(std::move(all)),
        rules_(species_.size() * species_.size(), rule),
        meets_(rules_.size(), true) {}

  const std::vector<Species>& species() const { return species_; }
  const Species& operator[](std::size_t index) const { return species_[index]; }
  std::size_t size() const { return species_.size(); }

  /// The rule of collisions of species a with species b, which is that of b with a.
  const Restitution& restitution(std::size_t a, std::size_t b) const {
    return rules_[a * species_.size() + b];
  }
  void set_restitution(std::size_t a, std::size_t b, const Restitution& rule) {
    rules_[a * species_.size() + b] = rules_[b * species_.size() + a] = rule;
  }
  /// The rules of all pairs, by first and second species.
  const std::vector<Restitution>& rules() const { return rules_; }
  /// Whether bodies of species a and b meet, as those of b and a; others pass through each other.
  bool meets(std::size_t a, std::size_t b) const { return meets_[a * species_.size() + b] != 0; }
  /// Two that do not meet have the rule of elastic smooth bodies, which nothing asks for.
  void set_meets(std::size_t a, std::size_t b, bool meets) {
    meets_[a * species_.size() + b] = meets_[b * species_.size() + a] = meets;
    if (!meets) set_restitution(a, b, {});
  }
  /// Whether no distance is kept: of those that do not meet, but for fixed ones, which may overlap
  /// each other only where both species say so.
  bool may_overlap(std::size_t a, std::size_t b) const {
    const Species &first = species_[a], &second = species_[b];
    if (first.fixed && second.fixed) return first.overlap && second.overlap;
    return !meets(a, b);
  }
  bool all_meet() const;  ///< the bodies of each two species
  /// Whether any two of the bodies meet; of a species alone, those that there may be.
  bool any_meet() const;

  void set_count(std::size_t index, std::uint64_t count) { species_[index].count = count; }
  void set_species(std::size_t index, const Species& species) { species_[index] = species; }

  std::uint64_t count() const;  ///< number of needles of all species
  std::uint64_t fixed() const;  ///< of those that do not move
  bool has_fixed() const { return fixed() > 0; }
  /// The species that all needles are of, where there is but one with needles. A species alone is
  /// that, whatever its count.
  std::optional<std::size_t> only() const;
  // Of the species with needles, or of all if none has any:
  double longest() const;  ///< largest extent, that of needles is their length [L]
  double widest() const;   ///< largest diameter [L]
  /// Whether these are rods, which collide where their axes are their mean diameter apart.
  bool has_width() const { return widest() > 0; }
  bool are_spheres() const;  ///< whether no body has an axis
  /// Whether bodies of both species are spheres, which roughness lets turn about any axis.
  bool are_spheres(std::size_t a, std::size_t b) const {
    return !species_[a].has_axis() && !species_[b].has_axis();
  }
  /// Whether thin needles are among bodies that have a width.
  bool is_partly_thin() const;
  /// Whether no two bodies of these species may overlap: they meet, and not as thin needles do, or
  /// are fixed and kept apart.
  bool exclude(std::size_t a, std::size_t b) const {
    return contact_distance(a, b) > 0 && !may_overlap(a, b);
  }
  /// Half the number of rotational degrees of freedom of a moving body, the mean: 1 of needles and
  /// of none. The energy per body is 1.5 T_tr plus this times T_rot.
  double turning_share() const;
  /// The distance of the axes of two rods in contact. [L]
  double contact_distance(std::size_t a, std::size_t b) const {
    return 0.5 * (species_[a].diameter + species_[b].diameter);
  }
  /// Whether the bodies of any species have numbers of their own.
  bool has_own_sizes() const;
  double packing_fraction(double volume) const;  ///< share of this volume that rods take up
  bool is_mixture() const { return size() > 1; }
  /// One species of alike thin needles, as in the paper: kinetic theory is exact at every density.
  bool is_needle_gas() const {
    return !is_mixture() && !has_width() && !has_own_sizes() && all_meet();
  }
  /// Whether any pair has tangential restitution, or loses energy.
  bool is_rough() const;
  bool is_inelastic() const;
  /// The species of each needle in order of id: those given or, if none are, as many of each as
  /// there are, one species after the other.
  std::vector<SpeciesIndex> in_order_of_id(const std::vector<SpeciesIndex>& given = {}) const;
  /// The index of the pair (a, b) among all pairs without order, in rows: (0,0), (0,1), ..., (1,1).
  std::size_t pair_index(std::size_t a, std::size_t b) const {
    const std::size_t low = a < b ? a : b, high = a < b ? b : a;
    return low * size() - low * (low + 1) / 2 + high;
  }
  std::size_t pairs() const { return size() * (size() + 1) / 2; }

 private:
  std::vector<Species> species_;
  std::vector<Restitution> rules_;
  std::vector<std::uint8_t> meets_;  ///< by first and second species
};

}  // namespace needlework
