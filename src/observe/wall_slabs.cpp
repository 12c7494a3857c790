#include "src/observe/wall_slabs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "src/scene/confinement.h"

namespace needlework::observe {
namespace {

constexpr double edges_above_a_floor = 3;
constexpr double slabs_a_needle = 8;
constexpr double most_slabs = 300;

struct Span {
  bool has_low = false, has_high = false;
  double low = 0, high = 0;  // how far a wall that shakes goes beyond the edge
};

// Until when walls are where slabs should be: the end of the run or, where it is not known, when
// all walls that come to rest have done so.
double last_time_of(const Scene& scene, const MovingEdges& moving) {
  constexpr double never = std::numeric_limits<double>::infinity();
  const auto meeting = meeting_of(scene, scene.needles.box);
  const double end = std::min(scene.until.time.value_or(never), meeting ? meeting->time : never);
  if (std::isfinite(end)) return end;
  const std::vector<double> pieces = moving.pieces(never);
  return pieces[pieces.size() - 2];
}

}  // namespace

std::vector<Slabs> wall_slabs(const Scene& scene) {
  std::array<Span, 3> spans;
  for (const Scene::WallSide& side : scene.wall_sides()) {
    Span& span = spans[side.axis];
    const auto& motion = scene.walls[side.entry].motion;
    (side.is_high ? span.has_high : span.has_low) = true;
    (side.is_high ? span.high : span.low) = motion ? motion->amplitude : 0;
  }
  const auto moving = moving_edges_of(scene, scene.needles.box);
  const double finest = scene.composition().longest() / slabs_a_needle;
  std::vector<Slabs> out;
  std::size_t count = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Span& span = spans[axis];
    if (!span.has_low && !span.has_high) continue;
    const double edge = scene.needles.box[axis];
    double begin = span.has_low ? -span.low : edge - edges_above_a_floor * edge;
    double end = span.has_high ? edge + span.high : edges_above_a_floor * edge;
    if (moving) {
      // All places at which walls with a velocity are before the run ends.
      const auto [lowest, highest] = moving->range(axis, last_time_of(scene, *moving));
      begin = std::min(begin, lowest);
      end = std::max(end, highest);
    }
    out.push_back({.axis = axis, .begin = begin, .thickness = end - begin});
    const double wanted = scene.output.grid
                              ? (*scene.output.grid)[axis]
                              : std::min(std::ceil((end - begin) / finest), most_slabs);
    count = std::max(count, static_cast<std::size_t>(wanted));
  }
  for (Slabs& slabs : out) {
    slabs.count = count;
    slabs.thickness /= static_cast<double>(count);
  }
  return out;
}

}  // namespace needlework::observe
