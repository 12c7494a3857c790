#include "src/scene/confinement.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

#include "kernels/sine_cosine.h"
#include "needlework/error.h"
#include "src/scene/box_edges.h"
#include "src/scene/check.h"
#include "src/scene/observable_names.h"

namespace needlework {
namespace {

constexpr std::array<char, 3> axis_names = {'x', 'y', 'z'};

// Of the surfaces of two walls along one axis, either of which may be at rest, over all times. Of
// different frequencies, all pairs of phases occur.
double approach_of(const Scene::WallMotion& a, const Scene::WallMotion& b) {
  if (a.frequency != b.frequency) return a.amplitude + b.amplitude;
  const SineCosine<double> turn_a = sine_cosine(a.phase), turn_b = sine_cosine(b.phase);
  return std::hypot(a.amplitude * turn_a.cosine - b.amplitude * turn_b.cosine,
                    a.amplitude * turn_a.sine - b.amplitude * turn_b.sine);
}

// The key of an entry [[walls]] as Scene::places has it.
std::string key_of(std::string_view key, std::size_t entry) {
  return entry == 0 ? fmt::format("walls.{}", key) : fmt::format("walls.{}#{}", key, entry);
}

std::string quoted(std::string_view text) { return fmt::format("\"{}\"", text); }

std::string place_of_side(const Scene& scene, std::size_t entry) {
  return place_of(scene, key_of("side", entry), quoted(scene.walls[entry].side));
}

std::string place_of_gravity(const Scene& scene) {
  return place_of(scene, "forces.gravity",
                  fmt::format("[{}]", fmt::join(scene.forces.gravity, ", ")));
}

[[noreturn]] void refuse_at(const std::string& place, const std::string& expected) {
  throw InputError(fmt::format("{}: expected {}", place, expected));
}

void require_one_wall_a_side(const Scene& scene) {
  const std::vector<Scene::WallSide> sides = scene.wall_sides();
  for (auto side = sides.begin(); side != sides.end(); ++side) {
    const bool is_taken = std::any_of(sides.begin(), side, [&](const Scene::WallSide& other) {
      return other.axis == side->axis && other.is_high == side->is_high;
    });
    if (!is_taken) continue;
    refuse_at(place_of_side(scene, side->entry),
              fmt::format("no second wall at the {} edge of {}", side->is_high ? "high" : "low",
                          axis_names[side->axis]));
  }
}

void require_thermal_walls_at_rest(const Scene& scene) {
  constexpr const char* reason =
      "none beside temperature: a thermal wall is at rest, and epsilon and t_c do not apply";
  for (std::size_t n = 0; n < scene.walls.size(); ++n) {
    const Scene::Wall& wall = scene.walls[n];
    if (!wall.temperature) continue;
    const std::string epsilon = key_of("epsilon", n);
    if (wall.epsilon != 1 || scene.places.contains(epsilon))
      refuse_at(place_of(scene, epsilon, fmt::to_string(wall.epsilon)), reason);
    if (wall.motion)
      refuse_at(
          place_of(scene, key_of("motion.amplitude", n), fmt::to_string(wall.motion->amplitude)),
          reason);
  }
}

// Nothing holds needles back on an open side but gravity, and nothing brakes them along a periodic
// axis but the faces of thermal walls beside it.
void require_gravity_to_walls(const Scene& scene) {
  const std::array<Gap, 3> gaps = gaps_of(scene);
  for (const Scene::WallSide& side : scene.wall_sides()) {
    const double gravity = scene.forces.gravity[side.axis];
    if (!gaps[side.axis].is_open() || (side.is_high ? gravity > 0 : gravity < 0)) continue;
    const char axis = axis_names[side.axis];
    refuse_at(
        place_of_side(scene, side.entry),
        fmt::format("\"both\", or a second wall along {}, or forces.gravity that points to this "
                    "one: needles would leave the box at its open side",
                    axis));
  }
  const bool brakes = std::ranges::any_of(
      scene.walls, [](const Scene::Wall& wall) { return wall.temperature.has_value(); });
  for (std::size_t axis = 0; axis < 3 && !brakes; ++axis) {
    if (scene.forces.gravity[axis] == 0 || gaps[axis].is_walled()) continue;
    refuse_at(place_of_gravity(scene),
              fmt::format("none along {0}, which is periodic, or a wall with a temperature along "
                          "another axis: thermal walls brake along their face, and without one all "
                          "needles would gain speed along {0} together for ever",
                          axis_names[axis]));
  }
  if (brakes && has_gravity_along_periodic(scene) && scene.until.energy_ratio) {
    refuse_at(place_of(scene, "until.energy_ratio", fmt::to_string(*scene.until.energy_ratio)),
              "another end, such as time: gravity along a periodic axis does work all the time, "
              "which thermal walls take out");
  }
}

void require_thermostat_without_gravity(const Scene& scene) {
  if (!scene.driving.andersen || scene.forces.gravity == std::array<double, 3>{}) return;
  refuse_at(place_of(scene, "driving.andersen.rate", fmt::to_string(scene.driving.andersen->rate)),
            "none beside forces.gravity: the thermostat is for needles that fly freely");
}

// What sliding contact does not know of.
void require_what_slides(const Scene& scene) {
  if (!scene.collisions.sliding) {
    if (!scene.collisions.elastic_strikes) return;
    refuse_at(place_of(scene, "collisions.elastic_strikes", "true"),
              "false, or collisions.sliding = true: only needles in contact are struck");
  }
  const auto refuse = [&](const std::string& reason) {
    refuse_at(place_of(scene, "collisions.sliding", "true"), reason);
  };
  const Composition composition = scene.composition();
  if (composition.is_rough())
    refuse("false, or beta = -1: needles slide on each other without friction only");
  if (composition.has_width()) refuse("false, as rods of finite width do not slide");
  if (scene.collisions.tc || scene.collisions.tc_relative)
    refuse("either sliding or a contact time, tc or tc_relative: both replace the same bounces");
}

}  // namespace

double Gap::beyond(double centre, double reach, double edge) const {
  constexpr double none = -std::numeric_limits<double>::infinity();
  return std::max(has_low ? low - (centre - reach) : none,
                  has_high ? (centre + reach) - (edge + high) : none);
}

std::array<Gap, 3> gaps_of(const Scene& scene) {
  std::array<Gap, 3> out;
  std::array<std::array<Scene::WallMotion, 2>, 3> motions;
  for (const Scene::WallSide& side : scene.wall_sides()) {
    Gap& gap = out[side.axis];
    (side.is_high ? gap.has_high : gap.has_low) = true;
    const auto& motion = scene.walls[side.entry].motion;
    if (!motion) continue;
    motions[side.axis][side.is_high] = *motion;
    (side.is_high ? gap.high : gap.low) = motion->amplitude * sine_cosine(motion->phase).sine;
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    out[axis].approach = approach_of(motions[axis][0], motions[axis][1]);
  }
  return out;
}

Room::Room(const Scene& scene) : gaps_(gaps_of(scene)) {
  const Composition composition = scene.composition();
  if (scene.collisions.sliding) counts_as_ = length_with_sliding;
  const double length = composition.longest() * counts_as_;
  if (composition.has_width()) body_ = "rod";
  for (std::size_t axis = 0; axis < 3; ++axis) {
    least_[axis] = gaps_[axis].is_walled() ? length + gaps_[axis].approach : least_edge(length);
  }
  most_ = largest_edge(length);
}

bool Room::holds(const std::array<double, 3>& box) const {
  return holds(box[0], 0) && holds(box[1], 1) && holds(box[2], 2);
}

std::string Room::expected_instead_of(const std::array<double, 3>& box) const {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Gap& gap = gaps_[axis];
    if (box[axis] >= least_[axis]) continue;
    if (!gap.is_walled()) {
      const bool all = std::ranges::none_of(gaps_, &Gap::is_walled);
      return fmt::format("edges of at least {:.10g}{} ({:.10g} {} lengths)", least_[axis],
                         all ? "" : " along periodic axes", least_edge(counts_as_), body_);
    }
    return fmt::format(
        "an edge of at least {:.10g} along {}, which has walls ({} {} length{}{})", least_[axis],
        axis_names[axis], counts_as_ == 1 ? "one" : fmt::to_string(counts_as_), body_,
        counts_as_ == 1 ? "" : "s", gap.approach > 0 ? " at all times of their motion" : "");
  }
  return fmt::format("edges of at most {:.10g} (1e9 {} lengths)", most_, body_);
}

