// [[walls]].
#include <fmt/format.h>

#include <algorithm>

#include "src/scene/confinement.h"
#include "src/scene/read_value.h"
#include "src/scene/sections/sections.h"

namespace needlework {
namespace {

constexpr std::size_t most_walls = 6;  // one at each side of the box

// Those beside which a motion has no amplitude.
constexpr std::array<std::string_view, 2> other_motions = {"motion.velocity", "motion.tangential"};

// The table is made by the first key of it that is read.
// clang 14 does not know that emplace() can make what a class nested in another one contains.
Scene::WallMotion& motion_of(Scene& scene) {
  auto& motion = scene.walls.back().motion;
  if (!motion) motion = Scene::WallMotion{};
  return *motion;
}

Violation violation_of_side(const Scene& scene, std::size_t entry, std::string reason) {
  return {.key = key_of_entry("walls.side", entry),
          .value = in_quotes(scene.walls[entry].side),
          .reason = std::move(reason)};
}

std::optional<Violation> side_has_two_walls(const Scene& scene) {
  const std::vector<Scene::WallSide> sides = scene.wall_sides();
  for (auto side = sides.begin(); side != sides.end(); ++side) {
    const bool is_taken = std::any_of(sides.begin(), side, [&](const Scene::WallSide& other) {
      return other.axis == side->axis && other.is_high == side->is_high;
    });
    if (!is_taken) continue;
    return violation_of_side(scene, side->entry,
                             fmt::format("expected no second wall at the {} edge of {}",
                                         side->is_high ? "high" : "low", "xyz"[side->axis]));
  }
  return {};
}

std::optional<Violation> thermal_wall_moves_or_bounces(const Scene& scene) {
  for (std::size_t n = 0; n < scene.walls.size(); ++n) {
    const Scene::Wall& wall = scene.walls[n];
    if (!wall.temperature || (wall.motion && wall.motion->velocity)) continue;
    Violation out{.key = key_of_entry("walls.epsilon", n),
                  .value = fmt::to_string(wall.epsilon),
                  .reason =
                      "expected none beside temperature: a thermal wall is at rest, and "
                      "epsilon and t_c do not apply"};
    if (wall.epsilon != 1 || scene.places.contains(out.key)) return out;
    if (!wall.motion || wall.motion->tangential) continue;
    out.key = key_of_entry("walls.motion.amplitude", n);
    out.value = fmt::to_string(wall.motion->amplitude);
    return out;
  }
  return {};
}

// A motion is one of three kinds.
std::optional<Violation> motion_is_of_two_kinds(const Scene& scene) {
  for (std::size_t n = 0; n < scene.walls.size(); ++n) {
    const Scene::Wall& wall = scene.walls[n];
    if (!wall.motion) continue;
    const auto& [amplitude, frequency, phase, velocity, stop_at, tangential] = *wall.motion;
    const bool shakes =
        amplitude != 0 || scene.places.contains(key_of_entry("walls.motion.amplitude", n));
    const auto wrong = [&](std::string_view key, std::string value, std::string reason) {
      return Violation{.key = key_of_entry(fmt::format("walls.motion.{}", key), n),
                       .value = std::move(value),
                       .reason = std::move(reason)};
    };
    const auto text = [](const std::optional<double>& number) { return fmt::to_string(*number); };
    const auto text_of_two = [](const auto& two) {
      return fmt::format("[{}, {}]", (*two)[0], (*two)[1]);
    };
    if (velocity && shakes)
      return wrong("velocity", text(velocity),
                   "expected none beside amplitude: a wall moves at "
                   "constant velocity or shakes");
    if (velocity && wall.temperature)
      return wrong("velocity", text(velocity),
                   "expected none beside temperature: thermal walls do "
                   "not move along their normal");
    if (tangential && (shakes || velocity))
      return wrong("tangential", text_of_two(tangential),
                   "expected none beside amplitude or velocity: walls that slide in their plane "
                   "are thermal, and those do not move along their normal");
    if (tangential && !wall.temperature)
      return wrong("tangential", text_of_two(tangential),
                   "expected walls.temperature besides: the impulse of a smooth wall is along its "
                   "normal, so that its own motion in its plane changes nothing");
    if (!stop_at) continue;
    if (!velocity || *velocity == 0)
      return wrong("stop_at", text(stop_at), "expected a velocity besides, other than 0");
    if (wall.side == "both")
      return wrong("stop_at", text(stop_at),
                   "expected side \"low\" or \"high\": two walls cannot stop at one place");
  }
  return {};
}

std::optional<Violation> piston_stops_behind(const Scene& scene) {
  for (const Scene::WallSide& side : scene.wall_sides()) {
    const Scene::Wall& wall = scene.walls[side.entry];
    const auto& motion = wall.motion;
    if (!motion || motion->velocity.value_or(0) == 0 || !motion->stop_at) continue;
    if (wall.side == "both") continue;                // which another rule is about
    if (scene.needles.box[side.axis] == 0) continue;  // that of a state, which is not known yet
    const double start = side.is_high ? scene.needles.box[side.axis] : 0;
    if ((*motion->stop_at - start) / *motion->velocity >= 0) continue;
    return Violation{
        .key = key_of_entry("walls.motion.stop_at", side.entry),
        .value = fmt::to_string(*motion->stop_at),
        .reason = fmt::format("expected a place at or {} {}, from which the wall moves {}",
                              *motion->velocity > 0 ? "above" : "below", start,
                              *motion->velocity > 0 ? "up" : "down")};
  }
  return {};
}

std::optional<Violation> pistons_meet(const Scene& scene) {
  if (!scene.until.time) return {};
  const std::optional<Meeting> found = meeting_of(scene, scene.needles.box);
  if (!found || found->time > *scene.until.time) return {};
  const auto& [time, axis, distance] = *found;
  return Violation{
      .key = "until.time",
      .value = fmt::to_string(*scene.until.time),
      .reason = fmt::format("expected a time before {:.10g}, when the walls along {} have come as "
                            "near as {:.10g}, the extent of the longest body",
                            time, "xyz"[axis], distance)};
}

// Nothing holds needles back on an open side but gravity.
std::optional<Violation> needles_would_leave(const Scene& scene) {
  const std::array<Gap, 3> gaps = gaps_of(scene);
  for (const Scene::WallSide& side : scene.wall_sides()) {
    const double gravity = scene.forces.gravity[side.axis];
    if (!gaps[side.axis].is_open() || (side.is_high ? gravity > 0 : gravity < 0)) continue;
    return violation_of_side(
        scene, side.entry,
        fmt::format("expected \"both\", or a second wall along {}, or forces.gravity that points "
                    "to this one: needles would leave the box at its open side",
                    "xyz"[side.axis]));
  }
  return {};
}

}  // namespace

SceneSection walls_section() {
  using namespace from_value;
  using V = const Value&;
  using R = const ValueRange&;
  return {
      .name = "walls",
      .keys =
          {
              {"axis",
               Aspect::walls,
               {},
               R"("x", "y" or "z")",
               [](Scene& s, V v, R) {
                 return store(s.walls.back().axis, one_of(v, {"x", "y", "z"}));
               },
               Presence::required},
              {"side",
               Aspect::walls,
               {},
               R"("low", "high" or "both")",
               [](Scene& s, V v, R) {
                 return store(s.walls.back().side, one_of(v, {"low", "high", "both"}));
               },
               Presence::required},
              {"epsilon", Aspect::walls, restitutions, expected_epsilon,
               [](Scene& s, V v, R r) { return store(s.walls.back().epsilon, number(v, r)); }},
              {"temperature", Aspect::walls, temperatures, expected_positive_temperature,
               [](Scene& s, V v, R r) { return store(s.walls.back().temperature, number(v, r)); }},
              {"motion.amplitude",
               Aspect::walls,
               {0, 1e9},
               "a length >= 0 (at most 1e9)",
               [](Scene& s, V v, R r) { return store(motion_of(s).amplitude, number(v, r)); },
               Presence::required,
               nullptr,
               other_motions},
              {"motion.frequency",
               Aspect::walls,
               {1 / largest_rate, largest_rate},
               "a number > 0 of cycles per time (from 1e-100 to 1e100)",
               [](Scene& s, V v, R r) { return store(motion_of(s).frequency, number(v, r)); },
               Presence::required,
               nullptr,
               other_motions},
              {"motion.phase",
               Aspect::walls,
               {-1000, 1000},
               "an angle in radians, from -1000 to 1000",
               [](Scene& s, V v, R r) { return store(motion_of(s).phase, number(v, r)); }},
              {"motion.velocity",
               Aspect::walls,
               {-largest_rate, largest_rate},
               "a velocity along the positive axis (at most 1e100)",
               [](Scene& s, V v, R r) { return store(motion_of(s).velocity, number(v, r)); }},
              {"motion.stop_at",
               Aspect::walls,
               {-1e9, 1e9},
               "a coordinate (from -1e9 to 1e9)",
               [](Scene& s, V v, R r) { return store(motion_of(s).stop_at, number(v, r)); }},
              {"motion.tangential",
               Aspect::walls,
               {-largest_rate, largest_rate},
               "[a, b], a velocity along each of the two other axes (at most 1e100)",
               [](Scene& s, V v, R r) {
                 return store(motion_of(s).tangential, two_numbers(v, r));
               }},
          },
      .rules = {{Aspect::effects, side_has_two_walls},
                {Aspect::effects, thermal_wall_moves_or_bounces},
                {Aspect::effects, motion_is_of_two_kinds},
                {Aspect::walls, piston_stops_behind},
                {Aspect::room, pistons_meet},
                {Aspect::effects, needles_would_leave}},
      .entries = entries_in<&Scene::walls>(most_walls),
  };
}

}  // namespace needlework
