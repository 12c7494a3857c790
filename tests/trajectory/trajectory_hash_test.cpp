// The fingerprint of a trajectory: of all collisions, whatever their order.
#include "src/trajectory/trajectory_hash.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "tests/support/random.h"

namespace needlework {
namespace {

using test::Random;

constexpr std::uint64_t hash_seed = 1414;

Collision draw(Random& random) {
  Collision c;
  c.epoch = static_cast<std::int64_t>(random.bits() >> 20);
  c.offset = random.uniform();
  c.first = static_cast<std::uint32_t>(random.bits());
  c.second = static_cast<std::uint32_t>(random.bits());
  for (std::int32_t& shift : c.shift) shift = random.below(5) - 2;
  for (double& impulse : c.impulse) impulse = random.normal();
  return c;
}

std::vector<Collision> draw(Random& random, int count) {
  std::vector<Collision> out;
  for (int i = 0; i < count; ++i) out.push_back(draw(random));
  return out;
}

std::string hash(const std::vector<Collision>& collisions) {
  TrajectoryHash out;
  for (const Collision& c : collisions) out.add(c);
  return out.hex();
}

TEST(TrajectoryHash, DoesNotDependOnTheOrderOfCollisions) {
  Random random(hash_seed);
  for (int n = 0; n < 50; ++n) {
    std::vector<Collision> collisions = draw(random, 300);
    const std::string first = hash(collisions);
    for (std::size_t i = collisions.size(); i > 1; --i) {
      std::swap(collisions[i - 1],
                collisions[static_cast<std::size_t>(random.below(static_cast<int>(i)))]);
    }
    ASSERT_EQ(hash(collisions), first) << "seed " << hash_seed << ", trajectory " << n;
  }
}

TEST(TrajectoryHash, ChangesWithEveryBitOfEveryField) {
  Random random(hash_seed);
  const std::vector<Collision> collisions = draw(random, 10);
  std::set<std::string> seen{hash(collisions)};
  std::size_t changes = 0;
  const auto expect_new = [&](const std::function<void(Collision&)>& change) {
    std::vector<Collision> other = collisions;
    change(other[3]);
    EXPECT_TRUE(seen.insert(hash(other)).second) << "change " << changes << ", seed " << hash_seed;
    ++changes;
  };
  const auto flipped = [](double a, int bit) {
    return std::bit_cast<double>(std::bit_cast<std::uint64_t>(a) ^ (std::uint64_t{1} << bit));
  };
  for (int bit = 0; bit < 64; ++bit) {
    expect_new([&](Collision& c) { c.epoch ^= std::int64_t(std::uint64_t{1} << bit); });
    expect_new([&](Collision& c) { c.offset = flipped(c.offset, bit); });
    for (int axis = 0; axis < 3; ++axis) {
      expect_new([&](Collision& c) { c.impulse[axis] = flipped(c.impulse[axis], bit); });
    }
  }
  for (int bit = 0; bit < 32; ++bit) {
    expect_new([&](Collision& c) { c.first ^= 1u << bit; });
    expect_new([&](Collision& c) { c.second ^= 1u << bit; });
    for (int axis = 0; axis < 3; ++axis) {
      expect_new([&](Collision& c) {
        c.shift[axis] =
            static_cast<std::int32_t>(static_cast<std::uint32_t>(c.shift[axis]) ^ (1u << bit));
      });
    }
  }
  expect_new([](Collision& c) { std::swap(c.first, c.second); });
  expect_new([](Collision& c) { std::swap(c.impulse[0], c.impulse[1]); });
  EXPECT_EQ(changes, 64u * 5 + 32u * 5 + 2);
}

TEST(TrajectoryHash, DetectsMissingAndRepeatedCollisions) {
  Random random(hash_seed);
  std::vector<Collision> collisions = draw(random, 20);
  std::set<std::string> seen{hash(collisions), hash({})};
  collisions.push_back(collisions[7]);
  EXPECT_TRUE(seen.insert(hash(collisions)).second);
  collisions.push_back(collisions[7]);
  EXPECT_TRUE(seen.insert(hash(collisions)).second);
  collisions.resize(19);
  EXPECT_TRUE(seen.insert(hash(collisions)).second);
}

TEST(TrajectoryHash, ReadsAs32HexadecimalDigits) {
  EXPECT_EQ(hash({}), std::string(32, '0'));
  Random random(hash_seed);
  const std::string digits = hash(draw(random, 3));
  EXPECT_EQ(digits.size(), 32u);
  EXPECT_EQ(digits.find_first_not_of("0123456789abcdef"), std::string::npos);
}

// Carries from the low half: the sum is one number of 128 bits, the same for any grouping.
TEST(TrajectoryHash, AddsUpAsOneNumber) {
  Random random(hash_seed);
  const std::vector<Collision> one = draw(random, 1);
  const auto value = [](const std::string& digits) {
    __extension__ unsigned __int128 out = 0;
    for (const char c : digits) out = out * 16 + (c <= '9' ? c - '0' : c - 'a' + 10);
    return out;
  };
  TrajectoryHash sum;
  const auto single = value(hash(one));
  auto expected = single - single;
  for (int i = 0; i < 100; ++i) {
    sum.add(one[0]);
    expected += single;
    ASSERT_TRUE(value(sum.hex()) == expected) << "seed " << hash_seed << ", " << i;
  }
}

}  // namespace
}  // namespace needlework
