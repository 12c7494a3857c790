// Configurations of DynamO: what is read from them, what is refused, and what is written.
#include "src/io/formats/dynamo.h"

#include <fmt/format.h>

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <fstream>
#include <random>

#include "src/io/formats/input_text.h"
#include "tests/io/complaints.h"
#include "tests/io/compressed.h"
#include "tests/io/dynamo_text.h"
#include "tests/io/support.h"

namespace needlework::io {
namespace {

using Vectors = std::vector<std::array<double, 3>>;
using Many = boost::multiprecision::cpp_bin_float_50;

class Dynamo : public InFolder {
 protected:
  std::string put(const std::string& text, const std::string& name = "a.xml") const {
    std::ofstream(file(name), std::ios::binary) << text;
    return file(name);
  }
  Configuration read(const std::string& text) const { return read_dynamo(put(text)); }

  // What is said of a text, without the name of the file.
  std::string complaint(const std::string& text) const {
    const std::string path = put(text);
    const std::string message = message_of<InputError>([&] { read_dynamo(path); });
    EXPECT_TRUE(message.starts_with(path + ": ")) << message;
    return message.substr(std::min(message.size(), path.size() + 2));
  }
};

TEST_F(Dynamo, ConfigurationIsReadWithoutRescaling) {
  const Configuration read = this->read(dynamo_text);
  EXPECT_EQ(read.material.names, std::vector<std::string>{"Bulk"});
  EXPECT_EQ(read.material.length, std::vector<double>{2});
  EXPECT_EQ(read.material.mass, std::vector<double>{2});
  EXPECT_EQ(read.material.k, std::vector<double>{6});  // m L^2 / (2 I) = 2 * 4 / (2 * 2/3)
  EXPECT_EQ(read.material.epsilon, std::vector<double>{0.9});
  EXPECT_EQ(read.material.beta, std::vector<double>{-1});
  EXPECT_EQ(read.state.box, (std::array<double, 3>{8, 9, 10.5}));
  EXPECT_EQ(read.state.position, (Vectors{{-3.9, 0.1, 5.249999999999999}, {1, 2, -3}}));
  EXPECT_EQ(read.state.velocity, (Vectors{{0.1, -2, 0.001}, {0.3, 0.2, -0.1}}));
  EXPECT_EQ(read.state.orientation, (Vectors{{1, 0, 0}, {0, 0, 1}}));
  EXPECT_EQ(read.state.angular_velocity, (Vectors{{0, 1.5, 0}, {0.1, 0.2, 0}}));
}

TEST_F(Dynamo, DecimalsBecomeTheNearestDoubles) {
  for (const auto& [decimal, value] :
       {std::pair("9007199254740993", 9007199254740992.0),  // half way: to even
        std::pair("9007199254740993.00000000000000000000001", 9007199254740994.0),
        std::pair("2.2250738585072011e-308", 0x0.fffffffffffffp-1022),
        std::pair("4.9406564584124654e-324", 0x1p-1074),
        std::pair("1.7976931348623157e+308", 0x1.fffffffffffffp1023),
        std::pair("-1.23456789012345678e-05", -1.23456789012345678e-05), std::pair("+0.1", 0.1)}) {
    const std::string text = replaced(dynamo_text, "x=\"0.3\"", fmt::format("x=\"{}\"", decimal));
    EXPECT_EQ(read(text).state.velocity[1][0], value) << decimal;
  }
}

// By arithmetic of 50 digits.
std::array<Many, 3> exact_director(const std::array<double, 4>& q) {
  const Many w = q[0], x = q[1], y = q[2], z = q[3];
  const Many square = w * w + x * x + y * y + z * z;
  return {2 * (x * z + w * y) / square, 2 * (y * z - w * x) / square,
          (w * w + z * z - x * x - y * y) / square};
}

TEST_F(Dynamo, DirectorsAreThoseOfTheQuaternionsWithinARounding) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 300; ++i) {
    // Of any size, and some that nearly turn into a coordinate plane.
    std::array<double, 4> q;
    for (double& component : q) component = normal(random) * std::pow(10, i % 7 - 3);
    if (i % 3 == 0) q[i % 4] = 1e-17;
    std::string text =
        replaced(dynamo_text, "x=\"0\" y=\"0\" z=\"0\" w=\"1\"",
                 fmt::format("x=\"{}\" y=\"{}\" z=\"{}\" w=\"{}\"", q[1], q[2], q[3], q[0]));
    text = replaced(text, "<O x=\"0.1\" y=\"0.2\" z=\"0\"/>", "<O x=\"0\" y=\"0\" z=\"0\"/>");
    const auto director = read(text).state.orientation[1];
    const auto exact = exact_director(q);
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_LE(abs(director[axis] - exact[axis]), 4 * Many(0x1p-53)) << "quaternion " << i;
    }
  }
}

