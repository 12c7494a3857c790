// Where the walls of a scene are, how much room they leave, and what goes with them.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "needlework/scene.h"
#include "src/box/moving_edge.h"

namespace needlework {

/// What bounds the needles along an axis.
struct Gap {
  bool has_low = false, has_high = false;  ///< a wall at 0, at the edge
  double low = 0, high = 0;                ///< how far the surfaces are from there at t = 0 [L]
  double approach = 0;  ///< they come so much nearer to each other than the edge [L]

  bool is_walled() const { return has_low || has_high; }  ///< neither wrapped nor imaged
  bool is_open() const { return has_low != has_high; }    ///< only one side has a wall
  /// The greater distance [L] by which a tip of a needle is beyond a wall at t = 0; at most 0 if it
  /// is beyond none. `edge` is that of the box, `reach` the distance of the tips from the centre
  /// along the axis.
  double beyond(double centre, double reach, double edge) const;
};
std::array<Gap, 3> gaps_of(const Scene& scene);

/// Whether a wall has a motion that goes to and fro.
bool shakes(const Scene::Wall& wall);

/// The edges of a box as walls with a velocity move them; none where no wall has one.
std::optional<MovingEdges> moving_edges_of(const Scene& scene, const std::array<double, 3>& box);

/// When walls first come so near to each other that the longest body of the scene has no room.
struct Meeting {
  double time = 0;
  std::size_t axis = 0;
  double distance = 0;  ///< how near, the extent of that body [L]
};
std::optional<Meeting> meeting_of(const Scene& scene, const std::array<double, 3>& box);

/// How long the edges of a box may be for the needles and the walls of a scene.
class Room {
 public:
  explicit Room(const Scene& scene);

  double least(std::size_t axis) const { return least_[axis]; }  ///< [L]
  double most() const { return most_; }                          ///< [L]
  /// But for the rounding of bodies that have grown until they were as long.
  bool holds(double edge, std::size_t axis) const {
    return edge >= least_[axis] * (1 - 1e-14) && edge <= most_;
  }
  bool holds(const std::array<double, 3>& box) const;
  /// What messages expect of a box that is none of these.
  std::string expected_instead_of(const std::array<double, 3>& box) const;

 private:
  std::array<Gap, 3> gaps_;
  std::array<double, 3> least_{};
  double most_;
  double counts_as_ = 1;         ///< a length of 1
  const char* body_ = "needle";  ///< whose length, from end to end, it is
};

/// Whether a needle's motion may change without a collision: walls or driving do so, and in a
/// uniform flow the part of it that is not the flow's.
bool acts_on_single_needles(const Scene& scene);
/// Whether energy may change but in collisions of needles: by inelastic, thermal or moving walls,
/// by driving or by uniform shear.
bool exchanges_energy(const Scene& scene);

/// Whether there is a uniform flow beside which a drift of all needles stays for ever: neither a
/// thermostat nor walls that draw velocities change it.
bool keeps_drift(const Scene& scene);

/// Whether a run comes to an end that the scene sets: one of [until], or that its bodies have
/// grown.
bool has_end(const Scene& scene);

/// Whether anything changes the motion of needles so that a gas does not just cool or stay as it
/// is.
bool is_pushed(const Scene& scene);
bool has_gravity(const Scene& scene);
/// Whether there is some along a periodic axis, where thermal walls beside it brake.
bool has_gravity_along_periodic(const Scene& scene);

/// "x-low": how messages and `--set` name an entry [[walls]].
std::string name_of(const Scene::Wall& wall);

}  // namespace needlework
