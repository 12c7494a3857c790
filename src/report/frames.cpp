#include "src/report/frames.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <ranges>

#include "needlework/h5md.h"
#include "src/box/box.h"
#include "src/box/vector.h"
#include "src/picture/needle_values.h"
#include "src/picture/walls.h"

namespace needlework::report {

using Json = nlohmann::ordered_json;

namespace {

float length_of(const Vector& a) { return static_cast<float>(std::hypot(a[0], a[1], a[2])); }

// Between the ends of what is drawn along an axis, in units of its length / 65536.
std::uint16_t place_between(double low, double high, double place) {
  const double share = (place - low) / (high - low);
  return static_cast<std::uint16_t>(std::clamp(std::floor(share * 65536), 0.0, 65535.0));
}

// The values that needlework view draws, of the needles chosen.
std::vector<float> chosen_values(const char* quantity, const State& state,
                                 std::span<const std::size_t> chosen) {
  const std::vector<double> all = picture::values_of(quantity, state, true).values;
  std::vector<float> values;
  for (const std::size_t i : chosen) values.push_back(static_cast<float>(all[i]));
  return values;
}

// Along which axis needles flow most.
std::size_t flow_axis_of(const State& state) {
  std::array<double, 3> energy{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const double flow : picture::values_of(picture::flow_along[axis], state, true).values) {
      energy[axis] += flow * flow;
    }
  }
  return static_cast<std::size_t>(std::ranges::max_element(energy) - energy.begin());
}

// What a picture shows, but at an open side only as far as needles are: a layer at the bottom of a
// high box would be small.
picture::Region region_of_layer(const State& state, std::span<const picture::WallSurface> walls) {
  constexpr double least = 0.125;  // of the shortest edge of the box
  picture::Region region = picture::region_of(state, walls);
  const double thinnest = least * std::ranges::min(state.box);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double &low = region.low[axis], &high = region.high[axis];
    if (picture::is_open(walls, axis, true)) {
      high = low + thinnest;
      for (const Vector& centre : state.position) high = std::max(high, centre[axis]);
    }
    if (picture::is_open(walls, axis, false)) {
      low = high - thinnest;
      for (const Vector& centre : state.position) low = std::min(low, centre[axis]);
    }
  }
  return region;
}

// Grows the first along the axes of walls, so that it has room for the second.
void include(picture::Region& region, const picture::Region& other, const State& state) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (state.periodic[axis]) continue;
    region.low[axis] = std::min(region.low[axis], other.low[axis]);
    region.high[axis] = std::max(region.high[axis], other.high[axis]);
  }
}

Json frame_of(const State& state, std::span<const picture::WallSurface> walls,
              const picture::Region& drawn, std::span<const std::size_t> chosen,
              std::size_t flow_axis, Arrays& arrays) {
  const Box box = box_of(state);
  std::vector<std::uint16_t> position;
  std::vector<std::int16_t> orientation;
  std::vector<float> speed, spin;
  const std::vector<Vector> velocities = picture::velocities_beside_flow(state);
  for (const std::size_t i : chosen) {
    const Vector place = box.wrap(state.position[i]).place;
    for (std::size_t a = 0; a < 3; ++a) {
      position.push_back(place_between(drawn.low[a], drawn.high[a], place[a]));
      orientation.push_back(
          static_cast<std::int16_t>(std::lround(32767 * state.orientation[i][a])));
    }
    speed.push_back(length_of(velocities[i]));
    spin.push_back(length_of(state.angular_velocity[i]));
  }
  const std::size_t n = chosen.size();
  const auto add = [&](const std::vector<float>& values) {
    return arrays.add(std::span<const float>(values), {n});
  };
  Json places = Json::array();
  for (const picture::WallSurface& wall : walls) places.push_back(wall.place);
  return {{"low", drawn.low},
          {"high", drawn.high},
          {"walls", places},
          {"position", arrays.add(std::span<const std::uint16_t>(position), {n, 3})},
          {"orientation", arrays.add(std::span<const std::int16_t>(orientation), {n, 3})},
          {"speed", add(speed)},
          {"spin", add(spin)},
          {"flow", add(chosen_values(picture::flow_along[flow_axis], state, chosen))},
          {"alignment", add(chosen_values("alignment", state, chosen))},
          {"density", add(chosen_values("density", state, chosen))}};
}