TEST_F(Dynamo, FilesOfEarlierProgramsAreRead) {
  std::string text = replaced(dynamo_text, R"(Type="Lines">
        <IDRange Type="All"/>
      </Species>)",
                              R"(IntName="Bulk" Type="SphericalTop" Range="All"/>)");
  text = replaced(text, R"(<IDPairRange Type="All"/>)", "");
  text = replaced(text, R"(Elasticity="0.9")", R"(Elasticity="0.9" Range="2All")");
  text = replaced(text, R"(x="0" y="0" z="0" w="1")", R"(x="0" y="0" z="2")");
  text = replaced(text, " w=\"7.07106781186547573e-01\"", "");
  text = replaced(text, "<O x=\"0\" y=\"1.5\" z=\"0\"/>", "<O x=\"0\" y=\"0\" z=\"3\"/>");
  const Configuration read = this->read(text);
  EXPECT_EQ(read.material.k, std::vector<double>{6});
  EXPECT_EQ(read.state.orientation, (Vectors{{0, 1, 0}, {0, 0, 1}}));
}

// A wall with this normal, through z or, for one along x, x.
std::string wall(double x, double y, double z, double place, double epsilon,
                 const std::string& more = "") {
  return fmt::format(
      "<Local Type=\"Wall\" Name=\"W\" Elasticity=\"{}\" Diameter=\"2\"{}>"
      "<IDRange Type=\"All\"/><Norm x=\"{}\" y=\"{}\" z=\"{}\"/>"
      "<Origin x=\"{}\" y=\"0\" z=\"{}\"/></Local>",
      epsilon, more, x, y, z, x != 0 ? place : 0, x != 0 ? 0 : place);
}

TEST_F(Dynamo, WallsAndGravityAreRead) {
  std::string text =
      replaced(dynamo_text, "<Locals/>",
               "<Locals>" + wall(0, 0, 2, -6, 0.5) + wall(0, 0, -1, 6.5, 0, " Temperature=\"3\"") +
                   wall(-1, 0, 0, 4.5, 0.25) + "</Locals>");
  text = replaced(text, "\"PBC\"", "\"NoXPBC\"");
  text = replaced(text, "<Dynamics Type=\"Newtonian\"/>",
                  "<Dynamics Type=\"NewtonianGravity\" tc=\"0.125\"><g x=\"1\" y=\"0\" "
                  "z=\"-2\"/></Dynamics>");
  const Configuration read = this->read(text);
  EXPECT_EQ(read.state.periodic, (std::array{false, true, false}));
  // Along z between the walls; along x the wall is at the edge.
  EXPECT_EQ(read.state.box, (std::array<double, 3>{8, 9, 12.5}));
  EXPECT_EQ(read.state.position[1], (std::array<double, 3>{1 + 3.5, 2, 3}));
  ASSERT_EQ(read.material.walls.size(), 3u);
  const auto& [low, high, x] =
      std::tie(read.material.walls[0], read.material.walls[1], read.material.walls[2]);
  EXPECT_EQ(low.axis + low.side, "zlow");
  EXPECT_EQ(low.epsilon, 0.5);
  EXPECT_EQ(high.axis + high.side, "zhigh");
  EXPECT_EQ(high.temperature, 3);
  EXPECT_EQ(x.axis + x.side, "xhigh");
  EXPECT_EQ(x.epsilon, 0.25);
  EXPECT_EQ(read.material.gravity, (std::array<double, 3>{1, 0, -2}));
  EXPECT_EQ(read.contact_time, 0.125);
  EXPECT_EQ(read.notes.size(), 1u);
}

