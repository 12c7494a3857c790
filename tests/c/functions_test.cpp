// First contacts and kinetic theory through C are those of the program.
#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>

#include "tests/c/c_simulation.h"
#include "tests/cli/program.h"

namespace needlework {
namespace {

class CFunctions : public ProgramTest {};

/// Pairs as arrays; the rows are those of needlework_pairs, r1 u1 v1 w1 r2 u2 v2 w2.
struct PairArrays {
  std::vector<double> horizon, numbers;
  std::vector<unsigned char> skip;

  needlework_pairs pairs(const char* accuracy) const {
    const auto column = [&](int n) {
      return needlework_const_vectors{numbers.data() + 3 * n, 24, 1};
    };
    return {horizon.size(), column(0), column(1), column(2),      column(3),   column(4),
            column(5),      column(6), column(7), horizon.data(), skip.data(), accuracy};
  }
};

TEST_F(CFunctions, PredictWhatTheProgramPredicts) {
  PairArrays arrays;
  std::ifstream file(NEEDLEWORK_SOURCE "/tests/cli/pairs/accuracy.csv");
  std::string line;
  while (std::getline(file, line)) {
    if (line.empty() || line[0] == '#' || line.starts_with("id,")) continue;
    std::istringstream fields(line);
    std::string field;
    std::vector<std::string> all;
    while (std::getline(fields, field, ',')) all.push_back(field);
    ASSERT_EQ(all.size(), 28u) << line;
    arrays.horizon.push_back(std::stod(all[2]));
    for (int n = 3; n < 27; ++n) arrays.numbers.push_back(std::stod(all[n]));
    arrays.skip.push_back(all[27] == "1");
  }
  ASSERT_GT(arrays.horizon.size(), 5u);
  const std::size_t count = arrays.horizon.size();
  for (const char* accuracy : {"fast", "standard", "rigorous"}) {
    std::vector<double> time(count), s12(count), s21(count);
    const needlework_pairs pairs = arrays.pairs(accuracy);
    needlework_error error;
    ASSERT_EQ(needlework_predict(&pairs, time.data(), s12.data(), s21.data(), &error),
              NEEDLEWORK_OK)
        << error.message;
    std::istringstream out(output_of(
        std::string("predict " NEEDLEWORK_SOURCE "/tests/cli/pairs/accuracy.csv --accuracy ") +
        accuracy));
    for (std::size_t n = 0; n < count; ++n) {
      do ASSERT_TRUE(std::getline(out, line));
      while (line.starts_with("id"));
      double expected[3];
      ASSERT_EQ(std::sscanf(line.substr(line.find(',')).c_str(), ",%lf,%lf,%lf", expected,
                            expected + 1, expected + 2),
                3);
      EXPECT_EQ(time[n], expected[0]) << line;
      EXPECT_TRUE(s12[n] == expected[1] || std::isnan(expected[1])) << line;
      EXPECT_TRUE(s21[n] == expected[2] || std::isnan(expected[2])) << line;
      EXPECT_EQ(std::isnan(s12[n]), std::isnan(expected[1])) << line;
    }
  }
}

TEST_F(CFunctions, SayWhichPairCannotBePredicted) {
  PairArrays arrays;
  arrays.horizon = {2, 2, 2};
  arrays.skip = {0, 0, 0};
  for (int n = 0; n < 3; ++n) {
    for (const double x : {.25, -.125, -.5, 1., 0., 0., 0., 0., 1., 0., 0., 0.,  //
                           0.,  0.,    0.,  0., 1., 0., 0., 0., 0., 0., 0., 0.}) {
      arrays.numbers.push_back(x);
    }
  }
  std::fill_n(&arrays.numbers[24 + 3], 3, 0);  // the director of the second pair's first needle
  const needlework_pairs pairs = arrays.pairs(nullptr);
  double time[3] = {-1, -1, -1};
  needlework_error error;
  EXPECT_EQ(needlework_predict(&pairs, time, nullptr, nullptr, &error), NEEDLEWORK_INPUT);
  EXPECT_STREQ(error.message, "pair 1: orientation = 0: expected a direction");
  EXPECT_EQ(time[0], 0.5);
  EXPECT_EQ(time[1], -1);
  for (const double wrong : {-1., std::numeric_limits<double>::quiet_NaN()}) {
    arrays.horizon[0] = wrong;
    EXPECT_EQ(needlework_predict(&pairs, time, nullptr, nullptr, &error), NEEDLEWORK_INPUT);
    EXPECT_TRUE(std::string(error.message).starts_with("pair 0: horizon = ")) << error.message;
  }
}

TEST_F(CFunctions, GiveTheTheoryOfTheProgram) {
  const nlohmann::json expected =
      json_of("theory --epsilon 0.8 --k 6 --beta 0.5 --t-rot0 0.5 --tau 1 --tau 10 --json");
  const needlework_gas gas{6, 0.8, 0.5};
  double ratio = 0, t_tr[2], t_rot[2];
  const double tau[2] = {1, 10};
  EXPECT_EQ(needlework_ratio(&gas, &ratio, nullptr), NEEDLEWORK_OK);
  EXPECT_EQ(ratio, expected["c"]);
  EXPECT_EQ(needlework_cooling(&gas, 1, 0.5, 2, tau, t_tr, t_rot, nullptr), NEEDLEWORK_OK);
  for (int n = 0; n < 2; ++n) {
    EXPECT_EQ(t_tr[n], expected["t_tr"][n]);
    EXPECT_EQ(t_rot[n], expected["t_rot"][n]);
  }
  EXPECT_EQ(needlework_cooling(&gas, 1, 0.5, 0, nullptr, nullptr, nullptr, nullptr), NEEDLEWORK_OK);

  double once = 0, twice = 0;
  EXPECT_EQ(needlework_collision_rate(6, 0.1, 1, 1, &once, nullptr), NEEDLEWORK_OK);
  EXPECT_EQ(needlework_collision_rate(6, 0.2, 1, 1, &twice, nullptr), NEEDLEWORK_OK);
  EXPECT_EQ(twice, 2 * once);
  const needlework_gas elastic{6, 1, -1};
  EXPECT_EQ(needlework_ratio(&elastic, &ratio, nullptr), NEEDLEWORK_OK);
  EXPECT_TRUE(std::isnan(ratio));
}

}  // namespace
}  // namespace needlework
