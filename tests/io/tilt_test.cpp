// Sheared boxes in the formats of other programs: cells with a tilt xy, images counted for it, and
// the slide of a state on the way back.
#include "src/box/tilt.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "needlework/simulation.h"
#include "src/io/formats/read_configuration.h"
#include "tests/io/complaints.h"
#include "tests/io/exported_files.h"
#include "tests/support/contains.h"

namespace needlework::io {
namespace {

class TiltedFormats : public Formats {
 protected:
  // Writes the text and reads it.
  State read(const std::string& text) const {
    std::ofstream(file("text"), std::ios::binary) << text;
    return read_configuration(file("text")).state;
  }
};

// In a box with edges that are not short in binary, so that sums of them round.
State sheared_state(double slide, double rate) {
  State state = make_state(60, 4);
  for (std::size_t i = 0; i < state.size(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double share = static_cast<double>((7 * i + 13 * axis) % 60) / 60 + 1e-3;
      state.position[i][axis] = share * state.box[axis];
      state.velocity[i][axis] = 1 / (1 + static_cast<double>(i + axis));
      state.image[i][axis] = static_cast<std::int32_t>(i * (axis + 2) % 7) - 3;
    }
  }
  state.slide = slide;
  state.shear_rate = rate;
  return state;
}

// Where a needle would be if the box had no boundary.
Vector path_of(const State& state, std::size_t i) {
  const auto edges = box_of(state).vectors();
  Vector out = state.position[i];
  for (std::size_t n = 0; n < 3; ++n) {
    for (std::size_t axis = 0; axis < 3; ++axis) out[axis] += state.image[i][n] * edges[n][axis];
  }
  return out;
}

void expect_near(const Vector& a, const Vector& b, double error) {
  for (std::size_t axis = 0; axis < 3; ++axis) EXPECT_NEAR(a[axis], b[axis], error) << axis;
}

TEST_F(TiltedFormats, AreReadBack) {
  const double edge = make_state(1).box[0];
  for (const double slide :
       {0.0, 1e-9, 3.3, std::nextafter(edge / 2, 0), edge / 2, 7.7, std::nextafter(edge, 0)}) {
    for (const double rate : {0.7, -0.3}) {
      const State state = sheared_state(slide, rate);
      for (const char* name : {"a.xyz", "a.dump", "a.data"}) {
        SCOPED_TRACE(testing::Message() << name << ", slide " << slide << ", rate " << rate);
        const State back = read_configuration(put(name, {state})).state;
        EXPECT_EQ(back.box, state.box);
        EXPECT_EQ(back.slide, state.slide);
        EXPECT_EQ(back.shear_rate, name == std::string("a.dump") ? 0 : rate);
        EXPECT_TRUE(same_bits(back.velocity, state.velocity));
        EXPECT_TRUE(same_bits(back.orientation, state.orientation));
        ASSERT_EQ(back.size(), state.size());
        const double xy = slide < edge / 2 ? slide : slide - edge;
        for (std::size_t i = 0; i < state.size(); ++i) {
          const double boxes = (back.position[i][0] - state.position[i][0]) / edge;
          EXPECT_NEAR(boxes, std::round(boxes), 1e-14);
          EXPECT_EQ(back.position[i][1], state.position[i][1]);
          EXPECT_EQ(back.position[i][2], state.position[i][2]);
          // Within the cell.
          const double x = back.position[i][0] - xy * back.position[i][1] / state.box[1];
          EXPECT_GE(x, -1e-14);
          EXPECT_LE(x, edge + 1e-14);
          if (!back.image.empty()) expect_near(path_of(back, i), path_of(state, i), 2e-14 * edge);
        }
      }
    }
  }
}

TEST_F(TiltedFormats, HaveBoundsAsOtherProgramsWantThem) {
  State state = sheared_state(6, 0.5);
  state.box = {8, 9, 10};
  put("a.dump", {state});
  EXPECT_TRUE(test::contains(text_of_file("a.dump"),
                             "ITEM: BOX BOUNDS xy xz yz pp pp pp\n-2 8 -2\n0 9 0\n0 10 0\nITEM"));
  put("a.data", {state});
  EXPECT_TRUE(test::contains(text_of_file("a.data"),
                             "\n0 8 xlo xhi\n0 9 ylo yhi\n0 10 zlo zhi\n-2 0 0 xy xz yz\n\nAtoms"));
  put("a.xyz", {state});
  EXPECT_TRUE(test::contains(text_of_file("a.xyz"), "Lattice=\"8 0 0 -2 9 0 0 0 10\" "));
  state.slide = 3;
  put("a.dump", {state});
  EXPECT_TRUE(test::contains(text_of_file("a.dump"), "pp pp pp\n0 11 3\n0 9 0\n0 10 0\nITEM"));
  state.slide = 4;
  put("a.xyz", {state});
  EXPECT_TRUE(test::contains(text_of_file("a.xyz"), "Lattice=\"8 0 0 -4 9 0 0 0 10\" "));
  // Of a box that only starts to slide, the tilt is 0; of one at rest, there is none.
  state.slide = 0;
  put("a.dump", {state});
  EXPECT_TRUE(test::contains(text_of_file("a.dump"), "xy xz yz pp pp pp\n0 8 0\n0 9 0\n0 10 0\n"));
  state.shear_rate = 0;
  put("a.dump", {state});
  EXPECT_TRUE(test::contains(text_of_file("a.dump"), "BOX BOUNDS pp pp pp\n0 8\n0 9\n0 10\n"));
}

TEST_F(TiltedFormats, OfOtherProgramsHaveAnyTiltAndCorner) {
  const std::string rest = " 4 5 6 1 0 0 0 7 8\n",
                    names = " vx vy vz mux muy muz omegax omegay omegaz";
  const auto path = [&](const std::string& tilts, const std::string& columns,
                        const std::string& numbers) {
    const State state =
        read(lammps_dump(1, columns + names, numbers + rest, "xy xz yz pp pp pp", tilts));
    EXPECT_EQ(state.box, (Vector{8, 9, 10}));
    EXPECT_EQ(state.slide, 6);
    EXPECT_EQ(state.velocity[0], (Vector{4, 5, 6}));
    return path_of(state, 0);
  };
  // xy = -2, and -18, which is two edges less; from the corner (-4, 1, 0).
  const std::string by_2 = "-6 4 -2\n1 10 0\n0 10 0\n", by_18 = "-22 4 -18\n1 10 0\n0 10 0\n";
  expect_near(path(by_2, "x y z ix iy iz", "-3 2 3 1 5 -2"), {1 + 8 - 10, 1 + 45, 3 - 20}, 1e-13);
  expect_near(path(by_18, "x y z ix iy iz", "-3 2 3 1 5 -2"), {1 + 8 - 90, 1 + 45, 3 - 20}, 1e-13);
  expect_near(path(by_18, "xs ys zs ix iy iz", "0.25 0.5 0.125 1 5 -2"),
              {2 - 9 + 8 - 90, 4.5 + 45, 1.25 - 20}, 1e-13);
  expect_near(path(by_18, "xsu ysu zsu", "-3.75 7.5 0.125"), {-30 - 135, 67.5, 1.25}, 1e-13);
  expect_near(path(by_18, "xu yu zu", "-99 -77 3.5"), {-95, -78, 3.5}, 1e-13);
  const State lattice = read(
      "1\nLattice=\"8 0 0 -18 9 0 0 0 10\" Properties=species:S:1:pos:R:3:velo:R:3:director:R:3:"
      "angular_velocity:R:3\nX 1 2 3" +
      rest);
  EXPECT_EQ(lattice.slide, 6);
  EXPECT_EQ(lattice.position[0], (Vector{1, 2, 3}));
  // A tilt so little below 0 that the slide rounds to the edge is 0.
  EXPECT_EQ(reduced_tilt(-1e-30, 8).rest, 0);
  EXPECT_EQ(reduced_tilt(-1e-30, 8).edges, 0);
}

TEST_F(TiltedFormats, AreRefusedByNameWhereTheyMeanNoSlide) {
  const std::string text = (put("a.data", {sheared_state(3, 1)}), text_of_file("a.data"));
  expect_complaints(text,
                    {{"3 0 0 xy", "3 1 0 xy", "line 9: tilt xz = 1: expected 0, as rows of boxes"},
                     {"3 0 0 xy", "3 0 1 xy", "line 9: tilt yz = 1: expected 0"},
                     {"3 0 0 xy", "x 0 0 xy", "line 9: tilt xy = x: expected a finite number"},
                     {"shear_rate=1", "shear_rate=inf", "line 1: shear_rate = inf: expected"}},
                    [&](const std::string& bad) { return complaint(bad); });
  EXPECT_EQ(
      message_of<InputError>([&] { put("a.xml", {sheared_state(3, 1)}); }),
      file("a.xml") +
          ": frame 0 is of a sheared box: expected one whose images are at rest, as the "
          "Lees-Edwards boundary of DynamO is not written; H5MD, XYZ and LAMMPS have its tilt");
}

TEST_F(TiltedFormats, OfH5mdFilesOfOtherProgramsAreSlides) {
  const std::string made = make([](HandMade& other) {
    other.put("/particles/all/box/edges", {3, 3}, {10, 0, 0, -13, 11, 0, 0, 0, 12});
    other.put("/particles/all/image", {2, 3}, {1, 2, 3, 0, -1, 0});
  });
  const State state = FrameFile(made).read(0);
  EXPECT_EQ(state.slide, 7);
  EXPECT_EQ(state.image[0], (std::array{1 - 2 * 2, 2, 3}));
  EXPECT_EQ(state.image[1], (std::array{2, -1, 0}));
}

// What the columns of a dump and its tilt say of a needle without a boundary.
std::vector<Vector> paths_in_dump(const std::string& text, std::size_t frame, const Vector& box) {
  std::istringstream lines(text);
  std::string line;
  for (std::size_t n = 0; n <= frame; ++n) {
    while (std::getline(lines, line) && !line.starts_with("ITEM: BOX BOUNDS xy xz yz")) continue;
  }
  double low = 0, high = 0, tilt = 0;
  lines >> low >> high >> tilt;
  EXPECT_GE(tilt, -box[0] / 2);
  EXPECT_LT(tilt, box[0] / 2);
  while (std::getline(lines, line) && !line.starts_with("ITEM: ATOMS")) continue;
  std::vector<Vector> out;
  while (std::getline(lines, line) && !line.starts_with("ITEM")) {
    std::istringstream words(line);
    double id, type, x, y, z, ix, iy, iz;
    words >> id >> type >> x >> y >> z >> ix >> iy >> iz;
    out.push_back({x + ix * box[0] + iy * tilt, y + iy * box[1], z + iz * box[2]});
  }
  return out;
}

// Between collisions the laboratory path is a straight line, however often needles and rows cross
// the edges: with images counted for the tilt, positions of a run lie on it.
TEST_F(TiltedFormats, FollowPathsOfARun) {
  for (const double rate : {0.9, -1.7}) {
    State start;
    start.box = {8, 9, 10};
    start.slide = 2.5;
    start.shear_rate = rate;
    // So far apart along z that they never meet.
    start.position = {{1, 2, 1}, {7, 8.5, 5}, {4, 0.1, 8}};
    start.velocity = {{1.5, 0.7, 0}, {-0.3, -1.9, 0}, {0.2, 1.2, 0}};
    start.orientation.assign(3, {1, 0, 0});
    start.angular_velocity.assign(3, {0, 0, 1});
    start.image = {{3, -1, 0}, {0, 0, 0}, {-5, 2, 7}};
    Scene scene;
    scene.needles.count = 3;
    scene.needles.box = start.box;
    scene.shear = Scene::Shear{rate};
    Simulation simulation(scene, start);
    std::vector<State> frames;
    Scene::Until until;
    std::vector<double> times;
    std::int32_t rows = 0;
    for (int n = 0; n < 40; ++n) {
      until.time = 1.7 * n;
      simulation.advance(until);
      times.push_back(simulation.totals().time);
      simulation.copy(frames.emplace_back());
      for (const auto& image : frames.back().image) rows = std::max(rows, std::abs(image[1]));
    }
    ASSERT_EQ(simulation.totals().collisions, 0u);
    ASSERT_GT(rows, 10);
    put("run.dump", frames);
    const std::string text = text_of_file("run.dump");
    const double velocity_of_rows = rate * start.box[1];
    for (std::size_t n = 0; n < frames.size(); ++n) {
      const auto paths = paths_in_dump(text, n, start.box);
      ASSERT_EQ(paths.size(), 3u);
      for (std::size_t i = 0; i < 3; ++i) {
        Vector expected = path_of(start, i);
        for (std::size_t axis = 0; axis < 3; ++axis)
          expected[axis] += start.velocity[i][axis] * times[n];
        expected[0] += start.image[i][1] * velocity_of_rows * times[n];
        expect_near(paths[i], expected, 1e-10);
        // LAMMPS's v is that of the image whose place is written, and so is that of the state.
        const double from_rows = frames[n].image[i][1] * velocity_of_rows;
        EXPECT_NEAR(frames[n].velocity[i][0] + from_rows,
                    start.velocity[i][0] + start.image[i][1] * velocity_of_rows, 1e-11);
      }
    }
  }
}

}  // namespace
}  // namespace needlework::io
