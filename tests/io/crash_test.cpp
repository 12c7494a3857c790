// A program that is killed loses nothing of what it had flushed.
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <random>
#include <thread>

#include "tests/io/support.h"
#include "tests/support/contains.h"

namespace needlework::io {
namespace {

using Crash = InFolder;

const RunInfo run{"scalar", 1, 1.0};

// A state whose numbers show to which frame it belongs.
State make_frame(std::size_t needles, int frame) {
  State state = make_state(needles);
  for (auto& velocity : state.velocity) velocity = {1.0 * frame, 2.0 * frame, 3.0 * frame};
  for (auto& image : state.image) image = {frame, frame, frame};
  for (auto& position : state.position) position[2] = frame;
  return state;
}

TEST_F(Crash, FlushedFramesSurviveKill) {
  const std::string path = file("killed.h5");
  const pid_t child = fork();
  if (child == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    Writer writer(path, false, make_scene(100, true), run);
    for (int frame = 0; frame < 5; ++frame) {
      writer.write_frame(make_totals(frame), make_frame(100, frame));
      writer.write_series(make_totals(frame));
      writer.write_event(Collision());
    }
    writer.flush();
    for (int frame = 5; frame < 50; ++frame) {
      writer.write_frame(make_totals(frame), make_frame(100, frame));
      writer.write_event(Collision());
    }
    std::raise(SIGKILL);
  }
  int status = 0;
  waitpid(child, &status, 0);
  ASSERT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL);
  expect_same(make_frame(100, 4), read_last_frame(path));
  const std::string text = describe(path);
  EXPECT_TRUE(test::contains(text, "100 particles, 5 frames"));
}

// The last frame that the child process reported as flushed before it was killed.
struct Flushed {
  int frame = -1;
};

// Starts a child process that writes frames, with `events` collisions before each, and kills it
// after `delay`.
Flushed write_until_killed(const std::string& path, std::size_t needles, int events,
                           std::chrono::microseconds delay) {
  int ends[2];
  EXPECT_EQ(pipe(ends), 0);
  const pid_t child = fork();
  if (child == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    Writer writer(path, true, make_scene(needles, true), run);
    for (int frame = 0;; ++frame) {
      for (int i = 0; i < events; ++i) writer.write_event(Collision());
      writer.write_frame(make_totals(frame), make_frame(needles, frame));
      writer.write_series(make_totals(frame));
      writer.flush();
      if (write(ends[1], &frame, sizeof frame) != sizeof frame) _exit(1);
    }
  }
  close(ends[1]);
  Flushed flushed;
  EXPECT_EQ(read(ends[0], &flushed.frame, sizeof flushed.frame), ssize_t{sizeof flushed.frame});
  // The pipe is read continuously, so that the child never waits for it.
  std::jthread reader([&] {
    for (int frame; read(ends[0], &frame, sizeof frame) == sizeof frame;) flushed.frame = frame;
  });
  std::this_thread::sleep_for(delay);
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  reader.join();
  close(ends[0]);
  return flushed;
}

TEST_F(Crash, KillAtAnyMomentLeavesTheFlushedFrames_long) {
  std::mt19937_64 random(7);
  for (int round = 0; round < 40; ++round) {
    const std::size_t needles = std::array{1u, 30u, 3000u}[round % 3];
    const int events = round % 2 == 0 ? 10 : 9000;
    const std::chrono::microseconds delay(random() % 60000);
    SCOPED_TRACE(testing::Message() << "round " << round << ", " << delay.count() << " us");
    const Flushed flushed = write_until_killed(file("killed.h5"), needles, events, delay);
    const State state = read_last_frame(file("killed.h5"));
    const int frame = state.image.at(0)[0];
    EXPECT_GE(frame, flushed.frame);
    expect_same(make_frame(needles, frame), state);
    // All that is in the file can be read, by any program.
    EXPECT_FALSE(describe(file("killed.h5")).empty());
    EXPECT_EQ(read_numbers(file("killed.h5"), "/particles/needles/id").size(), needles);
    EXPECT_GT(read_numbers(file("killed.h5"), "/series/energy/step").size(), flushed.frame);
    const auto rows =
        static_cast<std::size_t>(flushed.frame + 1) * static_cast<std::size_t>(events);
    EXPECT_GE(read_numbers(file("killed.h5"), "/events/time").size(), rows);
    for (const char* name : {"pair", "arms", "impulse", "shift", "tc", "epoch", "offset"}) {
      EXPECT_GE(read_numbers(file("killed.h5"), std::string("/events/") + name).size(), rows);
    }
  }
}

TEST_F(Crash, AFileCanBeReadWhileAnotherProgramWritesIt) {
  int written[2], read_back[2];
  ASSERT_EQ(pipe(written), 0);
  ASSERT_EQ(pipe(read_back), 0);
  const pid_t child = fork();
  char token = 0;
  if (child == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    Writer writer(file("live.h5"), false, make_scene(50), run);
    for (int frame = 0; frame < 20; ++frame) {
      writer.write_frame(make_totals(frame), make_frame(50, frame));
      writer.flush();
      if (write(written[1], &token, 1) != 1 || read(read_back[0], &token, 1) != 1) _exit(1);
    }
    writer.close();
    _exit(0);
  }
  for (int frame = 0; frame < 20; ++frame) {
    ASSERT_EQ(read(written[0], &token, 1), 1);
    expect_same(make_frame(50, frame), read_last_frame(file("live.h5")));
    ASSERT_EQ(write(read_back[1], &token, 1), 1);
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
}

TEST_F(Crash, AFileCanBeReadWhileThisProgramWritesIt) {
  Writer writer(file("live.h5"), false, make_scene(50), run);
  for (int frame = 0; frame < 20; ++frame) {
    writer.write_frame(make_totals(frame), make_frame(50, frame));
    writer.flush();
    expect_same(make_frame(50, frame), read_last_frame(file("live.h5")));
  }
  writer.close();
  expect_same(make_frame(50, 19), read_last_frame(file("live.h5")));
}

}  // namespace
}  // namespace needlework::io
