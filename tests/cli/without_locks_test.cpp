// File systems without locks, as some of NFS, Lustre and DVS are: everything works there, with a
// warning.
#include <fmt/format.h>

#include <cerrno>
#include <string>

#include "tests/cli/program.h"

namespace needlework {
namespace {

constexpr int enotsupp = 524;  // of the kernel, which some file systems let out

class WithoutLocks : public ProgramTest {
 protected:
  WithoutLocks() {
    write("gas.toml", R"(
needles = { count = 300, box = 7 }
until = { collisions_per_needle = 20 }
)");
  }
  void SetUp() override {
    if (std::string(NEEDLEWORK_NO_LOCKS).empty()) GTEST_SKIP() << "sanitizers come first";
  }

  static std::string preloaded(int error) {
    return fmt::format("NO_LOCKS={} LD_PRELOAD='{}'", error, NEEDLEWORK_NO_LOCKS);
  }
};

TEST_F(WithoutLocks, EverythingWorksWithOneWarning) {
  const std::string whole = hash_of("run gas.toml");
  for (const int error : {ENOLCK, ENOSYS, EOPNOTSUPP, enotsupp}) {
    const std::string before = preloaded(error);
    const Outcome half =
        run("run gas.toml --quiet --force --out a.h5 --set until.collisions_per_needle=9", before);
    EXPECT_TRUE(half.fails(0, "warning: a.h5: the file system has no locks (")) << error;
    EXPECT_TRUE(half.complains("a second program that writes to it cannot be noticed")) << error;
    EXPECT_EQ(hash_of("resume a.h5 --set until.collisions_per_needle=20", before), whole) << error;
    if (error != EOPNOTSUPP) continue;
    for (const std::string arguments :
         {"info a.h5", "report a.h5 -o a.html --force", "export a.h5 a.vtkhdf --force",
          "run gas.toml --quiet --set initial.file=a.h5"}) {
      const Outcome outcome = run(arguments, before);
      EXPECT_EQ(outcome.exit_code, 0) << error << arguments;
      EXPECT_EQ(outcome.err, "") << error << arguments;
    }
  }
}

TEST_F(WithoutLocks, StoppedRunsAndSweepsGoOn_long) {
  const std::string before = preloaded(EOPNOTSUPP);
  const std::string more =
      " --set needles.count=2000 --set needles.box=13 "
      "--set engine.search=linked-lists";
  const Outcome stopped = run_and_signal("run gas.toml --quiet --out a.h5" + more,
                                         "test -e a.h5.checkpoint", "TERM", before);
  ASSERT_EQ(stopped.exit_code, 75) << stopped.err;
  EXPECT_EQ(hash_of("resume a.h5", before), hash_of("run gas.toml" + more));

  write("grid.toml", "scene = 'small.toml'\nseeds = [1, 2]\n");
  for (const char* missing : {"2", "0"}) {
    const Outcome sweep = run("sweep grid.toml --out sweep --json --quiet", before);
    EXPECT_TRUE(sweep.fails(0, "warning: sweep: the file system has no locks (Operation not"));
    EXPECT_EQ(sweep.json()["computed"].dump(), missing);
  }
}

TEST_F(WithoutLocks, DamagedFilesAreStillCalledSo) {
  ASSERT_EQ(run("run gas.toml --quiet --out a.h5").exit_code, 0);
  ASSERT_EQ(shell("truncate -s 5000 a.h5").exit_code, 0);
  EXPECT_TRUE(run("info a.h5", preloaded(ENOLCK)).complains("a.h5: damaged or cut short: HDF5: "));
}

TEST_F(WithoutLocks, TheVariableOfHdf5IsRespected) {
  const std::string off = "HDF5_USE_FILE_LOCKING=FALSE";
  EXPECT_TRUE(run("run gas.toml --quiet --out a.h5", off)
                  .complains("warning: a.h5: HDF5_USE_FILE_LOCKING=FALSE, so that a second "));
  EXPECT_EQ(run("info a.h5", off).err, "");
  EXPECT_EQ(run("info a.h5", off + " " + preloaded(ENOLCK)).err, "");
  for (const std::string demanded : {"TRUE", "BEST_EFFORT"}) {
    EXPECT_TRUE(run("info a.h5", "HDF5_USE_FILE_LOCKING=" + demanded + " " + preloaded(ENOLCK))
                    .fails(5,
                           "a.h5: cannot be read: No locks available: expected "
                           "HDF5_USE_FILE_LOCKING=FALSE"));
  }
}

}  // namespace
}  // namespace needlework
