#include <fmt/format.h>

#include <array>

#include "src/io/formats/dynamo.h"
#include "src/io/formats/rod.h"
#include "src/io/formats/text_file.h"

namespace needlework::io {
namespace {

using Vector = std::array<double, 3>;

class DynamoWriter : public FrameWriter {
 public:
  DynamoWriter(const std::string& path, bool force, const Material& material)
      : length_(material.length.at(0)),
        mass_(material.mass.at(0)),
        k_(material.k.at(0)),
        epsilon_(material.epsilon.at(0)),
        file_(path, force) {}

  void add(const Frame& frame) override {
    write_simulation(frame.state.box);
    file_.print("  <Properties/>\n  <ParticleData OrientationData=\"Y\">\n");
    for (std::size_t i = 0; i < frame.state.size(); ++i) write_particle(frame.state, i);
    file_.print("  </ParticleData>\n</DynamOconfig>\n");
  }
  void publish() override { file_.publish(); }

 private:
  void write_simulation(const Vector& box);
  void write_particle(const State& state, std::size_t i);
  void write_vector(const char* name, const Vector& v) {
    file_.print("      <{} x=\"{}\" y=\"{}\" z=\"{}\"/>\n", name, v[0], v[1], v[2]);
  }

  double length_;
  double mass_;
  double k_;
  double epsilon_;
  TextFile file_;
};

void DynamoWriter::write_simulation(const Vector& box) {
  // With more digits than a double has, so that k follows from it without an error.
  const long double length = length_;
  const long double inertia = length * length / (2 * static_cast<long double>(k_));
  file_.print(R"(<?xml version="1.0"?>
<DynamOconfig version="1.5.0">
  <Simulation>
    <Scheduler Type="NeighbourList">
      <Sorter Type="BoundedPQMinMax3"/>
    </Scheduler>
    <SimulationSize x="{}" y="{}" z="{}"/>
    <Genus>
      <Species InertiaConstant="{:.21g}" Mass="{}" Name="Bulk" Type="SphericalTop">
        <IDRange Type="All"/>
      </Species>
    </Genus>
    <BC Type="PBC"/>
    <Topology/>
    <Interactions>
      <Interaction Type="Lines" Length="{}" Elasticity="{}" Name="Bulk">
        <IDPairRange Type="All"/>
      </Interaction>
    </Interactions>
    <Locals/>
    <Globals/>
    <SystemEvents/>
    <Dynamics Type="Newtonian"/>
  </Simulation>
)",
              box[0], box[1], box[2], inertia, mass_, length_, epsilon_);
}

void DynamoWriter::write_particle(const State& state, std::size_t i) {
  const Vector& u = state.orientation[i];
  const auto [w, x, y, z] = quaternion_of(u);
  file_.print("    <Pt ID=\"{}\">\n", i);
  write_vector("P", state.position[i]);
  write_vector("V", state.velocity[i]);
  write_vector("O", state.angular_velocity[i]);
  file_.print("      <U x=\"{}\" y=\"{}\" z=\"{}\" w=\"{}\"/>\n", x, y, z, w);
  write_vector("Director", u);
  file_.print("    </Pt>\n");
}

}  // namespace

std::unique_ptr<FrameWriter> write_dynamo(const std::string& path, bool force,
                                          const Material& material) {
  return std::make_unique<DynamoWriter>(path, force, material);
}

}  // namespace needlework::io
