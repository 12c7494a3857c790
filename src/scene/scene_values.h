// The values of a scene's keys, as a scene file would give them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "needlework/parse.h"
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

/// Throws InputError, "the scene: SECTION.KEY: expected ...", for a number out of range, a word
/// that is none of those expected, or numbers that exclude each other, in a scene that was made in
/// code. Where a state is provided, the box is not looked at.
void require_in_range(const Scene& scene, Provided provided = {});

/// The same for a scene that was restored from a file: besides, a scene file must be able to
/// describe it.
void require_valid(const Scene& scene);

}  // namespace needlework
