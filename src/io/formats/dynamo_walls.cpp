// Boundaries and walls of DynamO.
#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "src/box/vector.h"
#include "src/io/formats/dynamo_parts.h"
#include "src/io/formats/lines.h"

namespace needlework::io::dynamo {
namespace {

// Along which axes the boundary is periodic.
std::array<bool, 3> read_boundary(const XmlElement& simulation) {
  const XmlElement boundary = simulation.child("BC");
  boundary.require_word("Type", {"PBC", "NoXPBC", "OnlyXPBC", "None", "Null"},
                        "PBC, NoXPBC, OnlyXPBC or None: other boundaries cannot be carried over");
  boundary.require_only({"Type"}, {});
  const std::string_view type = boundary.text("Type");
  const bool yz = type == "PBC" || type == "NoXPBC";
  return {type == "PBC" || type == "OnlyXPBC", yz, yz};
}

// A plane normal to an axis.
struct Plane {
  Scene::Wall wall;
  double place = 0;                    // along the axis
  std::vector<std::size_t> species{};  // of the particles that it stops, in order
};

// Walls stop spheres at their surface, and needles at a ball around the centre.
void require_fitting_wall(const XmlElement& local, const Plane& plane,
                          const SpeciesOfParticles& species, const Material& material) {
  if (!has_width(material)) return;
  for (const std::size_t index : plane.species) {
    const double expected = material.diameter[index];
    if (local.has("Diameter") && local.number("Diameter") == expected) continue;
    local.reject(fmt::format(
        "Diameter {}: expected {}, that of the spheres{}",
        local.has("Diameter") ? local.text("Diameter") : "is missing", expected,
        species.species() > 1 ? fmt::format(" of {}", quotation(species.name(index))) : ""));
  }
}

Plane read_plane(const XmlElement& local, const SpeciesOfParticles& species) {
  local.require_word("Type", {"Wall"}, "Wall: other local objects cannot be carried over");
  local.require_only({"Type", "Name", "Elasticity", "Diameter", "Temperature", "Render", "Range"},
                     {"IDRange", "Norm", "Origin"});
  Plane out;
  out.species = species.in_range(local);
  const Vector normal = read_vector(local, "Norm"), origin = read_vector(local, "Origin");
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (normal[axis] == 0 || normal[(axis + 1) % 3] != 0 || normal[(axis + 2) % 3] != 0) continue;
    out.wall.axis = std::string(1, "xyz"[axis]);
    out.wall.side = normal[axis] > 0 ? "low" : "high";
    out.place = origin[axis];
    out.wall.epsilon = elasticity_of(local);
    if (local.has("Temperature") && local.number("Temperature") != 0) {
      out.wall.temperature = positive_number(local, "Temperature");
      out.wall.epsilon = 1;
    }
    return out;
  }
  local.child("Norm").reject(fmt::format("({}, {}, {}): expected a normal along x, y or z",
                                         normal[0], normal[1], normal[2]));
}

// Spheres of several species have a wall for each, as a wall of DynamO has one diameter. Together
// they are one wall.
void unite(const XmlElement& local, const Plane& plane, Plane& with) {
  std::vector<std::size_t> both;
  std::ranges::set_intersection(plane.species, with.species, std::back_inserter(both));
  if (!both.empty()) {
    local.reject("a second wall with this normal: expected one at each end of an axis");
  }
  if (plane.place != with.place || plane.wall.epsilon != with.wall.epsilon ||
      plane.wall.temperature != with.wall.temperature) {
    local.reject(
        "another place, elasticity or temperature than with this normal before: expected those of "
        "one wall for all species");
  }
  std::ranges::set_union(plane.species, with.species, std::back_inserter(both));
  with.species = std::move(both);
}

std::vector<Plane> read_planes(const XmlElement& simulation, const SpeciesOfParticles& species,
                               const Material& material) {
  std::vector<Plane> planes;
  if (!simulation.first("Locals")) return planes;
  const XmlElement locals = simulation.child("Locals");
  locals.require_only({}, {"Local"});
  for (auto each = locals.first("Local"); each; each = each->next()) {
    Plane plane = read_plane(*each, species);
    require_fitting_wall(*each, plane, species, material);
    const auto same = std::ranges::find_if(planes, [&](const Plane& other) {
      return other.wall.axis == plane.wall.axis && other.wall.side == plane.wall.side;
    });
    if (same == planes.end()) {
      planes.push_back(std::move(plane));
    } else {
      unite(*each, plane, *same);
    }
  }
  for (const Plane& plane : planes) {
    for (std::size_t index = 0; index < species.species(); ++index) {
      if (std::ranges::binary_search(plane.species, index)) continue;
      locals.reject(fmt::format("the wall {}-{} is none for {}: expected it for all species",
                                plane.wall.axis, plane.wall.side, quotation(species.name(index))));
    }
  }
  return planes;
}

// Puts the walls of one axis at 0 and at the edge of the box, and the needles with them.
void place_walls(const XmlElement& simulation, std::size_t axis, bool periodic, const Plane* low,
                 const Plane* high, State& state) {
  const char name = "xyz"[axis];
  if (!low && !high) {
    if (periodic) return;
    simulation.child("BC").reject(
        fmt::format("not periodic along {}, without a wall: expected one in Locals", name));
  }
  double shift = 0;
  if (low && high) {
    state.box[axis] = high->place - low->place;
    if (!(state.box[axis] > 0)) {
      simulation.child("Locals").reject(
          fmt::format("walls along {} at {} and {}: expected the one with the normal along +{} "
                      "below the other",
                      name, low->place, high->place, name));
    }
    shift = -low->place;
  } else {
    if (periodic) {
      simulation.child("BC").reject(
          fmt::format("periodic along {}, with one wall: expected two walls, or a boundary that is "
                      "open along {}",
                      name, name));
    }
    shift = low ? -low->place : state.box[axis] - high->place;
  }
  state.periodic[axis] = false;
  for (Vector& centre : state.position) centre[axis] += shift;
}

}  // namespace

void read_walls(const XmlElement& simulation, const SpeciesOfParticles& species,
                Configuration& configuration) {
  const std::array<bool, 3> periodic = read_boundary(simulation);
  std::vector<Plane> planes = read_planes(simulation, species, configuration.material);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto find = [&](const char* side) -> const Plane* {
      for (const Plane& plane : planes) {
        if (plane.wall.axis[0] == "xyz"[axis] && plane.wall.side == side) return &plane;
      }
      return nullptr;
    };
    place_walls(simulation, axis, periodic[axis], find("low"), find("high"), configuration.state);
  }
  for (Plane& plane : planes) configuration.material.walls.push_back(std::move(plane.wall));
  if (planes.empty() || has_width(configuration.material)) return;
  configuration.notes.push_back(
      "walls of DynamO stop balls around the centres, whose diameters are left out: needles touch "
      "walls by their tips");
}

}  // namespace needlework::io::dynamo
