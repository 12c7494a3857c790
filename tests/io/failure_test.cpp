// Disks that are full and folders that may not be written.
#include <sys/resource.h>
#include <sys/stat.h>

#include <csignal>

#include "tests/io/disk.h"
#include "tests/io/support.h"

namespace needlework::io {
namespace {

using Failing = InFolder;

const RunInfo failing_run{"sse4", 1, 0.5};

TEST_F(Failing, UnwritableFolderIsNamed) {
  chmod(folder_.c_str(), 0555);
  const std::string path = file("a.h5");
  EXPECT_EQ(
      message_in_child(become_nobody, [&] { Writer(path, false, make_scene(1), failing_run); }),
      path + ": Permission denied");
  chmod(folder_.c_str(), 0755);
  EXPECT_TRUE(files().empty());
}

// Frames, series and events, flushed after each frame; "done" if all of that could be written.
std::string write_to_full_disk(const std::string& folder, const std::string& path, int first,
                               bool for_good) {
  return message_in_child(
      [&] {
        disk = {folder, first, for_good ? Disk::Event::full : Disk::Event::full_once};
      },
      [&] {
        Writer writer(path, false, make_scene(100, true), failing_run);
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

TEST_F(Failing, AnyWriteMayFindTheDiskFull_long) {
  for (const bool for_good : {true, false}) {
    int first = 0;
    int last_frame = -1;
    // The second time not each one, for time; the writes of one flush are alike.
    for (std::string message; message != "done"; first += for_good ? 1 : 7) {
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
    EXPECT_GE(last_frame, for_good ? 1 : 0);
    EXPECT_EQ(read_last_frame(file("full.h5")).image[0][0], 1);
    std::filesystem::remove(file("full.h5"));
  }
}

TEST_F(Failing, TheSizeOfFilesMayBeLimited) {
  constexpr rlim_t limit = 3'000'000;
  const std::string path = file("limited.h5");
  const auto prepare = [&] {
    std::signal(SIGXFSZ, SIG_IGN);
    const struct rlimit files { limit, limit };
    setrlimit(RLIMIT_FSIZE, &files);
  };
  const std::string message = message_in_child(prepare, [&] {
    Writer writer(path, false, make_scene(100, true), failing_run);
    for (int frame = 0;; ++frame) {
      writer.write_frame(make_totals(frame), make_state(100));
      writer.flush();
    }
  });
  EXPECT_EQ(message, path + ": File too large");
  EXPECT_LE(std::filesystem::file_size(path), limit);
  EXPECT_GT(recorded_size(path), limit - 200'000);
  expect_same(make_state(100), read_last_frame(path));
}

// Only then can kill -9 not leave half a change in the metadata.
TEST_F(Failing, SmallWritesNeverCrossAPage) {
  Writer writer(file("a.h5"), false, make_scene(700, true), failing_run);
  disk = {folder_.string()};
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
                                          Writer writer(path, false, make_scene(9), failing_run);
                                          writer.write_frame(make_totals(0), make_state(9));
                                          writer.flush();
                                          disk = {folder_.string(), 0, Disk::Event::full_once};
                                          writer.write_frame(make_totals(1), make_state(9));
                                          EXPECT_THROW(writer.flush(), IoError);
                                          writer.close();
                                        });
  EXPECT_EQ(message, path + ": an earlier write to this file failed");
  expect_same(make_state(9), read_last_frame(path));
}

}  // namespace
}  // namespace needlework::io
