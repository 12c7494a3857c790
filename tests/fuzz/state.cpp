// Fuzz target: an HDF5 file with any content is a state that can be run, or an error.
#include <array>
#include <cmath>

#include "needlework/h5md.h"
#include "needlework/parse.h"
#include "needlework/simulation.h"
#include "src/io/formats/material.h"
#include "src/runs/loaded_scene.h"
#include "tests/fuzz/edited_hdf5.h"
#include "tests/fuzz/target.h"
#include "tests/io/support.h"

using namespace needlework;

namespace {

// Plain datasets; elements with frames; what Needlework itself writes.
std::array<fuzz::BaseFile, 3> make_bases() {
  const std::string plain = fuzz::folder() / "plain.h5", elements = fuzz::folder() / "elements.h5",
                    own = fuzz::folder() / "own.h5";
  {
    io::HandMade file(plain);
    file.put_needles("all", 1);
    file.put("/particles/all/box/edges", {3}, {10, 11, 12});
    file.put("/particles/all/id", {2}, {4, 1});
    file.put("/particles/all/image", {2, 3}, {0, 1, 2, -1, 5, 9});
  }
  {
    io::HandMade file(elements);
    file.put_needles("needles", 3);
    for (const char* name : {"position", "velocity", "orientation", "angular_velocity"}) {
      file.put(std::string("/particles/needles/") + name + "/step", {3}, {0, 10, 20});
      file.put(std::string("/particles/needles/") + name + "/time", {3}, {0, 0.5, 1});
    }
    file.put("/particles/needles/box/edges", {3, 3}, {10, 0, 0, 0, 11, 0, 0, 0, 12});
  }
  {
    io::Writer writer(own, true, io::make_scene(2), {});
    State state = io::make_state(2);
    state.position = {{1, 2, 3}, {4, 5, 6}};
    state.velocity = {{1, 0, 0}, {0, 1, 0}};
    writer.write_frame(io::make_totals(0), state);
    writer.write_frame(io::make_totals(1), state);
    writer.close();
  }
  return {fuzz::BaseFile(plain), fuzz::BaseFile(elements), fuzz::BaseFile(own)};
}

void run_a_little(const std::string& path) {
  Scene scene = parse_scene("initial.file = \"" + path + "\"\nuntil.time = 1\n", "scene");
  runs::LoadedScene loaded = runs::complete_scene(std::move(scene));
  if (loaded.initial->size() > 100) return;
  try {
    Simulation simulation(loaded.scene, *loaded.initial);
    Scene::Until until;
    until.collisions_per_needle = 5;
    until.wall_s = 0.1;
    simulation.advance(until);
    fuzz::require(std::isfinite(simulation.totals().energy));
  } catch (const InvalidStateError&) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  static const std::array<fuzz::BaseFile, 3> bases = make_bases();
  io::set_reads_in_child_process(false);
  FuzzedDataProvider data(bytes, size);
  const std::string path = fuzz::folder() / "input.h5";
  bases[data.ConsumeIntegralInRange<std::size_t>(0, 2)].edit(path, data);
  fuzz::allow_bad_input([&] {
    const io::FrameFile file(path);
    for (std::size_t frame = 0; frame < std::min<std::size_t>(file.count(), 4); ++frame) {
      const State state = file.read(frame);
      fuzz::require(state.size() == file.needles() && state.velocity.size() == state.size());
      if (const auto time = file.time(frame)) (void)std::isfinite(*time);
    }
  });
  fuzz::allow_bad_input([&] { io::read_material(path); });
  fuzz::allow_bad_input([&] { run_a_little(path); });
  return 0;
}