TEST_F(Dynamo, WallsAndGravityAreWrittenAndReadAgain) {
  Material material{.length = {1}, .mass = {2}, .k = {6}, .epsilon = {0.75}};
  Frame frame;
  frame.state = make_state(50, 5);
  const auto written = [&](std::vector<Scene::Wall> walls) {
    material.walls = std::move(walls);
    Scene scene;
    scene.walls = material.walls;
    frame.state.periodic = scene.periodic();
    const auto writer = write_dynamo(file("a.xml"), true, material);
    writer->add(frame);
    writer->publish();
    return read_dynamo(file("a.xml"));
  };
  material.gravity = {0, 0, -1.5};
  Scene::Wall z, y, x;
  z.axis = "z", z.side = "both", z.epsilon = 0.5;
  y.axis = "y", y.side = "low", y.temperature = 2.5;
  x.axis = "x", x.side = "high", x.epsilon = 0;
  for (const auto& walls : {std::vector{z}, {x}, {y, z}, {z, y, x}}) {
    const Configuration read = written(walls);
    const auto expected = single_walls(walls);
    EXPECT_EQ(read.state.periodic, frame.state.periodic);
    EXPECT_EQ(read.state.box, frame.state.box);
    EXPECT_EQ(read.material.gravity, material.gravity);
    ASSERT_EQ(read.material.walls.size(), expected.size());
    for (std::size_t n = 0; n < expected.size(); ++n) {
      EXPECT_EQ(read.material.walls[n].axis, expected[n].axis);
      EXPECT_EQ(read.material.walls[n].side, expected[n].side);
      EXPECT_EQ(read.material.walls[n].epsilon, expected[n].epsilon);
      EXPECT_EQ(read.material.walls[n].temperature, expected[n].temperature);
    }
    for (std::size_t i = 0; i < 50; ++i) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(read.state.position[i][axis], frame.state.position[i][axis], 1e-14);
      }
    }
  }
  const std::string path = file("a.xml");
  EXPECT_EQ(message_of<InputError>([&] { written({y}); }),
            path +
                ": an open side along y: expected walls at both ends, as DynamO has no boundary "
                "that is open along this axis and periodic along the others");
  Scene::Wall moving = z;
  const auto complaint = [&](const std::string& does) {
    return path + ": the wall z-low " + does +
           ": expected walls at rest, as in a configuration of DynamO";
  };
  for (const Scene::WallMotion& motion :
       {Scene::WallMotion{.amplitude = 0.1}, Scene::WallMotion{.velocity = -1}}) {
    moving.motion = motion;
    EXPECT_EQ(message_of<InputError>([&] { written({moving}); }), complaint("moves"));
  }
  moving.motion = Scene::WallMotion{.tangential = std::array<double, 2>{0, 1}};
  moving.temperature = 1;
  EXPECT_EQ(message_of<InputError>([&] { written({moving}); }), complaint("slides"));
}

