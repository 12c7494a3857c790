// A file that is continued becomes the file of a run that was never stopped, wherever it was.
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <set>

#include "tests/io/planned_run.h"
#include "tests/support/contains.h"

namespace needlework::io {
namespace {

TEST_F(Continuing, AFileContinuesWhereItWasClosed_long) {
  for (const Plan& plan : {small, large}) {
    const std::string path = file("part.h5"), full = file("full.h5");
    std::filesystem::remove(full);
    write_all(full, plan);
    const Recorded expected = read_contents(full);
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

TEST_F(Continuing, RowsBeyondThePositionDoNotRemain_long) {
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

TEST_F(Continuing, AFileCanBeReadMeanwhile) {
  write_all(file("full.h5"), small);
  const Recorded full = read_contents(file("full.h5"));
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
  EXPECT_TRUE(test::contains(describe(file("a.h5")), "5 particles, 6 frames"));
  kill(child, SIGCONT);
  waitpid(child, &status, 0);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
  expect_same(full, read_contents(file("a.h5")));
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
