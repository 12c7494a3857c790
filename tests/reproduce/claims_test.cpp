// The claims of the paper, and files of claims with errors.
#include "src/reproduce/claims.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "needlework/error.h"
#include "src/reproduce/embedded_files.h"
#include "src/reproduce/figure.h"

namespace needlework::reproduce {
namespace {

constexpr const char* file = "profiles/paper/claims.toml";

std::vector<Claim> committed() { return read_claims(embedded_text(file), file); }

std::string error_of(const std::string& text) {
  try {
    read_claims(text, "claims.toml");
  } catch (const InputError& error) {
    return error.what();
  }
  return "none";
}

TEST(Claims, OfThePaperAreReadWithNumberAndPrecision) {
  const auto claims = committed();
  const auto claim = std::find_if(claims.begin(), claims.end(),
                                  [](const Claim& one) { return one.id == "equipartition-k"; });
  ASSERT_NE(claim, claims.end());
  EXPECT_EQ(claim->figure, "3");
  EXPECT_EQ(claim->paper.number, 4.3607);
  EXPECT_EQ(claim->paper.precision, 5e-5);
  EXPECT_NE(claim->statement.find("4.3607"), std::string::npos);
}

TEST(Claims, OfThePaperBelongToFiguresOfTheCommand) {
  for (const Claim& claim : committed()) {
    EXPECT_NE(find_figure(claim.figure), nullptr) << claim.id << ": " << claim.figure;
  }
}

TEST(Claims, OfThePaperSayWhereAndHow) {
  for (const Claim& claim : committed()) {
    EXPECT_TRUE(claim.statement.ends_with('.')) << claim.id;
    EXPECT_FALSE(claim.quantity.empty()) << claim.id;
  }
}

TEST(Claims, WithErrorsAreRefusedWithTheirPlace) {
  const std::string head = "[a]\nfigure = \"2\"\nstatement = \"S.\"\nquantity = \"q\"\n";
  EXPECT_EQ(error_of(head), "none");
  EXPECT_EQ(error_of("paper = 1\n"), "claims.toml: line 1: paper = 1: expected a claim, [ID]");
  EXPECT_EQ(
      error_of(head + "number = 1\n"),
      "claims.toml: line 5: a.number = 1: expected one of figure, statement, where, quantity, "
      "paper, precision, reading");
  EXPECT_EQ(error_of(head + "paper = \"2\"\n"),
            "claims.toml: line 5: a.paper = \"2\": expected a number");
  EXPECT_EQ(error_of(head + "paper = 2\nprecision = 0\n"),
            "claims.toml: line 6: a.precision = 0: expected a number greater than 0");
  EXPECT_EQ(error_of(head + "precision = 1\n"),
            "claims.toml: a.paper is missing: expected the number that has this precision");
  EXPECT_EQ(error_of("[a]\nfigure = \"2\"\nstatement = \"S.\"\n"),
            "claims.toml: a.quantity is missing: expected a text");
  EXPECT_EQ(error_of(head + "where = 3\n"), "claims.toml: line 5: a.where = 3: expected a text");
}

TEST(EmbeddedFiles, AreFoundByTheirPaths) {
  EXPECT_EQ(embedded_text("profiles/paper/full/../dense.toml"),
            embedded_text("profiles/paper/dense.toml"));
  EXPECT_THROW(embedded_text("profiles/paper/none.toml"), IoError);
}

TEST(Figures, HaveDifferentNames) {
  std::set<std::string> names;
  for (const Figure& figure : figures()) EXPECT_TRUE(names.insert(figure.name).second);
  for (const char* name : {"2", "3", "4", "5a", "5b", "6", "7", "8", "fluctuations", "moment",
                           "rotation", "relaxation"}) {
    EXPECT_TRUE(names.count(name)) << name;
  }
}

}  // namespace
}  // namespace needlework::reproduce