TEST_F(Dynamo, WhatNeedlesDoNotHaveIsNamed) {
  const auto locals = [](const std::string& walls) { return "<Locals>" + walls + "</Locals>"; };
  const std::string oblique = locals(wall(0, 1, 1, 0, 1)), lively = locals(wall(0, 0, 1, -4, 2)),
                    single = locals(wall(0, 0, 1, -4, 1)),
                    twice = locals(wall(0, 0, 1, -4, 1) + wall(0, 0, 1, -3, 1)),
                    apart = locals(wall(0, 0, 1, 4, 1) + wall(0, 0, -1, -4, 1));
  expect_complaints(
      dynamo_text,
      {
          {"1.5.0", "1.4.0", "line 2: DynamOconfig version = 1.4.0: expected 1.5.0"},
          {"<DynamOconfig", "<!-- --><Dyn",
           "line 45: not well-formed XML: Start-end tags mismatch"},
          {"\"PBC\"", "\"LE\"", "line 13: BC Type = LE: expected PBC"},
          {"\"PBC\"", "\"None\"", "line 13: BC: not periodic along x, without a wall: expected"},
          {"Type=\"Newtonian\"", "Type=\"Compression\"",
           "line 28: Dynamics Type = Compression: expected Newtonian or NewtonianGravity"},
          {"Type=\"Newtonian\"", "Type=\"NewtonianGravity\"", "line 28: Dynamics: "},
          {"<Dynamics Type=\"Newtonian\"/>",
           "<Dynamics Type=\"NewtonianGravity\" ElasticV=\"1\"><g x=\"0\" y=\"0\" "
           "z=\"-1\"/></Dynamics>",
           "line 28: Dynamics ElasticV = 1: expected 0"},
          {"<SystemEvents/>",
           "<SystemEvents><System Type=\"Andersen\" Name=\"Thermostat\"/></SystemEvents>",
           "line 27: System: cannot be carried over: expected none in SystemEvents"},
          {"<Locals/>", "<Locals><Local Type=\"OscillatingPlate\"/></Locals>",
           "line 23: Local Type = OscillatingPlate: expected Wall"},
          {"<Locals/>", oblique.c_str(),
           "line 23: Norm: (0, 1, 1): expected a normal along x, y or z"},
          {"<Locals/>", lively.c_str(),
           "line 23: Local Elasticity = 2: expected a number from 0 to 1"},
          {"<Locals/>", single.c_str(),
           "line 13: BC: periodic along z, with one wall: expected two walls, or a boundary"},
          {"<Locals/>", twice.c_str(), "line 23: Local: a second wall with this normal"},
          {"<Locals/>", apart.c_str(),
           "line 23: Locals: walls along z at 4 and -4: expected the one with the normal along +z"},
          {"\"Cells\"", "\"Waker\"", "line 25: Global Type = Waker: expected Cells"},
          {"<Topology/>", "<Topology><Structure Type=\"Chain\"/></Topology>",
           "line 14: Structure: cannot be carried over: expected none in Topology"},
          {"Type=\"Lines\" Length", "Type=\"HardSphere\" Length",
           "line 16: Interaction Type = HardSphere: expected Lines, as of particles that turn"},
          {"</Interactions>", "<Interaction Type=\"SquareWell\"/></Interactions>",
           "line 22: Interaction Type = SquareWell: expected Lines"},
          {"</Interactions>", "<Interaction Type=\"Lines\"/></Interactions>",
           "line 22: Interaction: IDPairRange is missing: expected one"},
          {"IDPairRange Type=\"All\"", "IDPairRange Type=\"Self\"",
           "line 17: IDPairRange Type = Self: expected All"},
          {"Name=\"Bulk\" Type=\"Lines\">", "Name=\"Bulk\" Type=\"Point\">",
           "line 16: Interaction Type = Lines: expected HardSphere, as of points"},
          {"Name=\"Bulk\" Type=\"Lines\">", "Name=\"Bulk\" Type=\"FixedCollider\">",
           "line 9: Species Type = FixedCollider: expected SphericalTop, Lines or Point"},
          {"Mass=\"2\"", "Mass=\"M\"",
           "line 9: Species Mass = M: expected a finite number, the same for all particles"},
          {"Length=\"2\"", "Length=\"L\"", "line 16: Interaction Length = L: expected a finite"},
          {"<Properties/>", "<Properties><Property Type=\"PerParticle\" Name=\"M\"/></Properties>",
           "line 30: Property: cannot be carried over: expected none in Properties"},
          {"<Pt ID=\"0\"", "<Pt ID=\"0\" M=\"1\"",
           "line 32: Pt: attribute M cannot be carried over: expected ID"},
          {"<Pt ID=\"0\"", "<Pt ID=\"0\" Static=\"Static\"",
           "line 32: Pt Static = Static: expected none: all needles move"},
          {" OrientationData=\"Y\"", "",
           "line 31: ParticleData: OrientationData is missing: expected OrientationData="},
          {"<Dynamics Type=\"Newtonian\"/>", "<Dynamics Type=\"Newtonian\"/><Umbrella/>",
           "line 28: Umbrella: cannot be carried over: expected Scheduler"},
      },
      [&](const std::string& bad) { return complaint(bad); });
}

