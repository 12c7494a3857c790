// What can be said of a scene before it runs.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "needlework/theory.h"
#include "src/observe/forecast.h"
#include "src/runs/loaded_scene.h"

namespace needlework::runs {

/// The facts of a scene, for people and for programs. Borrows the scene.
struct Explanation {
  explicit Explanation(const LoadedScene& loaded);

  const Scene& scene;
  double density;                                ///< [L^-3]
  theory::Temperatures initial;                  ///< as drawn or read
  std::vector<theory::Temperatures> by_species;  ///< the same of each species
  double mean_free_time;                         ///< at the start, 1 / theory::collision_rate
  /// Of a mixture: collisions of each two species per time at the start, by
  /// Composition::pair_index; empty if they are too many.
  std::vector<double> rates;
  std::optional<Forecast> expected;  ///< none: never met, or wall_s alone
  double collisions;                 ///< of all needles until then; NaN if nothing is expected
  double seconds;                    ///< estimate of the wall time; NaN if no end is expected
  double memory;                     ///< estimate [bytes]
  std::string search, calendar, accuracy, isa;  ///< of the engine, `auto` resolved
  int threads;
  std::vector<std::string> warnings;
};

}  // namespace needlework::runs
