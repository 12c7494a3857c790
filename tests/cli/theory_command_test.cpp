// The command `needlework theory`, as other people's scripts see it.
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "needlework/theory.h"
#include "tests/cli/program.h"

namespace needlework {
namespace {

using TheoryCommand = ProgramTest;

TEST_F(TheoryCommand, PrintsOneJsonObjectWithAllDigits) {
  const Outcome outcome =
      run("theory --epsilon 0.8 --k 6 --t-rot0 0 --tau 100 --tau 1 --tau 1e8 --json");
  ASSERT_EQ(outcome.exit_code, 0);
  const auto json = nlohmann::ordered_json::parse(outcome.out);
  std::vector<std::string> keys;
  for (const auto& item : json.items()) keys.push_back(item.key());
  EXPECT_EQ(keys, (std::vector<std::string>{"epsilon", "beta", "k", "c", "k_star", "tau", "t_tr",
                                            "t_rot", "energy"}));

  const theory::Gas gas{6.0, 0.8, -1.0};
  const std::vector<double> taus = {100.0, 1.0, 1e8};
  const auto curve = theory::cooling_curve(gas, {1.0, 0.0}, taus);
  EXPECT_EQ(json["epsilon"], 0.8);
  EXPECT_EQ(json["beta"], -1.0);
  EXPECT_EQ(json["k"], 6.0);
  EXPECT_EQ(json["c"].get<double>(), theory::asymptotic_ratio(gas));
  EXPECT_EQ(json["k_star"].get<double>(), theory::equipartition_k());
  EXPECT_EQ(json["tau"].get<std::vector<double>>(), taus);
  for (std::size_t i = 0; i < taus.size(); ++i) {
    EXPECT_EQ(json["t_tr"][i].get<double>(), curve[i].t_tr);
    EXPECT_EQ(json["t_rot"][i].get<double>(), curve[i].t_rot);
    EXPECT_EQ(json["energy"][i].get<double>(), curve[i].energy());
  }
}

TEST_F(TheoryCommand, PrintsNullForWhatIsUndefined) {
  const auto elastic = run("theory --epsilon 1 --k 6 --json").json();
  EXPECT_TRUE(elastic["c"].is_null());
  EXPECT_TRUE(elastic["k_star"].is_number());
  EXPECT_EQ(elastic["tau"], nlohmann::json::array());
  EXPECT_EQ(elastic["energy"], nlohmann::json::array());

  const auto rough = run("theory --epsilon 1 --k 6 --beta -0.5 --json").json();
  EXPECT_TRUE(rough["c"].is_number());
  EXPECT_TRUE(rough["k_star"].is_null());
}

TEST_F(TheoryCommand, StartsWithEqualTemperatures) {
  const auto json = run("theory --epsilon 0.8 --k 6 --tau 0 --json").json();
  EXPECT_EQ(json["t_tr"][0], 1.0);
  EXPECT_EQ(json["t_rot"][0], 1.0);
  EXPECT_EQ(json["energy"][0], 2.5);
}

TEST_F(TheoryCommand, PrintsATable) {
  const Outcome outcome = run("theory --epsilon 0.8 --k 6 --t-rot0 0 --tau 1");
  EXPECT_EQ(outcome.exit_code, 0);
  for (const char* part : {"epsilon 0.8", "1.037732671", "4.360700345", "tau", "1.426099077"}) {
    EXPECT_NE(outcome.out.find(part), std::string::npos) << part << " in\n" << outcome.out;
  }
}

TEST_F(TheoryCommand, NamesFlagValueAndExpectation) {
  struct Case {
    const char *arguments, *message;
  };
  for (const Case& bad :
       {Case{"--epsilon 1.5 --k 6", "--epsilon 1.5: expected a number in [0, 1]"},
        Case{"--epsilon nan --k 6", "--epsilon nan: expected a number in [0, 1]"},
        Case{"--epsilon 0.8 --k 0", "--k 0: expected a number in [1e-12, 1e12]"},
        Case{"--epsilon 0.8 --k six", "--k six: expected a number in [1e-12, 1e12]"},
        Case{"--epsilon 0.8 --k 6 --beta -1.5", "--beta -1.5: expected a number in [-1, 1]"},
        Case{"--epsilon 0.8 --k 6 --tau -1", "--tau -1: expected a finite number, 0 or more"},
        Case{"--epsilon 0.8 --k 6 --t-rot0 inf",
             "--t-rot0 inf: expected a finite number, 0 or more"}}) {
    const Outcome outcome = run(std::string("theory ") + bad.arguments);
    EXPECT_EQ(outcome.exit_code, 2) << bad.arguments;
    EXPECT_EQ(outcome.err, std::string("needlework: ") + bad.message + "\n");
    EXPECT_EQ(outcome.out, "") << bad.arguments;
  }
}

}  // namespace
}  // namespace needlework
