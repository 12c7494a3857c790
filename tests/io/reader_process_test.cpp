// Reading in a child process: what it answers, and how it ends.
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <new>
#include <stdexcept>
#include <thread>

#include "src/io/in_child_process.h"
#include "src/machine/stop_request.h"
#include "tests/io/support.h"
#include "tests/support/contains.h"

namespace needlework::io {
namespace {

class ReadInChildProcess : public InFolder {
 protected:
  // What a child that does this is said to have done, without the name of the file.
  template <class Error, class Read>
  std::string end_of(Read read) {
    return message_of<Error>([&] { read_in_child_process("f.h5", read); });
  }
};

ReaderProcess::Service reading(std::function<void()> action) {
  return [action](std::string_view) { return action(), std::string(); };
}

TEST_F(ReadInChildProcess, ErrorsOfTheChildAreThoseOfItsCaller) {
  EXPECT_EQ(end_of<InputError>([]() -> int { throw InputError("bad"); }), "bad");
  EXPECT_EQ(end_of<IoError>([]() -> int { throw IoError("gone"); }), "gone");
  EXPECT_EQ(end_of<std::invalid_argument>([]() -> int { throw std::invalid_argument("no"); }),
            "no");
  EXPECT_EQ(read_in_child_process("f.h5", [] { return std::string("fine"); }), "fine");
}

TEST_F(ReadInChildProcess, ACrashIsAnError) {
  EXPECT_EQ(end_of<IoError>([]() -> int { return raise(SIGSEGV); }),
            "f.h5: damaged: HDF5 crashed while it read the file (signal 11, Segmentation fault)");
  EXPECT_EQ(end_of<IoError>([]() -> int { std::abort(); }),
            "f.h5: damaged: HDF5 crashed while it read the file (signal 6, Aborted)");
  EXPECT_EQ(end_of<IoError>([]() -> int { _exit(1); }),
            "f.h5: the process that read it ended before it was done");
}

// A child that would never answer, and nobody waits for.
TEST_F(ReadInChildProcess, IsStoppedWithItsChild) {
  pid_t child = 0;
  {
    ReaderProcess process("f.h5", {1u << 30, 600}, [] {
      return [asked = false](std::string_view) mutable {
        if (asked) pause();
        asked = true;
        return std::to_string(getpid());
      };
    });
    child = std::stoi(process.ask("who"));
    const StopRequest request([] { return "enough"; });
    EXPECT_THROW(process.ask("anything"), StoppedEarly);
  }
  EXPECT_NE(kill(child, 0), 0);
}

TEST_F(ReadInChildProcess, AfterACrashEveryRequestFails) {
  ReaderProcess process("f.h5", {1u << 30, 5}, [] { return reading([] { raise(SIGBUS); }); });
  for (int n = 0; n < 2; ++n) {
    EXPECT_TRUE(test::contains(message_of<IoError>([&] { process.ask("anything"); }), "signal 7"));
  }
}

TEST_F(ReadInChildProcess, AHangIsAnError) {
  ReaderProcess process("f.h5", {1u << 30, 0}, [] {
    return reading([] {
      std::atomic<int> n = 0;
      while (n < 1) n = 0;
    });
  });
  EXPECT_EQ(message_of<IoError>([&] { process.ask("anything"); }),
            "f.h5: damaged: reading it took more than 0 s");
}

TEST_F(ReadInChildProcess, TakingAllMemoryIsAnError) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the address sanitizer ends a process that has no memory left";
#endif
  ReaderProcess process("f.h5", {100 << 20, 60}, [] {
    return reading([] {
      std::vector<std::string> all;
      for (;;) all.emplace_back(10 << 20, 'x');
    });
  });
  EXPECT_EQ(message_of<InputError>([&] { process.ask("anything"); }),
            "f.h5: reading it takes more than 0.1 GB of memory: expected less, for its size and on "
            "this machine");
}

TEST_F(ReadInChildProcess, WithoutAChildTheSameIsRead) {
  const std::string path = make();
  const State by_child = read_last_frame(path);
  set_reads_in_child_process(false);
  EXPECT_FALSE(reads_in_child_process());
  expect_same(read_last_frame(path), by_child);
  set_reads_in_child_process(true);
  setenv("NEEDLEWORK_FORK", "0", 1);
  EXPECT_FALSE(reads_in_child_process());
  unsetenv("NEEDLEWORK_FORK");
  EXPECT_TRUE(reads_in_child_process());
}

// Programs that want to know nothing of their children, or wait for any of them.
TEST_F(ReadInChildProcess, TheProgramMayIgnoreItsChildren) {
  const std::string path = make();
  const auto before = signal(SIGCHLD, SIG_IGN);
  EXPECT_EQ(read_last_frame(path).size(), 2u);
  EXPECT_EQ(end_of<IoError>([]() -> int { std::abort(); }),
            "f.h5: the process that read it ended before it was done");
  signal(SIGCHLD, before);
}

TEST_F(ReadInChildProcess, NoProcessIsLeft) {
  const std::string path = make();
  read_last_frame(path);
  { const FrameFile file(path); }
  EXPECT_THROW(read_last_frame(file("none.h5")), IoError);
  EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1);
  EXPECT_EQ(errno, ECHILD);
}

// A child that held the lock of a file would keep its writer from opening it again.
TEST_F(ReadInChildProcess, ChildrenHoldNoLocksOfTheProgram) {
  const std::string path = make(), written = file("run.h5");
  Writer writer(written, true, make_scene(2), {});
  writer.write_frame(make_totals(0), make_state(2));
  writer.flush();
  const FrameFile open(path);
  const auto position = writer.position();
  writer.close();
  Writer::resume(written, make_scene(2), {}, position).close();
}

// The fork waits until no other thread uses HDF5, which the child could never use otherwise.
TEST_F(ReadInChildProcess, OtherThreadsMayUseHdf5) {
  const std::string path = make();
  std::atomic<bool> done = false;
  std::thread host([&] {
    while (!done) H5Fis_hdf5(path.c_str());
  });
  for (int n = 0; n < 100; ++n) EXPECT_EQ(read_last_frame(path).size(), 2u);
  done = true;
  host.join();
}

TEST_F(ReadInChildProcess, SeveralThreadsReadAtTheSameTime) {
  const std::string path = make();
  std::vector<std::thread> threads;
  std::atomic<int> read = 0;
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([&] {
      for (int n = 0; n < 20; ++n) read += read_last_frame(path).size() == 2;
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(read, 80);
}

}  // namespace
}  // namespace needlework::io
