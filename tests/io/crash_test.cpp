// A program that is killed loses nothing of what it had flushed.
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

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
