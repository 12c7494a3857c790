// Distributions of sizes: values of 20 digits, moments, ends, refusals, bits.
#include "needlework/distribution.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "src/random/needle_random.h"
#include "tests/support/statistics.h"

namespace needlework {

void PrintTo(const Distribution& d, std::ostream* out) {
  *out << name_of(d.shape);
  for (const auto& [name, value] : {std::pair("mean", d.mean),
                                    {"width", d.width},
                                    {"min", d.least},
                                    {"max", d.greatest},
                                    {"exponent", d.exponent}}) {
    if (value) *out << " " << name << " " << *value;
  }
}

namespace {

using Shape = Distribution::Shape;

constexpr std::uint64_t all_bits = std::uint64_t{1} << 53;

// Values at the probabilities (j + 1/2) / 2^53, by definition, computed with 50 digits.
constexpr std::array<std::uint64_t, 8> some_bits{0,
                                                 (1 << 20) + 7,
                                                 all_bits / 4 + 1,
                                                 all_bits / 2 - 1,
                                                 all_bits / 2,
                                                 3 * all_bits / 4 + 12345,
                                                 all_bits - (1 << 20),
                                                 all_bits - 1};
struct Case {
  Distribution distribution;
  std::array<double, 8> values;
};
const std::vector<Case>& cases() {
  static const std::vector<Case> all{
      {{Shape::uniform, 1.5, 0.5, {}, {}, {}},
       {0.20096189432334217408, 0.20096189462580007146, 0.85048094716167144759,
        1.4999999999999998558, 1.5000000000000001442, 2.1495190528418899754, 2.7990381053742022361,
        2.7990381056766578259}},
      {{Shape::uniform, 1.5, 1e-06, {}, {}, {}},
       {1.4999974019237886467, 1.4999974019237892516, 1.4999987009618943233, 1.5, 1.5,
        1.5000012990381056838, 1.5000025980762107484, 1.5000025980762113533}},
      {{Shape::uniform, 1.0, 0.5, {}, 1.2, {}},
       {0.13397459621556141241, 0.13397459633966393134, 0.40048094716167118135,
        0.66698729810778059524, 0.66698729810778071359, 0.93349364905535142696,
        1.1999999998758983243, 1.1999999999999998964}},
      {{Shape::normal, 1.0, 0.3, 0.1, {}, {}},
       {0.10000000000000375813, 0.10000000786978632328, 0.79860783914563509068,
        1.0005075541282254013, 1.0005075541282254847, 1.2026656353029855737, 2.9014498009569207618,
        3.4877565099875621418}},
      {{Shape::normal, 1.0, 0.2, 1.5, {}, {}},
       {1.5000000000000000039, 1.5000000000082484364, 1.5200580214108292384, 1.5472999382274287603,
        1.5472999382274287749, 1.5914327333831984307, 2.4159183083268995772,
        2.7753180707244405317}},
      {{Shape::normal, 2.0, 1e-06, 1.0, {}, {}},
       {1.9999834152778483728, 1.9999873240866954999, 1.9999986510204996078, 2.0, 2.0,
        2.0000013489795004008, 2.000012675915656082, 2.0000165847221516272}},
      {{Shape::lognormal, 1.0, 0.3, {}, {}, {}},
       {0.083961450334152379212, 0.14902192944809405435, 0.78576908479815239221,
        0.95782628522115135644, 0.95782628522115143469, 1.1675582692304331106,
        6.1563523752782497887, 10.926814496525838978}},
      {{Shape::lognormal, 2.5, 1.0, {}, {}, {}},
       {0.0017746956962951087348, 0.0090320321321249031853, 1.0082010356472020123,
        1.7677669529663686062, 1.7677669529663690158, 3.0995802320369255814, 345.99113614541010493,
        1760.8652607451600428}},
      {{Shape::lognormal, 1.0, 0.3, 0.5, 1.25, {}},
       {0.50000000000000019071, 0.50000000039996100732, 0.7593646085480833102,
        0.89971695215813975784, 0.89971695215813981832, 1.0450152759300033327,
        1.2499999998700536921, 1.249999999999999938}},
      {{Shape::lognormal, 1.0, 0.3, 2.0, {}, {}},
       {2.0000000000000000115, 2.0000000000241521256, 2.0596069691522817991, 2.1434315376047695025,
        2.1434315376047695484, 2.286563690045352143, 7.6607752031814242833, 12.980661713204790804}},
      {{Shape::gamma, 1.0, 0.3, {}, {}, {}},
       {0.015565694831739998224, 0.060090738116086359997, 0.78475042310763848417,
        0.97016529244193301934, 0.97016529244193310136, 1.1827967690144847288, 4.192619470941305168,
        5.7901552746721634649}},
      {{Shape::gamma, 3.0, 1.0, {}, {}, {}},
       {1.6653345369377348569e-16, 3.492484635029389315e-10, 0.86304621735534344845,
        2.0794415416798355952, 2.0794415416798362613, 4.1588830833761193665, 68.621572305946401302,
        112.28984325071114013}},
      {{Shape::gamma, 1.0, 0.3, {}, 0.5, {}},
       {0.011107115723379641609, 0.042362111760048482365, 0.40666075224871439297,
        0.44944684310842338992, 0.44944684310842340476, 0.47792335221506422237,
        0.49999999999071732244, 0.49999999999999999557}},
      {{Shape::gamma, 1.0, 0.3, 2.0, 2.5, {}},
       {2.0000000000000000084, 2.0000000000176297932, 2.0430379783172680207, 2.1018108414265260855,
        2.101810841426526117, 2.1963484866426163013, 2.4999999995223353354, 2.4999999999999997722}},
      {{Shape::gamma, 1.0, 0.01, {}, {}, {}},
       {0.91932075543005712607, 0.93792018686009611341, 0.99323705649041880004,
        0.99996666686420474098, 0.99996666686420474376, 1.0067266062389421703, 1.064691012296006133,
        1.0851964330031034488}},
      {{Shape::powerlaw, {}, {}, 1.0, 20.0, 2.5},
       {1.0000000000000000366, 1.0000000000767430549, 1.208413263416913653, 1.5756784148623279286,
        1.5756784148623281567, 2.4650260642017127572, 19.999999862718898542,
        19.999999999999934539}},
      {{Shape::powerlaw, {}, {}, 1.0, 20.0, 1.0},
       {1.0000000000000001663, 1.0000000003487516312, 2.1147425268811292941, 4.4721359549995786491,
        4.4721359549995801365, 9.4574160900705905488, 19.999999993025020592,
        19.999999999999996674}},
      {{Shape::powerlaw, {}, {}, 0.1, 3.0, 0.5},
       {0.10000000000000005526, 0.10000000010424428243, 0.4491459590644376174,
        1.0488612787525829047, 1.0488612787525832267, 1.8991459590697858609, 2.9999999994290349369,
        2.9999999999999997277}},
      {{Shape::powerlaw, {}, {}, 0.1, 3.0, -3.0},
       {0.10000000000112410498, 0.10000235734086096029, 2.1213223077424181929,
        2.5226900243685749944, 2.5226900243685751344, 2.7918148645312519264, 2.9999999999126886581,
        2.9999999999999999584}},
      {{Shape::powerlaw, {}, {}, 0.5, 50.0, 1.0000001},
       {0.50000000000000012782, 0.50000000026805804027, 1.5811385157203594884,
        4.9999986745256460166, 4.999998674525648573, 15.811385157302901117, 49.999999973194388153,
        49.999999999999987218}},
      {{Shape::powerlaw, {}, {}, 1.0, 1000000.0, 12.0},
       {1.000000000000000005, 1.0000000000105832868, 1.0264979040950386107, 1.0650410894399626674,
        1.0650410894399626889, 1.134312522196027933, 8.0000003467907507092, 30.045789141174603209}},
  };
  return all;
}

TEST(Distribution, HasTheValuesOfItsDefinition) {
  for (const auto& [distribution, values] : cases()) {
    ASSERT_FALSE(what_is_wrong(distribution)) << testing::PrintToString(distribution);
    const Quantiles quantiles(distribution);
    // 1 + width z of a normal distribution has an absolute error.
    const double scale = distribution.shape == Shape::normal ? *distribution.mean : 0;
    for (std::size_t n = 0; n < values.size(); ++n) {
      const double x = quantiles(some_bits[n]);
      EXPECT_LT(std::abs(x - values[n]), 1e-15 * std::max(scale, values[n]))
          << testing::PrintToString(distribution) << " at " << some_bits[n] << ": " << x;
    }
  }
}

// Quantiles at decimal probabilities, computed independently, lie between those of neighbouring
// multiples of 2^-53.
TEST(Distribution, EnclosesQuantilesOfDecimals) {
  struct Row {
    double u, lognormal, gamma, powerlaw;
  };
  const Quantiles lognormal({Shape::lognormal, 1, 0.3}), gamma({Shape::gamma, 1, 0.3}),
      powerlaw({Shape::powerlaw, {}, {}, 1, 20, 2.5});
  for (const Row& row : std::initializer_list<Row>{
           {1e-12, 0.12146433633307872926, 0.038392995216562411551, 1.0000000000006592131},
           {1e-6, 0.23728201922222219808, 0.14696351669098662311, 1.0000006592136499445},
           {0.01, 0.48383448098284373025, 0.43591439424365783785, 1.0066469331236112332},
           {0.25, 0.78576908479815226341, 0.784750423107638342, 1.2084132634169134768},
           {0.5, 0.95782628522115139264, 0.97016529244193305816, 1.5756784148623280426},
           {0.9, 1.3953201894673218888, 1.3985511684042198755, 4.354192195791632857},
           {0.999, 2.3728242670320487057, 2.1867004349584813063, 18.901355186485258128},
           {0.999999, 3.8664168303513415907, 3.1155060135335972421, 19.998820850650885337}}) {
    const auto j = static_cast<std::uint64_t>(row.u * 0x1p53);
    for (const auto& [quantiles, value] :
         {std::pair(&lognormal, row.lognormal), {&gamma, row.gamma}, {&powerlaw, row.powerlaw}}) {
      EXPECT_LE((*quantiles)(j - 2), value * (1 + 1e-15)) << row.u;
      EXPECT_GE((*quantiles)(j + 2), value * (1 - 1e-15)) << row.u;
    }
  }
}

TEST(Distribution, GrowsWithTheBitsAndStaysWithinItsEnds) {
  for (const auto& [distribution, values] : cases()) {
    const Quantiles quantiles(distribution);
    double last = distribution.least.value_or(std::numeric_limits<double>::min());
    constexpr std::uint64_t step = all_bits / 3001;
    for (std::uint64_t j = 0; j < all_bits; j += step) {
      const double x = quantiles(j);
      ASSERT_GE(x, last) << testing::PrintToString(distribution) << " at " << j;
      last = x;
    }
    if (distribution.greatest) {
      EXPECT_LE(quantiles(all_bits - 1), *distribution.greatest);
    }
  }
}

TEST(Distribution, OfWidthZeroIsItsMean) {
  for (const Shape shape : {Shape::uniform, Shape::normal, Shape::lognormal, Shape::gamma}) {
    const Distribution one{shape, 2.5, 0.0};
    ASSERT_FALSE(what_is_wrong(one));
    const Quantiles quantiles(one);
    for (const std::uint64_t j : some_bits) EXPECT_EQ(quantiles(j), 2.5);
    EXPECT_DOUBLE_EQ(quantiles.moment(3), 15.625);
    EXPECT_FALSE(what_is_wrong({shape, 2.5, 0.0, 2.5, 3.0}));
    EXPECT_STREQ(what_is_wrong({shape, 2.5, 0.0, 2.6, 3.0})->name, "min");
    EXPECT_STREQ(what_is_wrong({shape, 2.5, 0.0, 2.0, 2.4})->name, "max");
  }
}

TEST(Distribution, HasTheMeanAndTheWidthAskedForIfNothingIsCutOff) {
  for (const auto& [distribution, values] : cases()) {
    if (!distribution.mean || distribution.least || distribution.greatest) continue;
    const Quantiles quantiles(distribution);
    const double mean = *distribution.mean, width = *distribution.width;
    EXPECT_EQ(quantiles.share(), 1);
    EXPECT_NEAR(quantiles.moment(1) / mean, 1, 1e-14) << testing::PrintToString(distribution);
    EXPECT_NEAR(quantiles.moment(2) / (mean * mean), 1 + width * width, 1e-14);
    EXPECT_NEAR(quantiles.moment(0), 1, 1e-14);
  }
  // The third central moments of the two that are skew: w^4 (3 + w^2) and 2 w^4.
  const auto third = [](const Quantiles& q) { return q.moment(3) - 3 * q.moment(2) + 2; };
  EXPECT_NEAR(third(Quantiles({Shape::lognormal, 1, 0.3})), 0.0081 * 3.09, 1e-14);
  EXPECT_NEAR(third(Quantiles({Shape::gamma, 1, 0.3})), 0.0081 * 2, 1e-14);
}

// The mean over equally spaced probabilities, which converges quickly where both ends are cut.
TEST(Distribution, HasTheMomentsOfItsValues) {
  for (const Distribution& distribution : {Distribution{Shape::uniform, 1, 0.5, 0.3, 1.2},
                                           {Shape::normal, 1, 0.4, 0.1, 2},
                                           {Shape::lognormal, 2, 0.6, 0.5, 5},
                                           {Shape::gamma, 1, 0.7, 0.2, 3},
                                           {Shape::gamma, 1, 0.3, 1.8, 2.5},
                                           {Shape::powerlaw, {}, {}, 1, 3, 2.5},
                                           {Shape::powerlaw, {}, {}, 1, 3, 1},
                                           {Shape::powerlaw, {}, {}, 1, 3, 0.5}}) {
    ASSERT_FALSE(what_is_wrong(distribution)) << testing::PrintToString(distribution);
    const Quantiles quantiles(distribution);
    for (const double p : {-0.5, 1.0, 1.5, 3.0}) {
      constexpr int count = 8192;
      double sum = 0;
      for (std::uint64_t n = 0; n < count; ++n) {
        sum += std::pow(quantiles((2 * n + 1) * (all_bits / count / 2)), p);
      }
      EXPECT_NEAR(sum / count / quantiles.moment(p), 1, 2e-6)
          << testing::PrintToString(distribution) << ", power " << p;
    }
  }
}

// Within 4.5 standard errors of 1e5 draws.
TEST(Distribution, IsThatOfTheNumbersDrawn) {
  for (const auto& [distribution, values] : cases()) {
    const Quantiles quantiles(distribution);
    std::array<test::Mean, 2> means;
    for (std::uint64_t id = 0; id < 100000; ++id) {
      const double x = quantiles(NeedleRandom(11, id, RandomFor::size, 0).bits());
      means[0].add(x);
      means[1].add(x * x);
    }
    EXPECT_TRUE(test::agrees(means[0].measured(), quantiles.moment(1), 4.5))
        << testing::PrintToString(distribution);
    EXPECT_TRUE(test::agrees(means[1].measured(), quantiles.moment(2), 4.5))
        << testing::PrintToString(distribution);
  }
}

TEST(Distribution, SaysWhatIsWrong) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  struct Bad {
    Distribution distribution;
    std::string name;
  };
  const std::vector<Bad> all{
      {{Shape::uniform, {}, 0.1}, "mean"},
      {{Shape::uniform, 0, 0.1}, "mean"},
      {{Shape::uniform, -1, 0.1}, "mean"},
      {{Shape::gamma, nan, 0.1}, "mean"},
      {{Shape::gamma, INFINITY, 0.1}, "mean"},
      {{Shape::lognormal, 1}, "width"},
      {{Shape::lognormal, 1, -0.1}, "width"},
      {{Shape::lognormal, 1, nan}, "width"},
      {{Shape::lognormal, 1, 1.01}, "width"},
      {{Shape::gamma, 1, 1.01}, "width"},
      {{Shape::gamma, 1, 9e-4}, "width"},
      {{Shape::uniform, 1, 0.5774}, "width"},
      {{Shape::uniform, 1, 1e-7}, "width"},
      {{Shape::normal, 1, 0.51, 0.1}, "width"},
      {{Shape::normal, 1, 0.2}, "min"},
      {{Shape::normal, 1, 0.2, 0}, "min"},
      {{Shape::lognormal, 1, 0.2, -1}, "min"},
      {{Shape::lognormal, 1, 0.2, {}, 0}, "max"},
      {{Shape::lognormal, 1, 0.2, {}, nan}, "max"},
      {{Shape::lognormal, 1, 0.2, 2, 2}, "max"},
      {{Shape::lognormal, 1, 0.2, 2, 1}, "max"},
      {{Shape::lognormal, 1, 0.2, {}, {}, 2}, "exponent"},
      {{Shape::lognormal, 1, 0.2, 1.9}, "min"},
      {{Shape::lognormal, 1, 0.2, {}, 0.5}, "max"},
      {{Shape::lognormal, 1, 0.2, 1.9, 5}, "min"},
      {{Shape::gamma, 1, 0.2, 0.9, 0.9001}, "max"},
      {{Shape::uniform, 1, 0.2, 1.35}, "min"},
      {{Shape::normal, 1, 0.2, 1.7}, "min"},
      {{Shape::powerlaw, 1, {}, 1, 2, 3}, "mean"},
      {{Shape::powerlaw, {}, 0.1, 1, 2, 3}, "width"},
      {{Shape::powerlaw, {}, {}, 1, 2}, "exponent"},
      {{Shape::powerlaw, {}, {}, 1, 2, 21}, "exponent"},
      {{Shape::powerlaw, {}, {}, {}, 2, 3}, "min"},
      {{Shape::powerlaw, {}, {}, 1, {}, 3}, "max"},
      {{Shape::powerlaw, {}, {}, 1, 2e12, 3}, "max"},
  };
  for (const auto& [distribution, name] : all) {
    const auto wrong = what_is_wrong(distribution);
    ASSERT_TRUE(wrong) << testing::PrintToString(distribution);
    EXPECT_EQ(wrong->name, name) << testing::PrintToString(distribution) << ": " << wrong->expected;
    EXPECT_NE(std::string(wrong->expected), "");
  }
  const auto wrong = what_is_wrong({Shape::normal, 1, 0.51, 0.1});
  EXPECT_EQ(wrong->value, 0.51);
  EXPECT_STREQ(wrong->expected, "0, or from 1e-6 to 0.5");
  EXPECT_FALSE(what_is_wrong({Shape::normal, 1, 0.5})->value);
}

// Of all that is allowed, values are numbers within the ends.
TEST(Distribution, HasNumbersAtAllLimits) {
  for (const Distribution& distribution : {Distribution{Shape::uniform, 1e100, 0.57735},
                                           {Shape::normal, 1e-100, 0.5, 1e-100},
                                           {Shape::normal, 1, 0.5, 1e-100},
                                           {Shape::lognormal, 1e100, 1.0, 1e-100},
                                           {Shape::lognormal, 1, 1e-6},
                                           {Shape::gamma, 1, 1e-3},
                                           {Shape::gamma, 1e-100, 1.0, {}, 1e100},
                                           {Shape::gamma, 1, 1.0, 1e-100},
                                           {Shape::powerlaw, {}, {}, 1e-100, 1e-88, 20},
                                           {Shape::powerlaw, {}, {}, 1e88, 1e100, -20}}) {
    ASSERT_FALSE(what_is_wrong(distribution)) << testing::PrintToString(distribution);
    const Quantiles quantiles(distribution);
    for (const std::uint64_t j : some_bits) {
      const double x = quantiles(j);
      EXPECT_TRUE(x > 0 && std::isfinite(x)) << testing::PrintToString(distribution) << " at " << j;
      EXPECT_GE(x, distribution.least.value_or(0));
    }
    EXPECT_TRUE(std::isfinite(quantiles.moment(1))) << testing::PrintToString(distribution);
  }
}

// Golden bits: they change only when the drawing is changed, never with machine or compiler.
TEST(Distribution, GivesTheSameBitsOnEveryMachine) {
  std::vector<std::uint64_t> hashes;
  for (const auto& [distribution, values] : cases()) {
    const Quantiles quantiles(distribution);
    std::uint64_t hash = 0;
    for (std::uint64_t id = 0; id < 1000; ++id) {
      const double x = quantiles(NeedleRandom(1, id, RandomFor::size, 0).bits());
      hash = (hash ^ std::bit_cast<std::uint64_t>(x)) * 0x100000001b3;
    }
    hashes.push_back(hash);
  }
  EXPECT_EQ(hashes, (std::vector<std::uint64_t>{
                        15103115093602999922u, 6376134040732442454u,  9892694531311770526u,
                        12323201692120952293u, 6117224227451827421u,  13066653300007298372u,
                        2782340853411670987u,  9770329758711498067u,  17009883801439206034u,
                        7565067931685004570u,  15953556117197815293u, 17743126202071834997u,
                        13212434248268779541u, 618838791468395635u,   971565254959339185u,
                        7836049727415478756u,  9558106650685427831u,  669249684468834464u,
                        14570879416664283806u, 9195566871589952095u,  13797624213563704664u}));
}

}  // namespace
}  // namespace needlework
