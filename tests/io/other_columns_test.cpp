// Columns that other programs write in place of velocities, directors and angular velocities, and
// frames other than the last.
#include <fstream>

#include "tests/io/complaints.h"
#include "tests/io/exported_files.h"
#include "tests/support/contains.h"

namespace needlework::io {
namespace {

class OtherColumns : public Formats {
 protected:
  Configuration read(const std::string& text, std::optional<std::size_t> frame = {}) const {
    std::ofstream(file("a"), std::ios::binary) << text;
    return read_configuration(file("a"), frame);
  }
};

std::string xyz_of(const std::string& columns, const std::string& row,
                   const std::string& more = "") {
  return "1\nLattice=\"9 0 0 0 9 0 0 0 9\" Properties=species:S:1:pos:R:3:" + columns + " " + more +
         "\nX 1 2 3 " + row + "\n";
}

std::string dump_of(const std::string& columns, const std::string& row, int step = 0) {
  return "ITEM: TIMESTEP\n" + std::to_string(step) +
         "\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS pp pp pp\n0 9\n0 9\n0 9\nITEM: ATOMS x y "
         "z " +
         columns + "\n1 2 3 " + row + "\n";
}

TEST_F(OtherColumns, MomentaOfASEAreDividedByMasses) {
  const std::string columns = "momenta:R:3:masses:R:1:director:R:3:angular_velocity:R:3";
  const Configuration ase = read(xyz_of(columns, "3 6 9 3 1 0 0 0 0 1"));
  EXPECT_EQ(ase.state.velocity[0], (std::array<double, 3>{1, 2, 3}));
  EXPECT_EQ(ase.material.mass, std::vector<double>{3});
  const std::string bare = "momenta:R:3:director:R:3:angular_velocity:R:3";
  EXPECT_EQ(read(xyz_of(bare, "3 6 9 1 0 0 0 0 1", "mass=3")).state.velocity[0],
            (std::array<double, 3>{1, 2, 3}));
  EXPECT_EQ(complaint(xyz_of(bare, "3 6 9 1 0 0 0 0 1")),
            "momenta without masses: expected a column of masses, or velocities");
  const std::string both = "momenta:R:3:velo:R:3:director:R:3:angular_velocity:R:3";
  EXPECT_EQ(read(xyz_of(both, "3 6 9 4 5 6 1 0 0 0 0 1")).state.velocity[0],
            (std::array<double, 3>{4, 5, 6}));
}

// A quarter turn about x takes z to -y. The other order of the same numbers is one about z.
TEST_F(OtherColumns, QuaternionsHaveTheOrderOfTheirFormat) {
  const std::string h = "0.70710678118654757";
  const std::string text = xyz_of("velo:R:3:orientation:R:4:angular_velocity:R:3",
                                  "0 0 0 " + h + " 0 0 " + h + " 0 0 2");
  const Configuration scalar_last = read(text);
  EXPECT_NEAR(scalar_last.state.orientation[0][1], -1, 1e-15);
  EXPECT_EQ(scalar_last.state.angular_velocity[0], (std::array<double, 3>{0, 0, 2}));
  EXPECT_TRUE(scalar_last.notes.empty());
  for (const char* names : {"c_q[1] c_q[2] c_q[3] c_q[4]", "quatw quati quatj quatk"}) {
    const std::string columns = "vx vy vz " + std::string(names) + " omegax omegay omegaz";
    const Configuration about_x = read(dump_of(columns, "0 0 0 " + h + " " + h + " 0 0 0 0 2"));
    EXPECT_NEAR(about_x.state.orientation[0][1], -1, 1e-15);
    const Configuration about_z = read(dump_of(columns, "0 0 0 " + h + " 0 0 " + h + " 0 3 2"));
    EXPECT_NEAR(about_z.state.orientation[0][2], 1, 1e-15);
    // Of a body that turns about its own axis as well, the rest counts.
    EXPECT_EQ(about_z.state.angular_velocity[0], (std::array<double, 3>{0, 3, 0}));
    ASSERT_EQ(about_z.notes.size(), 1u);
    EXPECT_EQ(about_z.notes[0],
              "1 of 1 bodies turn about their own axes, too: that is left out, as it changes "
              "nothing");
  }
}

TEST_F(OtherColumns, BadQuaternionsAreNamed) {
  const std::string columns = "velo:R:3:orientation:R:4:angular_velocity:R:3";
  EXPECT_TRUE(complaint(xyz_of(columns, "0 0 0 1 1 0 0 0 0 0"))
                  .starts_with("line 3: quaternion = (0, 1, 1, 0), of length 1.414"));
  EXPECT_TRUE(complaint(dump_of("vx vy vz c_a[1] c_a[2] c_a[3] c_a[4] c_b[1] c_b[2] c_b[3] c_b[4] "
                                "omegax omegay omegaz",
                                "0 0 0 1 0 0 0 1 0 0 0 0 0 0"))
                  .starts_with("line 9: several columns of four numbers, c_b[1] among them"));
}

TEST_F(OtherColumns, AngularMomentaAreDividedByMomentsOfInertia) {
  // m L^2 / (2 k) = 4 * 9 / 6 = 6
  const Configuration read_dump = read(dump_of(
      "vx vy vz mux muy muz angmomx angmomy angmomz diameter mass k", "0 0 0 1 0 0 0 12 0 3 4 3"));
  EXPECT_EQ(read_dump.state.angular_velocity[0], (std::array<double, 3>{0, 2, 0}));
  EXPECT_TRUE(read_dump.notes.empty());
  // Of a needle of which nothing is known, 1 / 12.
  const Configuration assumed =
      read(dump_of("vx vy vz mux muy muz angmomx angmomy angmomz", "0 0 0 1 0 0 0 1 0"));
  EXPECT_NEAR(assumed.state.angular_velocity[0][1], 12, 1e-13);
  EXPECT_EQ(assumed.notes.size(), 1u);
}

TEST_F(OtherColumns, AnyFrameIsRead) {
  const std::string columns = "vx vy vz mux muy muz omegax omegay omegaz";
  std::string dumps, frames;
  for (int i = 0; i < 3; ++i) {
    const std::string v = std::to_string(i);
    dumps += "ITEM: TIME\n" + v + "\n" + dump_of(columns, v + " 0 0 1 0 0 0 0 0", i);
    frames += xyz_of("velo:R:3:director:R:3:angular_velocity:R:3", v + " 0 0 1 0 0 0 0 0");
  }
  for (const std::string& text : {dumps, frames}) {
    for (std::size_t n = 0; n < 3; ++n)
      EXPECT_EQ(read(text, n).state.velocity[0][0], static_cast<double>(n));
    EXPECT_EQ(read(text).state.velocity[0][0], 2);
    EXPECT_EQ(message_of<InputError>([&] { read(text, 3); }),
              file("a") + ": frame 3: expected one below 3, as there are so many frames");
    // Cut short in the last line.
    const std::string cut = text.substr(0, text.size() - 6);
    EXPECT_EQ(read(cut, 1).state.velocity[0][0], 1);
    const std::string message = message_of<InputError>([&] { read(cut); });
    EXPECT_TRUE(test::contains(message, "cut short in line "));
    EXPECT_TRUE(
        message.ends_with("; the 2 frames before it are whole: --frame 1 reads the last of "
                          "them"))
        << message;
    // And before it.
    const std::string shorter = text.substr(0, text.rfind('\n', text.size() - 2) + 1);
    const std::string other = message_of<InputError>([&] { read(shorter); });
    EXPECT_TRUE(test::contains(other, "cut short after line "));
    EXPECT_TRUE(other.ends_with("--frame 1 reads the last of them")) << other;
  }
}

TEST_F(OtherColumns, FormatsOfOneFrameHaveTheFirst) {
  put("a.data", {make_state(2)});
  EXPECT_EQ(read_configuration(file("a.data"), 0).state.size(), 2u);
  EXPECT_THROW(read_configuration(file("a.data"), 1), InputError);
}

}  // namespace
}  // namespace needlework::io
