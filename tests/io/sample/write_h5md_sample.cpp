// Writes the files that tests/io/open_with_*.py read: `write_h5md_sample FOLDER [stop]`. All
// numbers are simple functions of frame, sample, event and needle, repeated in the scripts. With
// `stop`, the program stops itself while the last two files are open.
#include <csignal>
#include <cstdio>
#include <exception>
#include <string>

#include "needlework/h5md.h"

namespace {

using namespace needlework;

constexpr int needles = 5;
constexpr int frames = 7;
constexpr int samples = 3;
constexpr int events = 5000;

Scene make_scene(std::uint64_t count) {
  Scene scene;
  scene.title = "sample";
  scene.text = "[needles]\ncount = 5\n# é\n";
  scene.needles.count = count;
  scene.needles.k = 4.5;
  scene.needles.seed = 18446744073709551615u;
  scene.collisions.epsilon = 0.75;
  scene.collisions.beta = -0.5;
  scene.output.events = true;
  return scene;
}

Totals make_totals(int row) {
  Totals totals;
  totals.time = 0.5 * row;
  totals.t_tr = 1.0 / (1 + row);
  totals.t_rot = 2.0 / (1 + row);
  totals.energy = 3.0 / (1 + row);
  totals.momentum = {0.25 * row, -1.0 * row, 0};
  totals.collisions = static_cast<std::uint64_t>(100 * row);
  totals.tc_collisions = static_cast<std::uint64_t>(row);
  return totals;
}

State make_state(int count, int frame) {
  State state;
  state.box = {8, 9, 10};
  for (int i = 0; i < count; ++i) {
    const double x = i;
    state.position.push_back({0.5 * x, frame + 0.25, x / 8});
    state.velocity.push_back({-x, 0.5 * frame, 2 * x});
    state.orientation.push_back({0, i % 2 == 0 ? 1.0 : 0.0, i % 2 == 0 ? 0.0 : 1.0});
    state.angular_velocity.push_back({x + frame, 0, 0});
    state.image.push_back({i, -frame, 0});
    state.id.push_back(static_cast<std::uint32_t>(10 + i));
  }
  return state;
}

Collision make_collision(int event) {
  Collision collision;
  collision.epoch = event / 4;
  collision.offset = 0.125 * (event % 4);
  collision.time = 0.125 * event;
  collision.first = static_cast<std::uint32_t>(10 + event % 3);
  collision.second = static_cast<std::uint32_t>(13 + event % 2);
  collision.shift = {event % 3 - 1, 0, 1};
  collision.arm_first = 0.5 / (1 + event);
  collision.arm_second = -0.25;
  collision.normal_velocity = -1.0 * event;
  collision.impulse = {1.0 * event, 0.5, 0};
  collision.contact_time_rule = event % 5 == 0;
  return collision;
}

const io::RunInfo run{"avx2", 2, 0.5, "rigorous"};

// Writes all rows from those on that the file has.
void write_rows(io::Writer& writer) {
  const auto first = writer.position();
  for (int sample = static_cast<int>(first.samples); sample < samples; ++sample) {
    writer.write_series(make_totals(sample));
  }
  for (int frame = static_cast<int>(first.frames); frame < frames; ++frame) {
    writer.write_frame(make_totals(frame), make_state(needles, frame));
  }
  for (int event = static_cast<int>(first.events); event < events; ++event) {
    writer.write_event(make_collision(event));
  }
}

io::Writer write_all(const std::string& path) {
  io::Writer writer(path, false, make_scene(needles), run);
  write_rows(writer);
  return writer;
}

// The same file from a run that had gone another way after some rows.
io::Writer write_in_parts(const std::string& path) {
  io::Writer stopped = write_all(path);
  for (int row = 100; row < 105; ++row) {
    stopped.write_series(make_totals(row));
    stopped.write_frame(make_totals(row), make_state(needles, row));
  }
  stopped.close();
  io::Writer writer = io::Writer::resume(path, make_scene(needles), run, {4, 1, 3000});
  write_rows(writer);
  return writer;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2 && argc != 3) return 2;
  const std::string folder = std::string(argv[1]) + "/";
  try {
    write_all(folder + "sample.h5").close();

    io::Writer empty(folder + "empty.h5", false, make_scene(0), {"scalar", 1, 1});
    empty.write_frame(make_totals(0), make_state(0, 0));
    empty.close();
    io::Writer(folder + "header.h5", false, make_scene(needles), {"scalar", 1, 1}).close();

    // The last files are left behind by a program that was killed.
    io::Writer killed = write_all(folder + "killed.h5");
    killed.flush();
    io::Writer continued = write_in_parts(folder + "continued.h5");
    continued.flush();
    if (argc == 3) std::raise(SIGSTOP);
    std::raise(SIGKILL);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
  }
  return 1;
}
