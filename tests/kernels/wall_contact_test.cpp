// First contacts of tips with walls, against sampling and bisection with 33 digits.
#include "kernels/wall_contact.h"

#include <gtest/gtest.h>

#include <boost/math/constants/constants.hpp>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>

#include "src/physics/clock.h"
#include "src/physics/director.h"

namespace needlework::kernels {
namespace {

using WallQuad = boost::multiprecision::cpp_bin_float_quad;

WallQuad quad_component(const Vec3d& a, int axis) { return WallQuad(component(a, axis)); }

struct Approach {
  Flight flight;
  WallApproach approach;

  Approach() { approach.flight = &flight; }
  Approach(const Approach& other) : flight(other.flight), approach(other.approach) {
    approach.flight = &flight;
  }
  Approach& operator=(const Approach&) = delete;

  WallQuad height(int tip, const WallQuad& s) const {
    const WallApproach& a = approach;
    const int axis = a.wall.axis, next = (axis + 1) % 3, last = (axis + 2) % 3;
    const WallQuad sign = a.wall.normal, half = a.half;
    const WallQuad z = quad_component(flight.r, axis) - WallQuad(a.wall.place);
    const auto w = [&](int n) { return quad_component(flight.w, n); };
    const auto u = [&](int n) { return quad_component(flight.u, n); };
    const WallQuad omega = sqrt(w(0) * w(0) + w(1) * w(1) + w(2) * w(2));
    WallQuad along = u(axis);
    if (omega > 0) {
      const WallQuad p = (w(next) * u(last) - w(last) * u(next)) / omega;
      along = u(axis) * cos(omega * s) + p * sin(omega * s);
    }
    const WallQuad turns =
        WallQuad(a.turns.hi) + WallQuad(a.turns.lo) + WallQuad(a.wall.frequency) * s;
    const WallQuad surface =
        WallQuad(a.wall.amplitude) * sin(2 * boost::math::constants::pi<WallQuad>() * turns);
    const WallQuad centre =
        z + quad_component(flight.v, axis) * s + WallQuad(a.gravity) * s * s / 2;
    return sign * (centre - surface + (tip == 0 ? half : WallQuad(-half)) * along);
  }
};

struct Found {
  WallQuad time;
  int tip;
};

// Looks at small steps, then bisects.
std::optional<Found> sampled(const Approach& a, double to, int steps) {
  std::optional<Found> out;
  for (int tip = 0; tip < 2; ++tip) {
    WallQuad before = 0;
    for (int n = 1; n <= steps; ++n) {
      WallQuad at = WallQuad(to) * n / steps;
      if (out && before > out->time) break;
      if (a.height(tip, at) < 0) {
        WallQuad low = before;
        for (int k = 0; k < 110; ++k) {
          const WallQuad middle = (low + at) / 2;
          (a.height(tip, middle) < 0 ? at : low) = middle;
        }
        if (!out || at < out->time) out = Found{at, tip};
        break;
      }
      before = at;
    }
  }
  return out;
}

class Drawn {
 public:
  explicit Drawn(std::uint64_t seed) : random_(seed) {}
  double uniform(double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random_);
  }
  Vec3d normal() {
    std::normal_distribution<double> n;
    return {n(random_), n(random_), n(random_)};
  }
  int below(int n) { return std::uniform_int_distribution<int>(0, n - 1)(random_); }

  // Both tips are above the wall at the record.
  Approach approach(bool moves, bool falls) {
    for (;;) {
      Approach out;
      WallApproach& a = out.approach;
      a.wall.axis = below(3);
      a.wall.normal = below(2) == 0 ? 1 : -1;
      a.wall.place = uniform(-3, 3);
      a.half = uniform(0.05, 1);
      if (falls) a.gravity = a.wall.normal * uniform(-3, 1);
      if (moves) {
        a.wall.amplitude = uniform(0, 0.5);
        a.wall.frequency = uniform(0.1, 3);
        a.turns = DoubleDouble(uniform(0, 1));
      }
      a.resolution = 0x1p-52;
      a.tolerance = 0x1p-44;
      Flight& f = out.flight;
      f.u = normalised(normal());
      f.v = normal();
      f.w = project_out(normal() * 3, f.u);
      set_rotation(f);
      const double height = a.wall.place + a.wall.normal * uniform(0, 1.5);
      f.r = normal();
      (a.wall.axis == 0 ? f.r.x : a.wall.axis == 1 ? f.r.y : f.r.z) = height;
      if (out.height(0, 0) > 1e-6 && out.height(1, 0) > 1e-6) return out;
    }
  }

