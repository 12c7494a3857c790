// `needlework reproduce`: a figure from the beginning, and wrong usage.
#include "tests/cli/program.h"

namespace needlework {
namespace {

using nlohmann::json;

class ReproduceCommand : public ProgramTest {};

TEST_F(ReproduceCommand, MakesAFigureWithItsClaims) {
  const Outcome outcome = run("reproduce relaxation --quick --out all --json --quiet");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const json result = outcome.json();
  EXPECT_EQ(result["size"], "quick");
  std::size_t in_equilibrium = 0;
  for (const json& claim : result["claims"]) {
    EXPECT_EQ(claim["figure"], "relaxation");
    for (const char* key : {"id", "paper", "measured", "error", "verdict"}) {
      EXPECT_TRUE(claim.contains(key)) << key;
    }
    if (claim["claim"] != "elastic-equipartition") continue;
    ++in_equilibrium;
    EXPECT_EQ(claim["seeds"], 3);
    EXPECT_NEAR(claim["measured"], 1, 0.1) << claim["id"];  // 3 to 15 standard errors
  }
  EXPECT_EQ(in_equilibrium, 2u);  // the runs at half the density are too short
  EXPECT_EQ(read("all/claims-relaxation.json"), outcome.out);
  EXPECT_TRUE(exists("all/figure-relaxation.csv"));
  EXPECT_TRUE(exists("all/figure-relaxation.svg"));

  // Nothing is left to run, so the same is there at once; neither is an error of the other size.
  EXPECT_EQ(run("reproduce relaxation --quick --out all --json --quiet").out, outcome.out);
  const Outcome other = run("reproduce relaxation --out all");
  EXPECT_EQ(other.exit_code, 3);
  EXPECT_NE(other.err.find("holds another reproduction than the full one"), std::string::npos);
}

TEST_F(ReproduceCommand, RefusesWhatItCannotDo) {
  const Outcome none = run("reproduce 9 --quick");
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_NE(none.err.find("9: expected one of all, 2, 3, 4, 5a"), std::string::npos) << none.err;
  EXPECT_EQ(run("reproduce").exit_code, 2);
  const Outcome why = run("reproduce tc-dense --quick");
  EXPECT_EQ(why.exit_code, 2);
  EXPECT_TRUE(why.complains("tc-dense --quick: expected no --quick"));
  EXPECT_EQ(files(), std::vector<std::string>{small});
}

TEST_F(ReproduceCommand, KeepsFoldersOfSomethingElse) {
  const Outcome outcome = run("reproduce 3 --quick --out .");
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_TRUE(outcome.complains("--out .: expected a new folder, one of needlework reproduce, or"));
}

TEST_F(ReproduceCommand, StopsAtASignalAndSaysHowToContinue) {
  const Outcome outcome = run_and_signal("reproduce 2 --quick --out part --threads 1",
                                         "ls part/runs/dilute/*.part", "TERM");
  EXPECT_EQ(outcome.exit_code, 75);
  EXPECT_NE(outcome.err.find("needlework reproduce 2 --quick --out part continues"),
            std::string::npos)
      << outcome.err;
  EXPECT_FALSE(exists("part/figure-2.csv"));
}

}  // namespace
}  // namespace needlework
