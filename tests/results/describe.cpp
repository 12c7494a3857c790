// Prints the numbers of all results, and the fields that series have of them, as JSON, for
// declare.py.
#include <concepts>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>
#include <type_traits>

#include "src/observe/observation.h"
#include "src/runs/results.h"

namespace needlework {
namespace {

using Json = nlohmann::ordered_json;

Json results() {
  Json out = Json::object();
  runs::for_each_result([&](const runs::ResultKind& kind, const auto& sums) {
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
    });
    out[kind.key] = {{"meaning", kind.meaning}, {"numbers", numbers}};
  });
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
  scene.forces.gravity = {1, 0, 0};
  scene.driving.andersen = Scene::Andersen{};
  scene.driving.kicks = Scene::Kicks{};
  scene.collisions.sliding = true;
  return scene;
}

// By "GROUP/FIELD", with the shape of a row and the type of its elements.
Json series() {
  Json out = Json::object();
  const observe::Observation observation(with_everything());
  for (const SeriesGroup& group : observation.groups()) {
    for (const SeriesField& field : group.fields) {
      const bool is_constant = field.kind == SeriesField::Kind::constant;
      std::string shape = is_constant ? "" : "[samples]";
      for (const SeriesField::Extent& extent : field.shape) shape += "[" + extent.name + "]";
      out[group.name + "/" + field.name] = {
          {"unit", field.unit},
          {"meaning", field.meaning},
          {"type", (field.kind == SeriesField::Kind::count ? "int64" : "float64") + shape}};
    }
  }
  return out;
}

}  // namespace
}  // namespace needlework

int main() {
  std::puts(needlework::Json{{"results", needlework::results()}, {"series", needlework::series()}}
                .dump(1)
                .c_str());
}
