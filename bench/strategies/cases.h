// What is measured: scenes and the parts of the engine that run them, in named subsets.
#pragma once

#include <string>
#include <vector>

#include "needlework/scene.h"

namespace needlework::bench {

/// One scene, run by one choice of the engine's parts.
struct Case {
  std::string scene_name;
  Scene scene;
  double filled = 1;  ///< share of each edge of the box that needles begin in
  bool is_baseline = false;

  /// SCENE/SEARCH/QUEUE/ACCURACY/ISA/threads:N, as asked for, and what else is.
  std::string name() const;
};

struct Subset {
  std::string name, what;
  std::vector<Case> (*cases)();  ///< by scene, each time the baseline first
};

/// Those on offer; the first is the one that is meant when none is named.
const std::vector<Subset>& subsets();

/// Throws InputError, naming all, if there is none of this name.
const Subset& subset_of(const std::string& name);

}  // namespace needlework::bench
