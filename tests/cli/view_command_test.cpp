// What `needlework view` does with files; tests/picture judges the pictures.
#include <fmt/format.h>

#include <algorithm>
#include <pugixml.hpp>

#include "tests/cli/program.h"

namespace needlework {
namespace {

class ViewCommand : public ProgramTest {
 protected:
  // Writes frames at three times to a.h5.
  void make_frames() const {
    write("frames.toml",
          "needles = { count = 20, box = 7 }\nuntil.time = 2\n"
          "output = { file = \"a.h5\", frames = [1], checkpoint_every = 0 }\n");
    ASSERT_EQ(run("run frames.toml --quiet").exit_code, 0);
  }
  bool is_png(const std::string& name) const { return read(name).starts_with("\x89PNG\r\n"); }
};

TEST_F(ViewCommand, WritesPngAndSvgByTheEnding) {
  make_frames();
  const Outcome viewed = run("view a.h5 -o a.png");
  EXPECT_EQ(viewed.exit_code, 0);
  EXPECT_EQ(viewed.out + viewed.err, "");
  EXPECT_TRUE(is_png("a.png"));
  EXPECT_EQ(run("view a.h5 --out a.svg").exit_code, 0);
  EXPECT_TRUE(contains(read("a.svg"), ">20 needles</title>"));
  EXPECT_EQ(run("view a.h5 -o a.gif").exit_code, 2);
  EXPECT_TRUE(run("view a.h5 -o a.gif")
                  .complains("--out a.gif: expected a name that ends in .png or .svg"));
  EXPECT_EQ(files(), (std::vector<std::string>{"a.h5", "a.png", "a.svg", "frames.toml", small}));
}

TEST_F(ViewCommand, ShowsTheFrameThatIsAskedFor) {
  make_frames();
  for (const auto& [choice, time] : {std::pair{"first", 0}, {"1", 1}, {"last", 2}, {"2", 2}}) {
    ASSERT_EQ(run(fmt::format("view a.h5 -o a.svg --force --frame {}", choice)).exit_code, 0);
    EXPECT_TRUE(contains(read("a.svg"), fmt::format(">time {}<", time))) << choice;
  }
  EXPECT_TRUE(run("view a.h5 -o b.svg --frame 3")
                  .fails(3, "--frame 3: expected a number from 0 to 2, as there are 3 frames"));
  EXPECT_FALSE(exists("b.svg"));
}

TEST_F(ViewCommand, ShowsWallsWhereTheyAreAtTheTimeOfTheFrame) {
  write("shaken.toml",
        "needles = { count = 5, box = [5, 5, 3] }\nuntil.time = 0.75\nforces.gravity = [0, 0, -1]\n"
        "output = { file = \"a.h5\", frames = [0.25], checkpoint_every = 0 }\n"
        "[[walls]]\naxis = \"z\"\nside = \"low\"\nmotion = { amplitude = 0.5, frequency = 1 }\n");
  ASSERT_EQ(run("run shaken.toml --quiet").exit_code, 0);
  // The lowest line of the outline of the floor, at the height of the box from the side.
  const auto floor = [&](const char* frame) {
    const std::string options = "--projection orthographic --elevation 0 --colour none";
    EXPECT_EQ(
        run(fmt::format("view a.h5 -o a.svg --force --frame {} {}", frame, options)).exit_code, 0);
    pugi::xml_document picture;
    EXPECT_TRUE(picture.load_string(read("a.svg").c_str()));
    double lowest = 0, box = 0;
    for (const auto& line : picture.select_nodes("//line")) {
      const double y = line.node().attribute("y1").as_double();
      const std::string colour = line.node().attribute("stroke").value();
      if (colour == "#46bea0") lowest = std::max(lowest, y);
      if (colour == "#4a5680") box = std::max(box, y);
    }
    return box - lowest;
  };
  EXPECT_NE(floor("0"), floor("1"));
  EXPECT_GT(floor("1"), 20);         // at its highest
  EXPECT_NEAR(floor("2"), 0, 0.11);  // at its lowest, where the box is drawn to
  EXPECT_TRUE(contains(read("a.svg"), ">moving wall<"));
}

TEST_F(ViewCommand, NumbersThePicturesOfASeries) {
  make_frames();
  ASSERT_EQ(run("view a.h5 -o a.svg --frames all").exit_code, 0);
  for (const int frame : {0, 1, 2}) {
    EXPECT_TRUE(contains(read(fmt::format("a-{:05}.svg", frame)), fmt::format(">time {}<", frame)));
  }
  EXPECT_FALSE(exists("a.svg"));
}

TEST_F(ViewCommand, KeepsExistingFilesUnlessForced) {
  make_frames();
  write("a.png", "mine");
  EXPECT_TRUE(
      run("view a.h5 -o a.png").fails(5, "a.png: exists already: expected a new file, or --force"));
  EXPECT_EQ(read("a.png"), "mine");
  EXPECT_EQ(run("view a.h5 -o a.png --force").exit_code, 0);
  EXPECT_TRUE(is_png("a.png"));

  // Of a series nothing is written if one of its files exists.
  write("b-00002.png", "mine");
  EXPECT_EQ(run("view a.h5 -o b.png --frame all").exit_code, 5);
  EXPECT_FALSE(exists("b-00000.png"));
  EXPECT_EQ(read("b-00002.png"), "mine");
}

TEST_F(ViewCommand, ColoursAsAskedInBothSpellings) {
  make_frames();
  ASSERT_EQ(run("view a.h5 -o a.svg --colour spin").exit_code, 0);
  ASSERT_EQ(run("view a.h5 -o b.svg --color spin").exit_code, 0);
  EXPECT_EQ(read("a.svg"), read("b.svg"));
  EXPECT_TRUE(contains(read("a.svg"), ">spin / "));
  EXPECT_TRUE(run("view a.h5 -o c.svg --colour mass")
                  .fails(2, "mass: expected one of speed, spin, vx, vy, vz, flow-x"));
}

TEST_F(ViewCommand, HasTheSizeThatIsAskedFor) {
  make_frames();
  ASSERT_EQ(run("view a.h5 -o a.svg --width 640 --height 360").exit_code, 0);
  EXPECT_TRUE(contains(read("a.svg"), "viewBox=\"0 0 640 360\""));
  for (const char* size : {"--width 10", "--height 1000000", "--width nan", "--elevation 91"}) {
    EXPECT_EQ(run(fmt::format("view a.h5 -o b.png {}", size)).exit_code, 2) << size;
  }
  EXPECT_FALSE(exists("b.png"));
}

TEST_F(ViewCommand, WritesNothingAfterAnError) {
  write("text.h5", "text");
  for (const auto& [arguments, exit_code, message] :
       {std::tuple{"absent.h5 -o a.png", 5, "absent.h5: No such file"},
        {"text.h5 -o a.png", 5, "text.h5: not an HDF5 file"},
        {"text.h5 -o x/a.png", 5, "x/a.png: cannot be written: expected a folder that exists"}}) {
    EXPECT_TRUE(run(std::string("view ") + arguments).fails(exit_code, message)) << arguments;
  }
  EXPECT_EQ(run("view text.h5").exit_code, 2);
  EXPECT_EQ(files(), (std::vector<std::string>{small, "text.h5"}));
}

TEST_F(ViewCommand, ReportsAFullDisk) {
  make_frames();
  // A limit on the size of files stands for a full disk.
  EXPECT_TRUE(
      shell(fmt::format("(trap '' XFSZ; ulimit -f 1; {} view a.h5 -o a.png)", NEEDLEWORK_PROGRAM))
          .fails(5, "a.png: cannot be written completely"));
  EXPECT_FALSE(exists("a.png"));
}

}  // namespace
}  // namespace needlework
