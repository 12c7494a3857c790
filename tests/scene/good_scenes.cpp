// Scenes that are valid: every key reaches its member, defaults are as documented.
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

#include "needlework/error.h"
#include "needlework/parse.h"
#include "src/calendar/names.h"
#include "tests/scene/message.h"
#include "tests/support/message_of.h"

namespace needlework {
namespace {

constexpr const char* least = "needles = {count = 10, box = 4}\nuntil.time = 5\n";

TEST(GoodScene, HasTheDocumentedDefaults) {
  const Scene scene = parse_scene(least, "s.toml");
  EXPECT_EQ(scene.title, "");
  EXPECT_EQ(scene.needles.count, 10u);
  EXPECT_EQ(scene.needles.box, (std::array{4.0, 4.0, 4.0}));
  EXPECT_EQ(scene.needles.k, 6);
  EXPECT_EQ(scene.needles.seed, 1u);
  EXPECT_EQ(scene.initial.t_tr, 1);
  EXPECT_EQ(scene.initial.t_rot, 1);
  EXPECT_EQ(scene.initial.file, "");
  EXPECT_EQ(scene.collisions.epsilon, 1);
  EXPECT_EQ(scene.collisions.beta, -1);
  EXPECT_FALSE(scene.collisions.tc || scene.collisions.tc_relative);
  EXPECT_EQ(scene.engine.search, "auto");
  EXPECT_EQ(scene.engine.queue, "auto");
  EXPECT_EQ(scene.engine.accuracy, "standard");
  EXPECT_FALSE(scene.engine.threads.has_value());
  EXPECT_EQ(scene.engine.isa, "auto");
  EXPECT_FALSE(scene.engine.cell_side || scene.engine.capsule_radius);
  EXPECT_EQ(scene.until.time, 5);
  EXPECT_FALSE(scene.until.collisions_per_needle || scene.until.energy_ratio || scene.until.wall_s);
  EXPECT_EQ(scene.output.file, "");
  EXPECT_TRUE(scene.output.frame_times.empty());
  EXPECT_FALSE(scene.output.frames_per_decade);
  EXPECT_FALSE(scene.output.events);
  EXPECT_EQ(scene.text, least);
}

TEST(GoodScene, KeepsEveryKey) {
  const Scene scene = parse_scene(R"(title = "Cooling é"
needles = { count = 20_000, box = [12, 13.5, 1.4e1], k = 2, seed = 9223372036854775807 }
initial = { t_tr = 0, t_rot = 2.5 }
collisions = { epsilon = 0.8, beta = 0.5, tc = 1e-3 }
until = { time = 1e6, collisions_per_needle = 600, energy_ratio = 1e-11, wall_s = 3600 }
[engine]
search = "capsules"
queue = "bucket"
accuracy = "rigorous"
isolation = "sampling"
escalation = "never"
filter = "double"
root_tolerance = 1e-9
sampling_step = 0.125
threads = 2
isa = "avx2"
cell_side = 2
capsule_radius = 0.25
storage = "by-id"
[output]
file = "run.h5"
series_per_decade = 20
frames = [0, 1.5, 7]
observables = ["energy", "fields", "displacement"]
grid = [4, 5, 6]
events = true
)",
                                  "s.toml");
  EXPECT_EQ(scene.title, "Cooling é");
  EXPECT_EQ(scene.needles.count, 20000u);
  EXPECT_EQ(scene.needles.box, (std::array{12.0, 13.5, 14.0}));
  EXPECT_EQ(scene.needles.k, 2);
  EXPECT_EQ(scene.needles.seed, 9223372036854775807u);
  EXPECT_EQ(scene.initial.t_tr, 0);
  EXPECT_EQ(scene.initial.t_rot, 2.5);
  EXPECT_EQ(scene.collisions.epsilon, 0.8);
  EXPECT_EQ(scene.collisions.beta, 0.5);
  EXPECT_EQ(scene.collisions.tc, 1e-3);
  EXPECT_EQ(scene.engine.search, "capsules");
  EXPECT_EQ(scene.engine.queue, "bucket");
  EXPECT_EQ(scene.engine.accuracy, "rigorous");
  EXPECT_EQ(scene.engine.isolation, "sampling");
  EXPECT_EQ(scene.engine.escalation, "never");
  EXPECT_EQ(scene.engine.filter, "double");
  EXPECT_EQ(scene.engine.root_tolerance, 1e-9);
  EXPECT_EQ(scene.engine.sampling_step, 0.125);
  EXPECT_EQ(scene.engine.threads, 2);
  EXPECT_EQ(scene.engine.isa, "avx2");
  EXPECT_EQ(scene.engine.cell_side, 2);
  EXPECT_EQ(scene.engine.capsule_radius, 0.25);
  EXPECT_EQ(scene.engine.storage, "by-id");
  EXPECT_EQ(scene.until.time, 1e6);
  EXPECT_EQ(scene.until.collisions_per_needle, 600);
  EXPECT_EQ(scene.until.energy_ratio, 1e-11);
  EXPECT_EQ(scene.until.wall_s, 3600);
  EXPECT_EQ(scene.output.file, "run.h5");
  EXPECT_EQ(scene.output.series_per_decade, 20);
  EXPECT_EQ(scene.output.frame_times, (std::vector<double>{0, 1.5, 7}));
  EXPECT_EQ(scene.output.observables,
            (std::vector<std::string>{"energy", "fields", "displacement"}));
  EXPECT_EQ(scene.output.grid, (std::array{4, 5, 6}));
  EXPECT_TRUE(scene.output.events);
}

// Those of real numbers are in ranges.cpp.
TEST(GoodScene, TakesTheEndsOfRanges) {
  for (const char* line :
       {"[needles]\ncount = 0\nbox = 2.01", "[needles]\ncount = 4294967294\nbox = [1e9, 1e4, 1e4]",
        "[needles]\ncount = 1\nbox = [2.01, 3, 4]\nk = 1e-9",
        "[needles]\ncount = 1\nbox = 3\nseed = 0"})
    EXPECT_NO_THROW(parse_scene(std::string(line) + "\n[until]\ntime = 0", "s.toml")) << line;
  for (const char* line : {"[initial]\nt_tr = 0.0\nt_rot = -0.0", "[engine]\nthreads = 1024",
                           "[output]\nframes = []", "[output]\nframes = [0]", "[output]\nfile = ''",
                           "[output]\ngrid = [10000, 1, 100]\nobservables = []"})
    EXPECT_NO_THROW(parse_scene(std::string(least) + line, "s.toml")) << line;
}

TEST(GoodScene, TakesEveryNamedStrategy) {
  const auto engine = [](const std::string& line) {
    return parse_scene(least + ("engine." + line), "s.toml").engine;
  };
  for (const std::string name : {"auto", "all-pairs", "linked-lists", "linked-cells", "capsules"})
    EXPECT_EQ(engine("search = '" + name + "'").search, name);
  EXPECT_EQ(engine("queue = 'auto'").queue, "auto");
  for (const std::string& name : calendar_names())
    EXPECT_EQ(engine("queue = '" + name + "'").queue, name);
  for (const std::string name : {"fast", "standard", "rigorous"})
    EXPECT_EQ(engine("accuracy = '" + name + "'").accuracy, name);
  for (const std::string name : {"auto", "scalar", "sse4", "avx2", "avx512"})
    EXPECT_EQ(engine("isa = '" + name + "'").isa, name);
}

TEST(GoodScene, ChoosesThreadsBySizeUntilANumberIsGiven) {
  const auto engine = [](const std::vector<std::string>& overrides) {
    return parse_scene(least + std::string("engine.threads = 'auto'"), "s.toml", overrides).engine;
  };
  EXPECT_TRUE(engine({}).threads_by_size);
  EXPECT_FALSE(engine({}).threads.has_value());
  EXPECT_FALSE(engine({"engine.threads=2"}).threads_by_size);
  EXPECT_EQ(engine({"engine.threads=2"}).threads, 2);
  EXPECT_FALSE(engine({"engine.threads=2", "engine.threads=auto"}).threads.has_value());
}

TEST(GoodScene, GridIsOneNumberOrThree) {
  EXPECT_EQ(parse_scene(std::string(least) + "output.grid = 7", "s.toml").output.grid,
            (std::array{7, 7, 7}));
  EXPECT_FALSE(parse_scene(least, "s.toml").output.grid);
}

TEST(GoodScene, FramesAreTimesOrANumberPerDecade) {
  const Scene scene = parse_scene(std::string(least) + "output.frames = 2", "s.toml");
  EXPECT_EQ(scene.output.frames_per_decade, 2);
  EXPECT_TRUE(scene.output.frame_times.empty());
}

TEST(GoodScene, WithAnInitialFileNeedsNeitherCountNorBox) {
  const Scene scene = parse_scene("initial.file = 'a.h5'\nuntil.wall_s = 1", "s.toml");
  EXPECT_EQ(scene.initial.file, "a.h5");
  EXPECT_EQ(scene.needles.count, 0u);
  EXPECT_EQ(scene.needles.box, (std::array{0.0, 0.0, 0.0}));
  const std::string with_both = "initial.file = 'a.h5'\n" + std::string(least);
  EXPECT_EQ(parse_scene(with_both, "s.toml").needles.count, 10u);
}

TEST(GoodScene, MayHaveWindowsLineEndsAndAByteOrderMark) {
  const std::string text =
      "\xef\xbb\xbf[needles]\r\ncount = 10\r\nbox = 4\r\n[until]\r\ntime = 5\r\n";
  const Scene scene = parse_scene(text, "s.toml");
  EXPECT_EQ(scene.needles.count, 10u);
  EXPECT_EQ(scene.text, text);
}

class SceneFile : public testing::Test {
 protected:
  // ctest runs each test in a process of its own, side by side.
  std::string path_ = testing::TempDir() + "needlework_scene_" +
                      testing::UnitTest::GetInstance()->current_test_info()->name() + ".toml";
  ~SceneFile() override { std::remove(path_.c_str()); }
};

TEST_F(SceneFile, IsReadAndNamedInErrors) {
  std::ofstream(path_) << least;
  EXPECT_EQ(read_scene(path_).text, least);
  std::ofstream(path_) << "[needles]\ncount = -1\n";
  EXPECT_TRUE(test::refusal([&] { read_scene(path_); }).starts_with(path_ + ": line 2:"));
}

TEST_F(SceneFile, ThatCannotBeReadIsAnIoError) {
  const auto message = [](const std::string& path) {
    return test::message_of<IoError>([&] { read_scene(path); });
  };
  EXPECT_EQ(message("/nowhere/s.toml"),
            "/nowhere/s.toml: cannot be read: No such file or directory");
  EXPECT_EQ(message("/"), "/: cannot be read: Is a directory");
  EXPECT_EQ(message(""), ": cannot be read: No such file or directory");
  std::ofstream(path_) << least;
  std::filesystem::permissions(path_, std::filesystem::perms::none);
  const uid_t user = geteuid();
  constexpr uid_t nobody = 65534;  // the superuser may read everything
  if (user == 0 && seteuid(nobody) != 0) GTEST_SKIP() << "cannot become an ordinary user";
  const std::string refused = message(path_);
  ASSERT_EQ(seteuid(user), 0);
  EXPECT_EQ(refused, path_ + ": cannot be read: Permission denied");
}

TEST_F(SceneFile, OfOneMebibyteIsReadAndALargerOneRefused) {
  std::string text = std::string(least) + "#";
  text.resize(max_scene_bytes, '-');
  std::ofstream(path_) << text;
  EXPECT_EQ(read_scene(path_).text.size(), max_scene_bytes);
  std::ofstream(path_) << text << '-';
  EXPECT_EQ(test::refusal([&] { read_scene(path_); }),
            path_ + ": too large: expected a scene of at most 1048576 bytes");
}

}  // namespace
}  // namespace needlework
