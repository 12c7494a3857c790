// The files of the library in a process whose standard streams are closed.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <functional>
#include <thread>
#include <vector>

#include "needlework/h5md.h"
#include "src/machine/descriptors.h"
#include "src/runs/load_checkpoint.h"
#include "src/runs/prepared_run.h"
#include "tests/runs/silent.h"
#include "tests/support/runs.h"
#include "tests/support/temporary_folder.h"

namespace needlework::runs {
namespace {

bool all_are_closed() {
  for (int descriptor = 0; descriptor < 3; ++descriptor) {
    if (fcntl(descriptor, F_GETFD) >= 0) return false;
  }
  return true;
}

// Runs `action` in a child without standard streams, and returns what it does.
int in_child_without_streams(const std::function<int()>& action) {
  const pid_t child = fork();
  if (child == 0) {
    for (int descriptor = 0; descriptor < 3; ++descriptor) close(descriptor);
    _exit(action());
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(StandardDescriptors, AreNotThoseOfFilesOfARun) {
  const test::TemporaryFolder folder;
  Scene scene = test::scene_of(60, 5);
  scene.output.file = folder.path() / "run.h5";
  scene.engine.threads = 1;
  const int result = in_child_without_streams([&] {
    Silent monitor;
    {
      PreparedRun run(complete_scene(scene), false);
      if (!all_are_closed()) return 1;
      run.advance(from_now({.collisions = 20}, run.simulation()), monitor);
      if (write(STDERR_FILENO, "x", 1) >= 0) return 2;
      run.save_checkpoint();
      run.close();
    }
    if (!all_are_closed()) return 3;
    if (io::read_run(scene.output.file).series.empty()) return 4;
    PreparedRun again(load_checkpoint(scene.output.file).checkpoint);
    again.close();
    return all_are_closed() ? 0 : 5;
  });
  EXPECT_EQ(result, 0);
  EXPECT_FALSE(io::read_run(scene.output.file).series.empty());
}

TEST(StandardDescriptors, AreOccupiedWhileAnyThreadOpensFiles) {
  const int result = in_child_without_streams([] {
    std::vector<std::thread> threads;
    std::atomic<int> low = 0;
    for (int n = 0; n < 4; ++n) {
      threads.emplace_back([&] {
        for (int times = 0; times < 500; ++times) {
          const int descriptor = open_descriptor("/", O_RDONLY);
          low += descriptor < 3;
          close(descriptor);
        }
      });
    }
    for (std::thread& thread : threads) thread.join();
    return low > 0 ? 1 : all_are_closed() ? 0 : 2;
  });
  EXPECT_EQ(result, 0);
}

}  // namespace
}  // namespace needlework::runs
