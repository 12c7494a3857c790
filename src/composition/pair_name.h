// How pairs of species are named where something is told of each of them.
#pragma once

#include <string>

#include "needlework/composition.h"

namespace needlework {

/// "a-b", in the order of the species. Scenes in which two pairs would have one name are refused.
inline std::string pair_name(const Composition& composition, std::size_t a, std::size_t b) {
  return composition[a < b ? a : b].name + "-" + composition[a < b ? b : a].name;
}

}  // namespace needlework
