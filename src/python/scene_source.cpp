#include "src/python/scene_source.h"

#include <utility>

#include "needlework/error.h"
#include "needlework/parse.h"

namespace needlework::python {
namespace {

// The place without the number of its line.
std::string without_line(const std::string& place, const std::string& name) {
  const std::string begin = name + ": line ";
  if (!place.starts_with(begin)) return place;
  const std::size_t end = place.find(": ", begin.size());
  return end == std::string::npos ? place : name + place.substr(end);
}

Scene parse(const SceneSource& source, Provided provided) {
  if (!source.text) return read_scene(source.name, {}, provided);
  if (source.has_lines) return parse_scene(*source.text, source.name, {}, provided);
  try {
    Scene scene = parse_scene(*source.text, source.name, {}, provided);
    for (auto& [key, place] : scene.places) place = without_line(place, source.name);
    return scene;
  } catch (const InputError& error) {
    throw InputError(without_line(error.what(), source.name));
  }
}

}  // namespace

runs::LoadedScene load_scene(const SceneSource& source, std::optional<State> state) {
  // Without an end in the scene, each call of run() has to name one.
  Scene scene = parse(source, {.state = state.has_value(), .end = true});
  if (!state) return runs::complete_scene(std::move(scene));
  if (state->box == std::array<double, 3>{}) state->box = scene.needles.box;
  if (state->box == std::array<double, 3>{}) {
    throw InputError(source.name + ": needles.box is missing: expected the edges of the box");
  }
  return runs::complete_scene(std::move(scene), *std::move(state));
}

}  // namespace needlework::python