 private:
  std::mt19937_64 random_;
};

TEST(WallContact, IsThatOfSamplingInQuad) {
  Drawn drawn(1);
  int contacts = 0, none = 0;
  for (int n = 0; n < 160; ++n) {
    const Approach a = drawn.approach(n % 2 == 1, n % 4 >= 2);
    const double to = 3;
    const WallContact found = first_wall_contact(a.approach, 0, to);
    const auto truth = sampled(a, to, 1000);
    ASSERT_EQ(found.found, truth.has_value()) << n;
    ASSERT_FALSE(found.across);
    if (!found.found) {
      ++none;
      continue;
    }
    ++contacts;
    EXPECT_EQ(found.tip, truth->tip) << n;
    // A part of the resolution divided by the speed of approach, of which few are slow.
    EXPECT_NEAR(found.elapsed, static_cast<double>(truth->time), 1e-14) << n;
  }
  EXPECT_GT(contacts, 60);
  EXPECT_GT(none, 10);
}

TEST(WallContact, DoesNotDependOnWhenItIsAskedFor) {
  Drawn drawn(2);
  for (int n = 0; n < 2000; ++n) {
    const Approach a = drawn.approach(n % 2 == 1, n % 4 >= 2);
    const double to = 6;
    const WallContact found = first_wall_contact(a.approach, 0, to);
    const double latest = found.found ? found.elapsed : to;
    for (const double share : {0.1, 0.5, 0.99, 1.0}) {
      const WallContact again = first_wall_contact(a.approach, share * latest, to);
      ASSERT_EQ(again.found, found.found) << n;
      ASSERT_EQ(again.elapsed, found.elapsed) << n << ", from " << share;
      ASSERT_EQ(again.tip, found.tip) << n;
    }
    if (!found.found) continue;
    const WallContact shorter = first_wall_contact(a.approach, 0, found.elapsed);
    EXPECT_TRUE(shorter.found);
    EXPECT_EQ(shorter.elapsed, found.elapsed);
    EXPECT_FALSE(first_wall_contact(a.approach, 0, found.elapsed * (1 - 1e-9)).found);
  }
}

// A tip whose lowest point is so little above the wall, or beyond it.
TEST(WallContact, DecidesWhetherATipGrazes) {
  for (const double depth : {1e-3, 1e-9, 1e-15, 1e-20, 1e-25}) {
    for (const double side : {1.0, -1.0}) {
      Approach a;
      a.approach.resolution = 0x1p-80;
      a.approach.half = 0.5;
      // The tip at -u points down after a quarter turn: h = z - sin(t) / 2.
      a.flight.u = {1, 0, 0};
      a.flight.w = {0, 1, 0};
      set_rotation(a.flight);
      a.flight.r = {0, 0, 0.5};
      a.approach.wall.axis = 2;
      // The height of the middle is exact: 0.5 less the place of the wall.
      a.approach.wall.place = -side * depth;
      const WallContact found = first_wall_contact(a.approach, 0, 3);
      EXPECT_EQ(found.found, side < 0) << depth;
      if (!found.found) continue;
      // 1 - cos(x) = 2 depth, before the quarter turn.
      EXPECT_NEAR(found.elapsed, std::numbers::pi / 2 - std::sqrt(4 * depth),
                  1e-6 * std::sqrt(4 * depth) + depth + 1e-15);
    }
  }
}

// Just after a hit, however slow, the tip does not hit at once, but when it has come back.
TEST(WallContact, ComesBackAfterABounce) {
  for (const double speed : {1.0, 1e-4, 1e-8, 1e-12}) {
    Approach a;
    a.approach.resolution = 0x1p-90;
    a.approach.wall.axis = 2;
    a.approach.gravity = -2;
    a.approach.touching = 2;  // the tip at -u
    a.flight.u = {0, 0, 1};
    // Rounding has taken the tip beyond the wall, or not quite to it.
    for (const double off : {0.0, 1e-16, -1e-16}) {
      a.approach.tolerance = 1e-14;
      a.flight.r = {0, 0, 0.5 + off};
      a.flight.v = {0, 0, speed};
      const WallContact found = first_wall_contact(a.approach, 0, 10);
      ASSERT_TRUE(found.found);
      EXPECT_EQ(found.tip, 1);
      // Heights are good to 1e-31.
      EXPECT_NEAR(found.elapsed, speed, 1e-14 * speed + 1e-29 / speed) << off;
      EXPECT_FALSE(found.unresolvable);
    }
  }
  Approach a;
  a.approach.resolution = 0x1p-52;
  a.approach.wall.axis = 2;
  a.approach.gravity = -2;
  a.approach.touching = 2;
  a.flight.u = {0, 0, 1};
  a.flight.r = {0, 0, 0.5};
  a.flight.v = {0, 0, 1e-16};
  EXPECT_TRUE(first_wall_contact(a.approach, 0, 10).unresolvable);
}

// A needle that lies on the wall, its centre coming down: the tip at +u first, at once.
TEST(WallContact, OfBothTipsAtOnceIsThatOfTheFirst) {
  Approach a;
  a.approach.resolution = 0x1p-52;
  a.approach.tolerance = 0x1p-44;
  a.approach.wall.axis = 2;
  a.flight.u = {1, 0, 0};
  a.flight.r = {0, 0, 1};
  a.flight.v = {0, 0, -1};
  WallContact found = first_wall_contact(a.approach, 0, 10);
  EXPECT_EQ(found.tip, 0);
  EXPECT_EQ(found.elapsed, 1);
  // After the first tip has hit: the other one still approaches.
  a.flight.r = {0, 0, 0};
  a.flight.v = {0, 0, -0.5};
  a.flight.w = {0, -4, 0};  // lifts the tip at +u
  set_rotation(a.flight);
  a.approach.touching = 1;
  found = first_wall_contact(a.approach, 0, 10);
  ASSERT_TRUE(found.found);
  EXPECT_EQ(found.tip, 1);
  EXPECT_EQ(found.elapsed, 0);
  EXPECT_FALSE(found.unresolvable);
}

TEST(WallContact, SeesAWallThatCatchesUp) {
  // The needle rises at speed 1; the wall, at rest at first, comes from behind at up to 6.
  Approach a;
  a.approach.resolution = 0x1p-52;
  a.approach.wall = {
      .axis = 0, .normal = 1, .place = 0, .amplitude = 1, .frequency = 3 / std::numbers::pi};
  a.approach.turns = DoubleDouble(0.75);  // at its lowest
  a.flight.u = {0, 1, 0};
  a.flight.r = {-0.9, 0, 0};
  a.flight.v = {1, 0, 0};
  const WallContact found = first_wall_contact(a.approach, 0, 2);
  const auto truth = sampled(a, 2, 4000);
  ASSERT_TRUE(found.found && truth);
  EXPECT_NEAR(found.elapsed, static_cast<double>(truth->time), 1e-14);
}

TEST(WallContact, TellsANeedleAcrossTheWall) {
  Approach a;
  a.approach.resolution = 0x1p-52;
  a.approach.tolerance = 0x1p-44;
  a.approach.wall.axis = 1;
  a.flight.u = {0, 1, 0};
  a.flight.r = {0, 0.4, 0};
  EXPECT_TRUE(first_wall_contact(a.approach, 0, 1).across);
}

// The same phase, by numbers of 100 bits.
TEST(ClockTurns, LoseNoDigitsAtAnyAge) {
  for (const double near : {1e-3, 0.7, 50.0}) {
    const Clock clock(near);
    for (const double frequency : {0.01, 1.0, 7.77, 1e3}) {
      for (const std::int64_t epoch :
           {std::int64_t{0}, std::int64_t{12345}, (std::int64_t{1} << 50) + 77}) {
        const Time time{epoch, 0.3 * clock.epoch_length()};
        const DoubleDouble turns = clock.turns(time, frequency);
        using Wide = boost::multiprecision::number<
            boost::multiprecision::cpp_bin_float<300, boost::multiprecision::digit_base_2>>;
        const Wide exact = Wide(frequency) * (Wide(epoch) * clock.epoch_length() + time.offset);
        const Wide off = exact - floor(exact) - (Wide(turns.hi) + Wide(turns.lo));
        EXPECT_LT(static_cast<double>(abs(off - round(off))), 1e-28) << near << " " << epoch;
      }
    }
  }
}

}  // namespace
}  // namespace needlework::kernels