TEST_F(Dynamo, BadNumbersAndCountsAreNamed) {
  expect_complaints(
      dynamo_text,
      {
          {"x=\"0.3\"", "x=\"nan\"", "line 40: V x = nan: expected a finite number"},
          {"x=\"0.3\"", "x=\"-inf\"", "line 40: V x = -inf: expected a finite number"},
          {"x=\"0.3\"", "x=\"1e999\"",
           "line 40: V x = 1e999: expected a number that a double can hold"},
          {"x=\"0.3\"", "x=\"0.3 \"", "line 40: V x = 0.3 : expected a finite number"},
          {"x=\"0.3\"", "x=\"\"", "line 40: V x = : expected a finite number"},
          {"x=\"0.3\"", "x=\"0x1p3\"", "line 40: V x = 0x1p3: expected a finite number"},
          {"x=\"0.3\" ", "", "line 40: V: x is missing: expected this attribute"},
          {"x=\"0.3\"", "x=\"0.3\" x=\"0.4\"", "line 40: V: x is given twice: expected it once"},
          {"y=\"9\"", "y=\"0\"", "line 7: SimulationSize y = 0: expected a number > 0"},
          {"y=\"9\"", "y=\"-9\"", "line 7: SimulationSize y = -9: expected a number > 0"},
          {"Mass=\"2\"", "Mass=\"0\"", "line 9: Species Mass = 0: expected a number > 0"},
          {"\"3.33333333333333315e-01\"", "\"0\"", "line 9: Species InertiaConstant = 0: "},
          {"Length=\"2\"", "Length=\"-2\"", "line 16: Interaction Length = -2: expected a "},
          {"\"0.9\"", "\"1.1\"", "line 16: Interaction Elasticity = 1.1: expected a number from"},
          {" Elasticity=\"0.9\"", "",
           "line 16: Interaction: Elasticity is missing: expected a number"},
          {"<Pt ID=\"1\"", "<Pt ID=\"0\"", "line 38: Pt ID = 0: expected 1: particles are "},
          {"OrientationData", "N=\"3\" OrientationData",
           "line 31: ParticleData N = 3: expected 2, the number of particles"},
          {"<Pt ID=\"1\"", "<Pt ID=\"2\"", "line 38: Pt ID = 2: expected 1: particles are "},
          {"<V x=\"0.3\" y=\"0.2\" z=\"-0.1\"/>", "", "line 38: Pt: V is missing: expected one"},
          {"<V x=\"0.3\"", "<V x=\"1\" y=\"1\" z=\"1\"/><V x=\"0.3\"",
           "line 40: V: the second: expected one"},
          {"w=\"1\"", "w=\"0\"", "line 42: U: of size 0: expected a direction"},
          {"<O x=\"0.1\" y=\"0.2\" z=\"0\"/>", "<O x=\"0\" y=\"0\" z=\"1\"/>",
           "line 41: O: 1 of its length is along the director: expected none"},
          {"</Pt>", "2.5</Pt>", "line 32: Pt: text '2.5': expected elements only"},
          {"w=\"1\"/>", "w=\"1\"/><Director x=\"0\" y=\"0.6\" z=\"0.8\"/>",
           "line 42: Director: (0, 0.6, 0.8): expected (0, 0, 1), to which U turns"},
      },
      [&](const std::string& bad) { return complaint(bad); });
}