bool acts_on_single_needles(const Scene& scene) {
  return !scene.walls.empty() || scene.driving.kicks || scene.driving.andersen;
}

bool exchanges_energy(const Scene& scene) {
  const auto exchanges = [](const Scene::Wall& wall) {
    return wall.epsilon < 1 || wall.temperature || wall.motion;
  };
  return std::ranges::any_of(scene.walls, exchanges) || scene.driving.kicks ||
         scene.driving.andersen;
}

bool is_pushed(const Scene& scene) { return exchanges_energy(scene) || has_gravity(scene); }

bool has_gravity(const Scene& scene) { return scene.forces.gravity != std::array<double, 3>{}; }

bool has_gravity_along_periodic(const Scene& scene) {
  const std::array<bool, 3> periodic = scene.periodic();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (periodic[axis] && scene.forces.gravity[axis] != 0) return true;
  }
  return false;
}

std::string name_of(const Scene::Wall& wall) { return wall.axis + "-" + wall.side; }

void require_compatible_effects(const Scene& scene) {
  require_one_wall_a_side(scene);
  require_thermal_walls_at_rest(scene);
  require_gravity_to_walls(scene);
  require_thermostat_without_gravity(scene);
  require_what_slides(scene);
}

void require_walls_to_observe(const Scene& scene) {
  if (!scene.walls.empty()) return;
  for (const std::string& name : scene.output.observables) {
    if (std::ranges::find(wall_observable_names, name) == wall_observable_names.end()) continue;
    refuse_at(place_of(scene, "output.observables", quoted(name)),
              fmt::format("an entry [[walls]] for {}, which is along axes with walls", name));
  }
}

}  // namespace needlework
