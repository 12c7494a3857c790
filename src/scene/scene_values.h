// The values of a scene's keys, as a scene file would give them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "needlework/scene.h"
#include "src/scene/entry.h"

namespace needlework {

struct KeyValue {
  std::string_view section;
  std::string_view key;
  Value value;
};

/// The keys that a scene has, with their values: all of those that exclude no other, and of the
/// others those that are set.
std::vector<KeyValue> values_of(const Scene& scene);

/// A value as messages quote it.
std::string in_quotes(const Value& value);

}  // namespace needlework
