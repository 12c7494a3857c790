#include "src/scene/confinement.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/sine_cosine.h"
#include "src/scene/box_edges.h"

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

bool shakes(const Scene::Wall& wall) {
  return wall.motion && !wall.motion->velocity && !wall.motion->tangential;
}

std::optional<MovingEdges> moving_edges_of(const Scene& scene, const std::array<double, 3>& box) {
  std::optional<MovingEdges> out;
  for (const Scene::WallSide& side : scene.wall_sides()) {
    const auto& motion = scene.walls[side.entry].motion;
    if (!motion || motion->velocity.value_or(0) == 0) continue;
    if (!out) out.emplace(box);
    const double start = side.is_high ? box[side.axis] : 0;
    out->set(side.axis, side.is_high, MovingEdge(start, *motion->velocity, motion->stop_at));
  }
  return out;
}

std::optional<Meeting> meeting_of(const Scene& scene, const std::array<double, 3>& box) {
  const std::optional<MovingEdges> edges = moving_edges_of(scene, box);
  if (!edges) return {};
  const std::array<Gap, 3> gaps = gaps_of(scene);
  const double extent = scene.composition().longest();
  std::optional<Meeting> out;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!gaps[axis].has_low || !gaps[axis].has_high) continue;
    // A wall that shakes comes nearer than where it is on average.
    const double distance = extent + gaps[axis].approach;
    const double time = edges->time_of_distance(axis, distance);
    if (std::isfinite(time) && (!out || time < out->time)) out = Meeting{time, axis, distance};
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
    if (holds(box[axis], axis) || box[axis] > most_) continue;
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
  return !scene.walls.empty() || scene.driving.kicks || scene.driving.andersen ||
         scene.driving.growth || scene.shear;
}

bool exchanges_energy(const Scene& scene) {
  const auto exchanges = [](const Scene::Wall& wall) {
    return wall.epsilon < 1 || wall.temperature || wall.motion;
  };
  return std::ranges::any_of(scene.walls, exchanges) || scene.driving.kicks ||
         scene.driving.andersen || scene.driving.growth || scene.shear;
}

bool keeps_drift(const Scene& scene) {
  return scene.shear && scene.shear->rate != 0 && !scene.driving.andersen &&
         std::ranges::none_of(scene.walls,
                              [](const Scene::Wall& wall) { return wall.temperature.has_value(); });
}

bool has_end(const Scene& scene) {
  const Scene::Until& until = scene.until;
  return until.time || until.collisions_per_needle || until.energy_ratio || until.wall_s ||
         scene.driving.growth;
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

}  // namespace needlework
