// [shear]: uniform shear.
#include <fmt/format.h>

#include "src/scene/read_value.h"
#include "src/scene/sections/sections.h"

namespace needlework {
namespace {

// Made by the first of its keys that is read.
Scene::Shear& shear_of(Scene& scene) {
  if (!scene.shear) scene.shear = Scene::Shear{};
  return *scene.shear;
}

Violation refused(const Scene& scene, std::string reason) {
  return {
      .key = "shear.rate", .value = fmt::to_string(scene.shear->rate), .reason = std::move(reason)};
}

std::optional<Violation> walls_stop_the_flow(const Scene& scene) {
  if (!scene.shear) return {};
  for (const Scene::Wall& wall : scene.walls) {
    if (wall.axis == "z") continue;
    return refused(scene,
                   fmt::format("expected no wall along {}: {}; walls along z are fine", wall.axis,
                               wall.axis == "x" ? "the flow goes through it"
                                                : "beside it there is no row of images to slide"));
  }
  return {};
}

std::optional<Violation> gravity_drives_the_flow(const Scene& scene) {
  const auto& gravity = scene.forces.gravity;
  if (!scene.shear || (gravity[0] == 0 && gravity[1] == 0)) return {};
  return refused(scene,
                 fmt::format("expected no gravity along {}, in which the flow would not stay "
                             "uniform; along z, with a wall, it is fine",
                             gravity[0] != 0 ? "x" : "y"));
}

std::optional<Violation> contacts_slide(const Scene& scene) {
  if (!scene.shear || !scene.collisions.sliding) return {};
  return refused(scene,
                 "expected no collisions.sliding: contacts that last are not followed in a "
                 "flow; the t_c rule is, collisions.tc or tc_relative");
}

std::optional<Violation> offset_is_beyond_the_edge(const Scene& scene) {
  if (!scene.shear || scene.shear->offset < scene.needles.box[0] || scene.shear->offset == 0)
    return {};
  return Violation{.key = "shear.offset",
                   .value = fmt::to_string(scene.shear->offset),
                   .reason = fmt::format("expected a length from 0 to below the edge along x, {:g}",
                                         scene.needles.box[0])};
}

}  // namespace

SceneSection shear_section() {
  using namespace from_value;
  using V = const Value&;
  using R = const ValueRange&;
  return {
      .name = "shear",
      .keys = {{"rate",
                Aspect::effects,
                {-largest_rate, largest_rate},
                "a number, d v_x / d y (at most 1e100)",
                [](Scene& s, V v, R r) { return store(shear_of(s).rate, number(v, r)); }},
               {"offset",
                Aspect::effects,
                {0, 1e12},
                "a length >= 0 (at most 1e12), below the edge along x",
                [](Scene& s, V v, R r) { return store(shear_of(s).offset, number(v, r)); }}},
      .rules = {{Aspect::effects, walls_stop_the_flow},
                {Aspect::effects, gravity_drives_the_flow},
                {Aspect::effects, contacts_slide},
                {Aspect::room, offset_is_beyond_the_edge}},
  };
}

}  // namespace needlework
