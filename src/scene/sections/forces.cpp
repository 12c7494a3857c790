// [forces]: gravity.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "src/scene/confinement.h"
#include "src/scene/read_value.h"
#include "src/scene/sections/sections.h"

namespace needlework {
namespace {

std::optional<std::array<double, 3>> acceleration(const Value& value, const ValueRange& range) {
  const auto out = from_value::three_numbers(value, range);
  const auto is_too_small = [](double g) { return g != 0 && std::abs(g) < 1 / largest_rate; };
  return out && std::ranges::none_of(*out, is_too_small) ? out : std::nullopt;
}

bool have_thermal_wall(const Scene& scene) {
  return std::ranges::any_of(scene.walls,
                             [](const Scene::Wall& wall) { return wall.temperature.has_value(); });
}

// Nothing brakes needles along a periodic axis but the faces of thermal walls beside it.
std::optional<Violation> needles_would_fall_for_ever(const Scene& scene) {
  if (have_thermal_wall(scene)) return {};
  const std::array<bool, 3> periodic = scene.periodic();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (scene.forces.gravity[axis] == 0 || !periodic[axis]) continue;
    return Violation{
        .key = "forces.gravity",
        .value = fmt::format("[{}]", fmt::join(scene.forces.gravity, ", ")),
        .reason = fmt::format(
            "expected none along {0}, which is periodic, or a wall with a temperature along "
            "another axis: thermal walls brake along their face, and without one all needles "
            "would gain speed along {0} together for ever",
            "xyz"[axis])};
  }
  return {};
}

std::optional<Violation> energy_ends_what_gravity_drives(const Scene& scene) {
  if (!scene.until.energy_ratio || !has_gravity_along_periodic(scene)) return {};
  return Violation{
      .key = "until.energy_ratio",
      .value = fmt::to_string(*scene.until.energy_ratio),
      .reason =
          "expected another end, such as time: gravity along a periodic axis does work all "
          "the time, which thermal walls take out"};
}

}  // namespace

SceneSection forces_section() {
  using namespace from_value;
  using V = const Value&;
  using R = const ValueRange&;
  return {
      .name = "forces",
      .keys = {{"gravity",
                Aspect::effects,
                {-largest_rate, largest_rate},
                "an array of three accelerations (each 0, or from 1e-100 to 1e100)",
                [](Scene& s, V v, R r) { return store(s.forces.gravity, acceleration(v, r)); }}},
      .rules = {{Aspect::effects, needles_would_fall_for_ever},
                {Aspect::effects, energy_ends_what_gravity_drives}},
  };
}

}  // namespace needlework
