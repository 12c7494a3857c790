#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "needlework/error.h"
#include "src/box/vector.h"
#include "src/io/formats/dynamo.h"
#include "src/io/formats/rod.h"
#include "src/io/formats/text_file.h"

namespace needlework::io {
namespace {

// Text in an attribute.
std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    const bool plain =
        static_cast<unsigned char>(c) >= ' ' && c != '&' && c != '<' && c != '>' && c != '"';
    out += plain ? std::string(1, c) : fmt::format("&#{};", static_cast<unsigned char>(c));
  }
  return out;
}

// The needles of each species, as elements IDRange.
std::vector<std::string> ranges_of(const State& state, const Composition& composition,
                                   const std::string& path) {
  const std::size_t count = composition.size();
  if (count == 1) return {"<IDRange Type=\"All\"/>"};
  std::vector<std::vector<std::size_t>> ids(count);
  for (std::size_t i = 0; i < state.size(); ++i) ids.at(species_at(state, i)).push_back(i);
  std::vector<std::string> out;
  for (std::size_t index = 0; index < count; ++index) {
    const std::vector<std::size_t>& own = ids[index];
    if (own.empty()) {
      throw InputError(
          fmt::format("{}: no needle of the species {}: expected some, as ranges of DynamO know "
                      "a species by its particles",
                      path, composition[index].name));
    }
    if (own.back() - own.front() + 1 == own.size()) {
      out.push_back(
          fmt::format(R"(<IDRange Type="Ranged" Start="{}" End="{}"/>)", own.front(), own.back()));
      continue;
    }
    std::string list = "<IDRange Type=\"List\">";
    for (const std::size_t id : own) list += fmt::format("<ID val=\"{}\"/>", id);
    out.push_back(list + "</IDRange>");
  }
  return out;
}

class DynamoWriter : public FrameWriter {
 public:
  DynamoWriter(const std::string& path, bool force, const Material& material)
      : path_(path),
        spheres_(are_spheres(material)),
        material_(material),
        composition_(composition_of(material, path)),
        name_(material.names.empty() ? "Bulk" : material.names[0]),
        walls_(single_walls(material.walls)),
        gravity_(material.gravity),
        file_(path, force) {
    require_known_bodies();
  }

  void add(const Frame& frame) override {
    if (frame.state.scale) composition_ = composition_of(grown(material_, frame.state), path_);
    const auto differ = which_differ(frame.state, composition_.size());
    const bool are_own = !frame.state.scale && !frame.state.own_bodies.empty();
    if (are_own || std::ranges::find(differ, true) != differ.end()) {
      throw InputError(
          fmt::format("{}: bodies of a species that differ: expected equal ones, as particles of a "
                      "species are written with one mass and one size",
                      path_));
    }
    if (frame.state.slide != 0 || frame.state.shear_rate != 0) {
      throw InputError(
          fmt::format("{}: frame {} is of a sheared box: expected one whose images are at rest, as "
                      "the Lees-Edwards boundary of DynamO is not written; H5MD, XYZ and LAMMPS "
                      "have its tilt",
                      path_, frame.number));
    }
    ranges_ = ranges_of(frame.state, composition_, path_);
    write_simulation(frame.state);
    file_.print("  <Properties/>\n  <ParticleData{}>\n", spheres_ ? "" : " OrientationData=\"Y\"");
    for (std::size_t i = 0; i < frame.state.size(); ++i) write_particle(frame.state, i);
    file_.print("  </ParticleData>\n</DynamOconfig>\n");
  }
  void publish() override { file_.publish(); }

 private:
  void require_known_bodies() const;
  void write_simulation(const State& state);
  void write_species();
  void write_interactions();
  void write_interaction(const std::string& name, std::size_t a, std::size_t b,
                         const std::string& pairs);
  // The length of both lines, or the distance of the centres of two spheres.
  double size_of(std::size_t a, std::size_t b) const {
    return spheres_ ? composition_.contact_distance(a, b) : composition_[a].length;
  }
  std::string boundary(const State& state, Vector& size) const;
  std::string locals(const Vector& box) const;
  std::string dynamics() const;
  void write_particle(const State& state, std::size_t i);
  void write_vector(const char* name, const Vector& v) {
    file_.print("      <{} x=\"{}\" y=\"{}\" z=\"{}\"/>\n", name, v[0], v[1], v[2]);
  }

  std::string path_;
  bool spheres_;
  Material material_;
  Composition composition_;
  std::string name_;                // of a single species
  std::vector<Scene::Wall> walls_;  // one by one
  Vector gravity_;
  std::vector<std::string> ranges_;  // of each species
  TextFile file_;
};

