// First contacts of tips with walls on any trajectory: those of free flights are known in quad.
#include "kernels/trajectory_wall.h"

#include <gtest/gtest.h>

#include <cmath>

#include "src/physics/motion.h"
#include "tests/support/wall_oracle.h"

namespace needlework::kernels {
namespace {

using test::DrawnWalls;
using test::WallCase;
using test::WallFamily;

// The flight of a case as a course of which no more is known than of any other.
class FlightCourse final : public Trajectory {
 public:
  FlightCourse(const WallCase& of, double until) : flight_(of.flight) {
    double* pull[] = {&gravity_.x, &gravity_.y, &gravity_.z};
    *pull[of.approach.wall.axis] = of.approach.gravity;
    lasts = until;
    const FreeFlight motion(flight_, &gravity_);
    speed = motion.fastest(0, until);
    acceleration = std::sqrt(dot(gravity_, gravity_));
    turning = flight_.omega;
  }
  BodyState at(double s) const override {
    const FreeFlight motion(flight_, &gravity_);
    return {motion.centre(s), motion.velocity(s), motion.director(s), flight_.w};
  }

 private:
  const Flight& flight_;
  Vec3d gravity_{};
};

TEST(CourseWall, IsThatOfTheOracleInEveryFamily) {
  for (int n = 0; n < test::wall_families; ++n) {
    const auto family = static_cast<WallFamily>(n);
    DrawnWalls drawn(31 + static_cast<std::uint64_t>(n));
    int contacts = 0;
    for (int i = 0; i < 500; ++i) {
      const WallCase a = drawn.draw(family);
      const double to = 3;
      const FlightCourse trajectory(a, to);
      const WallContact found = trajectory_wall_contact(trajectory, a.approach, 0, to);
      const test::WallTruth truth = first_wall_contact_in_quad(a, to);
      if (truth.found && std::abs(truth.time - to) < 1e-9) continue;
      // Double cannot decide whether a tip grazes to less than its rounding, nor when it does.
      if (family == WallFamily::grazing && found.found != truth.found) {
        const WallContact deeper = [&] {
          WallCase other = a;
          other.approach.wall.place =
              a.approach.wall.place + DoubleDouble(1e-13 * a.approach.wall.normal);
          return trajectory_wall_contact(trajectory, other.approach, 0, to);
        }();
        EXPECT_TRUE(deeper.found) << i;
        continue;
      }
      ASSERT_EQ(found.found, truth.found) << name_of(family) << i;
      if (!truth.found) continue;
      ++contacts;
      EXPECT_FALSE(found.across);
      // Where both tips come within rounding, double does not tell which is the first.
      const bool is_there =
          std::abs(test::TipHeight<double>(a, found.tip).height(truth.time)) < 1e-13;
      EXPECT_TRUE(found.tip == truth.tip || truth.is_of_both || is_there) << name_of(family) << i;
      // The height is good to rounding, and the tip comes at some speed.
      const test::TipHeight<double> tip(a, truth.tip);
      const double speed = std::abs(tip.rate(truth.time));
      const double slow = std::sqrt(1e-14 / std::max(1e-3, tip.bend()));
      EXPECT_NEAR(found.elapsed, truth.time, std::min(8e-14 / speed, 4 * slow) + 1e-14)
          << name_of(family) << i;
    }
    EXPECT_GT(contacts, 80) << name_of(family);
  }
}

TEST(CourseWall, DoesNotDependOnWhenItIsAskedFor) {
  DrawnWalls drawn(3);
  for (int n = 0; n < 300; ++n) {
    const WallCase a = drawn.draw(static_cast<WallFamily>(n % 6));
    const double to = 6;
    const FlightCourse trajectory(a, to);
    const WallContact found = trajectory_wall_contact(trajectory, a.approach, 0, to);
    const double latest = found.found ? found.elapsed : to;
    for (const double share : {0.1, 0.5, 0.99, 1.0}) {
      const WallContact again = trajectory_wall_contact(trajectory, a.approach, share * latest, to);
      ASSERT_EQ(again.found, found.found) << n;
      ASSERT_EQ(again.elapsed, found.elapsed) << n;
      ASSERT_EQ(again.tip, found.tip) << n;
    }
    if (!found.found) continue;
    EXPECT_EQ(trajectory_wall_contact(trajectory, a.approach, 0, latest).elapsed, latest);
    EXPECT_FALSE(trajectory_wall_contact(trajectory, a.approach, 0, latest * (1 - 1e-9)).found);
  }
}

// A tip at the wall, as rounding has it: it leaves, hits at once, or comes back.
TEST(CourseWall, ContinuesTheHeightOfATipAtTheWall) {
  for (const double off : {0.0, 1e-15, -1e-15}) {
    for (const unsigned touching : {0u, 2u}) {
      WallCase a;
      a.approach.resolution = 0x1p-52;
      a.approach.tolerance = 0x1p-44;
      a.approach.wall.axis = 2;
      a.approach.gravity = -2;
      a.approach.touching = touching;
      a.flight.u = {0, 0, 1};
      a.flight.r = {0, 0, 0.5 + off};
      const auto with_speed = [&](double speed) {
        a.flight.v = {0, 0, speed};
        const FlightCourse trajectory(a, 10);
        return trajectory_wall_contact(trajectory, a.approach, 0, 10);
      };
      for (const double speed : {1.0, 1e-3, 1e-6}) {
        EXPECT_NEAR(with_speed(speed).elapsed, speed, 1e-9 * speed + 4e-16 / speed) << off;
        EXPECT_EQ(with_speed(speed).tip, 1);
        EXPECT_EQ(with_speed(-speed).elapsed, 0);
        EXPECT_TRUE(with_speed(-speed).found);
      }
    }
  }
  WallCase beyond;
  beyond.approach.tolerance = 0x1p-44;
  beyond.approach.wall.axis = 2;
  beyond.flight.u = {0, 0, 1};
  beyond.flight.r = {0, 0, 0.4999};
  EXPECT_TRUE(trajectory_wall_contact(FlightCourse(beyond, 1), beyond.approach, 0, 1).across);
}

}  // namespace
}  // namespace needlework::kernels
