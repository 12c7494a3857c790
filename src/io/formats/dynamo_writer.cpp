#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "needlework/error.h"
#include "src/io/formats/dynamo.h"
#include "src/io/formats/rod.h"
#include "src/io/formats/text_file.h"

namespace needlework::io {
namespace {

using Vector = std::array<double, 3>;

class DynamoWriter : public FrameWriter {
 public:
  DynamoWriter(const std::string& path, bool force, const Material& material)
      : path_(path),
        spheres_(are_spheres(material)),
        length_(spheres_ ? material.diameter[0] : material.length.at(0)),
        mass_(material.mass.at(0)),
        k_(material.k.at(0)),
        epsilon_(material.epsilon.at(0)),
        walls_(single_walls(material.walls)),
        gravity_(material.gravity),
        file_(path, force) {
    if (spheres_ || !has_width(material)) return;
    throw InputError(fmt::format(
        "{}: rods of finite width: expected thin needles or spheres, as DynamO knows no "
        "cylinders with caps",
        path));
  }

  void add(const Frame& frame) override {
    write_simulation(frame.state);
    file_.print("  <Properties/>\n  <ParticleData{}>\n", spheres_ ? "" : " OrientationData=\"Y\"");
    for (std::size_t i = 0; i < frame.state.size(); ++i) write_particle(frame.state, i);
    file_.print("  </ParticleData>\n</DynamOconfig>\n");
  }
  void publish() override { file_.publish(); }

 private:
  void write_simulation(const State& state);
  std::string species() const;
  std::string interaction() const;
  std::string boundary(const State& state, Vector& size) const;
  std::string locals(const Vector& box) const;
  std::string dynamics() const;
  void write_particle(const State& state, std::size_t i);
  void write_vector(const char* name, const Vector& v) {
    file_.print("      <{} x=\"{}\" y=\"{}\" z=\"{}\"/>\n", name, v[0], v[1], v[2]);
  }

  std::string path_;
  bool spheres_;
  double length_;  // of lines; of spheres their diameter
  double mass_;
  double k_;
  double epsilon_;
  std::vector<Scene::Wall> walls_;  // one by one
  Vector gravity_;
  TextFile file_;
};

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
  std::string text = "    <Locals>\n";
  for (const Scene::Wall& wall : walls_) {
    const auto axis = static_cast<std::size_t>(wall.axis[0] - 'x');
    const bool high = wall.side == "high";
    Vector normal{}, origin{};
    normal[axis] = high ? -1 : 1;
    origin[axis] = (high ? 0.5 : -0.5) * box[axis];
    if (wall.motion && wall.motion->amplitude > 0) {
      throw InputError(
          fmt::format("{}: the wall {}-{} moves: expected walls at rest, as in a "
                      "configuration of DynamO",
                      path_, wall.axis, wall.side));
    }
    const std::string temperature =
        wall.temperature ? fmt::format(" Temperature=\"{}\"", *wall.temperature) : "";
    text += fmt::format(R"(      <Local Type="Wall" Name="{}-{}" Elasticity="{}" Diameter="{}"{}>
        <IDRange Type="All"/>
        <Norm x="{}" y="{}" z="{}"/>
        <Origin x="{}" y="{}" z="{}"/>
      </Local>
)",
                        wall.axis, wall.side, wall.epsilon, length_, temperature, normal[0],
                        normal[1], normal[2], origin[0], origin[1], origin[2]);
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

std::string DynamoWriter::species() const {
  if (spheres_) return fmt::format(R"(Mass="{}" Name="Bulk" Type="Point")", mass_);
  // With more digits than a double has, so that k follows from it without an error.
  const long double length = length_;
  const long double inertia = length * length / (2 * static_cast<long double>(k_));
  return fmt::format(R"(InertiaConstant="{:.21g}" Mass="{}" Name="Bulk" Type="SphericalTop")",
                     inertia, mass_);
}

std::string DynamoWriter::interaction() const {
  return spheres_ ? fmt::format(R"(Type="HardSphere" Diameter="{}")", length_)
                  : fmt::format(R"(Type="Lines" Length="{}")", length_);
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
      <Species {}>
        <IDRange Type="All"/>
      </Species>
    </Genus>
    <BC Type="{}"/>
    <Topology/>
    <Interactions>
      <Interaction {} Elasticity="{}" Name="Bulk">
        <IDPairRange Type="All"/>
      </Interaction>
    </Interactions>
{}    <Globals/>
    <SystemEvents/>
{}  </Simulation>
)",
              size[0], size[1], size[2], species(), type, interaction(), epsilon_,
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
