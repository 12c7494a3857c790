#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "needlework/error.h"
#include "src/io/formats/dynamo.h"
#include "src/io/formats/input_text.h"
#include "src/io/formats/xml.h"
#include "src/io/needle_check.h"

namespace needlework::io {
namespace {

using Vector = std::array<double, 3>;

constexpr const char* version = "1.5.0";

// About two million needles. The document takes about five times as much memory as its text.
constexpr std::size_t max_xml_bytes = std::size_t{1} << 30;

// A director that was written beside a quaternion differs from the quaternion's by roundings alone.
constexpr double largest_difference = 1e-14;

Vector vector_of(const XmlElement& element) {
  return {element.number("x"), element.number("y"), element.number("z")};
}

Vector read_vector(const XmlElement& parent, const char* name) {
  const XmlElement element = parent.child(name);
  element.require_only({"x", "y", "z"}, {});
  return vector_of(element);
}

double positive_number(const XmlElement& element, const char* attribute) {
  const double value = element.number(attribute);
  if (!(value > 0)) element.reject(attribute, "a number > 0");
  return value;
}

// Mass, length and elasticity can be the names of properties that differ between particles.
double common_number(const XmlElement& element, const char* attribute) {
  if (!element.has(attribute)) {
    element.reject(fmt::format("{} is missing: expected a number", attribute));
  }
  double value = 0;
  try {
    value = element.number(attribute);
  } catch (const InputError&) {
    element.reject(attribute, "a finite number, the same for all particles");
  }
  return value;
}

double elasticity_of(const XmlElement& element) {
  const double epsilon = common_number(element, "Elasticity");
  if (!(epsilon >= 0 && epsilon <= 1)) element.reject("Elasticity", "a number from 0 to 1");
  return epsilon;
}

// All particles, or all pairs: as an element, or as an attribute in files of earlier programs.
void require_all(const XmlElement& element, const char* range, const char* earlier) {
  if (const auto child = element.first(range)) {
    if (element.has("Range")) element.reject("Range", "this or the element, not both");
    element.child(range).require_word("Type", {"All"}, "All: ranges cannot be carried over");
    child->require_only({"Type"}, {});
  } else {
    element.require_word("Range", {earlier},
                         fmt::format("{}: ranges cannot be carried over", earlier));
  }
}

// Lines have a moment of inertia, points, which are the centres of spheres, have none.
struct Body {
  bool is_sphere = false;
  long double inertia = 0;  // for a unit of mass, with digits beyond those of a double: only these
                            // may lead back to a given k
};

Body read_species(const XmlElement& simulation, Material& material) {
  const XmlElement genus = simulation.child("Genus");
  genus.require_only({}, {"Species"});
  if (const auto species = genus.first("Species"); species && species->next()) {
    species->next()->reject("a second species cannot be carried over: expected one");
  }
  const XmlElement species = genus.child("Species");
  species.require_word("Type", {"SphericalTop", "Lines", "Point"},
                       "SphericalTop, Lines or Point: other particles cannot be carried over");
  species.require_only({"Type", "Name", "IntName", "Mass", "InertiaConstant", "Range"},
                       {"IDRange"});
  require_all(species, "IDRange", "All");
  material.names = {std::string(species.text("Name"))};
  material.mass = {common_number(species, "Mass")};
  if (!(material.mass[0] > 0)) species.reject("Mass", "a number > 0");
  if (species.text("Type") == "Point") return {.is_sphere = true};
  positive_number(species, "InertiaConstant");
  return {.inertia = std::strtold(std::string(species.text("InertiaConstant")).c_str(), nullptr)};
}

void read_interaction(const XmlElement& simulation, bool of_spheres, Material& material) {
  const XmlElement interactions = simulation.child("Interactions");
  interactions.require_only({}, {"Interaction"});
  for (auto each = interactions.first("Interaction"); each; each = each->next()) {
    if (of_spheres) {
      each->require_word("Type", {"HardSphere"},
                         "HardSphere, as of points: other interactions cannot be carried over");
    } else {
      each->require_word("Type", {"Lines"},
                         "Lines, as of particles that turn: other interactions cannot be carried "
                         "over");
    }
  }
  const XmlElement contact = interactions.child("Interaction");
  const char* size = of_spheres ? "Diameter" : "Length";
  // A CaptureMap lists which pairs are near each other, and follows from the positions.
  contact.require_only({"Type", "Name", size, "Elasticity", "Range"},
                       {"IDPairRange", "CaptureMap"});
  require_all(contact, "IDPairRange", "2All");
  const double value = common_number(contact, size);
  if (!(value > 0)) contact.reject(size, "a number > 0");
  material.length = {of_spheres ? 0 : value};
  if (of_spheres) material.diameter = {value};
  material.epsilon = {elasticity_of(contact)};
}

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

// Gravity, and the contact time that DynamO has with it.
void read_dynamics(const XmlElement& simulation, Configuration& configuration) {
  const XmlElement dynamics = simulation.child("Dynamics");
  dynamics.require_word("Type", {"Newtonian", "NewtonianGravity"},
                        "Newtonian or NewtonianGravity: other dynamics cannot be carried over");
  if (dynamics.text("Type") == "Newtonian") return dynamics.require_only({"Type"}, {});
  dynamics.require_only({"Type", "ElasticV", "tc"}, {"g"});
  if (dynamics.has("ElasticV") && dynamics.number("ElasticV") != 0) {
    dynamics.reject("ElasticV",
                    "0: collisions that are elastic by their speed cannot be carried "
                    "over");
  }
  if (dynamics.has("tc")) configuration.contact_time = positive_number(dynamics, "tc");
  configuration.material.gravity = read_vector(dynamics, "g");
}

// A plane normal to an axis.
struct Plane {
  Scene::Wall wall;
  double place = 0;  // along the axis
};

// Walls stop spheres at their surface, and needles at a ball around the centre.
void require_fitting_wall(const XmlElement& local, const Material& material) {
  if (!has_width(material) ||
      (local.has("Diameter") && local.number("Diameter") == material.diameter[0]))
    return;
  local.reject(fmt::format("Diameter {}: expected {}, that of the spheres",
                           local.has("Diameter") ? local.text("Diameter") : "is missing",
                           material.diameter[0]));
}

Plane read_plane(const XmlElement& local) {
  local.require_word("Type", {"Wall"}, "Wall: other local objects cannot be carried over");
  local.require_only({"Type", "Name", "Elasticity", "Diameter", "Temperature", "Render", "Range"},
                     {"IDRange", "Norm", "Origin"});
  require_all(local, "IDRange", "All");
  const Vector normal = read_vector(local, "Norm"), origin = read_vector(local, "Origin");
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (normal[axis] == 0 || normal[(axis + 1) % 3] != 0 || normal[(axis + 2) % 3] != 0) continue;
    Plane out;
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

void read_walls(const XmlElement& simulation, Configuration& configuration) {
  const std::array<bool, 3> periodic = read_boundary(simulation);
  std::vector<Plane> planes;
  if (simulation.first("Locals")) {
    const XmlElement locals = simulation.child("Locals");
    locals.require_only({}, {"Local"});
    for (auto each = locals.first("Local"); each; each = each->next()) {
      Plane plane = read_plane(*each);
      require_fitting_wall(*each, configuration.material);
      for (const Plane& other : planes) {
        if (other.wall.axis != plane.wall.axis || other.wall.side != plane.wall.side) continue;
        each->reject("a second wall with this normal: expected one at each end of an axis");
      }
      planes.push_back(std::move(plane));
    }
  }
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
  configuration.note =
      "walls of DynamO stop balls around the centres, whose diameters are left out: needles touch "
      "walls by their tips";
}

// Whatever else acts on particles besides collisions.
void require_nothing_else(const XmlElement& simulation) {
  for (const char* name : {"Topology", "SystemEvents"}) {
    if (simulation.first(name)) simulation.child(name).require_only({}, {});
  }
  if (!simulation.first("Globals")) return;
  // Lists of neighbours, and guards of boundaries and of parabolas, have no effect on the motion.
  simulation.child("Globals").require_only({}, {"Global"});
  for (auto global = simulation.child("Globals").first("Global"); global; global = global->next()) {
    global->require_word("Type", {"Cells", "PBCSentinel", "ParabolaSentinel"},
                         "Cells, PBCSentinel or ParabolaSentinel: others cannot be carried over");
  }
}

Vector read_box(const XmlElement& simulation) {
  const XmlElement size = simulation.child("SimulationSize");
  size.require_only({"x", "y", "z"}, {});
  return {positive_number(size, "x"), positive_number(size, "y"), positive_number(size, "z")};
}

// The direction into which the quaternion turns (0, 0, 1). In long double, so that the result is
// that of exact arithmetic within a rounding.
Vector turned(long double w, long double x, long double y, long double z) {
  const long double square = w * w + x * x + y * y + z * z;
  return {static_cast<double>(2 * (x * z + w * y) / square),
          static_cast<double>(2 * (y * z - w * x) / square),
          static_cast<double>((w * w + z * z - x * x - y * y) / square)};
}

Vector read_orientation(const XmlElement& element) {
  const Vector u = vector_of(element);
  const double w = element.has("w") ? element.number("w") : 0;
  // Products of numbers of this size neither overflow nor lose digits.
  const double size = std::max({std::abs(u[0]), std::abs(u[1]), std::abs(u[2]), std::abs(w)});
  if (!(size > 1e-100 && size < 1e100)) {
    element.reject(fmt::format("of size {}: expected a direction, of size near 1", size));
  }
  if (element.has("w")) return turned(w, u[0], u[1], u[2]);
  const long double x = u[0], y = u[1], z = u[2];
  const long double length = std::sqrt(x * x + y * y + z * z);
  return {static_cast<double>(x / length), static_cast<double>(y / length),
          static_cast<double>(z / length)};
}

Vector read_director(const XmlElement& particle) {
  const XmlElement orientation = particle.child("U");
  orientation.require_only({"x", "y", "z", "w"}, {});
  const Vector director = read_orientation(orientation);
  if (!particle.first("Director")) return director;

  const Vector exact = read_vector(particle, "Director");
  const double length = length_of(exact);
  const XmlElement element = particle.child("Director");
  if (!is_unit(exact)) element.reject(fmt::format("of length {}: expected a unit vector", length));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (std::abs(exact[axis] / length - director[axis]) <= largest_difference) continue;
    element.reject(fmt::format("({}, {}, {}): expected ({}, {}, {}), to which U turns (0, 0, 1)",
                               exact[0], exact[1], exact[2], director[0], director[1],
                               director[2]));
  }
  return exact;
}

void read_particle(const XmlElement& particle, Configuration& configuration) {
  State& state = configuration.state;
  const std::size_t number = state.size();
  if (particle.has("Static")) particle.reject("Static", "none: all needles move");
  const bool is_sphere = has_width(configuration.material);
  if (is_sphere) {
    particle.require_only({"ID"}, {"P", "V"});
  } else {
    particle.require_only({"ID"}, {"P", "V", "O", "U", "Director"});
  }
  if (particle.has("ID") && particle.number("ID") != static_cast<double>(number)) {
    particle.reject("ID", fmt::format("{}: particles are numbered in order", number));
  }
  state.position.push_back(read_vector(particle, "P"));
  state.velocity.push_back(read_vector(particle, "V"));
  if (is_sphere) {  // which does not turn
    state.orientation.push_back({0, 0, 1});
    state.angular_velocity.push_back({});
    return;
  }
  const Vector u = read_director(particle);
  Vector w = read_vector(particle, "O");
  if (const double part = std::abs(part_along(w, u)); !(part <= director_tolerance)) {
    if (!(part <= largest_rounding)) {
      particle.child("O").reject(
          fmt::format("{} of its length is along the director: expected none, within {}", part,
                      largest_rounding));
    }
    w = without_part_along(w, u);
    configuration.roundings.add(part);
  }
  state.orientation.push_back(u);
  state.angular_velocity.push_back(w);
}

void read_particles(const XmlElement& root, Configuration& configuration) {
  const XmlElement data = root.child("ParticleData");
  data.require_only({"OrientationData", "N"}, {"Pt"});
  const bool of_spheres = has_width(configuration.material);
  if (of_spheres && data.has("OrientationData"))
    data.reject("OrientationData", "none: points do not turn");
  if (!of_spheres && !data.has("OrientationData")) {
    data.reject(
        "OrientationData is missing: expected OrientationData=\"Y\", and U and O in each Pt");
  }
  for (auto particle = data.first("Pt"); particle; particle = particle->next()) {
    read_particle(*particle, configuration);
  }
  const State& state = configuration.state;
  if (data.has("N") && data.number("N") != static_cast<double>(state.size())) {
    data.reject("N", fmt::format("{}, the number of particles", state.size()));
  }
}

}  // namespace

bool is_dynamo(std::string_view beginning) {
  const auto first = beginning.find_first_not_of("\xef\xbb\xbf \t\r\n");
  return first != beginning.npos && beginning[first] == '<';
}

Configuration read_dynamo(const std::string& path) {
  const XmlDocument document(read_text_file(path, max_xml_bytes), path);
  const XmlElement root = document.root("DynamOconfig");
  root.require_word("version", {version}, version);
  root.require_only({"version"}, {"Simulation", "Properties", "ParticleData"});
  const XmlElement simulation = root.child("Simulation");
  simulation.require_only({"lastMFT"},
                          {"Scheduler", "SimulationSize", "Genus", "BC", "Topology", "Interactions",
                           "Locals", "Globals", "SystemEvents", "Dynamics", "Ensemble"});
  if (root.first("Properties")) root.child("Properties").require_only({}, {});
  require_nothing_else(simulation);

  Configuration configuration;
  Material& material = configuration.material;
  const Body body = read_species(simulation, material);
  read_interaction(simulation, body.is_sphere, material);
  const long double length = material.length[0];
  material.k = {body.is_sphere ? Species{}.k
                               : static_cast<double>(length * length / (2 * body.inertia))};
  material.beta = {-1};  // the impulse is normal to both lines
  configuration.state.box = read_box(simulation);
  read_particles(root, configuration);
  read_walls(simulation, configuration);
  read_dynamics(simulation, configuration);
  return configuration;
}

}  // namespace needlework::io
