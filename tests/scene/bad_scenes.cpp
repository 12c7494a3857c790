// Every kind of bad scene, with the one message that it must give.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "needlework/error.h"
#include "needlework/parse.h"
#include "src/calendar/names.h"
#include "tests/scene/message.h"

namespace needlework {
namespace {

using test::message;

struct BadLine {
  std::string section, line, message;  // the message behind the value
};

// That nothing beyond the range of a number is read is in ranges.cpp, and the words about each kind
// of key in invalid_scenes.json, for every way in.
TEST(BadScene, ValueOutOfRangeOrOfWrongTypeIsNamedWithItsLine) {
  const std::string count = "expected a whole number in digits, from 0 to 4294967294";
  const std::string seed = "expected a whole number in digits, from 0 to 9223372036854775807";
  const std::string box = "expected an edge from 2.01 to 1e9, or an array of three edges";
  const std::string k = "expected a number > 0 (from 1e-9 to 1e9; 6 is a uniform rod)";
  const std::string temperature = "expected a temperature >= 0 (0, or from 1e-200 to 1e200)";
  const std::string epsilon = "expected a number from 0 to 1";
  const std::string search =
      R"(expected "auto", "all-pairs", "linked-lists", "linked-cells" or "capsules")";
  const std::string queue =
      fmt::format("expected \"auto\", \"{}\" or \"{}\"",
                  fmt::join(calendar_names().begin(), calendar_names().end() - 1, "\", \""),
                  calendar_names().back());
  const std::string accuracy = R"(expected "fast", "standard" or "rigorous")";
  const std::string isa = R"(expected "auto", "scalar", "sse4", "avx2" or "avx512")";
  const std::string threads = R"(expected "auto" or a whole number in digits, from 1 to 1024)";
  const std::string side = "expected a length from 0.1";
  const std::string radius = "expected a length from 1e-3 to 10";
  const std::string series = "expected a number > 0 (at most 1e6)";
  const std::string frames =
      "expected a number > 0 (frames per decade, at most 1e6) or an array of times >= 0, "
      "increasing";
  const std::string every = "expected a time > 0";
  const std::string grid =
      "expected a whole number in digits, from 1 to 10000, or an array of three, at most 1e6 cells";
  const std::string observables =
      "expected an array of names among \"fields\", \"profiles\", \"flow_order\", "
      "\"distributions\", \"alignment\", \"velocity_moments\", \"temperature_by_axis\", "
      "\"pair_correlation\", \"structure_factor\", \"displacement\", "
      "\"time_correlation\", \"collision_statistics\", "
      "\"wall_profiles\", \"centre_of_mass\", \"contact_network\", \"pressure_tensor\", "
      "\"t_tr\", \"t_rot\", \"energy\", \"momentum\", \"collisions\", \"tc_collisions\"";
  const BadLine table[] = {
      {"needles", "count = -1", count},
      {"needles", "count = 1.5", count},
      {"needles", "count = 1e4", count},
      {"needles", "count = 9223372036854775807", count},
      {"needles", "count = \"10\"", count},
      {"needles", "count = true", count},
      {"needles", "count = nan", count},
      {"needles", "count = 1979-05-27", count},
      {"needles", "count = [10]", count},
      {"needles", "count = {n = 10}", count},
      {"needles", "seed = -1", seed},
      {"needles", "seed = 1.0", seed},
      {"needles", "seed = -9223372036854775808", seed},
      {"needles", "box = 2.0099", box},
      {"needles", "box = -12", box},
      {"needles", "box = 2e9", box},
      {"needles", "box = nan", box},
      {"needles", "box = inf", box},
      {"needles", "box = \"12\"", box},
      {"needles", "box = true", box},
      {"needles", "box = []", box},
      {"needles", "box = [12, 12]", box},
      {"needles", "box = [12, 12, 12, 12]", box},
      {"needles", "box = [12, 12, 2]", box},
      {"needles", "box = [12, nan, 12]", box},
      {"needles", "box = [12, [12], 12]", box},
      {"needles", "k = false", k},
      {"initial", "t_rot = \"0\"", temperature},
      {"initial", "file = 5", "expected the path of an H5MD file"},
      {"initial", "file = \"\"", "expected the path of an H5MD file"},
      {"initial", R"(file = "a\u0000b")", "expected the path of an H5MD file"},
      {"collisions", "epsilon = true", epsilon},
      {"collisions", "tc_relative = [1]", "expected a number >= 0 of mean free times"},
      {"engine", "search = 1", search},
      {"engine", "queue = \"heap\"", queue},
      {"engine", "queue = \"\"", queue},
      {"engine", "accuracy = \"Standard\"", accuracy},
      {"engine", "accuracy = true", accuracy},
      {"engine", "isolation = \"sample\"", R"(expected "sampling", "bounds" or "intervals")"},
      {"engine", "escalation = false", R"(expected "never", "undecided" or "always")"},
      {"engine", "storage = \"random\"", R"(expected "sorted" or "by-id")"},
      {"engine", "filter = \"half\"", R"(expected "float" or "double")"},
      {"engine", "sampling_step = 0", "expected a number from 1e-4 to 0.5"},
      {"engine", "isa = \"sse2\"", isa},
      {"engine", "isa = [\"avx2\"]", isa},
      {"engine", "threads = -2", threads},
      {"engine", "threads = 1025", threads},
      {"engine", "threads = 2.0", threads},
      {"engine", "threads = \"all\"", threads},
      {"engine", "search = \"linked-list\"", search},
      {"engine", "cell_side = \"1\"", side},
      {"engine", "cell_side = [1, 1, 1]", side},
      {"engine", "capsule_radius = 0", radius},
      {"engine", "capsule_radius = true", radius},
      {"until", "time = true", "expected a time >= 0"},
      {"until", "collisions_per_needle = \"many\"", "expected a number >= 0"},
      {"until", "energy_ratio = 0", "expected a number > 0"},
      {"output", "file = 5", "expected the path of a file to write, or \"\" for none"},
      {"output", "series_per_decade = 0", series},
      {"output", "series_per_decade = true", series},
      {"output", "frames = 0", frames},
      {"output", "frames = -2", frames},
      {"output", "frames = nan", frames},
      {"output", "frames = \"all\"", frames},
      {"output", "frames = [-1, 2]", frames},
      {"output", "frames = [0, 2, 1]", frames},
      {"output", "frames = [0, 1, 1]", frames},
      {"output", "frames = [0, nan]", frames},
      {"output", "frames = [0, true]", frames},
      {"output", "series_every = 0", every},
      {"output", "grid = 0", grid},
      {"output", "grid = 2.5", grid},
      {"output", "grid = 101", grid},
      {"output", "grid = [10, 10]", grid},
      {"output", "grid = [10, 10, 0]", grid},
      {"output", "grid = [10000, 101, 1]", grid},
      {"output", "observables = [\"field\"]",
       "\"field\": " + observables + ", did you mean fields?"},
      {"output", "observables = [\"energy\", \"flow-order\"]",
       "\"flow-order\": " + observables + ", did you mean flow_order?"},
      {"output", "observables = [\"theory\"]", "\"theory\": " + observables},
      {"output", "observables = [\"energy\", \"entropy\"]", "\"entropy\": " + observables},
      {"output", "observables = [5]", observables},
      {"output", "observables = \"fields\"", observables},
      {"output", "events = 1", "expected true or false"},
      {"output", "events = \"true\"", "expected true or false"},
  };
  for (const BadLine& bad : table)
    EXPECT_EQ(message("[" + bad.section + "]\n" + bad.line + "\n"),
              "s.toml: line 2: " + bad.section + "." + bad.line + ": " + bad.message);
}

struct BadScene {
  std::string text, message;
};

void expect_messages(const std::vector<BadScene>& table) {
  for (const BadScene& bad : table) EXPECT_EQ(message(bad.text), bad.message) << bad.text;
}

TEST(BadScene, UnknownKeyComesWithSuggestion) {
  const std::string of_needles = "expected one of count, box, k, diameter, seed";
  const std::string of_engine =
      "expected one of search, queue, accuracy, isolation, escalation, filter, root_tolerance, "
      "sampling_step, threads, team, isa, cell_side, capsule_radius, storage";
  expect_messages({
      {"[needles]\ncuont = 100\n",
       "s.toml: line 2: needles.cuont = 100: " + of_needles + ", did you mean count?"},
      {"[needles]\nCount = 100\n",
       "s.toml: line 2: needles.Count = 100: " + of_needles + ", did you mean count?"},
      {"[needles]\nxyzzy = 1\n", "s.toml: line 2: needles.xyzzy = 1: " + of_needles},
      {"[needles]\nepsilon = 0.8\n", "s.toml: line 2: needles.epsilon = 0.8: " + of_needles +
                                         ", did you mean collisions.epsilon or pairs.epsilon or "
                                         "walls.epsilon?"},
      {"[needles]\nfile = 'a'\n", "s.toml: line 2: needles.file = 'a': " + of_needles +
                                      ", did you mean initial.file or output.file?"},
      // A key of the same section, rather than a section of the same name.
      {"[until]\ncollisions = 5\n",
       "s.toml: line 2: until.collisions = 5: expected one of time, collisions_per_needle, "
       "energy_ratio, wall_s, did you mean collisions_per_needle?"},
      {"[until]\ncollisions.epsilon = 0.5\n",
       "s.toml: line 2: until.collisions = {...}: expected [collisions] as a section of its own, "
       "or "
       "collisions.KEY above the first [section]"},
      {"[until]\ndriving = 5\n",
       "s.toml: line 2: until.driving = 5: expected [driving] as a section of its own, or "
       "driving.KEY above the first [section]"},
      {"[engine]\nradius = 2\n",
       "s.toml: line 2: engine.radius = 2: " + of_engine + ", did you mean capsule_radius?"},
      {"[needles]\ncount = 5\nuntil.time = 1\n",
       "s.toml: line 3: needles.until = {...}: expected [until] as a section of its own, or "
       "until.KEY above the first [section]"},
      {"[engine]\nthreads.count = 2\n",
       "s.toml: line 2: engine.threads = {...}: expected \"auto\" or a whole number in digits, "
       "from 1 to 1024"},
      {"[engine]\n\"\" = 2\n", "s.toml: line 2: engine. = 2: " + of_engine},
      {"[engine]\ntread = { a = 1 }\n",
       "s.toml: line 2: engine.tread = { a = 1 }: " + of_engine + ", did you mean threads?"},
      {"[engine]\ncellside = 2\n",
       "s.toml: line 2: engine.cellside = 2: " + of_engine + ", did you mean cell_side?"},
      {"[engine]\ncapsule_radii = 2\n",
       "s.toml: line 2: engine.capsule_radii = 2: " + of_engine + ", did you mean capsule_radius?"},
      {"tilte = 'x'\n",
       "s.toml: line 1: tilte = 'x': expected a section or title, did you mean title?"},
      {"count = 5\n",
       "s.toml: line 1: count = 5: expected a section or title, did you mean needles.count or "
       "species.count?"},
  });
}

TEST(BadScene, UnknownSectionComesWithSuggestion) {
  const std::string sections =
      "expected one of the sections needles, species, initial, collisions, pairs, walls, forces, "
      "shear, "
      "driving, engine, until, output";
  expect_messages({
      {"# a scene\n[neddles]\ncount = 5\n",
       "s.toml: line 2: [neddles]: " + sections + ", did you mean needles?"},
      {"[output]\n\n[physics]\n", "s.toml: line 3: [physics]: " + sections},
      {"enigne.threads = 1\n", "s.toml: line 1: [enigne]: " + sections + ", did you mean engine?"},
      {"[title]\n", "s.toml: line 1: [title]: " + sections},
      {"needles = 5\n", "s.toml: line 1: needles = 5: expected a section [needles]"},
      {"[[needles]]\n", "s.toml: line 1: [[needles]]: expected [needles], once"},
  });
}

TEST(BadScene, SyntaxErrorIsNamedWithItsLine) {
  expect_messages({
      {"[needles]\ncount = \n", "s.toml: line 2: bad key-value pair: expected value, saw '\\n'"},
      {"[needles]\ncount 5\n", "s.toml: line 2: bad key-value pair: expected '=', saw '5'"},
      {"[needles\n", "s.toml: line 1: bad table header: expected ']', saw '\\n'"},
      {"[needles]\nbox = [1, 2\n", "s.toml: line 2: bad array: encountered end-of-file"},
      {"[needles]\ncount = 5\nk = 6\ncount = 6\n",
       "s.toml: line 4: bad key-value pair: cannot redefine existing integer 'count'"},
      {"[needles]\n[engine]\n[needles]\n",
       "s.toml: line 3: bad table header: cannot redefine existing table 'needles' (the keys "
       "of a section stand together: below [section], in braces, or as section.key)"},
      {"needles = { count = 5 }\nneedles.seed = 2\n",
       "s.toml: line 2: bad key-value pair: cannot redefine existing table as dotted key-value "
       "pair (the keys of a section stand together: below [section], in braces, or as "
       "section.key)"},
      {"[needles]\ncount = 99999999999999999999\n",
       "s.toml: line 2: bad decimal integer: '99999999999999999999' is not representable in 64 "
       "bits"},
      {"[engine]\nsearch = auto\n",
       "s.toml: line 2: bad value: could not determine value type (text needs quotes)"},
      {"title = \"a\n",
       "s.toml: line 1: bad string: unescaped control characters other than TAB "
       "(U+0009) are explicitly prohibited"},
  });
}

TEST(BadScene, MissingKeyIsNamed) {
  const std::string count =
      "s.toml: needles.count is missing: expected a whole number in digits, from 0 to 4294967294";
  const std::string box =
      "s.toml: needles.box is missing: expected an edge from 2.01 to 1e9, or an array of three "
      "edges";
  const std::string until =
      "s.toml: an end condition in [until] is missing: expected one or more of time, "
      "collisions_per_needle, energy_ratio, wall_s";
  expect_messages({
      {"", count},
      {"[needles]\nbox = 12\n[until]\ntime = 1\n", count},
      {"[needles]\ncount = 12\n[until]\ntime = 1\n", box},
      {"[needles]\ncount = 12\nbox = 12\n", until},
      {"[needles]\ncount = 12\nbox = 12\n[until]\n", until},
      {"[initial]\nfile = 'a.h5'\n", until},
  });
}

TEST(BadScene, AlternativesExcludeEachOther) {
  const std::string tc = "expected either tc or tc_relative, not both";
  const std::string file = "expected either file or temperatures to draw, not both";
  expect_messages({
      {"[collisions]\ntc = 1\ntc_relative = 2\n",
       "s.toml: line 3: collisions.tc_relative = 2: " + tc},
      {"[collisions]\ntc_relative = 2\ntc = 1\n", "s.toml: line 3: collisions.tc = 1: " + tc},
      {"[initial]\nfile = 'a'\nt_tr = 1\n", "s.toml: line 3: initial.t_tr = 1: " + file},
      {"[initial]\nt_rot = 1.0\nfile = 'a'\n", "s.toml: line 3: initial.file = 'a': " + file},
  });
}

TEST(BadScene, FirstErrorByLineIsReported) {
  expect_messages({
      {"[until]\ntime = -1\n[needles]\ncount = -2\n",
       "s.toml: line 2: until.time = -1: expected a time >= 0"},
      {"[until]\nwall_s = -1\ntime = -1\n",
       "s.toml: line 2: until.wall_s = -1: expected a number >= 0 of seconds"},
      {"until = { wall_s = -1, time = -1 }\n",
       "s.toml: line 1: until.wall_s = -1: expected a number >= 0 of seconds"},
      {"[until]\ntime = -1\n[nedles]\n", "s.toml: line 2: until.time = -1: expected a time >= 0"},
  });
}

TEST(BadScene, ValueIsShownAsInTheFile) {
  const std::string time = ": expected a time >= 0";
  expect_messages({
      {"[until]\n  time   =   -1_0.50e+1   # ends\n",
       "s.toml: line 2: until.time = -1_0.50e+1" + time},
      {"\xef\xbb\xbfuntil.time = 'abc'\n", "s.toml: line 1: until.time = 'abc'" + time},
      {"until = { \"\xc3\xa9\xe2\x82\xac\" = 1 }\n",
       "s.toml: line 1: until.\xc3\xa9\xe2\x82\xac = 1: expected one of time, "
       "collisions_per_needle, energy_ratio, wall_s"},
      {"until = { time = \"\xc3\xa9\xe2\x82\xac\", wall_s = 'x' }\n",
       "s.toml: line 1: until.time = \"\xc3\xa9\xe2\x82\xac\"" + time},
      {"[until]\r\ntime = -1\r\n", "s.toml: line 2: until.time = -1" + time},
      {"[until]\ntime = [1,\n  2]\n", "s.toml: line 2: until.time = [1,\\n  2]" + time},
      {"[until]\r\ntime = [1,\r\n]\r\n", "s.toml: line 2: until.time = [1,\\r\\n]" + time},
  });
}

}  // namespace
}  // namespace needlework
