#include "src/runs/capabilities.h"

#include <string_view>

#include "src/scene/effect_names.h"
#include "src/scene/engine_parts.h"

namespace needlework::runs {

std::vector<std::string> capabilities() {
  std::vector<std::string> out = {"threads", "files/h5md"};
  for (const std::string& isa : instruction_sets()) out.push_back("isa/" + isa);
  for (const std::string_view effect : effect_names) out.push_back("effect/" + std::string(effect));
  return out;
}

}  // namespace needlework::runs
