// Disks that are full and folders that may not be written.
#include <dlfcn.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>

#include "tests/io/support.h"

namespace {

// A disk that is watched and may fill up: writes to files in `folder` fail from the one numbered
// `first` on, or only that one fails. Off while `folder` is empty.
struct Disk {
  std::string folder;
  int first = 0;
  bool for_good = true;
  int writes = 0;
  int torn = 0;  // writes over a page boundary that need not have been
};
Disk disk;

bool is_on_disk(int descriptor) {
  if (disk.folder.empty()) return false;
  char path[4096];
  const std::string link = "/proc/self/fd/" + std::to_string(descriptor);
  const ssize_t size = readlink(link.c_str(), path, sizeof path);
  return size >= 0 && std::string(path, static_cast<std::size_t>(size)).starts_with(disk.folder);
}

bool fails(int descriptor) {
  if (!is_on_disk(descriptor)) return false;
  const int number = disk.writes++;
  return disk.for_good ? number >= disk.first : number == disk.first;
}

template <class Function>
Function* system_function(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

}  // namespace

// The calls by which the library and HDF5 write to files, in place of the system's.
extern "C" ssize_t pwrite(int descriptor, const void* bytes, size_t count, off_t offset) {
  static const auto system = system_function<decltype(pwrite)>("pwrite");
  constexpr std::size_t page = 4096;
  if (count <= page && static_cast<std::size_t>(offset) % page + count > page) {
    disk.torn += is_on_disk(descriptor);
  }
  if (!fails(descriptor)) return system(descriptor, bytes, count, offset);
  errno = ENOSPC;
  return -1;
}

extern "C" ssize_t write(int descriptor, const void* bytes, size_t count) {
  static const auto system = system_function<decltype(write)>("write");
  if (!fails(descriptor)) return system(descriptor, bytes, count);
  errno = ENOSPC;
  return -1;
}

namespace needlework::io {
namespace {

using Failing = InFolder;

const RunInfo run{"sse4", 1, 0.5};

// Runs `action` in a process of its own, so that users and disks may change; returns its message.
std::string message_in_child(const std::function<void()>& prepare,
                             const std::function<void()>& action) {
  int ends[2];
  EXPECT_EQ(pipe(ends), 0);
  const pid_t child = fork();
  if (child == 0) {
    dup2(ends[1], STDERR_FILENO);  // HDF5 must stay silent
    prepare();
    std::string text = "no exception";
    try {
      action();
    } catch (const IoError& error) {
      text = error.what();
    } catch (const std::exception& error) {
      text = std::string("another exception: ") + error.what();
    }
    if (write(ends[1], text.data(), text.size()) < 0) _exit(2);
    // Another user's process may not be looked into, which LeakSanitizer does at the end.
    if (geteuid() != getuid() && seteuid(getuid()) == 0) prctl(PR_SET_DUMPABLE, 1);
    std::exit(0);  // HDF5 cleans up on exit and must survive that
  }
  close(ends[1]);
  std::string text;
  char buffer[4096];
  for (ssize_t n; (n = read(ends[0], buffer, sizeof buffer)) > 0;) {
    text.append(buffer, static_cast<std::size_t>(n));
  }
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
  return text;
}

TEST_F(Failing, UnwritableFolderIsNamed) {
  chmod(folder_.c_str(), 0555);
  const std::string path = file("a.h5");
  const auto become_nobody = [] {
    if (geteuid() == 0 && seteuid(65534) != 0) _exit(3);
  };
  EXPECT_EQ(message_in_child(become_nobody, [&] { Writer(path, false, make_scene(1), run); }),
            path + ": Permission denied");
  chmod(folder_.c_str(), 0755);
  EXPECT_TRUE(files().empty());
}

// Frames, series and events, flushed after each frame; "done" if all of that could be written.
std::string write_to_full_disk(const std::string& folder, const std::string& path, int first,
                               bool for_good) {
  return message_in_child(
      [&] {
        disk = {folder, first, for_good};
      },
      [&] {
        Writer writer(path, false, make_scene(100, true), run);
        for (int frame = 0; frame < 2; ++frame) {
          State state = make_state(100);
          for (auto& image : state.image) image = {frame, 0, 0};
          writer.write_frame(make_totals(frame), state);
          writer.write_series(make_totals(frame));
          for (int i = 0; i < 10; ++i) writer.write_event(Collision());
          writer.flush();
        }
        writer.close();
        throw IoError("done");
      });
}

TEST_F(Failing, AnyWriteMayFindTheDiskFull) {
  for (const bool for_good : {true, false}) {
    int first = 0;
    int last_frame = -1;
    // Not each one, for time; the writes of one flush are alike.
    for (std::string message; message != "done"; first += for_good ? 3 : 7) {
      ASSERT_LT(first, 2000);
      SCOPED_TRACE(testing::Message()
                   << "write " << first << (for_good ? " and all after it" : ""));
      const std::string path = file("full.h5");
      message = write_to_full_disk(folder_.string(), path, first, for_good);
      if (message == "done") break;
      EXPECT_EQ(message, path + ": No space left on device");
      if (files().empty()) continue;
      ASSERT_EQ(files(), std::vector<std::string>{"full.h5"});
      // What was flushed before is there.
      if (describe(path).find(" 0 frames") != std::string::npos) {
        EXPECT_EQ(last_frame, -1);
      } else {
        const State state = read_last_frame(path);
        EXPECT_EQ(state.size(), 100u);
        EXPECT_GE(state.image[0][0], last_frame);
        last_frame = state.image[0][0];
      }
      std::filesystem::remove(path);
    }
    EXPECT_GT(first, 20);
    EXPECT_EQ(last_frame, 1);
    EXPECT_EQ(read_last_frame(file("full.h5")).image[0][0], 1);
    std::filesystem::remove(file("full.h5"));
  }
}

// Only then can kill -9 not leave half a change in the metadata.
TEST_F(Failing, SmallWritesNeverCrossAPage) {
  Writer writer(file("a.h5"), false, make_scene(700, true), run);
  disk = {folder_.string(), -1, false};
  const State state = make_state(700);
  for (int frame = 0; frame < 700; ++frame) {
    writer.write_frame(make_totals(frame), state);
    writer.write_series(make_totals(frame));
    writer.write_event(Collision());
    if (frame % 7 == 0) writer.flush();
  }
  for (int i = 0; i < 700000; ++i) writer.write_event(Collision());
  writer.close();
  EXPECT_GT(disk.writes, 5000);
  EXPECT_EQ(disk.torn, 0);
  disk = {};
}

TEST_F(Failing, AFailedWriterStaysFailed) {
  const std::string path = file("a.h5");
  const auto message = message_in_child([] {},
                                        [&] {
                                          Writer writer(path, false, make_scene(9), run);
                                          writer.write_frame(make_totals(0), make_state(9));
                                          writer.flush();
                                          disk = {folder_.string(), 0, false};
                                          writer.write_frame(make_totals(1), make_state(9));
                                          EXPECT_THROW(writer.flush(), IoError);
                                          writer.close();
                                        });
  EXPECT_EQ(message, path + ": an earlier write to this file failed");
  expect_same(make_state(9), read_last_frame(path));
}

}  // namespace
}  // namespace needlework::io
