// Exports of many blocks, compressed or not, in little memory.
#include <fmt/format.h>
#include <sys/resource.h>

#include "src/io/formats/columns.h"
#include "src/io/formats/lammps.h"
#include "src/io/formats/xyz.h"
#include "tests/io/compressed.h"
#include "tests/io/exported_files.h"

namespace needlework::io {
namespace {

// A block of 1 MiB ends within a line, and the last frame begins within a block.
TEST_F(Formats, FilesOfManyBlocksAreReadWhetherCompressedOrNot_long) {
  const State last = make_state(3500, 2);
  for (const char* name : {"a.xyz", "a.dump", "a.data"}) {
    std::vector<State> frames{make_state(5000, 1), last};
    if (name == std::string("a.data")) frames.erase(frames.begin());
    put(name, frames);
    const std::string text = text_of_file(name);
    ASSERT_GT(text.size(), std::size_t{1} << 20);
    const State expected = completed(last, name != std::string("a.xyz"));
    expect_same(read_configuration(file(name)).state, expected);
    const std::size_t middle = text.find('\n', text.size() / 2) + 1;
    for (const std::string& packed :
         {compressed(text), gzipped(text),
          gzipped(text.substr(0, middle)) + gzipped(text.substr(middle))}) {
      std::ofstream(file("b"), std::ios::binary) << packed;
      expect_same(read_configuration(file("b")).state, expected);
      EXPECT_TRUE(complaint(packed.substr(0, packed.size() - 20)).starts_with("cut short: "));
    }
    if (frames.size() == 1) continue;  // whose needles are not in one line each
    const auto lines = std::count(text.begin(), text.end(), '\n');
    const auto place = fmt::format("line {}: ", lines);
    const std::string bad = text.substr(0, text.size() - 1) + " 1\n";  // a column too many
    EXPECT_TRUE(complaint(bad).starts_with(place)) << complaint(bad);
    EXPECT_TRUE(complaint(compressed(bad)).starts_with(place)) << complaint(compressed(bad));
    EXPECT_TRUE(complaint(gzipped(bad)).starts_with(place)) << complaint(gzipped(bad));
  }
}

TEST_F(Formats, NamesThatEndInGzOrBz2AreCompressed) {
  const State state = make_state(2000);
  const std::string plain = (put("a.xyz", {state}), text_of_file("a.xyz"));
  for (const auto& [name, magic] : {std::pair("a.xyz.gz", "\x1f\x8b"),
                                    {"a.dump.gz", "\x1f\x8b"},
                                    {"a.data.bz2", "BZh"},
                                    {"a.xyz.bz2", "BZh"},
                                    {"a.xml.gz", "\x1f\x8b"},
                                    {"a.xml.bz2", "BZh"}}) {
    put(name, {state});
    EXPECT_TRUE(text_of_file(name).starts_with(magic)) << name;
    EXPECT_LT(text_of_file(name).size(), 3 * plain.size() / 4);
    EXPECT_EQ(read_configuration(file(name)).state.position, state.position) << name;
  }
}

TEST_F(Formats, DamagedCompressedFilesAreNamed) {
  put("a.xyz", {make_state(9)});
  for (const auto& [packed, kind] : {std::pair(gzipped(text_of_file("a.xyz")), "gzip"),
                                     std::pair(compressed(text_of_file("a.xyz")), "bzip2")}) {
    std::string bad = packed;
    bad[bad.size() / 2] = static_cast<char>(bad[bad.size() / 2] ^ 0x55);
    EXPECT_EQ(complaint(bad), fmt::format("damaged: expected a {} file", kind));
    EXPECT_EQ(complaint(packed.substr(0, 9)),
              fmt::format("cut short: expected a complete {} file", kind));
  }
}

TEST_F(Formats, FramesBeforeTheLastTakeNoMemory) {
  for (const char* name : {"a.xyz", "a.dump"}) {
    put(name, {make_state(1, 1)});
    const std::string one = text_of_file(name);
    {
      std::ofstream out(file("long"), std::ios::binary);
      for (std::size_t n = 0; n < (std::size_t{24} << 20) / one.size(); ++n) out << one;
    }
    const auto peak = [] {
      rusage usage;
      getrusage(RUSAGE_SELF, &usage);
      return usage.ru_maxrss;  // KiB
    };
    const auto before = peak();
    EXPECT_EQ(read_configuration(file("long")).state.size(), 1u);
    EXPECT_LT(peak() - before, 8 << 10);
  }
}

TEST_F(Formats, LinesThatDoNotFitABlockAreRefused) {
  const std::string spaces(std::size_t{1} << 20, ' ');
  for (const char* name : {"a.xyz", "a.dump"}) {
    put(name, {make_state(3)});
    const std::string text = text_of_file(name);
    const std::size_t second = text.find('\n') + 1;
    EXPECT_EQ(complaint(text.substr(0, second) + spaces + text.substr(second)),
              "line 2: more than 1048576 bytes: expected a shorter line");
  }
}

}  // namespace
}  // namespace needlework::io
