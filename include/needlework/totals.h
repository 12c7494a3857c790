// Sums over all needles at one instant.
#pragma once

#include <array>
#include <cstdint>

namespace needlework {

/// Sums over all needles at one instant, which do not depend on the order of the needles.
struct Totals {
  double time = 0;                   ///< since the start of the run [time]
  double t_tr = 0;                   ///< (2/3) <m v^2 / 2>
  double t_rot = 0;                  ///< <I w^2 / 2>
  double energy = 0;                 ///< per needle; with gravity g that of -m g r, r counted
                                     ///< from the low edges of the box
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
  double impulse = 0;  ///< sum of |J| [m L / time]
};

/// Hits of needles on one wall since the start of a run.
struct WallTotals {
  int axis = 0;       ///< 0, 1, 2 for x, y, z
  bool high = false;  ///< at the high edge of the box, else at the low one
  std::uint64_t hits = 0;
  double impulse = 0;  ///< sum of |J| [m L / time]
};

/// "x", "y" or "z", and "low" or "high", as in scenes.
inline const char* axis_name(const WallTotals& wall) {
  constexpr const char* names[] = {"x", "y", "z"};
  return names[wall.axis];
}
inline const char* side_name(const WallTotals& wall) { return wall.high ? "high" : "low"; }

}  // namespace needlework
