// What can be said of a scene before it runs.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "needlework/initial_state.h"
#include "needlework/theory.h"
#include "src/observe/forecast.h"
#include "src/runs/loaded_scene.h"
#include "src/scene/confinement.h"

namespace needlework::runs {

/// A wall, and what needles do to it at the start. NaN where that is not known exactly.
struct ExplainedWall {
  Scene::WallSide side;
  double hits = 0;   ///< of all needles [1 / time]
  double force = 0;  ///< mean, of all needles [energy / L]
  double stop = 0;   ///< when a wall with a velocity comes to rest; NaN where it does not [time]
};

/// What walls with a velocity come to. The run ends no later than `time`; NaN where nothing says
/// when.
struct ExplainedMotion {
  std::optional<Meeting> meeting;  ///< where nothing stops them before
  double time = 0;                 ///< until.time, when they meet, or when the last one has stopped
  double volume = 0;               ///< of the box then [L^3]
};

/// What gravity does along an axis, in the steady state: over a floor without a ceiling, or along a
/// periodic axis beside thermal walls.
struct ExplainedGravity {
  std::size_t axis = 0;
  double weight = 0;  ///< of all needles: the mean force on the floor, or on the faces of the
                      ///< walls beside a periodic axis [energy / L]
  /// T / (m g) of each species, at the temperature of the start: T = (3 T_tr + 2 T_rot) / 5; empty
  /// along a periodic axis [L]
  std::vector<double> scale_heights = {};
};

/// The facts of a scene, for people and for programs. Borrows the scene.
struct Explanation {
  /// Throws InputError for rods that find no room.
  explicit Explanation(const LoadedScene& loaded);

  const Scene& scene;
  double density;                                ///< [L^-3]
  theory::Temperatures initial;                  ///< as drawn or read
  std::vector<theory::Temperatures> by_species;  ///< the same of each species
  double mean_free_time;                         ///< at the start, 1 / theory::collision_rate
  double rate_exact;  ///< that of a gas in equilibrium, as runs::equilibrium_rate(); else NaN
  /// Of a mixture: collisions of each two species per time at the start, by
  /// Composition::pair_index; empty if they are too many.
  std::vector<double> rates;
  std::vector<double> counted_rates;  ///< the same, as runs::counted_rates_by_pair()
  std::vector<ExplainedWall> walls;
  std::optional<ExplainedMotion> motion;      ///< where walls have a velocity
  std::vector<ExplainedGravity> gravity;      ///< along the axes along which there is some
  double kick_power;                          ///< energy per needle and time that kicks give
  std::optional<theory::SteadyShear> steady;  ///< of uniform shear, at low density
  std::optional<Forecast> expected;  ///< none: never met, wall_s alone, or not known where walls,
                                     ///< gravity or driving are
  double collisions;                 ///< of all needles until then; NaN if nothing is expected
  std::optional<PlannedPlacement> placing;      ///< of rods of finite width that are drawn
  double placing_seconds;                       ///< estimate of the wall time of that
  double seconds;                               ///< of all of the run; NaN if no end is expected
  double memory;                                ///< estimate [bytes]
  std::string search, calendar, accuracy, isa;  ///< of the engine, `auto` resolved
  int threads;
  std::vector<std::string> warnings;
};

}  // namespace needlework::runs
