// The state of all needles at one instant, as arrays.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace needlework {

/// What a file says of the bodies in it: numbers of each species, none where it does not say them.
struct Bodies {
  std::vector<std::string> names = {};
  std::vector<double> length = {};    ///< of the axis, without the caps [L]
  std::vector<double> diameter = {};  ///< 0: thin needles [L]
  std::vector<double> mass = {};      ///< [m]
  std::vector<double> k = {};         ///< m L^2 / (2 I) [1]
  std::vector<double> q = {};         ///< 4 I / (m D^2) of rough spheres, 0 of others; counts
                                      ///< where `inertia` is empty [1]
  std::vector<double> inertia = {};   ///< 0 of smooth spheres, infinite of fixed bodies that turn;
                                      ///< growth changes k and q, but not this [m L^2]

  /// Number of species; 0 if the file says nothing.
  std::size_t species() const {
    return std::max({names.size(), length.size(), diameter.size(), mass.size(), k.size(), q.size(),
                     inertia.size()});
  }
};

/// Numbers of each needle, where those of a species differ: rows of a state. What is empty is as
/// the species says.
struct OwnBodies {
  std::vector<double> length = {};    ///< of the axis, without the caps [L]
  std::vector<double> diameter = {};  ///< [L]
  std::vector<double> mass = {};      ///< [m]
  std::vector<double> inertia =
      {};  ///< 0 for smooth spheres; if empty, by k of the species [m L^2]

  bool empty() const {
    return length.empty() && diameter.empty() && mass.empty() && inertia.empty();
  }
};

/// Positions, velocities, directors and angular velocities of N needles, one row of three numbers
/// for each needle.
struct State {
  std::array<double, 3> box{};                     ///< edges [L]
  std::array<double, 3> low{};                     ///< where the low edges are: 0, but where a wall
                                                   ///< has moved one; a start moves all to 0 [L]
  std::array<bool, 3> periodic{true, true, true};  ///< along which axes the box is; along the
                                                   ///< others, walls or open sides end it
  double slide = 0;       ///< of the row of boxes above along x, from 0 to the edge [L]
  double shear_rate = 0;  ///< of the uniform flow, rate * y along x, that they have [1 / time]
  std::optional<double> scale;  ///< of bodies that grow, their sizes, which are in bodies and
                                ///< own_bodies, in those of the start; a start needs it not [1]
  std::vector<std::array<double, 3>> position;           ///< centres, inside the box or not [L]
  std::vector<std::array<double, 3>> velocity;           ///< [L / time]
  std::vector<std::array<double, 3>> peculiar_velocity;  ///< beside the flow of [shear], whichever
                                                         ///< image is stored; a copy has it in a
                                                         ///< flow, and a start takes it where
                                                         ///< velocity is empty [L / time]
  std::vector<double> peculiar_x;                        ///< integral over time of its part along x
                                                         ///< since the start; a copy has it where
                                                         ///< an observable follows needles [L]
  std::vector<std::array<double, 3>> orientation;        ///< unit directors [1]
  std::vector<std::array<double, 3>> angular_velocity;   ///< normal to the director, but for
                                                         ///< spheres [1 / time]
  std::vector<std::array<std::int32_t, 3>> image;        ///< number of box crossings along each
                                                         ///< axis; empty: all 0
  std::vector<std::uint32_t> id;                         ///< distinct; empty: 0 to N - 1
  std::vector<std::uint8_t> species;                     ///< indices into the species of the scene;
                                                         ///< empty: as many as the scene counts of
                                                         ///< each, in order of id
  Bodies bodies;                                         ///< of the file that it was read from
  OwnBodies own_bodies;                                  ///< of each needle, or empty

  std::size_t size() const { return position.size(); }
  /// Resizes all arrays to n needles, images and ids included.
  void resize(std::size_t n) {
    position.resize(n);
    velocity.resize(n);
    orientation.resize(n);
    angular_velocity.resize(n);
    image.resize(n);
    id.resize(n);
  }
};

}  // namespace needlework
