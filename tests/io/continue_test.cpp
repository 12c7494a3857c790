// A file that is continued becomes the file of a run that was never stopped, wherever it was.
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <iterator>
#include <new>
#include <set>

#include "tests/io/contents.h"
#include "tests/io/disk.h"
#include "tests/io/support.h"

namespace needlework::io {
namespace {

// A run of steps, each of which writes so many rows.
struct Plan {
  std::size_t needles;
  int steps, samples, frames, events;  // the last three in each step
  int steps_per_checkpoint = 2;

  Scene scene() const { return make_scene(needles, true); }
  static RunInfo info() {
    using enum SeriesField::Kind;
    RunInfo run{"sse4", 1, 0.5};
    run.series = {{"a", "First", {{"x", "Three", "", {{"3", 3}}}, {"n", "A count", "", {}, count}}},
                  {"b", "Second", {{"edges", "Edges", "", {{"2", 2}}, constant, {0.25, 1 / 3.0}}}}};
    return run;
  }
};

// Some rows are in one chunk, which is continued in its middle.
constexpr Plan small{5, 6, 2, 1, 7};
// The same in fewer writes.
constexpr Plan brief{5, 3, 2, 1, 7};
// All datasets have several chunks, which lie in different parts of their indexes.
constexpr Plan large{300, 10, 150, 4, 5000, 3};

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

Collision make_collision(int event) {
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

State make_frame(std::size_t needles, int frame) {
  State state = make_state(needles, static_cast<unsigned>(frame % 5));
  for (auto& image : state.image) image = {frame, 1, 2};
  return state;
}

void write_sample(Writer& writer, int sample) {
  const double x = sample / 9.0;
  writer.write_series(make_totals(sample), std::array{x, -x, 2 * x, 1.0 * sample});
}

void write_step(Writer& writer, const Plan& plan, int step) {
  for (int i = 0; i < plan.events; ++i) writer.write_event(make_collision(step * plan.events + i));
  for (int i = 0; i < plan.samples; ++i) write_sample(writer, step * plan.samples + i);
  for (int i = 0; i < plan.frames; ++i) {
    const int frame = step * plan.frames + i;
    writer.write_frame(make_totals(1000 * frame), make_frame(plan.needles, frame));
  }
}

// Writes the steps up to `end`. As runs do, it flushes more often than it notes where it is.
void write_steps(Writer& writer, const Plan& plan, int end, Checkpoint& checkpoint) {
  for (int step = checkpoint.steps; step < end; ++step) {
    write_step(writer, plan, step);
    writer.flush();
    if ((step + 1) % plan.steps_per_checkpoint == 0) checkpoint = {step + 1, writer.position()};
  }
}

// What a run writes that ends before its time: one more sample and one more frame.
constexpr int odd = 77777;

void write_end(Writer& writer, const Plan& plan) {
  write_sample(writer, odd);
  writer.write_frame(make_totals(odd), make_frame(plan.needles, odd));
}

void write_all(const std::string& path, const Plan& plan) {
  Checkpoint checkpoint;
  Writer writer(path, false, plan.scene(), Plan::info());
  write_steps(writer, plan, plan.steps, checkpoint);
  writer.close();
}

Writer resume(const std::string& path, const Plan& plan, const Checkpoint& checkpoint) {
  return Writer::resume(path, plan.scene(), Plan::info(), checkpoint.position);
}

void resume_to_end(const std::string& path, const Plan& plan, Checkpoint& checkpoint) {
  Writer writer = resume(path, plan, checkpoint);
  write_steps(writer, plan, plan.steps, checkpoint);
  writer.close();
}

// Writes a file that ends too soon, `more` steps after the last checkpoint.
Checkpoint write_stopped(const std::string& path, const Plan& plan, int steps, int more) {
  Checkpoint checkpoint;
  Writer writer(path, true, plan.scene(), Plan::info());
  write_steps(writer, plan, steps, checkpoint);
  Checkpoint lost{steps, {}};
  write_steps(writer, plan, steps + more, lost);
  write_end(writer, plan);
  writer.close();
  return checkpoint;
}

// The complete rows of the file of an unfinished run are those of the full run. The last one may be
// that of the `stopped` run whose file is continued, if it is so in all datasets.
void expect_complete_rows(const Contents& found, const Contents& full, const Checkpoint& checkpoint,
                          const Contents* stopped = nullptr) {
  for (const auto& [path, content] : found) {
    const bool event = path.starts_with("/events/");
    const bool sample = path.starts_with("/series/");
    const std::string markers = event    ? "/events/time"
                                : sample ? "/series/step"
                                         : "/particles/needles/position/step";
    if (full.at(path).shape == content.shape && full.at(path).numbers == content.numbers) continue;
    if (full.at(path).shape.empty() || path == "/particles/needles/id") continue;
    const std::size_t rows = found.at(markers).shape[0];
    const std::uint64_t noted = event    ? checkpoint.position.events
                                : sample ? checkpoint.position.samples
                                         : checkpoint.position.frames;
    ASSERT_GE(rows, noted) << path;
    ASSERT_GE(content.shape[0], rows) << path;
    for (std::size_t row = 0; row < rows; ++row) {
      const bool of_stopped = stopped && row < stopped->at(markers).shape[0] &&
                              found.at(markers).row(row) == stopped->at(markers).row(row);
      const Contents& expected = of_stopped ? *stopped : full;
      ASSERT_EQ(content.row(row), expected.at(path).row(row)) << path << " row " << row;
    }
  }
}

// Runs `action` in a process that is killed in its write `at`; false if it ended before.
bool is_killed(const std::string& folder, int at, const std::function<void()>& action) {
  const std::string message = message_in_child(
      [&] {
        disk = {folder, at, Disk::Event::kill};
      },
      action);
  EXPECT_TRUE(message == "killed" || message == "no exception") << message;
  return message == "killed";
}

class Continuing : public InFolder {
 protected:
  std::string bytes(const std::string& path) const {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
};

TEST_F(Continuing, AFileContinuesWhereItWasClosed) {
  for (const Plan& plan : {small, large}) {
    const std::string path = file("part.h5"), full = file("full.h5");
    std::filesystem::remove(full);
    write_all(full, plan);
    const Contents expected = read_contents(full);
    for (const int steps : {0, 1, 3, plan.steps - 1, plan.steps}) {
      SCOPED_TRACE(steps);
      Checkpoint checkpoint;
      Writer writer(path, true, plan.scene(), Plan::info());
      write_steps(writer, plan, steps, checkpoint);
      checkpoint = {steps, writer.position()};
      EXPECT_EQ(checkpoint.position.samples, static_cast<std::uint64_t>(steps * plan.samples));
      EXPECT_EQ(checkpoint.position.frames, static_cast<std::uint64_t>(steps * plan.frames));
      EXPECT_EQ(checkpoint.position.events, static_cast<std::uint64_t>(steps * plan.events));
      writer.close();
      Writer again = resume(path, plan, checkpoint);
      EXPECT_EQ(again.position(), checkpoint.position);
      write_steps(again, plan, plan.steps, checkpoint);
      again.close();
      expect_same(expected, read_contents(path));
    }
  }
}

TEST_F(Continuing, RowsBeyondThePositionDoNotRemain) {
  for (const Plan& plan : {small, large}) {
    const std::string path = file("stopped.h5");
    for (const int more : {0, 1, 4}) {
      Checkpoint checkpoint = write_stopped(path, plan, 4, more);
      ASSERT_GT(checkpoint.position.events, 0u);
      // Continued no further than it was noted to be.
      resume(path, plan, checkpoint).close();
      std::filesystem::remove(file("short.h5"));
      Plan shorter = plan;
      shorter.steps = checkpoint.steps;
      write_all(file("short.h5"), shorter);
      expect_same(read_contents(file("short.h5")), read_contents(path));
      // Continued to its end, which leaves no trace of the removal.
      resume_to_end(path, plan, checkpoint);
      std::filesystem::remove(file("full.h5"));
      write_all(file("full.h5"), plan);
      expect_same(read_contents(file("full.h5")), read_contents(path));
    }
  }
}

TEST_F(Continuing, TheSpaceOfRemovedRowsIsUsedAgain) {
  const std::string path = file("a.h5");
  const Checkpoint checkpoint = write_stopped(path, large, 4, 3);
  std::set<std::uintmax_t> sizes;
  for (int round = 0; round < 5; ++round) {
    Checkpoint from = checkpoint;
    resume_to_end(path, large, from);
    sizes.insert(std::filesystem::file_size(path));
  }
  EXPECT_EQ(sizes.size(), 1u);
}

TEST_F(Continuing, AFileContinuesFromItsBeginning) {
  const std::string path = file("a.h5");
  write_stopped(path, small, 4, 0);
  Checkpoint beginning;
  resume_to_end(path, small, beginning);
  write_all(file("full.h5"), small);
  expect_same(read_contents(file("full.h5")), read_contents(path));
}

// A program is killed in each of its writes in turn, and so is the one that continues, in its own
// way. What they leave can be read, and the third program ends with the file of a whole run.
TEST_F(Continuing, AKillInAnyWriteLosesNothing) {
  const std::string path = file("killed.h5"), folder = folder_.string();
  for (const Plan& plan : {brief, large}) {
    std::filesystem::remove(file("full.h5"));
    write_all(file("full.h5"), plan);
    const Contents full = read_contents(file("full.h5"));
    int again_at = 0;
    int kills = 0;
    // Not each write of the large file, for time.
    const int stride = plan.needles == large.needles ? 61 : 1;
    for (int at = 0;; at += stride) {
      SCOPED_TRACE(testing::Message() << "killed in write " << at << ", then in " << again_at);
      std::filesystem::remove(path);
      const SharedCheckpoint checkpoint;
      if (!is_killed(folder, at, [&] {
            Writer writer(path, false, plan.scene(), Plan::info());
            write_steps(writer, plan, plan.steps, *checkpoint);
            writer.close();
          })) {
        break;
      }
      if (!std::filesystem::exists(path)) continue;  // it was not complete
      ++kills;
      expect_complete_rows(read_contents(path), full, *checkpoint);
      if (is_killed(folder, again_at, [&] { resume_to_end(path, plan, *checkpoint); })) {
        ++again_at;
        expect_complete_rows(read_contents(path), full, *checkpoint);
      } else {
        again_at = 0;
      }
      resume_to_end(path, plan, *checkpoint);
      expect_same(full, read_contents(path));
      if (HasFailure()) return;
    }
    EXPECT_GT(kills, 15);
  }
}

// The same for a file of which rows are removed, in each write in turn.
TEST_F(Continuing, AKillWhileRowsAreRemovedLosesNothing) {
  const std::string path = file("killed.h5"), folder = folder_.string();
  for (const Plan& plan : {small, large}) {
    std::filesystem::remove(file("full.h5"));
    write_all(file("full.h5"), plan);
    const Contents full = read_contents(file("full.h5"));
    const SharedCheckpoint checkpoint;
    *checkpoint = write_stopped(file("stopped.h5"), plan, 4, 3);
    const Checkpoint beginning = *checkpoint;
    const Contents stopped = read_contents(file("stopped.h5"));
    int kills = 0;
    for (int at = 0;; ++at) {
      SCOPED_TRACE(testing::Message() << "killed in write " << at);
      *checkpoint = beginning;
      std::filesystem::copy_file(file("stopped.h5"), path,
                                 std::filesystem::copy_options::overwrite_existing);
      if (!is_killed(folder, at, [&] { resume(path, plan, *checkpoint); })) break;
      ++kills;
      expect_complete_rows(read_contents(path), full, *checkpoint, &stopped);
      resume_to_end(path, plan, *checkpoint);
      expect_same(full, read_contents(path));
      if (HasFailure()) return;
    }
    EXPECT_GT(kills, 25);
  }
}

TEST_F(Continuing, AKillAtAnyMomentLosesNothing) {
  std::mt19937_64 random(11);
  write_all(file("full.h5"), large);
  const Contents full = read_contents(file("full.h5"));
  const std::string path = file("killed.h5");
  for (int round = 0; round < 8; ++round) {
    const SharedCheckpoint checkpoint;
    std::filesystem::remove(path);
    Writer(path, false, large.scene(), Plan::info()).close();
    for (int part = 0; part < 3; ++part) {
      const pid_t child = fork();
      if (child == 0) {
        prctl(PR_SET_PDEATHSIG, SIGKILL);
        resume_to_end(path, large, *checkpoint);
        _exit(0);
      }
      usleep(static_cast<useconds_t>(random() % 60000));
      kill(child, SIGKILL);
      waitpid(child, nullptr, 0);
      expect_complete_rows(read_contents(path), full, *checkpoint);
    }
    resume_to_end(path, large, *checkpoint);
    expect_same(full, read_contents(path));
  }
}

TEST_F(Continuing, AFullDiskLosesNothing) {
  const std::string path = file("a.h5"), folder = folder_.string();
  write_all(file("full.h5"), small);
  const Contents full = read_contents(file("full.h5"));
  const Checkpoint beginning = write_stopped(file("stopped.h5"), small, 3, 1);
  const Contents stopped = read_contents(file("stopped.h5"));
  const SharedCheckpoint checkpoint;
  for (const auto event : {Disk::Event::full, Disk::Event::full_once}) {
    for (int at = 0;; at += 11) {
      SCOPED_TRACE(at);
      *checkpoint = beginning;
      std::filesystem::copy_file(file("stopped.h5"), path,
                                 std::filesystem::copy_options::overwrite_existing);
      const std::string message = message_in_child(
          [&] {
            disk = {folder, at, event};
          },
          [&] { resume_to_end(path, small, *checkpoint); });
      if (message == "no exception") {
        EXPECT_GT(at, 100);
        break;
      }
      EXPECT_EQ(message, path + ": No space left on device");
      expect_complete_rows(read_contents(path), full, *checkpoint, &stopped);
      resume_to_end(path, small, *checkpoint);
      expect_same(full, read_contents(path));
      if (HasFailure()) return;
    }
  }
}

TEST_F(Continuing, SmallWritesNeverCrossAPage) {
  const Checkpoint checkpoint = write_stopped(file("a.h5"), large, 4, 3);
  disk = {folder_.string()};
  Checkpoint from = checkpoint;
  resume_to_end(file("a.h5"), large, from);
  EXPECT_GT(disk.writes, 500);
  EXPECT_EQ(disk.torn, 0);
  disk = {};
}

TEST_F(Continuing, AFileCanBeReadMeanwhile) {
  write_all(file("full.h5"), small);
  const Contents full = read_contents(file("full.h5"));
  Checkpoint checkpoint = write_stopped(file("a.h5"), small, 2, 1);
  // A reader that opened the file before does not stand in the way.
  const hdf5::Handle reader(H5Fopen(file("a.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose,
                            "a.h5");
  const pid_t child = fork();
  if (child == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    Writer writer = resume(file("a.h5"), small, checkpoint);
    write_steps(writer, small, small.steps, checkpoint);
    std::raise(SIGSTOP);
    writer.close();
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, WUNTRACED);
  ASSERT_TRUE(WIFSTOPPED(status)) << status;
  expect_complete_rows(read_contents(file("a.h5")), full, {small.steps, {6, 12, 42}});
  EXPECT_NE(describe(file("a.h5")).find("5 particles, 6 frames"), std::string::npos);
  kill(child, SIGCONT);
  waitpid(child, &status, 0);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
  expect_same(full, read_contents(file("a.h5")));
}

TEST_F(Continuing, NoticesAtTheEndThatTheFileHasBeenRemoved) {
  const std::string path = file("a.h5");
  Writer writer(path, false, small.scene(), Plan::info());
  std::filesystem::remove(path);
  EXPECT_EQ(message_of<IoError>([&] { writer.close(); }),
            path + ": the file has been removed, renamed or replaced while it was written");
}

TEST_F(Continuing, OneProgramWritesAtATime) {
  const std::string path = file("a.h5");
  const std::string refusal =
      path + ": another program or simulation has the file open for writing";
  const auto message = [&] { return message_of<IoError>([&] { resume(path, small, {}); }); };
  std::optional<Writer> writer;
  writer.emplace(path, false, small.scene(), Plan::info());
  EXPECT_EQ(message(), refusal);
  EXPECT_EQ(message_in_child([] {}, [&] { resume(path, small, {}); }), refusal);
  {
    const hdf5::Session quiet;
    EXPECT_LT(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), 0);
  }
  writer.reset();
  writer.emplace(resume(path, small, {}));
  EXPECT_EQ(message(), refusal);
  writer.reset();
  {
    const hdf5::Handle other(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose, path);
    EXPECT_EQ(message(), refusal);
  }
  resume(path, small, {}).close();
}

TEST_F(Continuing, WhatIsNotTheFileOfTheRunIsKept) {
  const std::string path = file("a.h5");
  const Checkpoint checkpoint = write_stopped(path, small, 4, 1);
  const std::string before = bytes(path);
  const auto message = [&](const Scene& scene, const RunInfo& run,
                           const Writer::Position& position) {
    return message_of<InputError>([&] { Writer::resume(path, scene, run, position); });
  };
  const Scene scene = small.scene();
  const RunInfo run = Plan::info();
  Writer::Position beyond = checkpoint.position;
  beyond.frames = 7;
  EXPECT_EQ(message(scene, run, beyond),
            path +
                ": /observables/collisions/step: 6 rows: expected at least 7, where the run is "
                "to be continued");
  beyond = checkpoint.position;
  beyond.samples = 100;
  EXPECT_NE(message(scene, run, beyond).find("/series/"), std::string::npos);
  beyond = checkpoint.position;
  beyond.events = 100;
  EXPECT_NE(message(scene, run, beyond).find("/events/arms: 35 rows: expected at least 100"),
            std::string::npos);

  Scene other = scene;
  other.text = "[needles]\ncount = 8\n";
  EXPECT_EQ(message(other, run, {}),
            path + ": /parameters/scene: line 2 = 'count = 7': expected 'count = 8'");
  other = scene;
  other.needles.seed = 5;
  EXPECT_EQ(message(other, run, {}), path + ": /parameters/seed: 18446744073709551615: expected 5");
  other = scene;
  other.collisions.epsilon = 0.9;
  EXPECT_EQ(message(other, run, {}), path + ": /parameters/epsilon: 0.8: expected 0.9");
  other = scene;
  other.needles.count = 6;
  EXPECT_NE(message(other, run, {}).find("[5][3]: expected"), std::string::npos);
  other = scene;
  other.output.events = false;
  EXPECT_EQ(message(other, run, {}),
            path + ": /events: expected nothing of this name in a file of this run");
  EXPECT_EQ(message(other, run, checkpoint.position),
            path + ": /events: missing: expected at least 28 rows");

  RunInfo observed = run;
  observed.series[0].name = "c";
  EXPECT_NE(message(scene, observed, {}).find("/series/c: missing: expected a group"),
            std::string::npos);
  observed = run;
  observed.series[0].fields[0].shape[0].size = 4;
  EXPECT_NE(message(scene, observed, {}).find("/series/a/x/value: shape [11][3]: expected [11][4]"),
            std::string::npos);
  observed = run;
  observed.series[0].fields[0].kind = SeriesField::Kind::count;
  EXPECT_NE(message(scene, observed, {}).find("type float64: expected int64"), std::string::npos);
  observed = run;
  observed.series[1].fields[0].values[1] = 3;
  EXPECT_NE(message(scene, observed, {}).find("/series/b/edges, value 1: 0.333"),
            std::string::npos);
  observed = run;
  observed.epoch_length = 0.75;
  EXPECT_EQ(message(scene, observed, {}), path + ": /parameters/epoch_length: 0.5: expected 0.75");
  EXPECT_EQ(bytes(path), before);

  // The machine and the number of threads may change.
  observed = run;
  observed.isa = "avx2";
  observed.threads = 8;
  Writer::resume(path, scene, observed, checkpoint.position).close();
  EXPECT_EQ(read_contents(path).at("/parameters/isa").texts.at(0), "sse4");
}

// To cut them off, HDF5 would take a step for each chunk, for hours.
TEST_F(Continuing, FilesWithMoreRowsThanTheyCanHoldAreKept) {
  const std::string path = file("a.h5");
  const Checkpoint checkpoint = write_stopped(path, small, 4, 1);
  {
    const hdf5::Handle opened(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose, path);
    const hdf5::Handle steps = hdf5::open_dataset(opened.get(), "/series/step", path);
    const hsize_t rows = 1ull << 40;
    hdf5::check(H5Dset_extent(steps.get(), &rows), path);
  }
  const std::string before = bytes(path);
  const std::string message = message_of<InputError>([&] { resume(path, small, checkpoint); });
  EXPECT_TRUE(message.find("/step: 1099511627776 numbers: expected fewer in a file of") !=
              message.npos)
      << message;
  EXPECT_EQ(bytes(path), before);
}

TEST_F(Continuing, OtherFilesAreKept) {
  const std::string path = file("a.h5");
  const auto expect_refused = [&](const std::string& reason) {
    const std::string before = std::filesystem::is_regular_file(path) ? bytes(path) : "";
    const std::string message = message_in_child(become_nobody, [&] { resume(path, small, {}); });
    EXPECT_NE(message.find(path + ": " + reason), std::string::npos) << message;
    EXPECT_EQ(std::filesystem::is_regular_file(path) ? bytes(path) : "", before);
  };
  std::filesystem::permissions(folder_, std::filesystem::perms::all);
  const auto allow = [&](int mode) {
    std::filesystem::permissions(path, static_cast<std::filesystem::perms>(mode));
  };

  expect_refused("No such file or directory");
  write_all(path, small);
  allow(0444);
  expect_refused("Permission denied");
  allow(0666);
  std::filesystem::resize_file(path, std::filesystem::file_size(path) - 5000);
  expect_refused("damaged or cut short");
  std::ofstream(path) << "no HDF5";
  expect_refused("not an HDF5 file");
  HandMade(path).put_needles("needles", 2);
  EXPECT_EQ(message_of<InputError>([&] { resume(path, small, {}); }),
            path +
                ": /events: missing: expected a group, as in files of this run that needlework "
                "has written");
  std::filesystem::remove(path);
  std::filesystem::create_directory(path);
  expect_refused("Is a directory");
}

TEST_F(Continuing, FramesKeepTheirIds) {
  Checkpoint checkpoint;
  {
    Writer writer(file("a.h5"), false, small.scene(), Plan::info());
    write_steps(writer, small, 2, checkpoint);
  }
  Writer writer = resume(file("a.h5"), small, checkpoint);
  State state = make_state(5);
  state.id = {1, 2, 3, 4, 5};
  EXPECT_THROW(writer.write_frame(make_totals(9000), state), std::invalid_argument);
  state.id.clear();
  writer.write_frame(make_totals(9000), state);
  writer.close();
  EXPECT_EQ(read_last_frame(file("a.h5")).id, make_state(5).id);

  RunInfo info = Plan::info();
  info.ids = make_state(5).id;
  Writer::resume(file("a.h5"), small.scene(), info, checkpoint.position).close();
  const std::string before = bytes(file("a.h5"));
  info.ids[3] = 255;
  EXPECT_EQ(message_of<InputError>(
                [&] { Writer::resume(file("a.h5"), small.scene(), info, checkpoint.position); }),
            fmt::format("{}: /particles/needles/id, value 3: {}: expected 255, as in the run that "
                        "is continued",
                        file("a.h5"), make_state(5).id[3]));
  EXPECT_EQ(bytes(file("a.h5")), before);
}

TEST_F(Continuing, SyncBringsFileAndNameToTheDisk) {
  disk = {folder_.string()};
  Writer writer(file("a.h5"), false, small.scene(), Plan::info());
  write_step(writer, small, 0);
  writer.flush();
  EXPECT_EQ(disk.operations.find_first_of("fd"), std::string::npos);
  write_step(writer, small, 1);
  disk.operations.clear();
  writer.sync();
  EXPECT_TRUE(disk.operations.starts_with("w") && disk.operations.ends_with("wfd"))
      << disk.operations;
  writer.sync();
  EXPECT_EQ(disk.operations.back(), 'f');
  disk.sync_fails = true;
  EXPECT_EQ(message_of<IoError>([&] { writer.sync(); }), file("a.h5") + ": Input/output error");
  EXPECT_THROW(writer.flush(), IoError);
  disk = {};
}

}  // namespace
}  // namespace needlework::io
