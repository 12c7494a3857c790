// Cases of a scene that the user gives, with several choices of the engine's parts.
#pragma once

#include <string>
#include <vector>

#include "bench/strategies/cases.h"

namespace needlework::bench {

/// A scene file with overrides, and what is to be compared on it: values of keys of [engine], of
/// which an empty list stands for what the scene says, and further overrides ("SECTION.KEY=VALUE"),
/// each of which makes another scene.
struct OwnScene {
  std::string file;
  std::vector<std::string> overrides, settings;
  std::vector<std::string> searches, calendars, accuracies, isas, threads, cell_sides,
      capsule_radii;
};

struct OwnCases {
  std::vector<Case> cases;            ///< the scene as it is first; it is the baseline
  std::vector<std::string> left_out;  ///< names of combinations that need one thread
};

/// All combinations, each once; where nothing is to be compared, the searches with SIMD are. Throws
/// InputError for a name that is unknown and for an instruction set that this CPU does not have,
/// naming the option; and as reading and completing a scene do.
OwnCases cases_of(const OwnScene& own);

}  // namespace needlework::bench
