// What can be said of a scene before it runs.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "src/observe/forecast.h"
#include "src/runs/scene_source.h"

namespace needlework::cli {

/// The facts of a scene, for people and for programs. Borrows the scene.
struct Explanation {
  explicit Explanation(const LoadedScene& loaded);

  const Scene& scene;
  double density;                    ///< [L^-3]
  theory::Temperatures initial;      ///< as drawn or read
  double mean_free_time;             ///< at the start, 1 / theory::collision_rate
  std::optional<Forecast> expected;  ///< none: never met, or wall_s alone
  double seconds;                    ///< estimate of the wall time; NaN if nothing is expected
  double memory;                     ///< estimate [bytes]
  std::vector<std::string> warnings;
};

/// The object that `check --json` prints.
std::string json_of(const Explanation& explanation);

/// Some lines for people.
std::string text_of(const Explanation& explanation);

}  // namespace needlework::cli
