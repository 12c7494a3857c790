// What the needles of a file have in common by species, and the law of their collisions.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "needlework/composition.h"
#include "needlework/scene.h"
#include "needlework/state.h"

namespace needlework::io {

/// The species of needles and their restitution. What a file does not say is empty. Where bodies of
/// a species differ, numbers are means, and each has its own in the state.
struct Material {
  std::vector<std::string> names = {};
  std::vector<double> length = {};    ///< of each species [L]
  std::vector<double> mass = {};      ///< of each species, infinite of fixed ones [m]
  std::vector<double> k = {};         ///< m L^2 / (2 I) of each species [1]
  std::vector<double> diameter = {};  ///< of each species of rods; none for thin needles [L]
  std::vector<double> inertia = {};   ///< of each species; none where k says it of all that turn
                                      ///< [m L^2]
  /// Normal and tangential restitution: one for all, or one for each two species, in rows [1].
  std::vector<double> epsilon = {}, beta = {};
  /// 0 for each two species that pass through each other, in rows.
  std::vector<double> meet = {};
  /// What ends the box along axes that are not periodic, and what acts on all needles.
  std::vector<Scene::Wall> walls = {};
  std::array<double, 3> gravity{};  ///< [L / time^2]

  std::size_t species() const;  ///< number of them, at least 1
};

/// The species of a material, in which what a file does not say has the value of the scene's
/// default. Throws InputError, "PATH: ...", if there are not as many values of each kind as there
/// are species, or of each two.
Composition composition_of(const Material& material, const std::string& path);
/// The same without counts and rules, for writers.
std::vector<Species> species_of(const Material& material);

/// The walls one by one, in the order of Scene::wall_sides().
std::vector<Scene::Wall> single_walls(const std::vector<Scene::Wall>& walls);
/// The wall at this end of an axis (0, 1, 2 for x, y, z), none if there is none.
const Scene::Wall* wall_at(const Material& material, std::size_t axis, bool high);

/// Whether the wall changes its place, or its surface moves along itself.
bool moves(const Scene::WallMotion& motion);
bool slides(const Scene::WallMotion& motion);

/// A body, as files have it.
struct BodyOfRow {
  double length, diameter;  ///< [L]
  double mass;              ///< infinite of a fixed one [m]
  double k;                 ///< [1]
  double inertia;           ///< 0 of smooth spheres [m L^2]
};
/// The body of a needle, by its own numbers or those of its species.
BodyOfRow body_at(const std::vector<Species>& all, const State& state, std::size_t i);
/// Whether the bodies of each of so many species differ.
std::vector<bool> which_differ(const State& state, std::size_t species);

/// The lengths of the species, and their diameters, 0 of needles.
std::vector<double> lengths_of(const Material& material);
std::vector<double> diameters_of(const Material& material);
/// As the bodies are in a state, where they grow.
Material grown(Material material, const State& state);
/// Whether they are rods of finite width or spheres, and whether all of them are spheres.
bool has_width(const Material& material);
bool are_spheres(const Material& material);
/// Half the longest extent of a body. [L]
double farthest_end(const std::vector<Species>& all, const State& state);
/// Whether not all species have the same mass and moment of inertia.
bool differ_in_inertia(const Material& material);

/// One of the numbers of species, of which a single one is that of all; `otherwise` if there is
/// none.
inline double number_of(const std::vector<double>& numbers, std::size_t species, double otherwise) {
  if (numbers.size() == 1) return numbers[0];
  return species < numbers.size() ? numbers[species] : otherwise;
}

/// The index of the species of a needle.
inline std::size_t species_at(const State& state, std::size_t i) {
  return state.species.empty() ? 0 : state.species[i];
}

/// Reads the material of an H5MD file: what a Writer writes in /parameters or else, of the mass,
/// what is in the group of the needles; and of its scene walls and gravity. Throws IoError if the
/// file cannot be read, and InputError if a number cannot be used or if the needles of a species
/// have several masses.
Material read_material(const std::string& path);

/// Throws InputError if length, mass, k or epsilon is absent. `path` is the file that was read.
void require_complete(const Material& material, const std::string& path);

}  // namespace needlework::io
