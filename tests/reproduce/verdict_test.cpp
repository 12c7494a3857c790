// Verdicts: each of the three, and each way to be open.
#include "src/reproduce/verdict.h"

#include <gtest/gtest.h>

#include <cmath>

namespace needlework::reproduce {
namespace {

// The paper says 2.5, within 0.1.
Verdict verdict(const Measured& measured) { return verdict_of({2.5, 0.1}, measured); }

TEST(Verdict, AgreesWithinThreeStandardErrorsPlusThePrecision) {
  EXPECT_EQ(verdict({2.5, 0.01, 3}), Verdict::agrees);
  EXPECT_EQ(verdict({2.62, 0.01, 3}), Verdict::agrees);
  EXPECT_EQ(verdict({2.38, 0.01, 3}), Verdict::agrees);
  EXPECT_EQ(verdict({2.59, 0, 3}), Verdict::agrees);
}

TEST(Verdict, DiffersBeyondThat) {
  EXPECT_EQ(verdict({2.64, 0.01, 3}), Verdict::differs);
  EXPECT_EQ(verdict({2.36, 0.01, 3}), Verdict::differs);
  EXPECT_EQ(verdict({2.61, 0, 3}), Verdict::differs);
  EXPECT_EQ(verdict({-2.5, 0.1, 30}), Verdict::differs);
}

TEST(Verdict, IsOpenWithoutANumberOrAPrecision) {
  EXPECT_EQ(verdict_of({}, {2.5, 0.01, 3}), Verdict::open);
  EXPECT_EQ(verdict_of({2.5, {}}, {2.5, 0.01, 3}), Verdict::open);
}

TEST(Verdict, IsOpenWithFewerThanThreeSeeds) {
  EXPECT_EQ(verdict({2.5, 0.01, 2}), Verdict::open);
  EXPECT_EQ(verdict({9.5, 0.01, 0}), Verdict::open);
}

TEST(Verdict, IsOpenWithAStandardErrorAboveThePrecision) {
  EXPECT_EQ(verdict({2.5, 0.1, 3}), Verdict::agrees);
  EXPECT_EQ(verdict({2.5, 0.101, 3}), Verdict::open);
  EXPECT_EQ(verdict({9.5, 0.101, 3}), Verdict::open);
}

TEST(Verdict, IsOpenWithoutAMeasurement) {
  EXPECT_EQ(verdict({std::nan(""), 0.01, 3}), Verdict::open);
  EXPECT_EQ(verdict({2.5, std::nan(""), 3}), Verdict::open);
  EXPECT_EQ(verdict({INFINITY, 0.01, 3}), Verdict::open);
}

TEST(Verdict, NeedsNoSeedsWhereThereIsNoChance) {
  EXPECT_EQ(verdict({2.5, 0, {}}), Verdict::agrees);
  EXPECT_EQ(verdict({2.7, 0, {}}), Verdict::differs);
}

TEST(Verdict, HasTheNamesOfTheCommand) {
  EXPECT_EQ(name_of(Verdict::agrees), "agrees");
  EXPECT_EQ(name_of(Verdict::differs), "differs");
  EXPECT_EQ(name_of(Verdict::open), "open");
}

}  // namespace
}  // namespace needlework::reproduce
