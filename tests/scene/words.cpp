// Suggestions for misspelt words, and text made fit to print.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "src/scene/printable.h"
#include "src/scene/suggest.h"

namespace needlework {
namespace {

TEST(EditDistance, CountsInsertionsDeletionsChangesAndSwaps) {
  EXPECT_EQ(edit_distance("", ""), 0u);
  EXPECT_EQ(edit_distance("", "abc"), 3u);
  EXPECT_EQ(edit_distance("abc", ""), 3u);
  EXPECT_EQ(edit_distance("count", "count"), 0u);
  EXPECT_EQ(edit_distance("count", "cuont"), 1u);
  EXPECT_EQ(edit_distance("count", "counts"), 1u);
  EXPECT_EQ(edit_distance("count", "coumt"), 1u);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3u);
  EXPECT_EQ(edit_distance("T-Rot", "t_rot"), 0u);
}

TEST(NearestWord, IsTheNearestIfNearEnough) {
  const std::vector<std::string_view> words = {"tc", "tc_relative", "epsilon", "beta"};
  EXPECT_EQ(nearest_word("t_c", words), "tc");
  EXPECT_EQ(nearest_word("epsylon", words), "epsilon");
  EXPECT_EQ(nearest_word("tcrelativ", words), "tc_relative");
  EXPECT_EQ(nearest_word("gamma", words), "");
  EXPECT_EQ(nearest_word("", words), "");
  EXPECT_EQ(nearest_word(std::string(1000, 'e'), words), "");
}

TEST(NearestWord, OfOneLetterIsNotAnyOther) {
  const std::vector<std::string_view> words = {"k"};
  EXPECT_EQ(nearest_word("K", words), "k");
  EXPECT_EQ(nearest_word("n", words), "");
}

TEST(Printable, KeepsTextAndEscapesTheRest) {
  EXPECT_EQ(printable("plain \xc3\xa9\xe2\x82\xac\xf0\x9f\x98\x80"),
            "plain \xc3\xa9\xe2\x82\xac\xf0\x9f\x98\x80");
  EXPECT_EQ(printable(std::string("a\nb\tc\rd\0e\x7f", 10)), "a\\nb\\tc\\rd\\x00e\\x7f");
  EXPECT_EQ(printable("\x1b[31m\xc2\x9b\xe2\x80\xae"), "\\x1b[31m\\u009b\\u202e");
}

TEST(Printable, EscapesWhatIsNoUtf8ByteByByte) {
  EXPECT_EQ(printable("\xff\x80"), "\\xff\\x80");
  EXPECT_EQ(printable("\xc0\xaf"), "\\xc0\\xaf") << "overlong";
  EXPECT_EQ(printable("\xe0\x80\xaf"), "\\xe0\\x80\\xaf") << "overlong";
  EXPECT_EQ(printable("\xed\xa0\x80"), "\\xed\\xa0\\x80") << "surrogate";
  EXPECT_EQ(printable("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80") << "beyond Unicode";
  EXPECT_EQ(printable("\xe2\x82"), "\\xe2\\x82") << "cut short";
  EXPECT_FALSE(is_printable("\xe2\x82"));
  EXPECT_FALSE(is_printable("a\n"));
  EXPECT_TRUE(is_printable("\xe2\x82\xac"));
}

TEST(Printable, CutsBetweenCharacters) {
  EXPECT_EQ(printable("abcdefgh", 8), "abcdefgh");
  EXPECT_EQ(printable("abcdefghi", 8), "abcde...");
  EXPECT_EQ(printable("abcd\xe2\x82\xacx", 8), "abcd\xe2\x82\xacx");
  EXPECT_EQ(printable("abcd\xe2\x82\xacxy", 8), "abcd...");
  EXPECT_EQ(printable("abc\n\n\n\n", 8), "abc\\n...");
}

}  // namespace
}  // namespace needlework
