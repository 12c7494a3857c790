// Overrides of the form section.key=value, as given to --set.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "needlework/error.h"
#include "needlework/parse.h"
#include "tests/scene/message.h"

namespace needlework {
namespace {

using test::Overrides;

const std::string least_scene = "needles.count = 10\nneedles.box = 4\nuntil.time = 5\n";

Scene parse(const Overrides& overrides, const std::string& more = "") {
  return parse_scene(least_scene + more, "s.toml", overrides);
}

std::string message_of_overrides(const Overrides& overrides, const std::string& more = "") {
  return test::message(least_scene + more, overrides);
}

TEST(Override, ReplacesOrAddsAKey) {
  const Scene scene = parse({"needles.count=7", "collisions.epsilon = 0.5", "needles.box=[3,4,5]"});
  EXPECT_EQ(scene.needles.count, 7u);
  EXPECT_EQ(scene.needles.box, (std::array{3.0, 4.0, 5.0}));
  EXPECT_EQ(scene.collisions.epsilon, 0.5);
}

TEST(Override, TakesABareWordForAString) {
  EXPECT_EQ(parse({"engine.search=all-pairs"}).engine.search, "all-pairs");
  EXPECT_EQ(parse({"engine.search=\"all-pairs\""}).engine.search, "all-pairs");
  EXPECT_EQ(parse({"output.file=out/run#1 = b.h5"}).output.file, "out/run#1 = b.h5");
  EXPECT_EQ(parse({"output.file="}, "output.file = 'x'").output.file, "");
  EXPECT_EQ(parse({"output.events=true"}).output.events, true);
}

TEST(Override, LastOneForAKeyCounts) {
  EXPECT_EQ(parse({"needles.count=-1", "needles.count=8"}).needles.count, 8u);
}

TEST(Override, HidesABadValueInTheFile) {
  EXPECT_EQ(parse({"needles.k=3"}, "needles.k = -1").needles.k, 3);
}

TEST(Override, SuppliesWhatIsMissing) {
  const Scene scene =
      parse_scene("", "s.toml", Overrides{"needles.count=1", "needles.box=4", "until.wall_s=1"});
  EXPECT_EQ(scene.needles.count, 1u);
}

TEST(Override, OfAnAlternativeReplacesTheChoiceOfTheFile) {
  const Scene absolute = parse({"collisions.tc=0.1"}, "collisions.tc_relative = 1e-3");
  EXPECT_EQ(absolute.collisions.tc, 0.1);
  EXPECT_FALSE(absolute.collisions.tc_relative);
  const Scene relative = parse({"collisions.tc_relative=0.1"}, "collisions.tc = 1e-3");
  EXPECT_EQ(relative.collisions.tc_relative, 0.1);
  EXPECT_FALSE(relative.collisions.tc);
  const Scene linear = parse({"output.series_every=2"}, "output.series_per_decade = 5");
  EXPECT_EQ(linear.output.series_every, 2);
  const Scene logarithmic = parse({"output.series_per_decade=5"}, "output.series_every = 2");
  EXPECT_EQ(logarithmic.output.series_per_decade, 5);
  EXPECT_FALSE(logarithmic.output.series_every);
  const Scene even = parse({"output.frames_every=2"}, "output.frames = [1, 2]");
  EXPECT_EQ(even.output.frames_every, 2);
  EXPECT_TRUE(even.output.frame_times.empty());
  const Scene restart = parse({"initial.file=a.h5"}, "initial = {t_tr = 2, t_rot = 0}");
  EXPECT_EQ(restart.initial.file, "a.h5");
  EXPECT_EQ(restart.initial.t_tr, 1);
}

TEST(Override, RemovesAnEnd) {
  const Scene scene = parse({"until.energy_ratio=none"}, "until.energy_ratio = 0.5");
  EXPECT_FALSE(scene.until.energy_ratio);
  EXPECT_EQ(parse({"until.energy_ratio=none", "until.energy_ratio=0.2"}).until.energy_ratio, 0.2);
  EXPECT_EQ(message_of_overrides({"until.end=none"}).substr(0, 47),
            "--set until.end=none: expected one of time, col");
  EXPECT_EQ(message_of_overrides({"collisions.tc=none"}, "collisions.tc = 1").substr(0, 40),
            "--set collisions.tc=none: expected a tim");
}

// Also of a run that is resumed.
TEST(Override, OfAnEndIsRefusedWhereTheSceneCannotHaveIt) {
  Scene scene = parse({},
                      "forces.gravity = [1, 0, 0]\n[[walls]]\naxis = 'z'\nside = 'both'\n"
                      "temperature = 2\n");
  override_until(scene, Overrides{"until.time=6"});
  EXPECT_EQ(scene.until.time, 6);
  EXPECT_EQ(test::refusal([&] { override_until(scene, Overrides{"until.energy_ratio=0.1"}); }),
            "--set until.energy_ratio=0.1: expected another end, such as time: gravity along a "
            "periodic axis does work all the time, which thermal walls take out");
}

TEST(Override, CannotChooseBothAlternatives) {
  EXPECT_EQ(message_of_overrides({"collisions.tc=0.1", "collisions.tc_relative=1"}),
            "--set collisions.tc_relative=1: expected either tc or tc_relative, not both");
  EXPECT_EQ(message_of_overrides({}, "output.series_every = 1\noutput.series_per_decade = 2"),
            "s.toml: line 5: output.series_per_decade = 2: expected either series_per_decade or "
            "series_every, not both");
  EXPECT_EQ(message_of_overrides({}, "output.frames = 1\noutput.frames_every = 2"),
            "s.toml: line 5: output.frames_every = 2: expected either frames or frames_every, not "
            "both");
  EXPECT_EQ(message_of_overrides({"initial.t_tr=1"}, "initial.file = 'a.h5'"),
            "--set initial.t_tr=1: expected either file or temperatures to draw, not both");
  EXPECT_EQ(message_of_overrides({"initial.file=a.h5", "initial.t_rot=1"}),
            "--set initial.t_rot=1: expected either file or temperatures to draw, not both");
}

TEST(Override, IsNamedInItsError) {
  const std::string count = "expected a whole number in digits, from 0 to 4294967294";
  EXPECT_EQ(message_of_overrides({"needles.count=-1"}), "--set needles.count=-1: " + count);
  EXPECT_EQ(message_of_overrides({"needles.count= 10k "}), "--set needles.count=10k: " + count);
  EXPECT_EQ(message_of_overrides({"needles.count="}), "--set needles.count=: " + count);
  EXPECT_EQ(message_of_overrides({"needles.count=99999999999999999999"}),
            "--set needles.count=99999999999999999999: " + count);
  EXPECT_EQ(
      message_of_overrides({"needles.cuont=5"}),
      "--set needles.cuont=5: expected one of count, box, k, diameter, seed, did you mean count?");
  EXPECT_EQ(
      message_of_overrides({"neddles.count=5"}),
      "--set neddles.count=5: expected one of the sections needles, species, initial, collisions, "
      "pairs, walls, forces, shear, driving, engine, until, output, did you mean needles?");
}

TEST(Override, ErrorsOfTheFileComeFirst) {
  EXPECT_EQ(message_of_overrides({"needles.count=-1"}, "needles.k ="),
            "s.toml: line 4: bad key-value pair: encountered end-of-file");
  EXPECT_EQ(message_of_overrides({"needles.count=-1"}, "collisions.beta = 3"),
            "s.toml: line 4: collisions.beta = 3: expected a number from -1 (smooth) to 1 "
            "(perfectly rough)");
}

TEST(Override, WithoutSectionKeyAndValueIsRefused) {
  for (const std::string bad :
       {"", "needles", "needles.count", "=5", ".=5", "needles.=5", ".count=5", "a.b.c=5",
        "need les.count=5", "needles.\"count\"=5", "my title=5"})
    EXPECT_EQ(message_of_overrides({bad}), "--set " + bad + ": expected section.key=value");
}

TEST(Override, OfTheTitleNeedsNoSection) {
  EXPECT_EQ(parse({"title=x"}).title, "x");
  EXPECT_EQ(parse({"title = Ten needles, \"hard\""}).title, "Ten needles, \"hard\"");
  EXPECT_EQ(parse({"title='quoted'"}).title, "quoted");
  const Scene replaced = parse_scene("title = 'a'\n" + least_scene, "s.toml", Overrides{"title=b"});
  EXPECT_EQ(replaced.title, "b");
  EXPECT_EQ(message_of_overrides({"title=5"}),
            "--set title=5: expected a string without control characters");
  EXPECT_EQ(
      message_of_overrides({"count=5"}),
      "--set count=5: expected a section or title, did you mean needles.count or species.count?");
  EXPECT_EQ(message_of_overrides({"needles=5"}), "--set needles=5: expected a section [needles]");
}

TEST(Override, ChangesWhereAKeyIsSaidToBeGiven) {
  const Scene scene = parse({"needles.box=5", "title=x"});
  EXPECT_EQ(scene.places.at("needles.count"), "s.toml: line 1: needles.count = 10");
  EXPECT_EQ(scene.places.at("needles.box"), "--set needles.box=5");
  EXPECT_EQ(scene.places.at("title"), "--set title=x");
  EXPECT_EQ(scene.places.count("needles.k"), 0u);
}

TEST(Override, CannotSmuggleInMoreThanOneValue) {
  EXPECT_EQ(message_of_overrides({"needles.k=5\nseed=7"}),
            "--set needles.k=5\\nseed=7: expected a number > 0 (from 1e-9 to 1e9; 6 is a uniform "
            "rod)");
  EXPECT_EQ(message_of_overrides({"needles.k=5\n[engine]\nthreads=2"}),
            "--set needles.k=5\\n[engine]\\nthreads=2: expected a number > 0 (from 1e-9 to 1e9; 6 "
            "is a uniform rod)");
  EXPECT_EQ(message_of_overrides({"output.file=a\x1b[31m"}),
            "--set output.file=a\\x1b[31m: expected the path of a file to write, or \"\" for none");
  EXPECT_EQ(message_of_overrides({"output.file=\xff.h5"}),
            "--set output.file=\\xff.h5: expected the path of a file to write, or \"\" for none");
}

TEST(Override, IsKeptInTheTextAsAComment) {
  EXPECT_EQ(parse({}).text, least_scene);
  EXPECT_EQ(parse({"needles.k=2", "needles.box=[3,\n3,3]"}, "# end").text,
            least_scene + "# end\n# --set needles.k=2\n# --set needles.box=[3,\\n3,3]\n");
  const Scene scene = parse({"needles.k=2"});
  EXPECT_EQ(scene.text, least_scene + "# --set needles.k=2\n");
  EXPECT_EQ(parse_scene(scene.text, "s.toml").needles.k, 6) << "a comment changes nothing";
}

}  // namespace
}  // namespace needlework
