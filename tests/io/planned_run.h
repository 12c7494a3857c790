// A run that writes known rows step by step, is stopped anywhere, and continued.
#pragma once

#include <sys/mman.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>
#include <functional>
#include <new>
#include <string>
#include <utility>
#include <vector>

#include "tests/io/contents.h"
#include "tests/io/disk.h"
#include "tests/io/support.h"
#include "tests/support/whole_file.h"

namespace needlework::io {

// A run of steps, each of which writes so many rows.
struct Plan {
  std::size_t needles;
  int steps, samples, frames, events;  // the last three in each step
  int steps_per_checkpoint = 2;

  Scene scene() const { return make_scene(needles, true); }
  static RunInfo info() {
    using enum SeriesField::Kind;
    RunInfo run{"sse4", 1, 0.5};
    run.has_kinds = true;
    run.series = {{"a", "First", {{"x", "Three", "", {{"3", 3}}}, {"n", "A count", "", {}, count}}},
                  {"b", "Second", {{"edges", "Edges", "", {{"2", 2}}, constant, {0.25, 1 / 3.0}}}}};
    return run;
  }
};

// Some rows are in one chunk, which is continued in its middle.
inline constexpr Plan small{5, 6, 2, 1, 7};
// The same in fewer writes.
inline constexpr Plan brief{5, 3, 2, 1, 7};
// All datasets have several chunks, which lie in different parts of their indexes.
inline constexpr Plan large{300, 10, 150, 4, 5000, 3};

// Where a run was when it last flushed its file and said so.
struct Checkpoint {
  int steps = 0;
  Writer::Position position;
};

// Memory that a forked process shares with this one, and which survives its end.
class SharedCheckpoint {
 public:
  SharedCheckpoint()
      : memory_(mmap(nullptr, sizeof(Checkpoint), PROT_READ | PROT_WRITE,
                     MAP_SHARED | MAP_ANONYMOUS, -1, 0)),
        checkpoint_(new (memory_) Checkpoint) {}
  ~SharedCheckpoint() { munmap(memory_, sizeof(Checkpoint)); }
  SharedCheckpoint(const SharedCheckpoint&) = delete;
  SharedCheckpoint& operator=(const SharedCheckpoint&) = delete;

  Checkpoint& operator*() const { return *checkpoint_; }
  Checkpoint* operator->() const { return checkpoint_; }

