// Figures of runs of a few needles, and of files whose numbers are known.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "needlework/error.h"
#include "needlework/h5md.h"
#include "needlework/theory.h"
#include "src/reproduce/course.h"
#include "src/reproduce/reproduction.h"
#include "src/runs/exit_codes.h"
#include "tests/reproduce/small_paper.h"
#include "tests/support/temporary_folder.h"

namespace needlework::reproduce {
namespace {

namespace fs = std::filesystem;

class Silent : public runs::SweepMonitor {
 public:
  bool is_due(double) const override { return false; }
  void show(double, double, std::size_t, std::size_t) override {}
  void report_failure(const runs::sweep::Member& member, const runs::Failure& failure) override {
    ADD_FAILURE() << member.name << ": " << failure.message;
  }
};

std::string contents(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

std::vector<Claim> claims() {
  return read_claims(embedded_text("profiles/paper/claims.toml"), "claims.toml");
}

class SmallPaper : public testing::Test {
 protected:
  PaperRuns paper(const std::string& name) const {
    return {(temporary_.path() / name).string(), Size::full, test::small_text};
  }
  fs::path folder() const { return temporary_.path(); }

  static void run_all(PaperRuns& runs) {
    Silent silent;
    runs.claim_folder(false);
    for (const Figure& figure : figures()) {
      for (const std::string& set : figure.sets) {
        EXPECT_EQ(runs.run(set, 1, silent, false).exit_code, runs::ok) << set;
      }
    }
  }

 private:
  needlework::test::TemporaryFolder temporary_;
};

// A measurement without a claim would throw.
TEST_F(SmallPaper, EachClaimIsMeasuredAndEachFigureHasDataAndPicture) {
  PaperRuns runs = paper("all");
  run_all(runs);
  std::set<std::string> measured, ids;
  for (const Figure& figure : figures()) {
    for (const Row& row : reproduce(figure, runs, claims())) {
      measured.insert(row.claim.id);
      EXPECT_TRUE(ids.insert(row.id()).second) << row.id() << " is there twice";
    }
    const std::string file = runs.folder() + "/figure-" + figure.name;
    EXPECT_TRUE(contents(file + ".svg").starts_with("<?xml")) << figure.name;
    std::istringstream lines(contents(file + ".csv"));
    std::string head, line;
    std::getline(lines, head);
    const auto commas = std::count(head.begin(), head.end(), ',');
    std::size_t rows = 0;
    while (std::getline(lines, line)) {
      ++rows;
      EXPECT_EQ(std::count(line.begin(), line.end(), ','), commas) << figure.name << ": " << line;
    }
    EXPECT_GT(rows, 1u) << figure.name;
  }
  for (const Claim& claim : claims()) EXPECT_TRUE(measured.count(claim.id)) << claim.id;
}

/// Asks to stop as soon as a run of a set is finished.
class Interrupting : public Silent {
 public:
  explicit Interrupting(fs::path set) : set_(std::move(set)) {}
  bool stop_requested() const override {
    const fs::directory_iterator files(set_);
    return std::any_of(begin(files), end(files),
                       [](const auto& file) { return file.path().extension() == ".h5"; });
  }

 private:
  fs::path set_;
};

TEST_F(SmallPaper, IsTheSameAfterAnInterruption) {
  const Figure& figure = *find_figure("3");
  Silent silent;
  PaperRuns whole = paper("whole"), parts = paper("parts");
  whole.claim_folder(false), parts.claim_folder(false);
  ASSERT_EQ(whole.run("ratio", 1, silent, false).computed, 6u);

  Interrupting interrupting(folder() / "parts/runs/ratio");
  EXPECT_EQ(parts.run("ratio", 1, interrupting, false).exit_code, runs::stopped);
  const auto rest = parts.run("ratio", 1, silent, false);
  EXPECT_EQ(rest.exit_code, runs::ok);
  EXPECT_GT(rest.computed, 0u);
  EXPECT_LT(rest.computed, rest.members) << "nothing was finished before the interruption";
  EXPECT_EQ(parts.run("ratio", 1, silent, false).computed, 0u);

  const std::string once = json_of(reproduce(figure, whole, claims()), Size::full);
  EXPECT_EQ(once, json_of(reproduce(figure, parts, claims()), Size::full));
  EXPECT_EQ(contents(folder() / "whole/figure-3.csv"), contents(folder() / "parts/figure-3.csv"));
  EXPECT_EQ(contents(folder() / "whole/figure-3.svg"), contents(folder() / "parts/figure-3.svg"));
}

TEST_F(SmallPaper, RefusesFoldersOfSomethingElse) {
  fs::create_directory(folder() / "mine");
  std::ofstream(folder() / "mine/thesis.txt") << "mine";
  const auto error = [&](PaperRuns runs) -> std::string {
    try {
      runs.claim_folder(false);
    } catch (const InputError& error) {
      return error.what();
    }
    return "none";
  };
  EXPECT_NE(error(paper("mine")).find("expected a new folder, one of needlework reproduce, or"),
            std::string::npos);
  paper("mine").claim_folder(true);
  EXPECT_EQ(contents(folder() / "mine/thesis.txt"), "mine");
  EXPECT_EQ(error(paper("mine")), "none");

  const std::string full = (folder() / "mine").string();
  EXPECT_NE(error({full, Size::quick, embedded_text}).find("another reproduction than the quick"),
            std::string::npos);
}

TEST_F(SmallPaper, TheQuickSizeHasNoTestsOfWhy) {
  const PaperRuns quick("quick", Size::quick, embedded_text),
      full("full", Size::full, embedded_text);
  EXPECT_FALSE(quick.has("dense-tc"));
  for (const Figure& figure : figures()) {
    for (const std::string& set : figure.sets) {
      EXPECT_TRUE(full.has(set)) << set;
      EXPECT_TRUE(quick.has(set) || figure.name.starts_with("tc-")) << set;
    }
  }
}

/// A finished run of the first set of figure 5a, in which S, the second moment and the order of
/// rotation grow in a known way.
class KnownRuns : public SmallPaper {
 protected:
  static constexpr double needles = 40;

  // S at so many collisions per needle; the seeds differ by a tenth.
  static double s(std::uint64_t seed, double collisions) {
    return 0.05 + 0.004 * collisions + 0.1 * (static_cast<double>(seed) - 2);
  }

  void write(const PaperRuns& runs) const {
    for (const Point& point : runs.points("dense")) {
      for (const std::uint64_t seed : {1, 2, 3}) write_run(*point.scene, seed, runs.folder());
    }
  }

 private:
  static void write_run(const Scene& start, std::uint64_t seed, const std::string& folder) {
    const fs::path file = fs::path(folder) / "runs/dense" /
                          ("k=" + std::to_string(int(start.needles.k)) +
                           ",t_rot=" + std::to_string(int(start.initial.t_rot)) +
                           ",seed=" + std::to_string(seed) + ".h5");
    fs::create_directories(file.parent_path());
    io::RunInfo info{.isa = "scalar"};
    info.series = {
        {"flow_order",
         "Order",
         {{"translational", "S", ""}, {"rotational", "R", ""}, {"second_moment", "M", ""}}}};
    io::Writer writer(file.string(), true, start, info);
    for (int sample = 0; sample <= 12; ++sample) {
      Totals totals;
      totals.time = sample;
      totals.t_tr = totals.t_rot = std::exp(-sample);
      totals.energy = 2.5 * totals.t_tr;
      const double collisions = 100.0 * sample;
      totals.collisions = static_cast<std::uint64_t>(collisions * needles / 2);
      totals.tc_collisions = 10 * totals.collisions / 100;
      const double moment = 0.05 * (1 + 5 * (collisions <= 500 ? collisions / 400 : 0));
      const double values[] = {s(seed, collisions), 0.25 * (1 + collisions / 1200),
                               moment};  // 8 cells
      writer.write_series(totals, values);
    }
    State state;
    state.box = start.needles.box;
    state.resize(static_cast<std::size_t>(needles));
    for (std::uint32_t i = 0; i < state.size(); ++i) {
      state.orientation[i] = {0, 0, 1};
      state.id[i] = i;
    }
    writer.write_frame(Totals(), state);
    writer.close();
  }
};

TEST_F(KnownRuns, GiveTheirNumbersToTheClaims) {
  PaperRuns runs = paper("known");
  runs.claim_folder(false);
  write(runs);
  std::map<std::string, Row> rows;
  for (const char* figure : {"5a", "moment", "rotation"}) {
    for (const Row& row : reproduce(*find_figure(figure), runs, claims())) rows[row.id()] = row;
  }
  const auto row = [&](const std::string& claim) { return rows.at(claim); };
  const std::string start = "k = 2, T_rot(0) = 0";

  const Row s600 = row("flow-order [" + start + ", at 600]");
  EXPECT_NEAR(s600.measured.value, 2.45, 1e-12);
  EXPECT_NEAR(s600.measured.error, 0.1 / std::sqrt(3), 1e-12);
  EXPECT_EQ(s600.measured.seeds, 3u);
  EXPECT_EQ(s600.verdict, Verdict::agrees);
  EXPECT_EQ(s600.figure, "5a");
  EXPECT_NEAR(row("flow-order [" + start + ", at 1200]").measured.value, 4.85, 1e-12);
  EXPECT_EQ(row("flow-order [" + start + ", at 1200]").verdict, Verdict::differs);

  EXPECT_NEAR(row("moment-growth [" + start + ", at 400]").measured.value, 6, 1e-12);
  EXPECT_EQ(row("moment-growth [" + start + ", at 400]").verdict, Verdict::agrees);
  EXPECT_NEAR(row("moment-peak [" + start + "]").measured.value, 500, 1e-12);
  EXPECT_NEAR(row("rotation-growth [" + start + ", at 600]").measured.value, 0.5, 1e-12);
  EXPECT_NEAR(row("tc-instances [dense, " + start + "]").measured.value, std::log10(2400), 1e-12);

  const auto json = nlohmann::json::parse(json_of(std::vector{s600}, Size::full));
  const auto& claim = json["claims"][0];
  EXPECT_EQ(claim["id"], "flow-order [" + start + ", at 600]");
  EXPECT_EQ(claim["figure"], "5a");
  EXPECT_EQ(claim["paper"], 2.5);
  EXPECT_EQ(claim["verdict"], "agrees");
  EXPECT_NEAR(claim["measured"].get<double>(), 2.45, 1e-12);
}

TEST_F(KnownRuns, AreReadAsTheyWereWritten) {
  PaperRuns runs = paper("known");
  runs.claim_folder(false);
  write(runs);
  const FinishedRun run = runs.points("dense").front().runs.at(1);
  EXPECT_EQ(run.seed, 2u);
  EXPECT_EQ(collisions_of(run).at(6), 600);
  const io::RecordedField field = run.field("flow_order/translational");
  EXPECT_EQ(field.times.size(), 13u);
  EXPECT_TRUE(field.shape.empty());
  EXPECT_EQ(field.row(6)[0], s(2, 600));
  EXPECT_THROW(run.field("flow_order/none"), InputError);
}

TEST(Course, InterpolatesBetweenSamples) {
  const std::vector<double> x{0, 1, 3}, y{5, 7, 3};
  EXPECT_EQ(interpolated(x, y, 0), 5);
  EXPECT_EQ(interpolated(x, y, 0.5), 6);
  EXPECT_EQ(interpolated(x, y, 2), 5);
  EXPECT_EQ(interpolated(x, y, 3), 3);
  EXPECT_TRUE(std::isnan(interpolated(x, y, 3.1)));
  EXPECT_TRUE(std::isnan(interpolated(x, y, -1)));
}

TEST(Course, ScalesTimeAsThePaperDoes) {
  Scene scene;
  scene.needles.count = 10000;
  scene.needles.box = {24, 24, 24};
  EXPECT_NEAR(time_scale(scene), 0.854771, 1e-6);
  scene.initial.t_tr = 4;
  EXPECT_NEAR(time_scale(scene), 2 * 0.854771, 2e-6);
}

TEST(Csv, HasNumbersUnderTheirNamesAndNothingForNan) {
  EXPECT_EQ(csv_of({{"a", "b"}, {{1, 2.5}, {std::nan(""), -1e-9}}}), "a,b\n1,2.5\n,-1e-09\n");
}

}  // namespace
}  // namespace needlework::reproduce
