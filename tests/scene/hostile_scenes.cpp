// Input made to break a parser: nothing but InputError may come of it, with a message fit to print.
#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "needlework/error.h"
#include "needlework/parse.h"
#include "src/scene/printable.h"
#include "src/scene_text/toml_guard.h"
#include "tests/scene/message.h"
#include "tests/support/cpu_seconds.h"

namespace needlework {
namespace {

using test::message;

std::string repeated(const std::string& piece, std::size_t times) {
  std::string text;
  for (std::size_t i = 0; i < times; ++i) text += piece;
  return text;
}

TEST(HostileScene, DeepNestingIsRefusedBeforeItCanOverflowTheStack) {
  const std::string reason = ": expected at most 16 levels of nesting";
  EXPECT_EQ(message(repeated("a.", 500000) + "a = 1"), "s.toml: line 1" + reason);
  EXPECT_EQ(message("\n\n[" + repeated("a.", 400000) + "a]"), "s.toml: line 3" + reason);
  EXPECT_EQ(message("\na = " + repeated("[", 400000)), "s.toml: line 2" + reason);
  EXPECT_EQ(message("a = " + repeated("{a=", 300000)), "s.toml: line 1" + reason);
  EXPECT_EQ(message("a = [" + repeated("\"\"\".\"\"\",", 2) + "\n{" + repeated("'a,\"b'.", 20)),
            "s.toml: line 2" + reason);
  EXPECT_EQ(message("", {"needles.box=" + repeated("[", 100000)}),
            "--set needles.box=" + repeated("[", 57) +
                "...: expected an edge from 2.01 to 1e9, or an array of three edges");
}

std::size_t hazard_line(const std::string& toml) {
  const auto hazard = find_toml_hazard(toml);
  return hazard ? hazard->line : 0;
}

TEST(TomlGuard, LooksPastStringsCommentsAndNumbers) {
  const std::string dots = repeated(".", 50) + "\xc3\xa9";
  const std::string brackets = repeated("[", 50);
  for (const std::string& harmless : std::vector<std::string>{
           "a = \"" + dots + brackets + "\"", "a = '" + dots + "'", "# " + brackets + dots,
           "a = \"\"\"\n" + brackets + "\n\"\" \\\"\"\" " + dots + "\"\"\"\"\"",
           "a = '''\\'' " + brackets + "\n'''", "a = \"\\\"" + brackets + "\"",
           "a = \"\" # " + dots, "a = [" + repeated("0.5, ", 100) + "]",
           repeated("a.b = 1.5\n", 100), "a = " + repeated("[", 16) + repeated("]", 16),
           repeated("a.", 16) + "a = 1", "\xef\xbb\xbf# " + dots, "\xef\xbb\xbf'" + dots + "' = 1",
           "a = '''\\\n" + dots + "'''", "a = \"\"\"\\\n  b" + dots + "\"\"\"",
           "a = 1979-05-27 07:32:00.5-08:00 # " + dots,
           "a = [1979-05-27 07:32:00\t\n, 1979-05-27 ] # " + dots, "a = {b = '''" + dots + "'''''}",
           "{'" + dots + "'.'" + dots + "'"})
    EXPECT_EQ(hazard_line(harmless), 0u) << harmless;
}

TEST(TomlGuard, FindsTheLine) {
  const std::string brackets = repeated("[", 50);
  EXPECT_EQ(hazard_line("a = \"\"\"\n\n\"\"\"\n" + repeated("a.", 17)), 4u);
  EXPECT_EQ(hazard_line("a = \"\"\"\\\n\\\n\"\"\"\n" + brackets), 4u);
  EXPECT_EQ(hazard_line("a = \"\\\\\"\n" + brackets), 2u);
  EXPECT_EQ(hazard_line("a = '\\'" + brackets), 1u);
  EXPECT_EQ(hazard_line("# \xc3\xa9\n\xc3\xa9 = 1"), 2u);
  EXPECT_EQ(hazard_line("a = \"\"\"\\ \n \t\xc3\xa9\"\"\""), 2u);
  EXPECT_EQ(hazard_line("a = \"\"\"\\\xc3\xa9\"\"\""), 1u);
  EXPECT_EQ(hazard_line("a = 1\n\nb = 1\"\xc3\xa9\""), 3u) << "this quote begins no string";
}

TEST(HostileScene, WhiteSpaceThatIsNoneIsRefused) {
  EXPECT_EQ(message("[engine]\nsearch = \u201cauto\u201d"),
            "s.toml: line 2: unexpected '\u201c': expected ASCII outside quotes and comments");
  EXPECT_EQ(message("title = \"\"\"a\\\n  \u00e9\"\"\""),
            "s.toml: line 2: unexpected '\u00e9': expected ASCII after a backslash that ends a "
            "line");
  // The parser looks for the end of a date and its time before it looks at either.
  EXPECT_EQ(message("title = 1979-05-27 07:32:00.9(s=\"\u00e9\""),
            "s.toml: line 1: unexpected '\u00e9': expected ASCII outside quotes and comments");
  const std::string end = ": expected the end of the line, or of what the value stands in";
  EXPECT_EQ(message("title = 1979-05-27 1#=\"\u00e9\""), "s.toml: line 1: unexpected '1'" + end);
  EXPECT_EQ(message("[needles]\ncount = 'a' b"), "s.toml: line 2: unexpected 'b'" + end);
  const std::vector<std::string> overrides = {"needles.count=1", "needles.box=3", "until.time=1",
                                              "output.file=\u00e9t\u00e9.h5"};
  EXPECT_EQ(parse_scene("", "s.toml", overrides).output.file, "\u00e9t\u00e9.h5");
}

// They fail assertions of the parser, in builds that have them.
TEST(HostileScene, DatesWithoutAnHourAndBracketsWithoutAKeyAreErrors) {
  EXPECT_EQ(message("\nuntil.time = 1979-05-27Tx7:32:00"),
            "s.toml: line 2: bad time: expected 2-digit hour, saw 'x'");
  EXPECT_EQ(
      message("\n[[[needles]]]"),
      "s.toml: line 2: bad key: expected bare key starting character or string delimiter, saw '['");
}

TEST(HostileScene, BytesThatAreNoTextAreRefused) {
  EXPECT_EQ(message("title = \"\xff\""), "s.toml: line 1: Encountered invalid utf-8 sequence");
  EXPECT_EQ(message(std::string("title = 'a\0b'", 13)),
            "s.toml: line 1: bad literal string: control characters other than TAB (U+0009) are "
            "explicitly prohibited");
  EXPECT_EQ(message(std::string(1000, '\0')),
            "s.toml: line 1: bad root table: expected keys, tables, whitespace or comments, saw "
            "'\\u0000'");
  EXPECT_EQ(message(std::string("\xff\xfe[\0n\0", 6)),
            "s.toml: line 1: unexpected '\\xff': expected ASCII outside quotes and comments");
  EXPECT_EQ(message("a = 5\rb = 6"),
            "s.toml: line 1: unexpected 'b': expected the end of the line, or of what the value "
            "stands in");
}

TEST(HostileScene, MessageEscapesControlCharacters) {
  EXPECT_EQ(message(R"("\u001b[2J" = 1)"),
            "s.toml: line 1: \\x1b[2J = 1: expected a section or title");
  EXPECT_EQ(message(R"(["a\nb"])"),
            "s.toml: line 1: [a\\nb]: expected one of the sections needles, species, initial, "
            "collisions, "
            "pairs, walls, forces, shear, driving, engine, until, output");
  EXPECT_EQ(message("until.time = '\xe2\x80\xae'"),
            "s.toml: line 1: until.time = '\\u202e': expected a time >= 0");
  EXPECT_EQ(message(R"(title = "\u001b[2J")"),
            R"(s.toml: line 1: title = "\u001b[2J": expected a string without control characters)");
  try {
    parse_scene("= 5", "a\x1b[2J\nb");
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_TRUE(std::string(error.what()).starts_with("a\\x1b[2J\\nb: line 1: ")) << error.what();
  }
}

TEST(HostileScene, MessageIsCutToASaneLength) {
  const std::string x(100000, 'x');
  for (const std::string& text :
       {"until.time = '" + x + "'", x + " = 1", "[" + x + "]", "[" + x + "]\n[" + x + "]",
        "a = " + x, "a = 1" + x, "[needles]\n" + x + " = '" + x + "'",
        "a = " + std::string(100000, '1')})
    EXPECT_LT(message(text).size(), 400u) << message(text);
  EXPECT_LT(message("", {"needles." + x + "=" + x}).size(), 400u);
  EXPECT_LT(message("", {x}).size(), 400u);
  EXPECT_EQ(message("until.time = '" + x + "'"),
            "s.toml: line 1: until.time = '" + std::string(56, 'x') + "...: expected a time >= 0");
}

// CPU time of refusing scenes with this many unknown keys, on lines of their own and on one.
double cost_of_bad_keys(int count) {
  std::string lines = "[needles]\n";
  std::string one_line = "needles = {";
  for (int i = 0; i < count; ++i) {
    const std::string name = std::to_string(i);
    lines.append("k").append(name).append(" = 1\n");
    one_line.append(i ? ", k" : "k").append(name).append(" = 1");
  }
  return test::cpu_seconds([&] {
    EXPECT_TRUE(message(lines).starts_with("s.toml: line 2: needles.k0 = 1: "));
    EXPECT_TRUE(message(one_line + "}").starts_with("s.toml: line 1: needles.k0 = 1: "));
  });
}

// 32 times as many keys take about 32 times as long, not 1000 times.
TEST(HostileScene, CostsNoMoreThanInProportionToItsBadKeys) {
  EXPECT_LT(cost_of_bad_keys(64000), 180 * cost_of_bad_keys(2000));
}

// Bytes and pieces of TOML put in, taken out and exchanged at random.
std::string mutated(std::string text, std::mt19937_64& random) {
  static const std::vector<std::string> pieces = {"[",
                                                  "]",
                                                  "{",
                                                  "}",
                                                  "=",
                                                  ".",
                                                  ",",
                                                  "\n",
                                                  "\"",
                                                  "'",
                                                  "\"\"\"",
                                                  "'''",
                                                  "#",
                                                  "\\",
                                                  "\\u0000",
                                                  "\r",
                                                  "[[",
                                                  "]]",
                                                  "nan",
                                                  "-inf",
                                                  "1e400",
                                                  "99999999999999999999",
                                                  "-1",
                                                  "0x",
                                                  "true",
                                                  "1979-05-27T07:32:00Z",
                                                  "needles",
                                                  "count",
                                                  "until.time = 1\n",
                                                  "\xff",
                                                  "\xe2\x80\xa8",
                                                  "\xef\xbb\xbf",
                                                  "a.",
                                                  std::string(1, '\0')};
  const auto below = [&](std::size_t n) { return random() % n; };
  for (std::size_t n = 1 + below(4); n > 0; --n) {
    const std::size_t at = below(text.size() + 1);
    const std::size_t length = std::min(text.size() - at, below(8));
    switch (below(4)) {
      case 0:
        text.insert(at, pieces[below(pieces.size())]);
        break;
      case 1:
        text.erase(at, length);
        break;
      case 2:
        text.replace(at, length, pieces[below(pieces.size())]);
        break;
      default:
        text.insert(below(text.size() + 1), text.substr(at, below(40)));
        break;
    }
  }
  return text;
}

TEST(HostileScene, OfRandomEditsIsASceneOrAnInputError) {
  const std::string good =
      "title = \"a\"\n[needles]\ncount = 10\nbox = [4, 5.0, 6]\nk = 6.0\nseed = 1\n[initial]\n"
      "t_tr = 1.0\nt_rot = 0\n[collisions]\nepsilon = 0.8\nbeta = -1.0\ntc_relative = 1e-4\n"
      "[engine]\nsearch = \"auto\"\nthreads = 1\n[until]\ntime = 1e3\nenergy_ratio = 1e-3\n"
      "[output]\nfile = \"run.h5\"\nframes = [0, 1, 2]\nobservables = []\nevents = false\n";
  const std::string override_text = "needles.box=[4, 5, 6]";
  constexpr int trials = 30000;
  int scenes = 0;
  for (int seed = 0; seed < trials; ++seed) {
    std::mt19937_64 random(seed);
    const std::string text = mutated(good, random);
    const bool with_override = random() % 4 == 0;
    const std::vector<std::string> overrides(with_override ? 1 : 0, mutated(override_text, random));
    try {
      const Scene scene = parse_scene(text, "s.toml", overrides);
      ++scenes;
      EXPECT_GE(scene.collisions.epsilon, 0);
      EXPECT_GT(scene.needles.k, 0);
      EXPECT_TRUE(scene.text.starts_with(text));
    } catch (const InputError& error) {
      const std::string what = error.what();
      EXPECT_TRUE(is_printable(what) && what.size() < 400) << "seed " << seed << ": " << what;
      EXPECT_TRUE(what.starts_with("s.toml: ") || what.starts_with("--set "))
          << "seed " << seed << ": " << what;
    }  // anything else fails the test
  }
  // Both outcomes must be common, or the edits test nothing.
  EXPECT_GT(scenes, trials / 100);
  EXPECT_LT(scenes, trials * 9 / 10);
}

}  // namespace
}  // namespace needlework