 private:
  void* memory_;
  Checkpoint* checkpoint_;
};

inline Collision make_collision(int event) {
  Collision collision;
  collision.epoch = event / 3;
  collision.offset = event / 7.0;
  collision.time = event / 5.0;
  collision.first = static_cast<std::uint32_t>(event);
  collision.second = static_cast<std::uint32_t>(event + 1);
  collision.arm_first = event / 11.0;
  collision.normal_velocity = -event;
  collision.shift = {event, -1, 1};
  collision.impulse = {event / 13.0, 2, 3};
  return collision;
}

inline Happening make_happening(int event) {
  const bool hit = event % 3 == 2;
  return {hit ? Happening::wall : Happening::pair, hit, make_collision(event)};
}

inline State make_frame(std::size_t needles, int frame) {
  State state = make_state(needles, static_cast<unsigned>(frame % 5));
  for (auto& image : state.image) image = {frame, 1, 2};
  return state;
}

inline void write_sample(Writer& writer, int sample) {
  const double x = sample / 9.0;
  writer.write_series(make_totals(sample), std::array{x, -x, 2 * x, 1.0 * sample});
}

inline void write_step(Writer& writer, const Plan& plan, int step) {
  for (int i = 0; i < plan.events; ++i) writer.write_event(make_happening(step * plan.events + i));
  for (int i = 0; i < plan.samples; ++i) write_sample(writer, step * plan.samples + i);
  for (int i = 0; i < plan.frames; ++i) {
    const int frame = step * plan.frames + i;
    writer.write_frame(make_totals(1000 * frame), make_frame(plan.needles, frame));
  }
  for (int i = 0; i < plan.frames; ++i) {
    const int change = step * plan.frames + i;
    writer.write_velocities_set(make_totals(change), make_totals(change + 5000));
    const UserData data{UserData::Kind::bytes,
                        std::string(static_cast<std::size_t>(plan.events + change % 3), 'a')};
    writer.write_data(make_totals(change), "name " + std::to_string(change % 2),
                      change % 5 == 4 ? nullptr : &data);
  }
}

// Writes the steps up to `end`. As runs do, it flushes more often than it notes where it is.
inline void write_steps(Writer& writer, const Plan& plan, int end, Checkpoint& checkpoint) {
  for (int step = checkpoint.steps; step < end; ++step) {
    write_step(writer, plan, step);
    writer.flush();
    if ((step + 1) % plan.steps_per_checkpoint == 0) checkpoint = {step + 1, writer.position()};
  }
}

// What a run writes that ends before its time: one more sample and one more frame.
inline constexpr int odd = 77777;

inline void write_end(Writer& writer, const Plan& plan) {
  write_sample(writer, odd);
  writer.write_frame(make_totals(odd), make_frame(plan.needles, odd));
}

inline void write_all(const std::string& path, const Plan& plan) {
  Checkpoint checkpoint;
  Writer writer(path, false, plan.scene(), Plan::info());
  write_steps(writer, plan, plan.steps, checkpoint);
  writer.close();
}

inline Writer resume(const std::string& path, const Plan& plan, const Checkpoint& checkpoint) {
  return Writer::resume(path, plan.scene(), Plan::info(), checkpoint.position);
}

inline void resume_to_end(const std::string& path, const Plan& plan, Checkpoint& checkpoint) {
  Writer writer = resume(path, plan, checkpoint);
  write_steps(writer, plan, plan.steps, checkpoint);
  writer.close();
}

// Writes a file that ends too soon, `more` steps after the last checkpoint.
inline Checkpoint write_stopped(const std::string& path, const Plan& plan, int steps, int more) {
  Checkpoint checkpoint;
  Writer writer(path, true, plan.scene(), Plan::info());
  write_steps(writer, plan, steps, checkpoint);
  Checkpoint lost{steps, {}};
  write_steps(writer, plan, steps + more, lost);
  write_end(writer, plan);
  writer.close();
  return checkpoint;
}

// The dataset whose rows say how many of this one are complete, and how many were noted.
inline std::pair<std::string, std::uint64_t> markers_of(const std::string& path,
                                                        const Writer::Position& position) {
  if (path.starts_with("/events/")) return {"/events/time", position.events};
  if (path.starts_with("/series/")) return {"/series/step", position.samples};
  if (path.starts_with("/velocities_set/")) {
    return {"/velocities_set/step", position.velocities_set};
  }
  if (path.starts_with("/user_data/")) return {"/user_data/step", position.data};
  return {"/particles/needles/position/step", position.frames};
}

// The values of the entries that are complete, one after the other.
inline std::vector<double> complete_data(const Recorded& contents) {
  double end = 0;
  for (std::size_t n = 0; n < contents.at("/user_data/step").shape[0]; ++n) {
    end += std::max(contents.at("/user_data/size").numbers[n], 0.0);
  }
  const std::vector<double>& bytes = contents.at("/user_data/bytes").numbers;
  return {bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(end)};
}

// The complete rows of the file of an unfinished run are those of the full run. The last one may be
// that of the `stopped` run whose file is continued, if it is so in all datasets.
inline void expect_complete_rows(const Recorded& found, const Recorded& full,
                                 const Checkpoint& checkpoint, const Recorded* stopped = nullptr) {
  for (const auto& [path, content] : found) {
    const auto [markers, noted] = markers_of(path, checkpoint.position);
    if (full.at(path) == content) continue;
    if (path == "/user_data/bytes") {
      const std::vector<double> bytes = complete_data(found), expected = complete_data(full);
      // The stopped run may have had more.
      const auto size = static_cast<std::ptrdiff_t>(std::min(bytes.size(), expected.size()));
      ASSERT_TRUE(std::equal(bytes.begin(), bytes.begin() + size, expected.begin()));
      continue;
    }
    if (full.at(path).shape.empty() || path == "/particles/needles/id") continue;
    const std::size_t rows = found.at(markers).shape[0];
    ASSERT_GE(rows, noted) << path;
    ASSERT_GE(content.shape[0], rows) << path;
    for (std::size_t row = 0; row < rows; ++row) {
      const bool of_stopped = stopped && row < stopped->at(markers).shape[0] &&
                              found.at(markers).row(row) == stopped->at(markers).row(row);
      const Recorded& expected = of_stopped ? *stopped : full;
      ASSERT_EQ(content.row(row), expected.at(path).row(row)) << path << " row " << row;
      ASSERT_EQ(content.text(row), expected.at(path).text(row)) << path << " row " << row;
    }
  }
}

// Runs `action` in a process that is killed in its write `at`; false if it ended before.
inline bool is_killed(const std::string& folder, int at, const std::function<void()>& action) {
  const std::string message = message_in_child(
      [&] {
        disk = {folder, at, Disk::Event::kill};
      },
      action);
  EXPECT_TRUE(message == "killed" || message == "no exception") << message;
  return message == "killed";
}

struct Continuing : InFolder {
  static std::string bytes(const std::string& path) { return test::bytes_of(path); }
};

}  // namespace needlework::io
