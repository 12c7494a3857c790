// The command `needlework theory`, as other people's scripts see it.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "src/theory/theory.h"

namespace needlework {
namespace {

struct Outcome {
  int exit_code;
  std::string output;
};

/// Runs the program and keeps what it prints to one of its two streams.
Outcome run_theory(const std::string& arguments, bool keep_errors) {
  const std::string command = std::string("'") + NEEDLEWORK_PROGRAM + "' theory " + arguments +
                              (keep_errors ? " 2>&1 >/dev/null" : " 2>/dev/null");
  FILE* pipe = popen(command.c_str(), "r");
  EXPECT_NE(pipe, nullptr) << command;
  if (pipe == nullptr) return {-1, ""};
  Outcome outcome{};
  std::array<char, 4096> buffer;
  while (const std::size_t count = fread(buffer.data(), 1, buffer.size(), pipe)) {
    outcome.output.append(buffer.data(), count);
  }
  const int status = pclose(pipe);
  outcome.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return outcome;
}

Outcome printed_by(const std::string& arguments) { return run_theory(arguments, false); }
Outcome complaint_about(const std::string& arguments) { return run_theory(arguments, true); }

TEST(TheoryCommand, PrintsOneJsonObjectWithAllDigits) {
  const Outcome outcome =
      printed_by("--epsilon 0.8 --k 6 --t-rot0 0 --tau 100 --tau 1 --tau 1e8 --json");
  ASSERT_EQ(outcome.exit_code, 0);
  const auto json = nlohmann::ordered_json::parse(outcome.output);
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

TEST(TheoryCommand, PrintsNullForWhatIsUndefined) {
  const auto elastic = nlohmann::json::parse(printed_by("--epsilon 1 --k 6 --json").output);
  EXPECT_TRUE(elastic["c"].is_null());
  EXPECT_TRUE(elastic["k_star"].is_number());
  EXPECT_EQ(elastic["tau"], nlohmann::json::array());
  EXPECT_EQ(elastic["energy"], nlohmann::json::array());

  const auto rough =
      nlohmann::json::parse(printed_by("--epsilon 1 --k 6 --beta -0.5 --json").output);
  EXPECT_TRUE(rough["c"].is_number());
  EXPECT_TRUE(rough["k_star"].is_null());
}

TEST(TheoryCommand, StartsWithEqualTemperatures) {
  const auto json = nlohmann::json::parse(printed_by("--epsilon 0.8 --k 6 --tau 0 --json").output);
  EXPECT_EQ(json["t_tr"][0], 1.0);
  EXPECT_EQ(json["t_rot"][0], 1.0);
  EXPECT_EQ(json["energy"][0], 2.5);
}

TEST(TheoryCommand, PrintsATable) {
  const Outcome outcome = printed_by("--epsilon 0.8 --k 6 --t-rot0 0 --tau 1");
  EXPECT_EQ(outcome.exit_code, 0);
  for (const char* part : {"epsilon 0.8", "1.037732671", "4.360700345", "tau", "1.426099077"}) {
    EXPECT_NE(outcome.output.find(part), std::string::npos) << part << " in\n" << outcome.output;
  }
}

TEST(TheoryCommand, NamesFlagValueAndExpectation) {
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
    const Outcome outcome = complaint_about(bad.arguments);
    EXPECT_EQ(outcome.exit_code, 2) << bad.arguments;
    EXPECT_EQ(outcome.output, std::string("needlework: ") + bad.message + "\n");
    EXPECT_EQ(printed_by(bad.arguments).output, "") << bad.arguments;
  }
}

}  // namespace
}  // namespace needlework