void DynamoWriter::require_known_bodies() const {
  for (const Species& each : composition_.species()) {
    if (!each.fixed) continue;
    throw InputError(
        fmt::format("{}: the species {} is fixed: expected bodies that move, as immobile particles "
                    "of DynamO are not written",
                    path_, each.name));
  }
  if (!composition_.all_meet()) {
    throw InputError(fmt::format(
        "{}: pairs that pass through each other: expected species that all meet", path_));
  }
  if (spheres_) return;
  const auto is_needle = [](const Species& each) { return each.has_axis() && each.diameter == 0; };
  const auto is_sphere = [](const Species& each) { return !each.has_axis(); };
  if (std::ranges::any_of(composition_.species(), is_needle) &&
      std::ranges::any_of(composition_.species(), is_sphere)) {
    throw InputError(
        fmt::format("{}: needles beside spheres: expected one of both, as lines and points of "
                    "DynamO never meet",
                    path_));
  }
  if (composition_.has_width()) {
    throw InputError(fmt::format(
        "{}: rods of finite width: expected thin needles or spheres, as DynamO knows no "
        "cylinders with caps",
        path_));
  }
  const Species& first = composition_[0];
  for (const Species& other : composition_.species()) {
    if (other.length == first.length) continue;
    throw InputError(
        fmt::format("{}: needles of length {} and {}: expected one length, as lines of DynamO "
                    "that meet have one length",
                    path_, first.length, other.length));
  }
}

// DynamO has no boundary that is open along y or z alone, nor along x and one of them. The size is
// then doubled along walled axes, so that no two needles are near each other across the boundary.
std::string DynamoWriter::boundary(const State& state, Vector& size) const {
  const auto [x, y, z] = state.periodic;
  if (x && y && z) return "PBC";
  if (!x && y && z) return "NoXPBC";
  if (x && !y && !z) return "OnlyXPBC";
  if (!x && !y && !z) return "None";
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (state.periodic[axis]) continue;
    const auto sides = std::count_if(walls_.begin(), walls_.end(), [&](const Scene::Wall& wall) {
      return wall.axis[0] == "xyz"[axis];
    });
    if (sides != 2) {
      throw InputError(
          fmt::format("{}: an open side along {}: expected walls at both ends, as DynamO has no "
                      "boundary that is open along this axis and periodic along the others",
                      path_, "xyz"[axis]));
    }
    size[axis] *= 2;
  }
  return "PBC";
}

std::string DynamoWriter::locals(const Vector& box) const {
  if (walls_.empty()) return "    <Locals/>\n";
  // Spheres touch walls with their surfaces, and a wall has one diameter.
  const bool one_size = std::ranges::all_of(composition_.species(), [&](const Species& each) {
    return each.diameter == composition_[0].diameter;
  });
  std::string text = "    <Locals>\n";
  for (const Scene::Wall& wall : walls_) {
    const auto axis = static_cast<std::size_t>(wall.axis[0] - 'x');
    const bool high = wall.side == "high";
    Vector normal{}, origin{};
    normal[axis] = high ? -1 : 1;
    origin[axis] = (high ? 0.5 : -0.5) * box[axis];
    const bool moves = wall.motion && io::moves(*wall.motion);
    if (moves || (wall.motion && slides(*wall.motion))) {
      throw InputError(
          fmt::format("{}: the wall {}-{} {}: expected walls at rest, as in a "
                      "configuration of DynamO",
                      path_, wall.axis, wall.side, moves ? "moves" : "slides"));
    }
    const std::string temperature =
        wall.temperature ? fmt::format(" Temperature=\"{}\"", *wall.temperature) : "";
    for (std::size_t index = 0; index < (one_size ? 1 : composition_.size()); ++index) {
      text += fmt::format(
          R"(      <Local Type="Wall" Name="{}-{}{}" Elasticity="{}" Diameter="{}"{}>
        {}
        <Norm x="{}" y="{}" z="{}"/>
        <Origin x="{}" y="{}" z="{}"/>
      </Local>
)",
          wall.axis, wall.side, one_size ? "" : fmt::format("-{}", index + 1), wall.epsilon,
          size_of(index, index), temperature, one_size ? "<IDRange Type=\"All\"/>" : ranges_[index],
          normal[0], normal[1], normal[2], origin[0], origin[1], origin[2]);
    }
  }
  return text + "    </Locals>\n";
}

std::string DynamoWriter::dynamics() const {
  if (gravity_ == Vector{}) return "    <Dynamics Type=\"Newtonian\"/>\n";
  return fmt::format(R"(    <Dynamics Type="NewtonianGravity">
      <g x="{}" y="{}" z="{}"/>
    </Dynamics>
)",
                     gravity_[0], gravity_[1], gravity_[2]);
}

