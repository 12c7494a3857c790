#include "bench/strategies/own_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <optional>
#include <utility>

#include "needlework/error.h"
#include "src/cli/scene_arguments.h"
#include "src/runs/engine_choice.h"
#include "src/scene/schema.h"

namespace needlework::bench {
namespace {

// A list on the command line, and the key of [engine] that its elements are values of.
struct Choice {
  const char *option, *key;
  std::vector<std::string> values;
};

Value value_of(const std::string& text) {
  const char* const end = text.data() + text.size();
  const auto read = [&](auto number) -> std::optional<Value> {
    const auto done = std::from_chars(text.data(), end, number);
    if (done.ec == std::errc() && done.ptr == end) return Value{number};
    return std::nullopt;
  };
  if (const auto whole = read(std::int64_t{})) return *whole;
  return read(double{}).value_or(Value{text});
}

void set(Scene& scene, const Choice& choice, const std::string& text) {
  const std::string place = fmt::format("{} {}", choice.option, text);
  const SceneKey* key = find_scene_key("engine", choice.key);
  if (!key->read(scene, value_of(text))) {
    throw InputError(fmt::format("{}: expected {}", place, key->expected));
  }
  scene.places[std::string("engine.") + choice.key] = place;
}

// All combinations of the choices, in the order of the lists.
std::vector<Scene> combinations(const Scene& scene, const std::vector<Choice>& choices) {
  std::vector<Scene> all{scene};
  for (const Choice& choice : choices) {
    if (choice.values.empty()) continue;
    std::vector<Scene> more;
    for (const Scene& one : all) {
      for (const std::string& text : choice.values) {
        more.push_back(one);
        set(more.back(), choice, text);
      }
    }
    all = std::move(more);
  }
  return all;
}

}  // namespace

OwnCases cases_of(const OwnScene& own) {
  std::vector<Choice> choices{{"--searches", "search", own.searches},
                              {"--queues", "queue", own.calendars},
                              {"--accuracy", "accuracy", own.accuracies},
                              {"--isa", "isa", own.isas},
                              {"--threads", "threads", own.threads},
                              {"--cell-sides", "cell_side", own.cell_sides},
                              {"--capsule-radii", "capsule_radius", own.capsule_radii}};
  if (own.settings.empty() && std::all_of(choices.begin(), choices.end(), [](const Choice& choice) {
        return choice.values.empty();
      })) {
    choices[0].values = {"linked-cells", "capsules"};
  }

  OwnCases out;
  std::vector<std::string> names;
  const auto add = [&](Scene scene, const std::string& setting,
                       const std::shared_ptr<const State>& initial) {
    scene.engine.isa = runs::resolved_isa(scene.engine);
    Case one{.scene_name = std::filesystem::path(own.file).stem().string(),
             .scene = std::move(scene),
             .setting = setting,
             .initial = initial};
    const std::string name = one.name();
    if (std::find(names.begin(), names.end(), name) != names.end()) return;
    names.push_back(name);
    if (one.scene.engine.threads.value_or(1) > 1 && !runs::is_for_threads(one.scene.engine)) {
      out.left_out.push_back(name);
      return;
    }
    runs::choose_engine(one.scene);
    out.cases.push_back(std::move(one));
  };
  std::vector<std::string> settings{""};
  settings.insert(settings.end(), own.settings.begin(), own.settings.end());
  for (const std::string& setting : settings) {
    std::vector<std::string> overrides = own.overrides;
    if (!setting.empty()) overrides.push_back(setting);
    runs::LoadedScene loaded = cli::load_scene(
        {.path = own.file, .overrides = overrides, .engine = {}, .provided = {.end = true}});
    const std::shared_ptr<const State> initial =
        loaded.initial ? std::make_shared<const State>(*std::move(loaded.initial)) : nullptr;
    add(loaded.scene, setting, initial);
    for (Scene& scene : combinations(loaded.scene, choices)) {
      if (scene.engine.threads_by_size) runs::choose_engine(scene);
      add(std::move(scene), setting, initial);
    }
  }
  out.cases.front().is_baseline = true;
  return out;
}

}  // namespace needlework::bench
