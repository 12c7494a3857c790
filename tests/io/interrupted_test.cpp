// A run that is killed, or whose disk is full, in any of its writes loses nothing, and continues.
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

#include "tests/io/planned_run.h"

namespace needlework::io {
namespace {

// A program is killed in each of its writes in turn, and so is the one that continues, in its own
// way. What they leave can be read, and the third program ends with the file of a whole run.
TEST_F(Continuing, AKillInAnyWriteLosesNothing_long) {
  const std::string path = file("killed.h5"), folder = folder_.string();
  for (const Plan& plan : {brief, large}) {
    std::filesystem::remove(file("full.h5"));
    write_all(file("full.h5"), plan);
    const Recorded full = read_contents(file("full.h5"));
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
TEST_F(Continuing, AKillWhileRowsAreRemovedLosesNothing_long) {
  const std::string path = file("killed.h5"), folder = folder_.string();
  for (const Plan& plan : {small, large}) {
    std::filesystem::remove(file("full.h5"));
    write_all(file("full.h5"), plan);
    const Recorded full = read_contents(file("full.h5"));
    const SharedCheckpoint checkpoint;
    *checkpoint = write_stopped(file("stopped.h5"), plan, 4, 3);
    const Checkpoint beginning = *checkpoint;
    const Recorded stopped = read_contents(file("stopped.h5"));
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
  const Recorded full = read_contents(file("full.h5"));
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
      EXPECT_FALSE(describe(path).empty());
      if (checkpoint->position.frames == 0) continue;
      const int last = read_last_frame(path).image.at(0)[0];
      EXPECT_GE(last + 1, static_cast<int>(checkpoint->position.frames));
    }
    resume_to_end(path, large, *checkpoint);
    expect_same(full, read_contents(path));
  }
}

TEST_F(Continuing, AFullDiskLosesNothing) {
  const std::string path = file("a.h5"), folder = folder_.string();
  write_all(file("full.h5"), small);
  const Recorded full = read_contents(file("full.h5"));
  const Checkpoint beginning = write_stopped(file("stopped.h5"), small, 3, 1);
  const Recorded stopped = read_contents(file("stopped.h5"));
  const SharedCheckpoint checkpoint;
  for (const auto event : {Disk::Event::full, Disk::Event::full_once}) {
    for (int at = 0;; at += 67) {
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

}  // namespace
}  // namespace needlework::io
