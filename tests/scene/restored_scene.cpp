// A scene that was restored from a file has to be one that a scene file could describe.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <set>
#include <string>

#include "needlework/error.h"
#include "needlework/parse.h"
#include "src/scene/scene_values.h"
#include "src/scene/schema.h"
#include "src/scene/validity.h"
#include "tests/scene/message.h"
#include "tests/support/contains.h"

namespace needlework {
namespace {

const char* const rich = R"(title = "all kinds of keys"
needles = { count = 20, box = [7, 8, 9], k = 5, seed = 12 }
initial = { t_tr = 2, t_rot = 3 }
collisions = { epsilon = 0.9, beta = 0.1, tc = 0.01 }
until = { time = 3, collisions_per_needle = 5, energy_ratio = 0.1, wall_s = 7 }
[engine]
search = "capsules"
queue = "bucket"
accuracy = "rigorous"
isolation = "bounds"
escalation = "never"
filter = "float"
root_tolerance = 1e-9
sampling_step = 0.1
threads = 2
isa = "avx2"
cell_side = 2
capsule_radius = 0.3
storage = "by-id"
[output]
file = "a.h5"
series_every = 0.1
frames_every = 0.5
observables = ["fields"]
grid = [2, 3, 4]
size_classes = 3
events = true
checkpoint_every = 17
)";
const char* const species = R"(needles.box = 9
until.time = 1
species = [{ name = "a", count = 7, length = 0.5, mass = 3, k = 2, t_tr = 2, t_rot = 0 }]
pairs = [{ between = ["a", "a"], epsilon = 0.5, beta = 0 }]
)";

const char* const effects = R"(
needles = { count = 20, box = 9 }
forces.gravity = [0, 0, -1]
driving.kicks = { every = 0.1, translational = 2, rotational = 3 }
until.time = 1
[[walls]]
axis = "z"
side = "low"
epsilon = 0.5
motion = { amplitude = 0.1, frequency = 2, phase = 1 }
[[walls]]
axis = "z"
side = "high"
temperature = 3
)";

// Each number that may be drawn, by a distribution with a mean and by a power law.
std::string drawn_species() {
  const std::string cut =
      R"( = { distribution = "lognormal", mean = 1, width = 0.1, min = 0.5, max = 2 })";
  const std::string power = R"( = { distribution = "powerlaw", min = 1, max = 2, exponent = 2 })";
  std::string out = "needles.box = 9\nuntil.time = 1\n";
  const auto add = [&](const std::string& numbers) {
    out += fmt::format("[[species]]\nname = \"{}\"\ncount = 3\n{}\n", out.size(), numbers);
  };
  for (const std::string& how : {cut, power}) {
    for (const char* number : {"length", "mass", "k", "inertia"}) add(number + how);
    add("diameter" + how);
  }
  add("diameter = { aspect = 3 }\nmass = { density = 2 }");
  add("fixed = true\noverlap = true");
  return out;
}

TEST(RestoredScene, HasAllKeys) {
  const std::string drawn = drawn_species();
  std::set<std::string> seen;
  for (const char* text : {rich, species, effects, drawn.c_str(),
                           "needles = { count = 1, box = 3 }\nuntil.time = 1\n"
                           "driving.andersen = { rate = 0.5, temperature = 2 }\n"
                           "shear = { rate = 0.1, offset = 2 }",
                           "needles = { count = 1, box = 3, diameter = 0.1 }\nuntil.time = 1\n"
                           "driving.growth = { rate = 0.5, until_packing = 0.4, "
                           "until_pressure = 9, cool_every = 3 }\n",
                           "needles = { count = 1, box = 3 }\nuntil.time = 1\n"
                           "[[walls]]\naxis = 'z'\nside = 'high'\n"
                           "motion = { velocity = -1, stop_at = 2 }\n"
                           "[[walls]]\naxis = 'z'\nside = 'low'\ntemperature = 1\n"
                           "motion = { tangential = [1, 2] }\n",
                           "needles.box = 3\nuntil.time = 1\ncollisions.beta = 0\n"
                           "[[species]]\nname = 'a'\ncount = 1\nlength = 0\ndiameter = 1\n"
                           "inertia = 0.1\n",
                           "needles = { count = 1, box = 3 }\nuntil.time = 1\n"
                           "initial.file = \"state.h5\"\n"
                           "collisions.tc_relative = 1"}) {
    const Scene scene = parse_scene(text, "scene.toml");
    EXPECT_NO_THROW(require_restored(scene)) << text;
    for (const auto& [section, key, value] : values_of(scene)) {
      seen.insert(std::string(section) + "." + std::string(key));
    }
  }
  for (const SceneKey& key : scene_keys()) {
    EXPECT_TRUE(seen.contains(std::string(key.section) + "." + std::string(key.key))) << key.key;
  }
}

TEST(RestoredScene, IsAcceptedIfItWasParsed) {
  for (const auto& file : std::filesystem::directory_iterator(NEEDLEWORK_SOURCE "/profiles")) {
    if (file.path().extension() != ".toml" ||
        file.path().string().find("sweep") != std::string::npos)
      continue;
    EXPECT_NO_THROW(require_restored(read_scene(file.path().string()))) << file.path();
  }
}

// Beside what OneValidity.OfACheckpoint refuses.
TEST(RestoredScene, IsRefusedIfNoFileCouldDescribeIt) {
  const auto complaint = [](const char* text, auto&& change) -> std::string {
    Scene scene = parse_scene(text, "scene.toml");
    change(scene);
    return test::refusal([&] { require_restored(scene); });
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto expect = [&](const char* part, const char* text, auto&& change) {
    const std::string found = complaint(text, change);
    EXPECT_TRUE(test::contains(found, part)) << " of ";
  };
  EXPECT_EQ(complaint(rich, [](Scene&) {}), "no error");
  expect("title = ", rich, [](Scene& s) { s.title = "\x1b[2J"; });
  expect("needles.count = ", rich, [](Scene& s) { s.needles.count = ~std::uint64_t{0}; });
  expect("needles.box = ", rich, [&](Scene& s) { s.needles.box[1] = nan; });
  expect("until.time = ", rich, [&](Scene& s) { s.until.time = nan; });
  expect("output.frames = ", rich, [](Scene& s) { s.output.frame_times = {2, 1}; });
  expect("output.grid = ", rich, [](Scene& s) { s.output.grid = {10000, 10000, 1}; });
  expect("output.observables = ", rich, [](Scene& s) { s.output.observables = {"x"}; });
  expect("species: expected the count", species, [](Scene& s) { s.needles.count = 8; });
  expect("pairs.epsilon = ", species, [](Scene& s) { s.pairs[0].epsilon = 2; });
  expect("walls.axis = ", effects, [](Scene& s) { s.walls[1].axis = "w"; });
  expect("walls.motion.frequency = ", effects, [](Scene& s) { s.walls[0].motion->frequency = 0; });
  expect("forces.gravity = ", effects, [&](Scene& s) { s.forces.gravity[0] = nan; });
  expect("text: expected", rich, [](Scene& s) { s.text.resize(max_scene_bytes + 1); });
}

}  // namespace
}  // namespace needlework
