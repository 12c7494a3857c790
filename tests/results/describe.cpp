// Prints the numbers of all results, the fields that series have of them, and the keys of scenes,
// as JSON, for declare.py and for tests/compatibility/names.py.
#include <algorithm>
#include <concepts>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>
#include <tuple>
#include <type_traits>

#include "src/c/totals.h"
#include "src/observe/observation.h"
#include "src/runs/results.h"
#include "src/scene/observable_names.h"
#include "src/scene/schema.h"

namespace needlework {
namespace {

using Json = nlohmann::ordered_json;

Json results() {
  Json out = Json::object();
  const auto add = [&](const runs::ResultKind& kind, const auto& sums) {
    Json numbers = Json::array();
    sums.for_each([&](const Described& number, const auto& value) {
      using Value = std::decay_t<decltype(value)>;
      const char* type = std::integral<Value>         ? "count"
                         : std::floating_point<Value> ? "real"
                                                      : "reals";
      numbers.push_back({{"name", number.name},
                         {"unit", number.unit},
                         {"meaning", number.meaning},
                         {"type", type}});
      if constexpr (requires { std::tuple_size<Value>::value; })
        numbers.back()["size"] = value.size();
    });
    out[kind.key] = {{"meaning", kind.meaning}, {"numbers", numbers}};
  };
  runs::for_each_result(add);
  add(runs::ResultKind{"totals_in_c", "Totals as C has them"}, c::AllTotals{});
  return out;
}

// A scene with all that adds numbers to a series.
Scene with_everything() {
  Scene scene;
  scene.needles.box = {5, 5, 5};
  scene.species = {{.name = "spheres", .count = 2, .length = 0, .diameter = 0.5},
                   {.name = "rods", .count = 2, .length = 1, .diameter = 0.1}};
  scene.walls = {{.axis = "z", .side = "both"}};
  scene.walls[0].motion = Scene::WallMotion{};
  scene.walls.push_back({.axis = "y", .side = "low", .temperature = 1.0});
  // As a piston has it, but edges of the box stay.
  scene.walls.push_back({.axis = "y", .side = "high"});
  scene.walls.back().motion = Scene::WallMotion{.velocity = 0};
  scene.forces.gravity = {1, 0, 0};
  scene.driving.andersen = Scene::Andersen{};
  scene.driving.kicks = Scene::Kicks{};
  scene.collisions.sliding = true;
  return scene;
}

// One species in a flow, and between walls, with all observables.
Scene with_observables() {
  Scene scene;
  scene.needles.count = 2;
  scene.needles.box = {5, 5, 5};
  scene.shear = Scene::Shear{.rate = 1};
  for (const auto& name : observable_names) {
    if (std::ranges::find(wall_observable_names, name) == wall_observable_names.end())
      scene.output.observables.emplace_back(name);
  }
  return scene;
}

Scene with_growth() {
  Scene scene;
  scene.needles.box = {5, 5, 5};
  scene.needles.count = 2;
  scene.needles.diameter = 0.1;
  scene.driving.growth = Scene::Growth{};
  return scene;
}

Scene with_wall_observables() {
  Scene scene;
  scene.needles.count = 2;
  scene.needles.box = {5, 5, 5};
  scene.walls = {{.axis = "z", .side = "both"}};
  scene.output.observables.assign(wall_observable_names.begin(), wall_observable_names.end());
  return scene;
}

// By "GROUP/FIELD", with the shape of a row and the type of its elements.
void add_series(Json& out, const Scene& scene) {
  const observe::Observation observation(scene);
  for (const SeriesGroup& group : observation.groups()) {
    for (const SeriesField& field : group.fields) {
      // Of bodies that grow, the room that they take up is no constant.
      if (out.contains(group.name + "/" + field.name)) continue;
      const bool is_constant = field.kind == SeriesField::Kind::constant;
      std::string shape = is_constant ? "" : "[samples]";
      for (const SeriesField::Extent& extent : field.shape) shape += "[" + extent.name + "]";
      out[group.name + "/" + field.name] = {
          {"unit", field.unit},
          {"meaning", field.meaning},
          {"type", (field.kind == SeriesField::Kind::count ? "int64" : "float64") + shape}};
    }
  }
}

Json series() {
  Json out = Json::object();
  for (const Scene& scene :
       {with_everything(), with_observables(), with_wall_observables(), with_growth()})
    add_series(out, scene);
  return out;
}

// Those that share a table.
Json groups() {
  return {{"observables", with_observables().output.observables},
          {"observables_at_walls", with_wall_observables().output.observables}};
}

// By "section.key", with what each is expected to be.
Json keys_of_scenes() {
  Json out = Json::object();
  for (const SceneKey& key : scene_keys()) {
    const std::string section = key.section.empty() ? "" : std::string(key.section) + ".";
    out[section + std::string(key.key)] = key.expected;
  }
  return out;
}

}  // namespace
}  // namespace needlework

int main() {
  std::puts(needlework::Json{{"results", needlework::results()},
                             {"series", needlework::series()},
                             {"groups", needlework::groups()},
                             {"scene_keys", needlework::keys_of_scenes()}}
                .dump(1)
                .c_str());
}
