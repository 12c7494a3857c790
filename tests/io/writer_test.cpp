// What is written comes back, and what exists is kept.
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <thread>

#include "tests/io/support.h"
#include "tests/support/contains.h"

namespace needlework::io {
namespace {

using Writing = InFolder;

const RunInfo run{"avx2", 2, 0.25};

TEST_F(Writing, LastFrameComesBackBitForBit) {
  for (const std::size_t needles : {1u, 2u, 7u, 300u, 1000u}) {
    const std::string path = file("state.h5");
    const State last = make_state(needles, 5);
    Writer writer(path, true, make_scene(needles), run);
    for (int frame = 0; frame < 70; ++frame) {
      State other = make_state(needles, 100u + static_cast<unsigned>(frame));
      other.id = last.id;
      writer.write_frame(make_totals(frame), other);
    }
    writer.write_frame(make_totals(70), last);
    writer.close();
    expect_same(last, read_last_frame(path));
  }
}

TEST_F(Writing, ManyNeedlesComeBackBitForBit) {
  const State state = make_state(200000);
  {
    Writer writer(file("large.h5"), false, make_scene(state.size()), run);
    writer.write_frame(make_totals(0), state);
    writer.write_frame(make_totals(1), state);
  }
  expect_same(state, read_last_frame(file("large.h5")));
}

TEST_F(Writing, NoNeedlesAreAState) {
  State state;
  state.box = {3, 4, 5};
  Writer writer(file("empty.h5"), false, make_scene(0, true), run);
  writer.write_frame(make_totals(0), state);
  writer.write_series(make_totals(0));
  writer.flush();
  writer.write_frame(make_totals(1), state);
  writer.close();
  expect_same(state, read_last_frame(file("empty.h5")));
}

TEST_F(Writing, StateWithoutIdsAndImagesGetsPlainOnes) {
  State state = make_state(3);
  state.id.clear();
  state.image.clear();
  Writer(file("plain.h5"), false, make_scene(3), run).write_frame(make_totals(0), state);
  state.id = {0, 1, 2};
  state.image.resize(3);
  expect_same(state, read_last_frame(file("plain.h5")));
}

TEST_F(Writing, FieldsOfTheSeriesComeBack) {
  using enum SeriesField::Kind;
  RunInfo observed = run;
  observed.series = {{"a",
                      "First",
                      {{"x", "A pair", "length", {{"2", 2}}},
                       {"borders", "Borders", "", {{"3", 3}}, constant, {1, 2, 3}},
                       {"n", "A count", "", {}, count}}},
                     {"b", "Second", {{"grid", "Many", "", {{"cells", 300}, {"3", 3}}}}}};
  const int samples = 400;  // more numbers than are kept in memory
  std::vector<double> x, n, grid;
  Writer writer(file("fields.h5"), false, make_scene(2), observed);
  for (int i = 0; i < samples; ++i) {
    std::vector<double> row{i / 8.0, -i / 3.0, 9007199254740991.0 - i};
    x.insert(x.end(), row.begin(), row.begin() + 2);
    n.push_back(row.back());
    for (int cell = 0; cell < 900; ++cell) row.push_back(i + cell / 7.0);
    grid.insert(grid.end(), row.begin() + 3, row.end());
    writer.write_series(make_totals(i), row);
  }
  EXPECT_THROW(writer.write_series(make_totals(samples)), std::logic_error);
  writer.close();
  const auto numbers = [&](const char* name) { return read_numbers(file("fields.h5"), name); };
  EXPECT_EQ(numbers("/series/a/x/value"), x);
  EXPECT_EQ(numbers("/series/a/n/value"), n);
  EXPECT_EQ(numbers("/series/a/borders"), (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(numbers("/series/b/grid/value"), grid);
  EXPECT_EQ(numbers("/series/b/grid/time"), numbers("/series/time"));
  EXPECT_EQ(numbers("/series/b/grid/step"), numbers("/series/step"));
}

TEST_F(Writing, SumsAndTheirTimesComeBack) {
  const int samples = 5000;  // more than are kept in memory
  Writer writer(file("series.h5"), false, make_scene(2), run);
  for (int i = 0; i < samples; ++i) writer.write_series(make_totals(i));
  for (int i = 0; i < 3; ++i) writer.write_frame(make_totals(1000 * i), make_state(2));
  writer.close();
  const auto numbers = [&](const char* name) { return read_numbers(file("series.h5"), name); };
  for (const char* name : {"t_tr", "t_rot", "energy", "collisions", "tc_collisions"}) {
    const std::string group = std::string("/series/") + name;
    ASSERT_EQ(numbers((group + "/value").c_str()).size(), samples) << name;
    EXPECT_EQ(numbers((group + "/time").c_str())[4321], 4321 / 8.0) << name;
    EXPECT_EQ(numbers((group + "/step").c_str())[4321], 43210) << name;
  }
  EXPECT_EQ(numbers("/series/t_rot/value")[4999], 2.0 / 5000);
  EXPECT_EQ(numbers("/series/momentum/value")[3 * 77 + 2], 77.75);
  EXPECT_EQ(numbers("/series/collisions/value")[12], 120);
  // Those of the frames are on the grid of the frames.
  EXPECT_EQ(numbers("/observables/energy/value"),
            (std::vector<double>{3.5, 3.5 / 1001, 3.5 / 2001}));
  EXPECT_EQ(numbers("/observables/tc_collisions/value"), (std::vector<double>{0, 1000, 2000}));
  EXPECT_EQ(numbers("/observables/energy/time"), (std::vector<double>{0, 125, 250}));
  EXPECT_EQ(numbers("/particles/needles/box/edges/step"), (std::vector<double>{0, 10000, 20000}));
}

TEST_F(Writing, EventsComeBack) {
  const int events = 10000;  // two full blocks and a part
  Writer writer(file("events.h5"), false, make_scene(2, true), run);
  for (int i = 0; i < events; ++i) {
    Collision collision;
    collision.epoch = -i;
    collision.offset = i / 16.0;
    collision.time = i / 4.0;
    collision.first = static_cast<std::uint32_t>(i);
    collision.second = 4294967295u;
    collision.shift = {i, -1, 1};
    collision.arm_first = i / 3.0;
    collision.arm_second = -0.5;
    collision.normal_velocity = -i / 7.0;
    collision.impulse = {i + 0.1, i + 0.2, i + 0.3};
    collision.contact_time_rule = i % 2 == 1;
    writer.write_event(collision);
    if (i == 6000) writer.flush();
  }
  writer.close();
  const auto numbers = [&](const char* name) { return read_numbers(file("events.h5"), name); };
  for (const char* name : {"time", "epoch", "offset", "normal_velocity", "tc"}) {
    EXPECT_EQ(numbers((std::string("/events/") + name).c_str()).size(), events) << name;
  }
  for (const std::size_t i : {0u, 1u, 4095u, 4096u, 6001u, 9999u}) {
    const double x = static_cast<double>(i);
    EXPECT_EQ(numbers("/events/time")[i], x / 4);
    EXPECT_EQ(numbers("/events/epoch")[i], -x);
    EXPECT_EQ(numbers("/events/offset")[i], x / 16);
    EXPECT_EQ(numbers("/events/pair")[2 * i], x);
    EXPECT_EQ(numbers("/events/pair")[2 * i + 1], 4294967295.0);
    EXPECT_EQ(numbers("/events/arms")[2 * i], x / 3);
    EXPECT_EQ(numbers("/events/arms")[2 * i + 1], -0.5);
    EXPECT_EQ(numbers("/events/normal_velocity")[i], -x / 7);
    EXPECT_EQ(numbers("/events/tc")[i], static_cast<double>(i % 2));
    EXPECT_EQ(numbers("/events/shift")[3 * i], x);
    EXPECT_EQ(numbers("/events/shift")[3 * i + 1], -1);
    EXPECT_EQ(numbers("/events/impulse")[3 * i + 2], x + 0.3);
  }
}

TEST_F(Writing, KindsOfEventsComeBackWhereThereAreSome) {
  RunInfo with_kinds = run;
  with_kinds.has_kinds = true;
  Writer writer(file("kinds.h5"), false, make_scene(2, true), with_kinds);
  Collision hit;
  hit.first = 1, hit.second = 3, hit.arm_first = -0.5, hit.normal_velocity = -2;
  writer.write_event(Collision());
  writer.write_event(Happening{Happening::wall, 1, hit});
  writer.write_event(Happening{Happening::other, 2, hit});
  writer.close();
  const auto numbers = [&](const char* name) { return read_numbers(file("kinds.h5"), name); };
  EXPECT_EQ(numbers("/events/kind"), (std::vector<double>{0, 1, 255}));
  EXPECT_EQ(numbers("/events/pair"), (std::vector<double>{0, 0, 1, 3, 1, 3}));
  EXPECT_EQ(numbers("/events/arms"), (std::vector<double>{0, 0, -0.5, 0, -0.5, 0}));
  const std::string text = describe(file("kinds.h5"));
  EXPECT_TRUE(
      test::contains(text,
                     "/events: 3 events, time 0 to 0\n  1 of kind 0 (pair)\n  1 of kind 1 (wall)\n"
                     "  1 of kind 255 (other)\n"));
}

// Files of pairs alone are what they have always been.
TEST_F(Writing, AFileOfPairsHasNoKinds) {
  Writer writer(file("pairs.h5"), false, make_scene(2, true), run);
  EXPECT_THROW(writer.write_event(Happening{Happening::wall, 1, {}}), std::logic_error);
  writer.write_event(Collision());
  writer.close();
  EXPECT_FALSE(test::contains(describe(file("pairs.h5")), "kind"));
}

TEST_F(Writing, ExistingFileIsKeptWithoutForce) {
  std::ofstream(file("kept.h5")) << "precious";
  const auto message =
      message_of<IoError>([&] { Writer(file("kept.h5"), false, make_scene(1), run); });
  EXPECT_TRUE(message.starts_with(file("kept.h5") + ": the file exists")) << message;
  std::string text;
  std::ifstream(file("kept.h5")) >> text;
  EXPECT_EQ(text, "precious");
  EXPECT_EQ(files().size(), 1u);
}

TEST_F(Writing, ExistingFileIsReplacedByForceThroughALink) {
  std::ofstream(file("old.h5")) << "worthless";
  std::filesystem::create_symlink("old.h5", file("link.h5"));
  Writer(file("link.h5"), true, make_scene(1), run).write_frame(make_totals(0), make_state(1));
  EXPECT_TRUE(std::filesystem::is_symlink(file("link.h5")));
  EXPECT_EQ(read_last_frame(file("old.h5")).size(), 1u);
  EXPECT_EQ(files().size(), 2u);
}

TEST_F(Writing, OfTwoWritersOfOneNewNameOneWins) {
  for (int round = 0; round < 10; ++round) {
    const std::string path = file("race" + std::to_string(round));
    std::vector<pid_t> children;
    for (int i = 0; i < 4; ++i) {
      const pid_t child = fork();
      if (child == 0) {
        try {
          Writer writer(path, false, make_scene(1), run);
          writer.close();
          _exit(0);
        } catch (const IoError&) {
          _exit(1);
        }
      }
      children.push_back(child);
    }
    int won = 0;
    for (const pid_t child : children) {
      int status = 0;
      waitpid(child, &status, 0);
      ASSERT_TRUE(WIFEXITED(status));
      won += WEXITSTATUS(status) == 0;
    }
    EXPECT_EQ(won, 1);
  }
  EXPECT_EQ(files().size(), 10u);
}

TEST_F(Writing, OnlyFilesAreReplaced) {
  std::filesystem::create_directory(file("folder"));
  ASSERT_EQ(mkfifo(file("pipe").c_str(), 0600), 0);
  std::filesystem::create_symlink("nowhere", file("dangling"));
  for (const bool force : {false, true}) {
    const auto message = [&](const std::string& path) {
      return message_of<IoError>([&] { Writer(path, force, make_scene(1), run); });
    };
    EXPECT_EQ(message(file("folder")), file("folder") + ": Is a directory");
    EXPECT_EQ(message(file("pipe")), file("pipe") + ": not a regular file");
    EXPECT_EQ(message(file("dangling")), file("dangling") + ": the symbolic link leads nowhere");
    EXPECT_EQ(message("/dev/null"), "/dev/null: not a regular file");
    EXPECT_EQ(message(file("none/a.h5")), file("none/a.h5") + ": No such file or directory");
    EXPECT_EQ(message(file("new/")), file("new/") + ": No such file or directory");
    EXPECT_EQ(message(""), "'': expected a file name");
    EXPECT_EQ(message(file(std::string(300, 'x'))),
              file(std::string(300, 'x')) + ": File name too long");
  }
  EXPECT_EQ(files().size(), 3u);
}

TEST_F(Writing, WrongUseIsRefused) {
  Writer writer(file("a.h5"), false, make_scene(2), run);
  EXPECT_THROW(writer.write_event(Collision()), std::logic_error);
  EXPECT_THROW(writer.write_frame(make_totals(0), make_state(3)), std::invalid_argument);
  State uneven = make_state(2);
  uneven.velocity.pop_back();
  EXPECT_THROW(writer.write_frame(make_totals(0), uneven), std::invalid_argument);
  writer.write_frame(make_totals(0), make_state(2));
  State renamed = make_state(2);
  renamed.id = {8, 9};
  EXPECT_THROW(writer.write_frame(make_totals(1), renamed), std::invalid_argument);
  writer.close();
  EXPECT_THROW(writer.flush(), std::logic_error);
  expect_same(make_state(2), read_last_frame(file("a.h5")));
}

TEST_F(Writing, WritersMayBeMoved) {
  Writer one(file("one.h5"), false, make_scene(2), run);
  Writer two(file("two.h5"), false, make_scene(2), run);
  one.write_frame(make_totals(0), make_state(2, 1));
  two.write_frame(make_totals(0), make_state(2, 2));
  two = std::move(one);
  expect_same(make_state(2, 2), read_last_frame(file("two.h5")));
  Writer three(std::move(two));
  three.close();
  expect_same(make_state(2, 1), read_last_frame(file("one.h5")));
}

TEST_F(Writing, ThreadsMayWriteFilesOfTheirOwn) {
  std::vector<std::jthread> threads;
  for (unsigned i = 0; i < 4; ++i) {
    threads.emplace_back([this, i] {
      const std::string path = file(std::to_string(i));
      for (int round = 0; round < 5; ++round) {
        Writer writer(path, true, make_scene(20), run);
        for (int frame = 0; frame < 20; ++frame) {
          writer.write_frame(make_totals(frame), make_state(20, i));
          writer.flush();
        }
        writer.close();
        expect_same(make_state(20, i), read_last_frame(path));
      }
    });
  }
}

}  // namespace
}  // namespace needlework::io
