// A file that is not the one to continue, or that somebody else writes, stays as it is.
#include <fmt/format.h>

#include <optional>

#include "tests/io/planned_run.h"
#include "tests/support/contains.h"

namespace needlework::io {
namespace {

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
  EXPECT_TRUE(test::contains(message(scene, run, beyond), "/series/"));
  beyond = checkpoint.position;
  beyond.events = 100;
  EXPECT_TRUE(
      test::contains(message(scene, run, beyond), "/events/arms: 35 rows: expected at least 100"));

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
  EXPECT_TRUE(test::contains(message(other, run, {}), "[5][3]: expected"));
  other = scene;
  other.output.events = false;
  EXPECT_EQ(message(other, run, {}),
            path + ": /events: expected nothing of this name in a file of this run");
  EXPECT_EQ(message(other, run, checkpoint.position),
            path + ": /events: missing: expected at least 28 rows");

  RunInfo observed = run;
  observed.series[0].name = "c";
  EXPECT_TRUE(test::contains(message(scene, observed, {}), "/series/c: missing: expected a group"));
  observed = run;
  observed.series[0].fields[0].shape[0].size = 4;
  EXPECT_TRUE(test::contains(message(scene, observed, {}),
                             "/series/a/x/value: shape [11][3]: expected [11][4]"));
  observed = run;
  observed.series[0].fields[0].kind = SeriesField::Kind::count;
  EXPECT_TRUE(test::contains(message(scene, observed, {}), "type float64: expected int64"));
  observed = run;
  observed.series[1].fields[0].values[1] = 3;
  EXPECT_TRUE(test::contains(message(scene, observed, {}), "/series/b/edges, value 1: 0.333"));
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
    EXPECT_TRUE(test::contains(message, path + ": " + reason));
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

}  // namespace
}  // namespace needlework::io
