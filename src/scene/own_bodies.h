// Bodies that have numbers of their own, where those of a species differ.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "needlework/scene.h"
#include "needlework/state.h"
#include "src/composition/sizes.h"

namespace needlework {

/// Those of a body that is as its species says.
BodyNumbers numbers_of(const Species& species);

/// Whether the rows of a state lack numbers that the scene draws, or some of those of which others
/// are given.
bool lacks_numbers(const Scene& scene, const State& state);
/// The columns of a state with these numbers: of each row those that it has, then those that the
/// scene draws for its id or says of its species. Throws InputError for a wrong number of rows.
OwnBodies all_numbers_of(const Scene& scene, const State& state);

/// The bodies of all rows of a state that lacks no numbers; empty where those of a species are
/// alike. Throws InputError for numbers out of range, and for species in which some bodies turn, or
/// have width, and others do not.
std::vector<BodyNumbers> own_bodies_of(const Composition& composition, const State& state);

/// The needles of a state or of a scene: the species of each and, where those of one differ, its
/// body.
struct Members {
  Composition composition;
  std::vector<SpeciesIndex> species;
  std::vector<BodyNumbers> own;  ///< or empty

  std::size_t size() const { return species.size(); }
  const Species& species_of(std::size_t i) const { return composition[species[i]]; }
  BodyNumbers body(std::size_t i) const { return own.empty() ? numbers_of(species_of(i)) : own[i]; }
  /// Of its mass, or moment of inertia, in that of its species.
  double share_of_mass(std::size_t i) const {
    return own.empty() ? 1 : own[i].mass / species_of(i).mass;
  }
  double share_of_inertia(std::size_t i) const {
    const double of_species = own.empty() ? 0 : species_of(i).inertia();
    return of_species > 0 ? own[i].inertia / of_species : 1;
  }
};

/// Of all rows of a state. Throws as own_bodies_of().
Members members_of(const Composition& composition, const State& state);
/// Of a scene that is drawn, in order of id.
Members drawn_members(const Scene& scene);

/// A number of bodies that may be drawn, with the keys of its distribution.
struct DrawnQuantity {
  std::string_view name;
  std::optional<Distribution> DrawnSizes::*member;
  /// Of the shape, mean, width, least and greatest number, and of the exponent.
  std::array<std::string_view, 6> keys;
};
/// In the order of the counters from which they are drawn.
inline constexpr std::array<DrawnQuantity, 5> drawn_quantities{
    {{"length",
      &DrawnSizes::length,
      {"length.distribution", "length.mean", "length.width", "length.min", "length.max",
       "length.exponent"}},
     {"diameter",
      &DrawnSizes::diameter,
      {"diameter.distribution", "diameter.mean", "diameter.width", "diameter.min", "diameter.max",
       "diameter.exponent"}},
     {"mass",
      &DrawnSizes::mass,
      {"mass.distribution", "mass.mean", "mass.width", "mass.min", "mass.max", "mass.exponent"}},
     {"k", &DrawnSizes::k, {"k.distribution", "k.mean", "k.width", "k.min", "k.max", "k.exponent"}},
     {"inertia",
      &DrawnSizes::inertia,
      {"inertia.distribution", "inertia.mean", "inertia.width", "inertia.min", "inertia.max",
       "inertia.exponent"}}}};

/// Whether mass is nowhere farther from the centre than the surface: I = q m D^2 / 4, 0 < q <= 2/3.
bool is_inertia_of_sphere(const BodyNumbers& body);
inline constexpr const char* expected_inertia_of_sphere =
    "one with which q = 4 I / (m D^2) of a sphere is from 1e-9 to 2/3, of which all mass is at its "
    "surface";

/// A species of a scene for drawing its bodies, which are rough where those made of it are: rough
/// spheres then have the q that they have where nothing else says their moments of inertia.
Species as_drawn(const Species& given, const Species& made);

/// A species of a scene with all that follows from how it is drawn: numbers where its bodies are
/// alike, `sizes` and means where each has its own. `first` is the id of the first of them. Does
/// nothing where a distribution is wrong, and where `sizes` are known.
Species completed(const Species& species, std::uint64_t seed, std::uint64_t first);

/// A body of which a number is out of its range.
struct WrongBody {
  std::uint64_t id;
  std::string_view quantity;
  double value;
  std::string expected;
};
std::optional<WrongBody> wrong_body_of(const Species& species, std::uint64_t seed,
                                       std::uint64_t first);

/// The bodies that are drawn for a scene, in order of id; empty if those of each species are alike.
std::vector<BodyNumbers> drawn_bodies(const Scene& scene);

/// The same as columns of a state.
OwnBodies columns_of(const std::vector<BodyNumbers>& bodies);

/// Makes species of a scene spheres whose bodies in a state are, so that what follows knows which
/// are rough.
void adopt_spheres(Scene& scene, const State& state);
/// Gives rough spheres of a state a moment of inertia that were smooth in it. To be called before
/// adopt_own_bodies().
void add_inertia_of_spheres(const Scene& scene, State& state);
/// Makes the species of a scene those of the bodies of a state that have numbers of their own;
/// otherwise changes nothing. Throws as own_bodies_of().
void adopt_own_bodies(Scene& scene, const State& state);

}  // namespace needlework
