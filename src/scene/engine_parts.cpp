#include "src/scene/engine_parts.h"

#include <algorithm>

#include "kernels/isa.h"

namespace needlework {

bool is_for_threads(const Scene::Engine& engine) {
  const auto is_among = [](const std::string& name, const auto& names) {
    return name == "auto" || std::ranges::find(names, name) != names.end();
  };
  return is_among(engine.search, parallel_searches) && is_among(engine.queue, parallel_calendars);
}

std::vector<std::string> instruction_sets() {
  std::vector<std::string> names;
  for (const kernels::Isa isa : kernels::available()) names.emplace_back(kernels::name_of(isa));
  return names;
}

}  // namespace needlework