TEST_F(Dynamo, EntitiesOfTheirOwnAreRefused) {
  const std::string laughs = R"(<!DOCTYPE a [<!ENTITY l "lol"><!ENTITY m "&l;&l;&l;&l;">]>
<DynamOconfig)";
  EXPECT_EQ(complaint(replaced(dynamo_text, "<DynamOconfig", laughs)),
            "a document type (<!DOCTYPE ...>): expected none");
  EXPECT_EQ(complaint(replaced(dynamo_text, "x=\"0.3\"", "x=\"&m;\"")),
            "line 40: V x = &m;: expected a finite number");
}

TEST_F(Dynamo, AngularVelocitiesAreProjectedWhereRoundingExplainsIt) {
  const Configuration read = this->read(replaced(dynamo_text, "<O x=\"0.1\" y=\"0.2\" z=\"0\"/>",
                                                 "<O x=\"0.1\" y=\"0.2\" z=\"0.0001\"/>"));
  EXPECT_EQ(read.roundings.needles, 1u);
  EXPECT_NEAR(read.roundings.largest, 4.5e-4, 1e-5);
  const auto& w = read.state.angular_velocity[1];
  EXPECT_EQ(w[0], 0.1);
  EXPECT_EQ(w[1], 0.2);
  EXPECT_NEAR(w[2], 0, 1e-18);
}

TEST_F(Dynamo, FilesThatAreCutShortAreRefused) {
  const std::size_t end = dynamo_text.rfind("</DynamOconfig>") + 15;
  for (std::size_t size = 0; size < end; size += size < end - 40 ? 17 : 1) {
    EXPECT_FALSE(complaint(dynamo_text.substr(0, size)).empty()) << size;
  }
  const std::string bytes = compressed(dynamo_text);
  for (std::size_t size = 3; size < bytes.size(); size += 23) {
    EXPECT_EQ(complaint(bytes.substr(0, size)), "cut short: expected a complete bzip2 file")
        << size;
  }
}

TEST_F(Dynamo, DamagedFilesAreRefused) {
  std::string bytes = compressed(dynamo_text);
  bytes[bytes.size() / 2] ^= 1;
  EXPECT_EQ(complaint(bytes), "damaged: expected a bzip2 file");
  std::mt19937_64 random(3);
  for (int i = 0; i < 300; ++i) {
    // Whatever it is, it is read or refused.
    std::string text = dynamo_text;
    for (int j = 0; j < 3; ++j) text[random() % text.size()] = static_cast<char>(random());
    const std::string path = put(text);
    try {
      read_dynamo(path);
    } catch (const InputError&) {
    }
  }
  EXPECT_TRUE(complaint(std::string(100000, '<')).starts_with("line 1: not well-formed XML"));
  std::string deep;
  for (int i = 0; i < 100000; ++i) deep += "<a>";
  EXPECT_TRUE(complaint(deep).starts_with("line 1: not well-formed XML"));
}

TEST_F(Dynamo, CompressedFilesAreReadWhateverTheirName) {
  const Configuration plain = read(dynamo_text);
  expect_same(read_dynamo(put(compressed(dynamo_text), "a.xml.bz2")).state, plain.state);
  expect_same(read_dynamo(put(compressed(dynamo_text), "b")).state, plain.state);
  // bzip2 files may be joined.
  const std::string halves =
      compressed(dynamo_text.substr(0, 700)) + compressed(dynamo_text.substr(700));
  expect_same(read_dynamo(put(halves, "c.xml.bz2")).state, plain.state);
}

TEST_F(Dynamo, FilesThatExplodeAreRefused) {
  const std::string bomb = compressed(std::string(std::size_t{70} << 20, ' '));
  ASSERT_LT(bomb.size(), 1000u);
  EXPECT_EQ(complaint(bomb),
            fmt::format("more than 67108864 bytes when decompressed: expected less, "
                        "from {} compressed bytes",
                        bomb.size()));
  const std::string path = put(std::string(1001, 'x'));
  EXPECT_EQ(message_of<InputError>([&] { read_text_file(path, 1000); }),
            path + ": 1001 bytes: expected at most 1000");
}

}  // namespace
}  // namespace needlework::io
