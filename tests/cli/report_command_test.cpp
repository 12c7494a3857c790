// What `needlework report` does with files; tests/report has what pages hold.
#include "src/io/contents.h"
#include "tests/cli/program.h"
#include "tests/report/page_data.h"

namespace needlework {
namespace {

class ReportCommand : public ProgramTest {
 protected:
  void make_run() const { ASSERT_EQ(run("run small.toml --quiet --out run.h5").exit_code, 0); }
};

TEST_F(ReportCommand, KeepsAnExistingPageUnlessForced) {
  make_run();
  const Outcome written = run("report run.h5 -o page.html");
  EXPECT_EQ(written.exit_code, 0);
  EXPECT_EQ(written.out + written.err, "");
  const std::string page = read("page.html");
  EXPECT_TRUE(page.starts_with("<!doctype html>"));

  write("page.html", "mine");
  EXPECT_TRUE(run("report run.h5 -o page.html")
                  .fails(5, "page.html: exists already: expected a new file, or --force"));
  EXPECT_EQ(read("page.html"), "mine");
  EXPECT_EQ(run("report run.h5 -o page.html --force").exit_code, 0);
  EXPECT_EQ(read("page.html"), page);
}

TEST_F(ReportCommand, NamesFilesThatItDoesNotTakeAndWritesNothing) {
  make_run();
  const std::vector<std::string> before = files();
  EXPECT_TRUE(run("report run.h5 small.toml -o page.html")
                  .fails(3, "small.toml: expected a run (.h5), the summary.h5 of a sweep, or"));
  EXPECT_TRUE(run("report absent.h5 -o page.html")
                  .fails(5, "absent.h5: cannot be read: expected a file that exists"));
  EXPECT_EQ(run("report run.h5").exit_code, 2);
  EXPECT_EQ(run("report -o page.html").exit_code, 2);
  EXPECT_EQ(run("report run.h5 -o page.html --needles 0").exit_code, 2);
  EXPECT_EQ(files(), before);
}

TEST_F(ReportCommand, ShowsAtMostTheNeedlesAndFramesAskedFor) {
  ASSERT_EQ(run("run small.toml --quiet --out run.h5 --set output.frames=20").exit_code, 0);
  ASSERT_EQ(run("report run.h5 -o page.html --needles 7 --frames 2 --title 'A & B'").exit_code, 0);
  const test::PageData page(path("page.html"));
  EXPECT_EQ(page.json["title"], "A & B");
  const auto& frames = page.json["sections"][0]["frames"];
  EXPECT_EQ(frames["needles_shown"], 7);
  EXPECT_EQ(frames["frames"].size(), 2);
  EXPECT_GT(frames["frames_in_file"], 2);
}

TEST_F(ReportCommand, HoldsTheSummaryOfASweepBitForBit) {
  write("grid.toml",
        "scene = \"small.toml\"\nseeds = [1, 2]\nout = \"sweep\"\n[parameters]\n"
        "\"initial.t_rot\" = [0.5, 1.0, 2.0]\n");
  ASSERT_EQ(run("sweep grid.toml --quiet").exit_code, 0);
  ASSERT_EQ(run("report sweep/summary.h5 -o page.html").exit_code, 0);
  const test::PageData page(path("page.html"));
  const auto& sweep = page.json["sections"][0];
  EXPECT_EQ(sweep["kind"], "sweep");
  EXPECT_EQ(sweep["members"], (std::vector{2, 2, 2}));
  EXPECT_EQ(sweep["parameters"]["initial.t_rot"], (std::vector{0.5, 1.0, 2.0}));
  const io::Contents summary(path("sweep/summary.h5"));
  for (const char* part : {"mean", "standard_error"}) {
    EXPECT_EQ(page.numbers<double>(sweep["results"]["energy"][part]),
              summary.numbers(std::string("/results/energy/") + part));
    EXPECT_EQ(page.numbers<double>(sweep["series"][2]["quantities"]["momentum"][part]),
              summary.numbers(std::string("/series/00002/momentum/") + part));
  }
  EXPECT_EQ(page.numbers<double>(sweep["series"][1]["time"]),
            summary.numbers("/series/00001/time"));
}

TEST_F(ReportCommand, TakesWhatBenchWritesAndTheResultsThatAreKept) {
  const std::filesystem::path results = NEEDLEWORK_SOURCE "/bench/results";
  std::filesystem::path of_density;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(results)) {
    const std::filesystem::path file = entry.path();
    if (file.extension() != ".json") continue;
    if (file.filename() == "density.json") of_density = file;
    const std::string page = file.stem().string() + ".html";
    EXPECT_EQ(run("report " + file.string() + " --force -o " + page).exit_code, 0) << file;
  }
  ASSERT_FALSE(of_density.empty());  // that of the last page of this name
  const test::PageData page(path("density.html"));
  const auto kept = nlohmann::json::parse(std::ifstream(of_density));
  const auto& bench = page.json["sections"][0];
  EXPECT_EQ(bench["about"]["machine"], kept["machine"]);
  ASSERT_EQ(bench["cases"].size(), kept["cases"].size());
  for (std::size_t n = 0; n < kept["cases"].size(); ++n) {
    EXPECT_EQ(bench["cases"][n]["name"], kept["cases"][n]["name"]);
    EXPECT_EQ(bench["cases"][n]["values"], kept["cases"][n]["us_per_collision"]);
  }
}

}  // namespace
}  // namespace needlework
