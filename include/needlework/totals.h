// Sums over all needles at one instant.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace needlework {

/// Sums over all needles at one instant, which do not depend on the order of the needles.
struct Totals {
  double time = 0;                   ///< since the start of the run [time]
  double t_tr = 0;                   ///< (2/3) <m v^2 / 2>
  double t_rot = 0;                  ///< <I w^2 / 2> of those that turn, which spheres do not
  double energy = 0;                 ///< per needle; with gravity g along axes with walls that of
                                     ///< -m g r, r counted from the low edges of the box
  std::array<double, 3> momentum{};  ///< total
  std::uint64_t collisions = 0;      ///< since the start of the run
  std::uint64_t tc_collisions = 0;
};

/// What Totals has of the needles of one species.
struct SpeciesTotals {
  std::uint64_t count = 0;  ///< number of needles
  double t_tr = 0;          ///< (2/3) <m v^2 / 2>
  double t_rot = 0;         ///< <I w^2 / 2>
};

/// What has happened at one object of a source of events, such as a wall, since the start of a run.
struct ObjectTotals {
  std::uint64_t events = 0;
  double impulse = 0;         ///< sum of |J| [m L / time]
  double normal_impulse = 0;  ///< sum of their components along the normal of the object
};

/// Hits of needles on one wall since the start of a run.
struct WallTotals {
  int axis = 0;       ///< 0, 1, 2 for x, y, z
  bool high = false;  ///< at the high edge of the box, else at the low one
  std::uint64_t hits = 0;
  double impulse = 0;         ///< sum of |J| [m L / time]
  double normal_impulse = 0;  ///< sum of J along the normal into the gas, which thermal walls may
                              ///< draw negative; over area and time it is the pressure
  double area = 0;            ///< of its face of the box [L^2]
  double phase = 0;           ///< of its motion now, in radians from 0 to 2 pi; NaN at rest

  /// Mean over the time since the start. [energy / L^3]
  double pressure(double time) const { return normal_impulse / (area * time); }
};

/// Contacts of needles that slide on each other, since the start of the run. Each that was entered
/// has ended, or lasts.
struct SlidingContacts {
  std::uint64_t entered = 0;
  std::uint64_t ended_by_force = 0;   ///< the force that holds the needles together would pull
  std::uint64_t ended_by_tip = 0;     ///< a tip was reached; the needles pass each other
  std::uint64_t ended_by_strike = 0;  ///< anything else changed the velocities of one of the two
  /// Collisions whose epsilon was raised, as one of the needles had just touched a third one.
  std::uint64_t crowded = 0;
  double time = 0;  ///< that pairs have been in contact, without that of present steps [time]
};

/// What each effect has put into the energy of the needles since the start of a run, as energy per
/// needle; negative where it has taken energy out. The sum is the change of Totals::energy, up to
/// the rounding of needles' motion (Simulation::energy_drift).
struct EnergyBudget {
  double pairs = 0;                  ///< collisions of two needles
  std::vector<double> walls;         ///< hits on each wall, in the order of wall_totals()
  std::optional<double> thermostat;  ///< if there is one
  std::optional<double> kicks;       ///< if there are some
  std::optional<double> gravity;     ///< its work along periodic axes, if there is some
  double velocities_set = 0;         ///< velocities that a caller has replaced

  /// Calls visit(name, value) for each that there is; the value of walls is an array.
  template <class Visit>
  void for_each(Visit&& visit) const {
    visit("pairs", pairs);
    if (!walls.empty()) visit("walls", walls);
    if (thermostat) visit("thermostat", *thermostat);
    if (kicks) visit("kicks", *kicks);
    if (gravity) visit("gravity", *gravity);
    visit("velocities_set", velocities_set);
  }
};

/// "x", "y" or "z", and "low" or "high", as in scenes.
inline const char* axis_name(const WallTotals& wall) {
  constexpr const char* names[] = {"x", "y", "z"};
  return names[wall.axis];
}
inline const char* side_name(const WallTotals& wall) { return wall.high ? "high" : "low"; }

}  // namespace needlework
