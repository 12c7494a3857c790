// The values of a scene's keys, as a scene file would give them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "needlework/scene.h"
#include "src/scene/document.h"

namespace needlework {

struct KeyValue {
  std::string_view section;
  std::string_view key;
  Value value;
};

/// The keys that a scene has, with their values: all of those that exclude no other, and of the
/// others those that are set.
std::vector<KeyValue> values_of(const Scene& scene);

// These throw InputError, "the scene: SECTION.KEY = VALUE: expected ...", for a value that a scene
// file could not hold.

/// For what the engine reads of every scene: the needles' properties, [collisions] and [engine].
void require_simulable(const Scene& scene);
/// For what an initial state is drawn from, but the seed, which may be any.
void require_drawable(const Scene& scene);
/// For all keys of a scene that was restored from a file, which may be damaged.
void require_valid(const Scene& scene);

}  // namespace needlework
