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

TEST(PairFamilies, ThermalPairsEnterTheSphereAtTemperatureOne) {
  const int count = 20000;
  double normal = 0, tangential = 0, spin = 0;
  for (const NeedlePair& pair : draw_pairs("thermal-k6", count, 5)) {
    const Vec<double> r = pair.first.position - pair.second.position;
    const Vec<double> v = pair.first.velocity - pair.second.velocity;
    const double rv = dot(r, v), vv = dot(v, v);
    const double entry = (-rv - std::sqrt(rv * rv - vv * (dot(r, r) - 1))) / vv;
    EXPECT_GT(entry, -1e-9);
    EXPECT_LT(entry, pair.horizon);
    const double inwards = -dot(r + entry * v, v);
    normal += inwards * inwards / count;
    tangential += (vv - inwards * inwards) / count;
    spin += dot(pair.first.angular_velocity, pair.first.angular_velocity) / count;
  }
  // Rayleigh of variance 2 along the normal, two normal components of variance 2, 2 k for each
  // of two spins; each sum has a relative standard error of 1 / sqrt(count).
  EXPECT_NEAR(normal, 4, 4 * 4 / std::sqrt(count));
  EXPECT_NEAR(tangential, 4, 4 * 4 / std::sqrt(count));
  EXPECT_NEAR(spin, 24, 4 * 24 / std::sqrt(count));
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

TEST(PairFamilies, BackwardsMotionMeetsWhereForwardMotionDoes) {
  for (const NeedlePair& pair : draw_pairs("still", 200, 7)) {
    const OracleAnswer forth = first_contact(pair.first, pair.second, pair.horizon, false);
    const NeedlePair other = reversed(pair);
    const OracleAnswer back = first_contact(other.first, other.second, other.horizon, false);
    EXPECT_EQ(forth.contact, back.contact);
    if (!forth.contact) continue;
    EXPECT_LE(forth.time, pair.horizon - back.time + 1e-9 * pair.horizon);
  }
}

}  // namespace
}  // namespace needlework::test
