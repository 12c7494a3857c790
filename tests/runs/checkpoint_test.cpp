// Checkpoint files: what is written is read back; whatever is left of one is told from a whole one.
#include "src/runs/checkpoint.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "needlework/error.h"
#include "needlework/parse.h"
#include "tests/support/contains.h"
#include "tests/support/runs.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/whole_file.h"

namespace needlework::runs {
namespace {

namespace fs = std::filesystem;

RunCheckpoint sample(double time) {
  RunCheckpoint out;
  out.scene = parse_scene(R"(title = "all kinds of keys"
needles = { box = [7, 8, 9], seed = 12 }
collisions = { epsilon = 0.9, beta = 0.1, tc = 0.01 }
engine = { search = "capsules", threads = 2, isa = "avx2", root_tolerance = 1e-9 }
until = { time = 3, collisions_per_needle = 5, wall_s = 7 }
species = [{ name = "a", count = 20, length = 0.5 }]
[output]
frames = [1, 2, 3]
observables = ["fields", "displacement"]
grid = [2, 3, 4]
events = true
checkpoint_every = 17
)",
                          "scene.toml");
  out.drawn = true;
  out.initial.time = 0;
  out.initial.energy = 1.25;
  out.simulation.bytes = std::string("state\0of the gas", 16);
  out.output = {.frames = 1, .samples = 2, .events = std::uint64_t{1} << 40};
  out.observation = std::to_string(time);
  return out;
}

class CheckpointFile : public testing::Test {
 protected:
  std::string complaint() const {
    try {
      files.latest();
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
  std::string bytes() const { return test::bytes_of(files.newest()); }
  static std::string mark_of(const std::string& bytes) { return bytes.substr(0, bytes.find('\n')); }
  void put(const std::string& bytes) const {
    std::ofstream(files.newest(), std::ios::binary) << bytes;
  }

  test::TemporaryFolder folder;
  CheckpointFiles files{(folder.path() / "run.h5").string()};
};

TEST_F(CheckpointFile, IsReadAsItWasWritten) {
  const RunCheckpoint written = sample(1);
  EXPECT_FALSE(files.exist());
  files.write(written);
  EXPECT_TRUE(files.exist());
  const auto [read, warning] = files.latest();
  EXPECT_EQ(warning, "");
  EXPECT_EQ(read.simulation.bytes, written.simulation.bytes);
  EXPECT_EQ(read.output, written.output);
  EXPECT_EQ(read.observation, written.observation);
  EXPECT_TRUE(read.drawn);
  EXPECT_EQ(read.initial.energy, 1.25);
  const Scene &a = written.scene, &b = read.scene;
  EXPECT_EQ(a.title, b.title);
  EXPECT_EQ(a.text, b.text);
  EXPECT_EQ(a.places, b.places);
  EXPECT_EQ(a.needles.box, b.needles.box);
  EXPECT_EQ(a.needles.seed, b.needles.seed);
  EXPECT_EQ(a.collisions.epsilon, b.collisions.epsilon);
  EXPECT_EQ(a.collisions.tc, b.collisions.tc);
  EXPECT_EQ(a.collisions.tc_relative, b.collisions.tc_relative);
  EXPECT_EQ(a.engine.search, b.engine.search);
  EXPECT_EQ(a.engine.threads, b.engine.threads);
  EXPECT_EQ(a.engine.root_tolerance, b.engine.root_tolerance);
  EXPECT_EQ(a.until.wall_s, b.until.wall_s);
  EXPECT_EQ(a.until.energy_ratio, b.until.energy_ratio);
  ASSERT_EQ(b.species.size(), 1u);
  EXPECT_EQ(b.species[0].name, "a");
  EXPECT_EQ(b.species[0].length, 0.5);
  EXPECT_EQ(a.output.frame_times, b.output.frame_times);
  EXPECT_EQ(a.output.observables, b.output.observables);
  EXPECT_EQ(a.output.grid, b.output.grid);
  EXPECT_TRUE(b.output.events);
  EXPECT_EQ(b.output.checkpoint_every, 17);
}

TEST_F(CheckpointFile, BeforeTheNewestIsKeptAndUsedWhenThatIsDamaged) {
  files.write(sample(1));
  files.write(sample(2));
  EXPECT_EQ(files.latest().checkpoint.observation, sample(2).observation);
  EXPECT_TRUE(fs::exists(files.older()));
  const std::string whole = bytes();
  // The program was killed between the two renames.
  fs::rename(files.newest(), folder.path() / "aside");
  EXPECT_EQ(files.latest().checkpoint.observation, sample(1).observation);
  put(mark_of(whole) + "\nnot this");
  const auto [read, warning] = files.latest();
  EXPECT_EQ(read.observation, sample(1).observation);
  EXPECT_EQ(warning,
            files.newest() + ": damaged: it is cut short; continuing from " + files.older());
}

TEST_F(CheckpointFile, BeforeTheNewestIsUsedWhenThatCannotBeRead) {
  files.write(sample(1));
  fs::rename(files.newest(), files.older());
  fs::create_symlink(files.newest(), files.newest());
  const auto [read, warning] = files.latest();
  EXPECT_EQ(read.observation, sample(1).observation);
  EXPECT_EQ(warning, files.newest() + ": cannot be read: Too many levels of symbolic links; " +
                         "continuing from " + files.older());
  // Neither of the two may be begun again: the newest may be whole.
  std::ofstream(files.older()) << "damaged";
  EXPECT_THROW(files.latest(), IoError);
  fs::remove(files.older());
  EXPECT_TRUE(files.exist());
  EXPECT_THROW(files.latest(), IoError);
}

TEST_F(CheckpointFile, CutShortAtAnyByteIsDamaged_long) {
  files.write(sample(1));
  const std::string whole = bytes();
  for (std::size_t size = 0; size < whole.size(); ++size) {
    put(whole.substr(0, size));
    ASSERT_NE(complaint().find(files.newest()), std::string::npos) << size;
  }
  put(whole + "x");
  EXPECT_TRUE(test::contains(complaint(), ": damaged: "));
}

TEST_F(CheckpointFile, WithAnyByteChangedIsDamaged_long) {
  files.write(sample(1));
  const std::string whole = bytes();
  const std::size_t patch_version = whole.find('\n') - 1;  // may be another
  for (std::size_t n = 0; n < whole.size(); ++n) {
    if (n == patch_version) continue;
    std::string changed = whole;
    changed[n] ^= static_cast<char>(1 << n % 8);
    put(changed);
    ASSERT_NE(complaint(), "") << n;
  }
}

TEST_F(CheckpointFile, OfAnotherVersionIsNamed) {
  files.write(sample(1));
  const std::string whole = bytes(), mark = mark_of(whole);
  const std::string but_patch = mark.substr(0, mark.rfind('.') + 1);
  for (const std::string& other :
       {std::string("needlework checkpoint 0"), std::string("needlework checkpoint 4 of 0.0.1"),
        but_patch, but_patch + "1.2", "1" + but_patch + "1"}) {
    put(other + whole.substr(mark.size()));
    const std::string expected = "expected \"" + but_patch +
                                 "*\": a run is continued by versions "
                                 "with the same major and minor number as the one that began it; a "
                                 "new run starts from its last frame by initial.file";
    if (other.starts_with("needlework checkpoint ")) {
      EXPECT_EQ(complaint(), files.newest() + ": \"" + other + "\": " + expected);
    } else {
      EXPECT_EQ(complaint(), files.newest() + ": damaged: expected a checkpoint");
    }
  }
}

TEST_F(CheckpointFile, OfAnotherPatchVersionIsRead) {
  files.write(sample(1));
  const std::string whole = bytes(), mark = mark_of(whole);
  for (const std::string patch : {"0", "7", "12"}) {
    put(mark.substr(0, mark.rfind('.') + 1) + patch + whole.substr(mark.size()));
    EXPECT_EQ(complaint(), "") << patch;
  }
}

TEST_F(CheckpointFile, IsAnOrdinaryFileThatExists) {
  EXPECT_THROW(complaint(), IoError) << "nor is there a file of the run";
  fs::create_directory(files.newest());
  EXPECT_EQ(complaint(), files.newest() + ": expected an ordinary file");
  fs::remove(files.newest());
  ASSERT_EQ(mkfifo(files.newest().c_str(), 0600), 0);
  EXPECT_EQ(complaint(), files.newest() + ": expected an ordinary file");
}

TEST_F(CheckpointFile, WithASceneThatNoFileCouldDescribeIsRefused) {
  RunCheckpoint forged = sample(1);
  forged.scene.needles.box[1] = 2e9;
  files.write(forged);
  EXPECT_TRUE(test::contains(complaint(), "needles.box"));
}

// Ten gigabytes that take no place on the disk.
TEST_F(CheckpointFile, OfZerosTakesNoMemory) {
  put("");
  fs::resize_file(files.newest(), std::uintmax_t{10} << 30);
  EXPECT_EQ(complaint(), files.newest() + ": damaged: expected a checkpoint");
}

TEST_F(CheckpointFile, ThatCannotBeWrittenKeepsTheOneBefore) {
  files.write(sample(1));
  // A folder in the place of the file that is written first.
  fs::create_directory(files.newest() + ".part");
  EXPECT_THROW(files.write(sample(2)), IoError);
  EXPECT_EQ(files.latest().checkpoint.observation, sample(1).observation);
}

TEST_F(CheckpointFile, IsRemovedInAllGenerations) {
  files.write(sample(1));
  files.write(sample(2));
  files.remove();
  EXPECT_TRUE(fs::is_empty(folder.path()));
  files.remove();
}

}  // namespace
}  // namespace needlework::runs