// What stays as it is from frame to frame.
Json drawn_walls(std::span<const picture::WallSurface> walls) {
  Json out = Json::array();
  for (const picture::WallSurface& wall : walls) {
    out.push_back(
        {{"axis", wall.axis}, {"high", wall.is_high}, {"kind", picture::name_of(wall.kind)}});
  }
  return out;
}

// Adds the largest size as NAME and, of needles that differ or of several species, that of each
// needle in units of it as share_of_NAME. In a gas of spheres alone all lengths are 0, and so are
// the shares.
void add_sizes(Json& out, const std::string& name, std::vector<double> OwnBodies::*own,
               const std::vector<double>& of_species, const State& state,
               std::span<const std::size_t> chosen, Arrays& arrays) {
  const std::vector<double>& rows = state.own_bodies.*own;
  const std::vector<double>& sizes = rows.empty() ? of_species : rows;
  const double largest = sizes.empty() ? 1 : std::ranges::max(sizes);
  out[name] = largest;
  if (sizes.size() <= 1) return;
  std::vector<float> shares;
  for (const std::size_t i : chosen) {
    const std::size_t species = i < state.species.size() ? state.species[i] : 0;
    const double size = rows.empty() ? sizes[std::min(species, sizes.size() - 1)] : rows[i];
    shares.push_back(largest > 0 ? static_cast<float>(size / largest) : 0);
  }
  out["share_of_" + name] = arrays.add(std::span<const float>(shares), {shares.size()});
}

}  // namespace

Json frames_of(const std::string& path, const BodySizes& sizes, std::span<const Scene::Wall> walls,
               const PageLimits& limits, Arrays& arrays) {
  const io::FrameFile file(path);
  const State first = file.read(0);
  const std::size_t needles = first.size();
  const auto chosen = evenly(needles, limits.needles);
  const std::size_t affordable = limits.drawn / std::max<std::size_t>(chosen.size(), 1);
  const auto frames = evenly(file.count(), std::min(limits.frames, affordable));
  const std::size_t flow_axis = flow_axis_of(file.read(frames.back()));
  Json out = {{"box", first.box},
              {"periodic", first.periodic},
              {"walls", drawn_walls(picture::surfaces_of(walls, first, {}))},
              {"flow_axis", flow_axis},
              {"needles_in_file", needles},
              {"needles_shown", chosen.size()},
              {"frames_in_file", file.count()},
              {"frames", Json::array()}};
  add_sizes(out, "length", &OwnBodies::length, sizes.lengths, first, chosen, arrays);
  if (!sizes.diameters.empty())
    add_sizes(out, "diameter", &OwnBodies::diameter, sizes.diameters, first, chosen, arrays);
  // From the last to the first, as each shows what those after it need: a film narrows as a layer
  // settles, and does not follow each needle that flies up.
  std::optional<picture::Region> later;
  std::vector<Json> backwards;
  for (auto next = frames.rbegin(); next != frames.rend(); ++next) {
    const std::size_t frame = *next;
    Json one = {{"number", frame}, {"time", nullptr}};
    const auto time = file.time(frame);
    if (time) one["time"] = *time;
    const State state = file.read(frame);
    if (state.scale) one["scale"] = *state.scale / *first.scale;
    const auto surfaces = picture::surfaces_of(walls, state, time);
    picture::Region drawn = region_of_layer(state, surfaces);
    if (later) include(drawn, *later, state);
    later = drawn;
    one.update(frame_of(state, surfaces, drawn, chosen, flow_axis, arrays));
    backwards.push_back(std::move(one));
  }
  for (auto next = backwards.rbegin(); next != backwards.rend(); ++next)
    out["frames"].push_back(std::move(*next));
  return out;
}

}  // namespace needlework::report
