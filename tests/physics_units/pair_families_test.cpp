// The generated pairs: the same everywhere, and what they claim to be.
#include "tests/support/pair_families.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <sstream>

#include "tests/support/oracle.h"
#include "tests/support/pairs_csv.h"
#include "tests/support/vector.h"

namespace needlework::test {
namespace {

std::vector<double> numbers(const NeedlePair& pair) {
  std::vector<double> all = {pair.horizon};
  for (const FreeNeedle* needle : {&pair.first, &pair.second}) {
    for (const auto& vector :
         {needle->position, needle->orientation, needle->velocity, needle->angular_velocity}) {
      all.insert(all.end(), vector.begin(), vector.end());
    }
  }
  all.push_back(pair.just_collided);
  return all;
}

TEST(PairFamilies, AreTheSameOnEveryMachine) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const PairFamily& family : pair_families()) {
    for (const NeedlePair& pair : draw_pairs(family.name, 200, 3)) {
      for (const double value : numbers(pair)) {
        hash = (hash ^ std::bit_cast<std::uint64_t>(value)) * 0x100000001b3u;
      }
    }
  }
  EXPECT_EQ(hash, 7569656685364673443u);
}

TEST(PairFamilies, GoThroughACsvFileUnchanged) {
  for (const PairFamily& family : pair_families()) {
    const auto pairs = draw_pairs(family.name, 20, 4);
    std::stringstream file;
    write_pairs(file, pairs, 7);
    std::string line;
    std::getline(file, line);
    EXPECT_EQ(line.substr(0, 30), "# id,family,horizon,r1x,r1y,r1");
    EXPECT_EQ(std::count(line.begin(), line.end(), ','), 27);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      std::getline(file, line);
      EXPECT_EQ(line.find(std::to_string(7 + i) + "," + std::string(family.name) + ","), 0u);
      std::size_t at = line.find(',', line.find(',') + 1);
      for (const double value : numbers(pairs[i])) {
        EXPECT_EQ(std::strtod(line.c_str() + at + 1, nullptr), value);
        at = line.find(',', at + 1);
      }
      EXPECT_EQ(at, std::string::npos);
    }
  }
}

TEST(PairFamilies, HardPairsAreHard) {
  const auto share = [](const char* family, auto holds) {
    int found = 0, contacts = 0;
    for (const NeedlePair& pair : draw_pairs(family, 400, 6)) {
      const OracleAnswer answer =
          first_contact(pair.first, pair.second, pair.horizon, pair.just_collided);
      contacts += answer.contact;
      found += answer.contact && holds(pair, answer);
    }
    return static_cast<double>(found) / contacts;
  };
  const auto ill_conditioned = [](const NeedlePair&, const OracleAnswer& answer) {
    return answer.time_limit > 1e-12;
  };
  EXPECT_GT(share("parallel", ill_conditioned), 0.25);
  EXPECT_GT(share("grazing", ill_conditioned), 0.4);
  EXPECT_GT(share("just-collided",
                  [](const NeedlePair&, const OracleAnswer& answer) { return answer.time < 1e-3; }),
            0.25);
  EXPECT_GT(share("tip",
                  [](const NeedlePair&, const OracleAnswer& answer) {
                    return std::max(std::abs(answer.arm_first), std::abs(answer.arm_second)) >
                           0.499;
                  }),
            0.5);
}

}  // namespace
}  // namespace needlework::test
