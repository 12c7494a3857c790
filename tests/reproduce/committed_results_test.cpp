// The results in docs/reproduction are those of the committed claims and figures.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "src/reproduce/embedded_files.h"
#include "src/reproduce/reproduction.h"

namespace needlework::reproduce {
namespace {

const std::filesystem::path folder = NEEDLEWORK_SOURCE "/docs/reproduction";

nlohmann::json committed() {
  return nlohmann::json::parse(std::ifstream(folder / "claims-all.json"));
}

std::map<std::string, Claim> claims() {
  std::map<std::string, Claim> all;
  for (const Claim& claim :
       read_claims(embedded_text("profiles/paper/claims.toml"), "claims.toml")) {
    all[claim.id] = claim;
  }
  return all;
}

std::optional<double> number(const nlohmann::json& value) {
  if (value.is_null()) return std::nullopt;
  return value.get<double>();
}

TEST(CommittedResults, AreOfTheFullSize) { EXPECT_EQ(committed()["size"], "full"); }

TEST(CommittedResults, HaveEachClaimWithItsNumbersAndVerdicts) {
  const auto all = claims();
  auto missing = all;
  const nlohmann::json results = committed();
  for (const nlohmann::json& row : results["claims"]) {
    const std::string id = row["claim"];
    const auto found = all.find(id);
    ASSERT_NE(found, all.end()) << id;
    const Claim& claim = found->second;
    EXPECT_EQ(row["statement"], claim.statement);
    EXPECT_EQ(row["quantity"], claim.quantity);
    EXPECT_EQ(number(row["paper"]), claim.paper.number) << id;
    EXPECT_EQ(number(row["precision"]), claim.paper.precision) << id;
    Measured measured{number(row["measured"]).value_or(std::nan("")),
                      number(row["error"]).value_or(std::nan(""))};
    if (!row["seeds"].is_null()) measured.seeds = row["seeds"].get<std::size_t>();
    EXPECT_EQ(row["verdict"], name_of(verdict_of(claim.paper, measured))) << row["id"];
    missing.erase(id);
  }
  for (const auto& [id, claim] : missing) ADD_FAILURE() << id << " has no result";
}

TEST(CommittedResults, HaveDataAndPictureOfEachFigure) {
  for (const Figure& figure : figures()) {
    for (const char* ending : {".csv", ".svg"}) {
      EXPECT_TRUE(std::filesystem::exists(folder / ("figure-" + figure.name + ending)))
          << figure.name << ending;
    }
  }
}

}  // namespace
}  // namespace needlework::reproduce
