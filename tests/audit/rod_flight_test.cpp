// Overlaps of rods that only graze each other, some time within a flight, are seen by the audit,
// and none where they just pass.
#include "src/audit/rod_flight.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace needlework::test {
namespace {

using Row = std::array<double, 3>;

audit::Needle grazing_rod(double length, const Row& r, const Row& v, const Row& u) {
  return audit::Needle({{}, {r}, {v}, {u}, {}}, {.length = length, .diameter = 1});
}

// The first rod lies along z in the origin, unless it is a sphere. The second one passes it along x
// at time 3 with the nearest points at a distance of b along y.
audit::Needle passing_rod(double length, double b, const Row& u) {
  const double reach = u[1] * length / 2;
  return grazing_rod(length, {-3, b + std::abs(reach), 0}, {1, 0, 0}, u);
}

TEST(RodFlight, SeesOverlapsThatLastAMoment) {
  const struct {
    double first, second;
    Row director;
  } shapes[] = {{0, 0, {0, 0, 1}},      // spheres
                {4, 2, {0, 1, 0}},      // of a short one
                {4, 4, {0, 1, 0}},      // an end on a side
                {4, 4, {0, 0.6, 0.8}},  // oblique, an end on a side
                {4, 0, {0, 0, 1}},      // a sphere on a side
                {1, 6, {0, 0, 1}}};     // parallel
  const audit::Space space{.box = {40, 40, 40}, .longest = 7, .gravity = {}};
  for (const auto& [first, second, director] : shapes) {
    const audit::Needle one = grazing_rod(first, {0, 0, 0}, {0, 0, 0}, {0, 0, 1});
    for (const double depth : {1e-3, 1e-6, 1e-9, -1e-3, -1e-6, -1e-9}) {
      const audit::Needle other = passing_rod(second, 1 - depth, director);
      audit::RodFlight flight(one, other, {0, 0, 0}, space);
      const auto found = flight.overlap(0, 10);
      EXPECT_EQ(found.has_value(), depth > 0) << first << " " << second << " " << depth;
      EXPECT_NEAR(flight.overlap_at(3), std::max(depth, 0.0), 1e-14);
      EXPECT_FALSE(flight.gave_up()) << first << " " << second << " " << depth;
      if (!found) continue;
      // It overlaps while |x| < sqrt(2 depth), and is found as it begins.
      EXPECT_NEAR(*found, 3 - std::sqrt(2 * depth), 1e-3 * std::sqrt(2 * depth) + depth);
      EXPECT_FALSE(flight.overlap(3.1, 10).has_value());
      EXPECT_LT(flight.at(3).most, 1);
      EXPECT_NEAR(flight.at(3).least, 1 - depth, 1e-12);
    }
  }
}

}  // namespace
}  // namespace needlework::test
