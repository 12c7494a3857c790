#include "src/picture/walls.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "src/box/tilt.h"
#include "src/scene/confinement.h"

namespace needlework::picture {
namespace {

WallKind kind_of(const Scene::Wall& wall) {
  if (wall.temperature) return WallKind::thermal;
  const bool moves =
      wall.motion && (wall.motion->amplitude > 0 || wall.motion->velocity.value_or(0) != 0);
  return moves ? WallKind::moving : WallKind::resting;
}

}  // namespace

const char* name_of(WallKind kind) {
  constexpr std::array names{"wall", "moving wall", "thermal wall"};
  return names[static_cast<std::size_t>(kind)];
}

std::vector<WallSurface> surfaces_of(std::span<const Scene::Wall> walls, const State& state,
                                     std::optional<double> time) {
  std::vector<WallSurface> surfaces;
  for (const Scene::Wall& wall : walls) {
    WallSurface& surface = surfaces.emplace_back();
    surface.axis = static_cast<std::size_t>(wall.axis.at(0) - 'x');
    surface.is_high = wall.side == "high";
    surface.kind = kind_of(wall);
    surface.place = state.low[surface.axis] + (surface.is_high ? state.box[surface.axis] : 0);
    if (!shakes(wall) || !time) continue;
    const double turns = std::fmod(wall.motion->frequency * *time, 1.0);
    surface.place +=
        wall.motion->amplitude * std::sin(2 * std::numbers::pi * turns + wall.motion->phase);
  }
  return surfaces;
}

std::string description_of(const Scene::Wall& wall) {
  const WallKind kind = kind_of(wall);
  std::string text = fmt::format("{} {} ({}", wall.side, wall.axis, name_of(kind));
  if (kind == WallKind::thermal)
    return text + fmt::format(", temperature {:g})", *wall.temperature);
  if (shakes(wall)) {
    text += fmt::format(", amplitude {:g}, frequency {:g}", wall.motion->amplitude,
                        wall.motion->frequency);
  } else if (kind == WallKind::moving) {
    text += fmt::format(", velocity {:g}", *wall.motion->velocity);
  }
  return text + fmt::format(", restitution {:g})", wall.epsilon);
}

Region region_of(const State& state, std::span<const WallSurface> walls) {
  Region region{state.low, state.box, TiltedCell(state).xy()};
  for (std::size_t axis = 0; axis < 3; ++axis) region.high[axis] += state.low[axis];
  const auto include = [&](std::size_t axis, double place) {
    region.low[axis] = std::min(region.low[axis], place);
    region.high[axis] = std::max(region.high[axis], place);
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (state.periodic[axis]) continue;
    for (const Vector& centre : state.position) include(axis, centre[axis]);
  }
  for (const WallSurface& wall : walls) include(wall.axis, wall.place);
  return region;
}

bool is_open(std::span<const WallSurface> walls, std::size_t axis, bool high) {
  const auto is_at = [&](bool end) {
    return std::ranges::any_of(
        walls, [&](const WallSurface& wall) { return wall.axis == axis && wall.is_high == end; });
  };
  return is_at(!high) && !is_at(high);
}

}  // namespace needlework::picture
