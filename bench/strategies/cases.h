// The measured cases: scenes and the parts of the engine that run them, in named subsets.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "needlework/scene.h"
#include "needlework/state.h"

namespace needlework::bench {

/// One scene, run with one choice of the engine's parts.
struct Case {
  std::string scene_name;
  Scene scene;
  double filled = 1;  ///< fraction of each edge of the box in which needles start
  bool is_baseline = false;
  std::string setting = {};  ///< "SECTION.KEY=VALUE" that differs from the scene; "" if none does
  std::shared_ptr<const State> initial = {};  ///< null: drawn

  /// SCENE/SEARCH/CALENDAR/ACCURACY/ISA/threads:N, as asked for, and other settings, the one of
  /// the scene last.
  std::string name() const;
};

/// The parts of a case's name, empty where it has none.
struct NameParts {
  std::string scene, search, queue, accuracy, isa, threads, storage, cell_side, capsule_radius,
      setting;
  bool operator==(const NameParts&) const = default;

  struct Named {
    const char* name;
    std::string NameParts::*part;
  };
  static const std::vector<Named> all;  ///< in the order of the name
};
NameParts parts_of(const std::string& name);

struct Subset {
  std::string name, what;
  std::vector<Case> (*cases)();  ///< ordered by scene, the baseline of each first
};

/// All subsets; the first one is the default.
const std::vector<Subset>& subsets();

/// Throws InputError, listing all names, for an unknown name.
const Subset& subset_of(const std::string& name);

}  // namespace needlework::bench