void DynamoWriter::write_species() {
  for (std::size_t index = 0; index < composition_.size(); ++index) {
    const Species& each = composition_[index];
    const std::string name = escaped(composition_.is_mixture() ? each.name : name_);
    if (spheres_) {
      file_.print(R"(      <Species Mass="{}" Name="{}" Type="Point">)", each.mass, name);
    } else {
      // With more digits than a double has, so that k follows from it without an error.
      const long double length = each.length;
      const long double inertia = length * length / (2 * static_cast<long double>(each.k));
      file_.print(
          R"(      <Species InertiaConstant="{:.21g}" Mass="{}" Name="{}" Type="SphericalTop">)",
          inertia, each.mass, name);
    }
    file_.print("\n        {}\n      </Species>\n", ranges_[index]);
  }
}

void DynamoWriter::write_interaction(const std::string& name, std::size_t a, std::size_t b,
                                     const std::string& pairs) {
  file_.print(R"(      <Interaction Type="{}" {}="{}" Elasticity="{}" Name="{}">
        {}
      </Interaction>
)",
              spheres_ ? "HardSphere" : "Lines", spheres_ ? "Diameter" : "Length", size_of(a, b),
              composition_.restitution(a, b).epsilon, name, pairs);
}

// The first that holds a pair is that of it. So all pairs that collide like those of the first
// species follow in one that holds all.
void DynamoWriter::write_interactions() {
  const double epsilon = composition_.restitution(0, 0).epsilon;
  for (std::size_t a = 0; a < composition_.size(); ++a) {
    for (std::size_t b = a; b < composition_.size(); ++b) {
      if (size_of(a, b) == size_of(0, 0) && composition_.restitution(a, b).epsilon == epsilon) {
        continue;
      }
      write_interaction(
          fmt::format("{}-{}", a + 1, b + 1), a, b,
          a == b ? fmt::format(R"(<IDPairRange Type="Single">{}</IDPairRange>)", ranges_[a])
                 : fmt::format(R"(<IDPairRange Type="Pair">{}{}</IDPairRange>)", ranges_[a],
                               ranges_[b]));
    }
  }
  write_interaction("Bulk", 0, 0, R"(<IDPairRange Type="All"/>)");
}

void DynamoWriter::write_simulation(const State& state) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const bool walled = std::any_of(walls_.begin(), walls_.end(), [&](const Scene::Wall& wall) {
      return wall.axis[0] == "xyz"[axis];
    });
    if (walled != state.periodic[axis]) continue;
    throw InputError(
        fmt::format("{}: a box that is {}periodic along {}, {} a wall: expected walls "
                    "along the other axes alone",
                    path_, walled ? "" : "not ", "xyz"[axis], walled ? "with" : "without"));
  }
  Vector size = state.box;
  const std::string type = boundary(state, size);
  file_.print(R"(<?xml version="1.0"?>
<DynamOconfig version="1.5.0">
  <Simulation>
    <Scheduler Type="NeighbourList">
      <Sorter Type="BoundedPQMinMax3"/>
    </Scheduler>
    <SimulationSize x="{}" y="{}" z="{}"/>
    <Genus>
)",
              size[0], size[1], size[2]);
  write_species();
  file_.print("    </Genus>\n    <BC Type=\"{}\"/>\n    <Topology/>\n    <Interactions>\n", type);
  write_interactions();
  file_.print("    </Interactions>\n{}    <Globals/>\n    <SystemEvents/>\n{}  </Simulation>\n",
              locals(state.box), dynamics());
}

void DynamoWriter::write_particle(const State& state, std::size_t i) {
  file_.print("    <Pt ID=\"{}\">\n", i);
  // The origin is in the middle of the box.
  Vector centre = state.position[i];
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!state.periodic[axis]) centre[axis] -= 0.5 * state.box[axis];
  }
  write_vector("P", centre);
  write_vector("V", state.velocity[i]);
  if (!spheres_) {
    const Vector& u = state.orientation[i];
    const auto [w, x, y, z] = quaternion_of(u);
    write_vector("O", state.angular_velocity[i]);
    file_.print("      <U x=\"{}\" y=\"{}\" z=\"{}\" w=\"{}\"/>\n", x, y, z, w);
    write_vector("Director", u);
  }
  file_.print("    </Pt>\n");
}

}  // namespace

std::unique_ptr<FrameWriter> write_dynamo(const std::string& path, bool force,
                                          const Material& material) {
  return std::make_unique<DynamoWriter>(path, force, material);
}

}  // namespace needlework::io
