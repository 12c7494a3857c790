// `needlework predict` as a user runs it: lines in, lines or JSON out, exit codes.
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "needlework/predict.h"
#include "tests/cli/program.h"
#include "tests/support/pairs_csv.h"

namespace needlework::test {
namespace {

class PredictCommand : public ProgramTest {
 protected:
  Outcome run_on(const std::string& text, const std::string& flags = "") const {
    write("pairs.csv", text);
    return run("predict pairs.csv " + flags);
  }
};

const std::string meets = "7,hand,2,.25,-.125,-.5,1,0,0,0,0,.75,0,0,0,0,0,0,0,1,0,0,0,0,0,0,0,0";
const std::string misses = "b,,2,.75,-.125,-.5,1,0,0,0,0,.75,0,0,0,0,0,0,0,1,0,0,0,0,0,0,0,0";

/// The line that the pair `meets` must give: at 2/3, with the digits that the library finds.
std::string answer_to_meets() {
  const FirstContact contact = predict({{.25, -.125, -.5}, {1, 0, 0}, {0, 0, .75}, {0, 0, 0}},
                                       {{0, 0, 0}, {0, 1, 0}, {0, 0, 0}, {0, 0, 0}}, 2, false);
  EXPECT_NEAR(contact.time, 2.0 / 3, 1e-15);
  EXPECT_NEAR(contact.arm_first, -.25, 1e-15);
  EXPECT_NEAR(contact.arm_second, -.125, 1e-15);
  return fmt::format("7,{:.17g},{:.17g},{:.17g}\n", contact.time, contact.arm_first,
                     contact.arm_second);
}

TEST_F(PredictCommand, PrintsOneLineForEachPair) {
  const Outcome outcome = run_on("# a comment\nid,family,horizon\n\n" + meets + "\r\n  " + misses);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.out, answer_to_meets() + "b,inf,nan,nan\n");
  EXPECT_EQ(outcome.err, "");
}

TEST_F(PredictCommand, PrintsJsonWithNullsForWhatIsUndefined) {
  const Outcome outcome = run_on(meets + '\n' + misses + '\n', "--json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto pairs = outcome.json().at("pairs");
  ASSERT_EQ(pairs.size(), 2u);
  EXPECT_EQ(pairs[0].at("id"), 7);
  EXPECT_NEAR(pairs[0].at("time").get<double>(), 2.0 / 3, 1e-15);
  EXPECT_NEAR(pairs[0].at("s12").get<double>(), -0.25, 1e-15);
  EXPECT_NEAR(pairs[0].at("s21").get<double>(), -0.125, 1e-15);
  EXPECT_TRUE(pairs[0].at("evaluations").is_number_unsigned());
  EXPECT_TRUE(pairs[0].at("escalations").is_number_unsigned());
  EXPECT_EQ(pairs[1].at("id"), "b");
  for (const char* key : {"time", "s12", "s21"}) EXPECT_TRUE(pairs[1].at(key).is_null()) << key;
}

TEST_F(PredictCommand, ReadsStandardInput) {
  write("pairs.csv", meets + '\n');
  EXPECT_EQ(shell("{ '" NEEDLEWORK_PROGRAM "' predict - <pairs.csv; }").out, answer_to_meets());
  EXPECT_EQ(run("predict -").exit_code, 0);
  EXPECT_EQ(run("predict --json -").out, "{\"pairs\":[]}\n");
}

TEST_F(PredictCommand, NamesTheBadPlaceAndPrintsNoResults) {
  const auto expect = [&](std::size_t column, const char* value, const std::string& message) {
    std::stringstream fields(meets);
    std::string line, field;
    for (std::size_t i = 0; std::getline(fields, field, ','); ++i) {
      if (i > 0) line += ',';
      line += i == column ? value : field;
    }
    const Outcome outcome = run_on(meets + '\n' + line + '\n');
    EXPECT_EQ(outcome.exit_code, 3) << line;
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(outcome.err, "needlework: pairs.csv: line 2: column " + message + '\n');
  };
  expect(2, "-1", "horizon = -1: expected a time, 0 or later");
  expect(2, "inf", "horizon = inf: expected a finite number");
  expect(3, "x", "r1x = x: expected a finite number");
  expect(10, "1.5.5", "v1y = 1.5.5: expected a finite number");
  expect(14, "", "w1z = : expected a finite number");
  expect(15, "nan", "r2x = nan: expected a finite number");
  expect(26, "1e999", "w2z = 1e999: expected a number that a double can hold");
  expect(27, "2", "skip = 2: expected 0 or 1");
  expect(27, "0,1", "Lb = (missing): expected 28 columns, or 32 with La, Lb, Da, Db, found 29");
  expect(6, "0", "u1 = (0, 0, 0): expected a director that is not 0");
  expect(0, "", "id = (empty): expected a name or number");
  EXPECT_TRUE(run_on(std::string("\n").append(meets, 0, meets.size() - 2))
                  .fails(3,
                         "pairs.csv: line 2: column skip = (missing): expected 28 columns, "
                         "or 32 with La, Lb, Da, Db, found 27"));
}

// Two spheres of diameter 1 that fly at each other meet when their centres are 1 apart; crossed
// rods do so before needles, which meet where they cross.
TEST_F(PredictCommand, TakesLengthsAndDiameters) {
  const std::string head_on = "a,,10,0,0,0,1,0,0,1,0,0,0,0,0,5,0,0,0,1,0,-1,0,0,0,0,0,0";
  const std::string crossed = "b,,10,0,0,0,1,0,0,0,0,1,0,0,0,0,0,5,0,1,0,0,0,0,0,0,0,0";
  const Outcome outcome = run_on(head_on + ",0,0,1,1\n" + crossed + "\n" + crossed +
                                 ",1,1,0.5,0.5\n" + crossed + ",3,1,0,0\n");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.out, "a,2,0,0\nb,5,0,0\nb,4.5,0,0\nb,5,0,0\n");
  EXPECT_EQ(run_on(crossed + ",1,1,0.5,0\n").out, "b,4.75,0,0\n");
  EXPECT_TRUE(run_on(crossed + ",1,1,12,12\n").complains("the rods overlap"));
}

// Finite numbers with which a prediction would take too long, or would overflow.
TEST_F(PredictCommand, RefusesPairsThatWouldTakeTooLong) {
  const auto line = [](const char* horizon, const char* v, const char* w) {
    return std::string("1,,") + horizon + ",.25,-.125,-.5,1,0,0,0,0," + v + ",0,0," + w +
           ",0,0,0,0,3,0,0,0,-" + v + ",0,0,0,0\n";
  };
  EXPECT_TRUE(run_on(line("1", "1e308", "0")).complains("pairs.csv: line 1: velocity"));
  EXPECT_EQ(run_on(line("1", "1e300", "0")).exit_code, 0);
  EXPECT_EQ(run_on(line("1e-290", "1", "1e299")).exit_code, 3);
  // Far apart, or soon apart again, needles may turn as they like.
  EXPECT_EQ(run_on("1,,1e300,5,0,0,1,0,0,0,1,0,0,0,1e3,0,0,0,0,1,0,0,0,0,0,0,0,0").exit_code, 0);
  EXPECT_EQ(run_on(line("1e9", "1", "1e3")).exit_code, 0);
}

// Needles in one plane that is tilted, up to rounding; needles that turn in parallel planes; and a
// needle that turns beside one at rest.
TEST_F(PredictCommand, GivesUpPairsThatTurnNearEachOtherForEver_long) {
  for (const std::string pair : {".9,.1,.2,.3,.7,-.1,0,0,0,1,1,.7,0,0,0,.3,.7,-.1,0,0,0,1,1,.7,0",
                                 "0,0,.5,1,0,0,0,0,0,0,0,1e3,0,0,0,0,1,0,0,0,0,0,0,-711.3,0",
                                 "0,0,.9,1,0,0,0,0,0,0,0,1e3,0,0,0,0,1,0,0,0,0,0,0,0,0"}) {
    for (const std::string accuracy : {"standard", "rigorous"}) {
      write("pairs.csv", "1,,1e9," + pair + "\n");
      // The limit of the CPU time, in seconds, ends a program that hangs.
      const Outcome outcome =
          shell("{ ulimit -t 20; exec '" NEEDLEWORK_PROGRAM "' predict pairs.csv --accuracy " +
                accuracy + "; }");
      EXPECT_TRUE(outcome.fails(3, "pairs.csv: line 1: no contact by time ")) << accuracy << pair;
      EXPECT_TRUE(outcome.complains(": expected a horizon that ends before"));
      EXPECT_EQ(run_on("1,,1," + pair, "--accuracy " + accuracy).out, "1,inf,nan,nan\n");
    }
  }
}

// A needle whose centre stays, to within rounding, on the line of another one while it turns.
TEST_F(PredictCommand, GivesUpAPairThatItCannotDecide_long) {
  for (const std::string accuracy : {"standard", "rigorous"}) {
    write("pairs.csv", "1,,1e300,0,0,0,1,0,0,1,0,0,0,1e300,0,0,0.1,0,0,1,0,-1,0,0,0,0,1,0\n");
    EXPECT_TRUE(shell("{ ulimit -t 20; exec '" NEEDLEWORK_PROGRAM
                      "' predict pairs.csv --accuracy " +
                      accuracy + "; }")
                    .fails(3, "pairs.csv: line 1: no contact by time 0, after "))
        << accuracy;
  }
}

// Contacts are found as far away as a double can hold their times.
TEST_F(PredictCommand, FindsContactsFarAwayOrRefusesToLookForThem) {
  const auto at = [&](const std::string& distance) {
    write("pairs.csv",
          "1,,1e300," + distance + ",0,0,0,1,0,-1,0,0,0,0,0,0,0,0,0,0,1,0,0,0,0,0,0,0\n");
    return shell("{ ulimit -t 20; exec '" NEEDLEWORK_PROGRAM "' predict pairs.csv; }");
  };
  EXPECT_EQ(at("1e14").out, "1,100000000000000,0,0\n");
  EXPECT_TRUE(at("1e17").fails(3, "pairs.csv: line 1: no contact by time 1e+17, after which"));
}

TEST_F(PredictCommand, WarnsOfAFileWithoutPairs) {
  const Outcome nothing = run_on("\xEF\xBB\xBFid,family,horizon\n");
  EXPECT_EQ(nothing.exit_code, 0);
  EXPECT_EQ(nothing.err, "needlework: warning: pairs.csv: there are no pairs in it\n");
  EXPECT_EQ(run_on(meets, "--sampling-step nan").exit_code, 2);
  EXPECT_EQ(run_on(meets, "--root-tolerance nan").exit_code, 2);
  EXPECT_TRUE(run_on(meets, "--sampling-step 0.1").complains("engine.sampling_step"));
}

TEST_F(PredictCommand, HasAnExitCodeForEachKindOfError) {
  EXPECT_TRUE(run("predict absent.csv").fails(5, "absent.csv: cannot be read: "));
  EXPECT_EQ(run("predict .").exit_code, 5);
  EXPECT_EQ(run_on(meets, "--accuracy best").exit_code, 2);
  EXPECT_EQ(run("predict").exit_code, 2);
  EXPECT_EQ(run("predict pairs.csv", "", "/dev/full").exit_code, 5);
}

TEST_F(PredictCommand, FindsWhatTheLibraryFinds) {
  std::vector<NeedlePair> pairs;
  for (const PairFamily& family : pair_families()) {
    for (const NeedlePair& pair : draw_pairs(family.name, 50, 9)) pairs.push_back(pair);
  }
  std::stringstream file;
  write_pairs(file, pairs);
  const Outcome outcome = run_on(file.str());
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  std::stringstream lines(outcome.out);
  const auto same = [](double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); };
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const NeedlePair& pair = pairs[i];
    const FirstContact found = predict(pair.first, pair.second, pair.horizon, pair.just_collided);
    std::string line;
    ASSERT_TRUE(std::getline(lines, line));
    char* at = nullptr;
    EXPECT_EQ(std::strtoul(line.c_str(), &at, 10), i);
    for (const double value : {found.time, found.arm_first, found.arm_second}) {
      EXPECT_TRUE(same(std::strtod(at + 1, &at), value)) << line;
    }
  }
}

}  // namespace
}  // namespace needlework::test
