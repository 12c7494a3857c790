#include "src/io/contents.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "needlework/error.h"
#include "needlework/h5md.h"
#include "needlework/parse.h"
#include "tests/support/temporary_folder.h"

namespace needlework::io {
namespace {

using Numbers = std::vector<double>;

class ContentsOfAFile : public testing::Test {
 protected:
  // Five samples of a run without frames.
  ContentsOfAFile() {
    const Scene scene = parse_scene(
        "title = \"five\"\nneedles = { count = 0, box = 5 }\nuntil.time = 1\n", "scene");
    Writer writer(path_, true, scene, {"scalar", 1, 1.0});
    for (int n = 0; n < 5; ++n) {
      Totals totals;
      totals.time = 0.5 * n;
      totals.energy = 1.0 / (n + 3);
      totals.momentum = {1.0 * n, 2.0 * n, 3.0 * n};
      writer.write_series(totals);
    }
    writer.close();
  }

  test::TemporaryFolder folder_;
  std::string path_ = (folder_.path() / "run.h5").string();
};

TEST_F(ContentsOfAFile, AreFoundByPath) {
  const Contents contents(path_);
  EXPECT_TRUE(contents.has("/series"));
  EXPECT_FALSE(contents.has("/series/absent"));
  EXPECT_FALSE(contents.is_dataset("/series"));
  EXPECT_TRUE(contents.is_dataset("/series/energy"));  // an element is one dataset
  EXPECT_TRUE(contents.is_dataset("/parameters/seed"));
  const auto names = contents.names("/series");
  EXPECT_TRUE(std::is_sorted(names.begin(), names.end()));
  EXPECT_EQ(std::count(names.begin(), names.end(), "energy"), 1);
  EXPECT_TRUE(contents.names("/absent").empty());
  EXPECT_EQ(contents.description("/series/energy").substr(0, 14), "Kinetic energy");
}

TEST_F(ContentsOfAFile, AreTextsOrNumbers) {
  const Contents contents(path_);
  EXPECT_EQ(contents.texts("/parameters/title"), std::vector<std::string>{"five"});
  EXPECT_EQ(contents.texts("/parameters/seed"), std::nullopt);
  EXPECT_EQ(contents.texts("/parameters/absent"), std::nullopt);
  EXPECT_EQ(contents.numbers("/parameters/seed"), Numbers{1});
  EXPECT_EQ(contents.numbers("/series/energy"),
            (Numbers{1.0 / 3, 1.0 / 4, 1.0 / 5, 1.0 / 6, 1.0 / 7}));
  EXPECT_THROW(contents.numbers("/parameters/title"), InputError);
  EXPECT_THROW(contents.numbers("/absent"), InputError);
}

TEST_F(ContentsOfAFile, AreReadByRow) {
  const Contents contents(path_);
  EXPECT_EQ(contents.shape("/series/momentum"), (std::vector<std::size_t>{5, 3}));
  EXPECT_EQ(contents.rows("/series/momentum", std::vector<std::size_t>{4, 1}),
            (Numbers{4, 8, 12, 1, 2, 3}));
  EXPECT_THROW(contents.rows("/series/momentum", std::vector<std::size_t>{5}), InputError);
}

TEST(Contents, AreThoseOfAnHdf5File) { EXPECT_THROW(Contents("/nowhere/absent.h5"), IoError); }

}  // namespace
}  // namespace needlework::io
