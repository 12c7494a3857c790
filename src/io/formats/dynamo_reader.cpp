#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "needlework/error.h"
#include "src/box/vector.h"
#include "src/io/formats/dynamo.h"
#include "src/io/formats/dynamo_parts.h"
#include "src/io/formats/input_text.h"
#include "src/io/formats/xml.h"
#include "src/io/needle_check.h"

namespace needlework::io::dynamo {
namespace {

constexpr const char* version = "1.5.0";

// A director that was written beside a quaternion differs from the quaternion's by roundings alone.
constexpr double largest_difference = 1e-14;

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

std::size_t count_particles(const XmlElement& root) {
  std::size_t count = 0;
  const XmlElement data = root.child("ParticleData");
  for (auto particle = data.first("Pt"); particle; particle = particle->next()) ++count;
  return count;
}

Configuration read(const XmlElement& root) {
  root.require_word("version", {version}, version);
  root.require_only({"version"}, {"Simulation", "Properties", "ParticleData"});
  const XmlElement simulation = root.child("Simulation");
  simulation.require_only({"lastMFT"},
                          {"Scheduler", "SimulationSize", "Genus", "BC", "Topology", "Interactions",
                           "Locals", "Globals", "SystemEvents", "Dynamics", "Ensemble"});
  if (root.first("Properties")) root.child("Properties").require_only({}, {});
  require_nothing_else(simulation);

  Configuration configuration;
  const SpeciesOfParticles species = read_species(simulation, count_particles(root), configuration);
  configuration.state.box = read_box(simulation);
  read_particles(root, configuration);
  read_walls(simulation, species, configuration);
  read_dynamics(simulation, configuration);
  return configuration;
}

}  // namespace
}  // namespace needlework::io::dynamo

namespace needlework::io {

// About two million needles. The document takes about five times as much memory as its text.
static constexpr std::size_t max_xml_bytes = std::size_t{1} << 30;

bool is_dynamo(std::string_view beginning) {
  const auto first = beginning.find_first_not_of("\xef\xbb\xbf \t\r\n");
  return first != beginning.npos && beginning[first] == '<';
}

Configuration read_dynamo(const std::string& path) {
  const XmlDocument document(read_text_file(path, max_xml_bytes), path);
  return dynamo::read(document.root("DynamOconfig"));
}

}  // namespace needlework::io
