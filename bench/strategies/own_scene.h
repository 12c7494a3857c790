// Cases of a scene that the user gives, with several choices of the engine's parts.
#pragma once

#include <string>
#include <vector>

#include "bench/strategies/cases.h"

namespace needlework::bench {

/// A scene file with overrides, and which searches, calendars, instruction sets and numbers of
/// threads are to be compared on it. An empty list stands for what the scene says.
struct OwnScene {
  std::string file;
  std::vector<std::string> overrides;
  std::vector<std::string> searches, calendars, isas, threads;
};

struct OwnCases {
  std::vector<Case> cases;            ///< the scene as it is first; it is the baseline
  std::vector<std::string> left_out;  ///< names of combinations that need one thread
};

/// All combinations, each once; without any list, those of the searches with SIMD. Throws
/// InputError for a name that is unknown and for an instruction set that this CPU does not have,
/// naming the option; and as reading and completing a scene do.
OwnCases cases_of(const OwnScene& own);

}  // namespace needlework::bench
