// Checks whether two runs are the same, bit for bit.
#pragma once

#include <gtest/gtest.h>

#include "tests/support/by_build.h"
#include "tests/support/runs.h"

namespace needlework::test {

/// Factor by which runs are shortened where checks make them slow.
inline constexpr double thin = test::by_build<double>(1, 10);

inline void expect_same(const Recorded& truth, const Recorded& other) {
  ASSERT_EQ(truth.collisions.size(), other.collisions.size());
  for (std::size_t n = 0; n < truth.collisions.size(); ++n) {
    const Collision &a = truth.collisions[n], &b = other.collisions[n];
    ASSERT_TRUE(a.epoch == b.epoch && a.offset == b.offset && a.first == b.first &&
                a.second == b.second && a.shift == b.shift && a.impulse == b.impulse)
        << "collision " << n << ": " << a.first << "-" << a.second << " at " << a.time
        << " against " << b.first << "-" << b.second << " at " << b.time;
  }
  EXPECT_EQ(truth.hash, other.hash);
  EXPECT_EQ(truth.end.position, other.end.position);
  EXPECT_EQ(truth.end.velocity, other.end.velocity);
  EXPECT_EQ(truth.end.orientation, other.end.orientation);
  EXPECT_EQ(truth.end.angular_velocity, other.end.angular_velocity);
}

}  // namespace needlework::test
