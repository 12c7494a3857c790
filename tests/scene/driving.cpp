// Scenes with [driving].
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "needlework/error.h"
#include "needlework/parse.h"
#include "tests/scene/message.h"

namespace needlework {
namespace {

using test::message;
using test::Overrides;

// Lines 1 to 2, so that more begins at line 3.
const std::string undriven = "needles = { count = 10, box = 12 }\nuntil.time = 5\n";

TEST(Driving, HasWhatTheSceneSays) {
  for (const std::string text :
       {"driving.kicks = { every = 0.5, translational = 2, rotational = 3 }\n"
        "driving.andersen = { rate = 4, temperature = 5 }\n",
        "[driving]\nkicks = { every = 0.5, translational = 2, rotational = 3 }\n"
        "andersen.rate = 4\nandersen.temperature = 5\n",
        "[driving.kicks]\nevery = 0.5\ntranslational = 2\nrotational = 3\n"
        "[driving.andersen]\nrate = 4\ntemperature = 5\n"}) {
    const Scene::Driving driving = parse_scene(undriven + text, "s.toml").driving;
    ASSERT_TRUE(driving.kicks && driving.andersen) << text;
    EXPECT_EQ(driving.kicks->every, 0.5);
    EXPECT_EQ(driving.kicks->translational, 2);
    EXPECT_EQ(driving.kicks->rotational, 3);
    EXPECT_EQ(driving.andersen->rate, 4);
    EXPECT_EQ(driving.andersen->temperature, 5);
  }
  const Scene::Driving none = parse_scene(undriven, "s.toml").driving;
  EXPECT_FALSE(none.kicks || none.andersen);
  const Scene::Driving usual = parse_scene(undriven + "driving.kicks.every = 1", "s.toml").driving;
  EXPECT_EQ(usual.kicks->translational, 0);
  EXPECT_EQ(usual.kicks->rotational, 0);
}

TEST(Driving, CanBeOverridden) {
  const Scene::Driving driving =
      parse_scene(
          undriven + "driving.kicks = { every = 0.5, translational = 2 }", "s.toml",
          Overrides{"driving.kicks.every=0.25", "driving.andersen={rate = 4, temperature = 5}"})
          .driving;
  EXPECT_EQ(driving.kicks->every, 0.25);
  EXPECT_EQ(driving.kicks->translational, 2);
  ASSERT_TRUE(driving.andersen);
  EXPECT_EQ(driving.andersen->temperature, 5);
  const std::string keys =
      "expected one of kicks.every, kicks.translational, kicks.rotational, andersen.rate, "
      "andersen.temperature, growth.rate, growth.until_packing, growth.until_pressure, "
      "growth.cool_every";
  EXPECT_EQ(message(undriven, {"driving.kicks.evry=1"}),
            "--set driving.kicks.evry=1: " + keys + ", did you mean kicks.every?");
  EXPECT_EQ(message(undriven, {"driving.kicks=1"}),
            "--set driving.kicks=1: expected {every = ..., translational = ..., rotational = ...}");
  EXPECT_EQ(message(undriven, {"driving.a.kicks.every=1"}),
            "--set driving.a.kicks.every=1: expected section.key=value");
}

TEST(Driving, HasGrowth) {
  const std::string spheres =
      "needles = { count = 10, box = 12, diameter = 0.5 }\nuntil.time = 5\n";
  const auto growth = [&](const std::string& keys) {
    return parse_scene(spheres + "driving.growth = {" + keys + "}", "s.toml").driving.growth;
  };
  const auto all = growth("rate = 0.01, until_packing = 0.6, until_pressure = 1e6, cool_every = 2");
  ASSERT_TRUE(all);
  EXPECT_EQ(all->rate, 0.01);
  EXPECT_EQ(all->until_packing, 0.6);
  EXPECT_EQ(all->until_pressure, 1e6);
  EXPECT_EQ(all->cool_every, 2);
  EXPECT_EQ(all->from, 1);
  const auto least = growth("rate = 1");
  ASSERT_TRUE(least);
  EXPECT_FALSE(least->until_packing || least->until_pressure || least->cool_every);
  EXPECT_FALSE(parse_scene(spheres, "s.toml").driving.growth);
}

TEST(BadDriving, IsRefused) {
  const std::string interval = "expected a time > 0 (from 1e-100 to 1e100)";
  const std::string rate = "expected a number > 0 of redraws per time (from 1e-100 to 1e100)";
  const std::string temperature = "expected a temperature > 0 (from 1e-200 to 1e200)";
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"kicks = { every = 1, translational = -1 }",
       "line 3: driving.kicks.translational = -1: expected a number >= 0 (at most 1e100)"},
      {"kicks = { every = 1, rotational = inf }",
       "line 3: driving.kicks.rotational = inf: expected a number >= 0 (at most 1e100)"},
      {"kicks = { translational = 1 }", "driving.kicks.every is missing: " + interval},
      {"andersen = { rate = 1, temperature = 0 }",
       "line 3: driving.andersen.temperature = 0: " + temperature},
      {"andersen = { rate = 1 }", "driving.andersen.temperature is missing: " + temperature},
      {"andersen = { temperature = 1 }", "driving.andersen.rate is missing: " + rate},
      {"growth = { until_packing = 0.6 }",
       "driving.growth.rate is missing: expected a number > 0 (from 1e-9 to 10)"},
      {"growth = { rate = 1, until_packing = 1.5 }",
       "line 3: driving.growth.until_packing = 1.5: expected a number > 0 (from 1e-9 to 1)"},
      {"growth = { rate = 1, until_pressure = 0.5 }",
       "line 3: driving.growth.until_pressure = 0.5: expected a number from 1 to 1e10"},
      {"growth = { rate = 1, cool_every = -1 }",
       "line 3: driving.growth.cool_every = -1: expected a number >= 0 (at most 1e6)"},
  };
  for (const auto& [text, expected] : cases)
    EXPECT_EQ(message(undriven + "driving." + text), "s.toml: " + expected) << text;
}

}  // namespace
}  // namespace needlework
