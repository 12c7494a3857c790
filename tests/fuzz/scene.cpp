// Fuzz target: any bytes are a scene or an InputError, nothing else. Lines that begin with "!" are
// overrides, the others are the file.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "needlework/error.h"
#include "needlework/initial_state.h"
#include "needlework/parse.h"
#include "needlework/simulation.h"
#include "src/scene/check.h"
#include "src/scene/printable.h"

namespace {

void require(bool condition) {
  if (!condition) std::abort();
}

// What a scene promises to those who read it.
void check_scene(const needlework::Scene& scene, const std::string& text) {
  require(scene.text.starts_with(text));
  require(scene.needles.k > 0 && std::isfinite(scene.needles.k));
  require(scene.collisions.epsilon >= 0 && scene.collisions.epsilon <= 1);
  require(std::abs(scene.collisions.beta) <= 1);
  require(!(scene.collisions.tc && scene.collisions.tc_relative));
  require(!scene.engine.threads || *scene.engine.threads >= 1);
  require(scene.output.series_per_decade > 0);
  require(needlework::is_printable(scene.title) && needlework::is_printable(scene.output.file));
  const needlework::Composition composition = scene.composition();
  require(composition.size() >= 1 && composition.count() <= needlework::most_needles);
  require(scene.initial.file.empty() ? composition.count() == scene.needles.count : true);
  require(scene.needles.k == composition[0].k);
  for (const needlework::Species& species : scene.species) {
    require(species.length > 0 && species.mass > 0 && species.k > 0);
    require(!species.name.empty() && needlework::is_printable(species.name));
  }
  for (const needlework::Restitution& rule : composition.rules())
    require(rule.epsilon >= 0 && rule.epsilon <= 1 && std::abs(rule.beta) <= 1);
  for (const double edge : scene.needles.box)
    require(edge >= 2.01 * composition.longest() || (edge == 0 && !scene.initial.file.empty()));
  for (const std::string& warning : needlework::warnings(scene))
    require(needlework::is_printable(warning));
  if (scene.initial.file.empty() && scene.needles.count <= 10)
    require(needlework::draw_initial_state(scene).size() == scene.needles.count);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string text;
  std::vector<std::string> overrides;
  std::string_view rest(reinterpret_cast<const char*>(data), size);
  while (!rest.empty()) {
    const std::string_view line = rest.substr(0, std::min(rest.find('\n'), rest.size() - 1) + 1);
    rest.remove_prefix(line.size());
    if (line.starts_with('!'))
      overrides.emplace_back(line.substr(1, line.find('\n') - 1));
    else
      text += line;
  }
  try {
    check_scene(needlework::parse_scene(text, "fuzz", overrides), text);
  } catch (const needlework::InputError& error) {
    const std::string_view what = error.what();
    require(needlework::is_printable(what) && what.size() < 500);
    require(what.starts_with("fuzz: ") || what.starts_with("--set "));
  }
  return 0;
}
