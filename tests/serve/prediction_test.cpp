// First contacts of pairs over a pipe: those of the library, and errors that name field and pair.
#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "needlework/predict.h"
#include "src/json/base64.h"
#include "src/serve/server.h"

namespace needlework::serve {
namespace {

using json::base64_of;
using json::bytes_of;
using json::rows_of;
using json::text_of;
using Json = nlohmann::ordered_json;
using Vectors = std::vector<std::array<double, 3>>;

Json answer_to(const Json& request) {
  std::stringstream in(request.dump() + "\n"), out;
  serve(in, out);
  return Json::parse(out.str());
}

std::vector<double> numbers(const Json& answer, const char* field) {
  return rows_of<double>(answer.at(field).get<std::string>(), "a number");
}

/// Two that fly towards each other along z, the first along x, the second along y.
Json crossed(std::size_t count) {
  return {{"do", "predict"},
          {"r1", text_of(Vectors(count, {0, 0, 0}))},
          {"u1", text_of(Vectors(count, {1, 0, 0}))},
          {"r2", text_of(Vectors(count, {0.25, 0.125, 2}))},
          {"u2", text_of(Vectors(count, {0, 1, 0}))},
          {"v2", text_of(Vectors(count, {0, 0, -1}))},
          {"horizon", 10}};
}

TEST(ServePredict, GivesTheContactsOfTheLibrary) {
  constexpr std::size_t count = 200;
  std::mt19937_64 random(42);
  std::normal_distribution<double> normal;
  std::array<Vectors, 8> columns;
  std::vector<double> length1, diameter2, horizon;
  std::vector<std::uint8_t> skip;
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t n = 0; n < 8; ++n)
      columns[n].push_back({normal(random), normal(random), normal(random)});
    columns[4][i] = {columns[0][i][0] + 3, columns[0][i][1], columns[0][i][2]};
    const auto& v = columns[2][i];
    columns[6][i] = {v[0] - 3, v[1] + normal(random) / 2, v[2] + normal(random) / 2};
    length1.push_back(i % 5 == 0 ? 0 : 0.5 + 0.001 * static_cast<double>(i));
    diameter2.push_back(0.1 + 0.002 * static_cast<double>(i));
    horizon.push_back(i % 7 == 0 ? 0.5 : 20);
    skip.push_back(0);
  }
  Json request{
      {"do", "predict"},       {"length1", text_of(length1)},     {"length2", 0.75},
      {"diameter1", 0.3},      {"diameter2", text_of(diameter2)}, {"horizon", text_of(horizon)},
      {"skip", text_of(skip)}, {"accuracy", "rigorous"}};
  constexpr std::array names{"r1", "u1", "v1", "w1", "r2", "u2", "v2", "w2"};
  for (std::size_t n = 0; n < 8; ++n) request[names[n]] = text_of(columns[n]);
  const Json answer = answer_to(request);
  ASSERT_EQ(answer.at("ok"), true) << answer;
  EXPECT_EQ(answer.at("pairs"), count);
  const auto time = numbers(answer, "time"), s12 = numbers(answer, "s12"),
             s21 = numbers(answer, "s21");
  ASSERT_EQ(time.size(), count);
  int found = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const FirstContact expected =
        predict({columns[0][i], columns[1][i], columns[2][i], columns[3][i], length1[i], 0.3},
                {columns[4][i], columns[5][i], columns[6][i], columns[7][i], 0.75, diameter2[i]},
                horizon[i], false, rigorous_accuracy);
    EXPECT_EQ(time[i], expected.time) << i;
    if (time[i] == std::numeric_limits<double>::infinity()) continue;
    ++found;
    EXPECT_EQ(s12[i], expected.arm_first) << i;
    EXPECT_EQ(s21[i], expected.arm_second) << i;
  }
  EXPECT_GT(found, 10);
  EXPECT_LT(found, 190);
}

TEST(ServePredict, TakesNeedlesOfLengthOneWithoutSizes) {
  const Json needles = answer_to(crossed(3));
  EXPECT_EQ(numbers(needles, "time"), std::vector<double>(3, 2)) << needles;
  EXPECT_EQ(numbers(needles, "s12"), std::vector<double>(3, 0.25));
  EXPECT_EQ(numbers(needles, "s21"), std::vector<double>(3, -0.125));
  Json rods = crossed(3);
  rods["diameter1"] = 0.5;
  rods["diameter2"] = 0.25;
  EXPECT_EQ(numbers(answer_to(rods), "time"), std::vector<double>(3, 2 - 0.375));
  Json skipped = crossed(2);
  skipped["r2"] = text_of(Vectors(2, {0, 0, 0}));
  skipped["skip"] = text_of(std::vector<std::uint8_t>{1, 1});
  EXPECT_EQ(numbers(answer_to(skipped), "time"),
            std::vector<double>(2, std::numeric_limits<double>::infinity()));
  EXPECT_EQ(answer_to(crossed(0)).at("time"), "");
}

TEST(ServePredict, NamesTheFieldOrThePairThatIsWrong) {
  const auto expect = [](const char* field, const Json& value, int code, const char* message) {
    Json request = crossed(2);
    request[field] = value;
    const Json answer = answer_to(request);
    EXPECT_EQ(answer.at("code"), code) << answer;
    EXPECT_EQ(answer.at("message"), message);
  };
  const auto rows = [](std::size_t count) { return text_of(Vectors(count)); };
  expect("u1", nullptr, 2, "u1: expected an array of vectors in base64");
  expect("horizon", nullptr, 2, "horizon: expected a number, or an array in base64");
  expect("v1", rows(3), 2, "v1: 3 rows: expected 2");
  expect("skip", text_of(std::vector<std::uint8_t>(3)), 2, "skip: 3 bytes: expected 2");
  expect("length1", text_of(std::vector<double>(1)), 2, "length1: 1 numbers: expected 2");
  expect("diameter1", true, 2, "diameter1 = true: expected a number, or an array in base64");
  expect("accuracy", "perfect", 2,
         "engine.accuracy = \"perfect\": expected one of fast, standard, rigorous");
  expect("simulation", 1, 2,
         "simulation = 1: expected one of the fields do, id, r1, u1, v1, w1, r2, u2, v2, w2, "
         "horizon, skip, accuracy, length1, length2, diameter1, diameter2");
  expect("u2", text_of(Vectors{{1, 0, 0}, {0, 0, 0}}), 3,
         "pair 1: orientation = 0: expected a direction");
  expect("length2", -1, 3, "pair 0: length = -1: expected a number from 1e-150 to 1e+150");
}

}  // namespace
}  // namespace needlework::serve
