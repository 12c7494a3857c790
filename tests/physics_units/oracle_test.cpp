// The oracle itself, against pairs whose contacts are known in closed form, against brute force,
// against itself with more digits, and against an exact collision rate.
#include "tests/support/oracle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "tests/support/pair_families.h"
#include "tests/support/pairs_csv.h"
#include "tests/support/random.h"
#include "tests/support/real.h"
#include "tests/support/vector.h"

namespace needlework::test {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();

OracleAnswer ask(const NeedlePair& pair, const OracleOptions& options = {}) {
  return first_contact(pair.first, pair.second, pair.horizon, pair.just_collided, options);
}

/// Along x and along y, r12 = (a, b, -height), v12 = (0, 0, speed); nothing rotates: f is linear.
NeedlePair crossing(double a, double b, double height, double speed, double horizon) {
  NeedlePair pair;
  pair.first = {{a, b, -height}, {1, 0, 0}, {0, 0, speed}, {0, 0, 0}};
  pair.second = {{0, 0, 0}, {0, 3, 0}, {0, 0, 0}, {0, 0, 0}};
  pair.horizon = horizon;
  return pair;
}

/// A needle along z at the origin and one turning about z through (distance, 0, 0), from the angle
/// atan(slope): f = distance sin(angle).
NeedlePair turning(double distance, double slope, double spin, double horizon) {
  NeedlePair pair;
  pair.first = {{0, 0, 0}, {0, 0, 1}, {0, 0, 0}, {0, 0, 0}};
  pair.second = {{distance, 0, 0}, {1, slope, 0}, {0, 0, 0}, {0, 0, spin}};
  pair.horizon = horizon;
  return pair;
}

/// On a contact at t = 0; u1 turns in the plane of x and y, u2 in that of x and z, both at rate 1:
/// f is proportional to sin(t) sin(t - atan(e)) for r12 along (1, 0, -1).
NeedlePair returning(double e) {
  NeedlePair pair;
  pair.first = {{0.2, 0, -0.2}, {1, 0, 0}, {0, 0, 0}, {0, 0, 1}};
  pair.second = {{0, 0, 0}, {1 - e, 0, -1 - e}, {0, 0, 0}, {0, -1, 0}};
  pair.horizon = 2;
  pair.just_collided = true;
  return pair;
}

TEST(Oracle, StillNeedlesMeetWhereALineCrossesAPlane) {
  const OracleAnswer answer = ask(crossing(0.25, -0.125, 0.5, 0.75, 2));
  ASSERT_TRUE(answer.contact);
  EXPECT_EQ(answer.time, 2.0 / 3);
  EXPECT_LT(std::abs(answer.time_low), 1.2e-16);
  EXPECT_EQ(answer.arm_first, -0.25);
  EXPECT_EQ(answer.arm_second, -0.125);
  EXPECT_EQ(answer.decision_margin, margin_cap);
  EXPECT_LT(answer.time_limit, 1e-14);
  EXPECT_EQ(ask(crossing(0.75, 0, 0.5, 0.75, 2)).outcome, Outcome::arms_outside);
  EXPECT_EQ(ask(crossing(0.25, 0.125, 0.5, -0.75, 2)).outcome, Outcome::no_sign_change);
  EXPECT_EQ(ask(crossing(2, 0, 0.5, 0.75, 2)).outcome, Outcome::spheres_apart);
  EXPECT_EQ(ask(crossing(0.25, 0.125, 0.5, 0, 2)).outcome, Outcome::no_sign_change);
}

TEST(Oracle, TurningNeedleSweepsOverAStandingOne) {
  const OracleAnswer answer = ask(turning(0.25, 1, 2, 10));
  ASSERT_TRUE(answer.contact);
  const Quad exact = 3 * Quad(atan(Quad(1))) / 2;
  EXPECT_LT(std::abs(static_cast<double>(Quad(answer.time) + answer.time_low - exact)), 1e-31);
  EXPECT_EQ(answer.arm_first, 0);
  EXPECT_EQ(answer.arm_second, 0.25);
  EXPECT_TRUE(ask(turning(0.25, 1, -2, 10)).contact);
  EXPECT_NEAR(ask(turning(0.25, 1, -2, 10)).time, std::numbers::pi / 8, 1e-15);
}

TEST(Oracle, TipsDecideToTheLastDigit) {
  for (const double offset : {1e-3, 1e-6, 1e-9, 1e-12, 1e-15}) {
    const OracleAnswer inside = ask(turning(0.5 - offset, 1, 1, 4));
    const OracleAnswer outside = ask(turning(0.5 + offset, 1, 1, 4));
    EXPECT_TRUE(inside.contact) << offset;
    EXPECT_FALSE(outside.contact) << offset;
    EXPECT_EQ(outside.outcome, Outcome::arms_outside);
    EXPECT_EQ(inside.decision_margin < 8, offset < 1e-14) << inside.decision_margin;
    EXPECT_EQ(outside.decision_margin < 8, offset < 1e-14) << outside.decision_margin;
  }
  const OracleAnswer exact = ask(turning(0.5, 1, 1, 4));
  EXPECT_FALSE(exact.contact);
  EXPECT_EQ(exact.decision_margin, 0);
  EXPECT_TRUE(exact.undecidable);
}

TEST(Oracle, ParallelDirectorsAreNoContact) {
  NeedlePair pair;
  pair.first = {{0, 0, 0.3}, {1, 0, 0}, {0, 0, 0}, {0, 0, 1}};
  pair.second = {{0, 0, 0}, {0, 1, 0}, {0, 0, 0}, {0, 0, -0.5}};
  pair.horizon = 20;
  const OracleAnswer above = ask(pair);
  EXPECT_FALSE(above.contact);
  EXPECT_EQ(above.outcome, Outcome::parallel);
  EXPECT_EQ(above.decision_margin, margin_cap);
  // Beside each other, then the plane is crossed between two parallel times.
  pair.first.position = {0.1, 0.05, 0.3};
  pair.first.velocity = {0, 0, -0.125};
  const OracleAnswer through = ask(pair);
  ASSERT_TRUE(through.contact);
  EXPECT_NEAR(through.time, 2.4, 1e-15);
  EXPECT_EQ(through.decision_margin, margin_cap);
}

TEST(Oracle, NeedlesInOnePlaneNeverMeet) {
  NeedlePair pair;
  pair.first = {{0.1, 0.2, 0}, {1, 0.5, 0}, {-0.3, 0.1, 0}, {0, 0, 1.5}};
  pair.second = {{0, 0, 0}, {0.3, 1, 0}, {0.1, 0.7, 0}, {0, 0, -2}};
  pair.horizon = 5;
  const OracleAnswer answer = ask(pair);
  EXPECT_FALSE(answer.contact);
  EXPECT_EQ(answer.outcome, Outcome::coplanar);
  EXPECT_EQ(answer.decision_margin, 0);
  pair.first.velocity = pair.second.velocity = {0, 0, 0};
  pair.first.angular_velocity = pair.second.angular_velocity = {0, 0, 0};
  EXPECT_FALSE(ask(pair).contact);
}

TEST(Oracle, FindsTheSecondOfTwoCloseRoots) {
  for (int power = 1; power < 24; ++power) {
    const double e = std::ldexp(1, -power);
    const NeedlePair pair = returning(e);
    const OracleAnswer answer = ask(pair);
    ASSERT_TRUE(answer.contact) << power;
    const Quad exact = atan(Quad(e));
    const double error = static_cast<double>(Quad(answer.time) + answer.time_low - exact);
    EXPECT_LT(std::abs(error), 1e-31 / e) << power;
    EXPECT_LT(answer.time_limit, 1e-14 / (e * e)) << power;
    // The excursion of f is about 0.07 e^2: rounding hides it below e = 1e-7.
    EXPECT_EQ(answer.decision_margin >= 8, power < 24) << power;
  }
  EXPECT_LT(ask(returning(0x1p-26)).decision_margin, 8);
  EXPECT_TRUE(ask(returning(0x1p-40)).contact);
}

TEST(Oracle, SkipsTheKnownRootOnly) {
  NeedlePair pair = returning(0x1p-4);
  pair.just_collided = false;
  const OracleAnswer open = ask(pair);  // a root exactly at 0 does not lie in (0, horizon]
  EXPECT_TRUE(open.contact);
  EXPECT_EQ(open.decision_margin, 0);
  // Displaced by some ulp to either side: the same return, moved by the shift reported.
  for (const double lift : {-1e-15, 1e-15}) {
    pair = returning(0x1p-4);
    pair.first.position[1] = lift;
    const OracleAnswer at_zero = ask(pair);
    const OracleAnswer as_rounded = ask(pair, {.known_root = KnownRoot::as_rounded});
    ASSERT_TRUE(at_zero.contact && as_rounded.contact);
    EXPECT_NEAR(at_zero.time, std::atan(0x1p-4), 1e-13);
    EXPECT_NEAR(as_rounded.time, std::atan(0x1p-4), 1e-13);
    EXPECT_NEAR(at_zero.shift, std::abs(at_zero.time - as_rounded.time), 1e-17);
    EXPECT_GT(at_zero.shift, 0);
    EXPECT_GE(at_zero.time_limit, at_zero.shift / at_zero.time);
  }
}

TEST(Oracle, HorizonBelongsToTheInterval) {
  const double before = std::nextafter(1, 0), after = std::nextafter(1, 2);
  EXPECT_TRUE(ask(crossing(0.25, 0.125, 0.5, 0.5, after)).contact);
  EXPECT_TRUE(ask(crossing(0.25, 0.125, 0.5, 0.5, 1)).contact);
  EXPECT_EQ(ask(crossing(0.25, 0.125, 0.5, 0.5, 1)).time, 1);
  EXPECT_FALSE(ask(crossing(0.25, 0.125, 0.5, 0.5, before)).contact);
  EXPECT_LT(ask(crossing(0.25, 0.125, 0.5, 0.5, before)).decision_margin, 8);
  EXPECT_EQ(ask(crossing(0.25, 0.125, 0.5, 0.5, before)).time, never);
  EXPECT_TRUE(ask(crossing(0.25, 0.125, 0.5, 0.5, never)).contact);
  EXPECT_FALSE(ask(crossing(0.25, 0.125, 0, 0.5, 1)).contact);  // touching at 0 only
  EXPECT_FALSE(ask(crossing(0.25, 0.125, 0.5, 0.5, 0)).contact);
}

TEST(Oracle, RefusesWhatIsNoPair) {
  NeedlePair pair = crossing(0.25, 0.125, 0.5, 0.5, 1);
  pair.second.orientation = {0, 0, 0};
  EXPECT_THROW(ask(pair), std::invalid_argument);
  pair = crossing(0.25, 0.125, 0.5, 0, never);
  EXPECT_THROW(ask(pair), std::invalid_argument);
  pair = crossing(0.25, 0.125, std::nan(""), 0.5, 1);
  EXPECT_THROW(ask(pair), std::invalid_argument);
}

TEST(Oracle, AgreesWithItselfAtAHundredDigits) {
  for (const PairFamily& family : pair_families()) {
    for (const NeedlePair& pair : draw_pairs(family.name, 60, 11)) {
      const OracleAnswer quad = ask(pair, {.digits = Digits::quad});
      const OracleAnswer wide = ask(pair, {.digits = Digits::hundred});
      ASSERT_FALSE(wide.undecidable) << csv_line(0, pair);
      if (quad.undecidable) continue;
      ASSERT_EQ(quad.contact, wide.contact) << csv_line(0, pair);
      if (!quad.contact) continue;
      const double difference = (quad.time - wide.time) + (quad.time_low - wide.time_low);
      // 113 bits have 60 bits more than a double. Of needles parallel to 1e-16, none are left for
      // the arms but those within the condition limit.
      const double digits = family.made_of_limits ? 1e-8 : 1e-15;
      const double limit = quad.time * std::max(1e-30, 0.1 * digits * quad.time_limit);
      EXPECT_LE(std::abs(difference), limit) << csv_line(0, pair);
      EXPECT_NEAR(quad.arm_first, wide.arm_first, 1e-15 + digits * quad.arm_limit);
      EXPECT_NEAR(quad.arm_second, wide.arm_second, 1e-15 + digits * quad.arm_limit);
    }
  }
}

TEST(Oracle, DoublesSettleOnlyWhatIsClear_long) {
  for (const PairFamily& family : pair_families()) {
    SCOPED_TRACE(family.name);
    int settled = 0;
    constexpr int count = 2000;
    for (const NeedlePair& pair : draw_pairs(family.name, count, 11)) {
      SCOPED_TRACE(csv_line(0, pair));
      const OracleAnswer quick = ask(pair, {.digits = Digits::fewest});
      const OracleAnswer full = ask(pair);
      ASSERT_EQ(quick.contact, full.contact);
      if (quick.digits > std::numeric_limits<double>::digits10) {
        ASSERT_EQ(quick.time, full.time);
        ASSERT_EQ(quick.decision_margin, full.decision_margin);
        continue;
      }
      ++settled;
      if (full.contact) {
        const double turned =
            (norm(pair.first.angular_velocity) + norm(pair.second.angular_velocity)) * full.time;
        ASSERT_NEAR(quick.time / full.time, 1, 100 * (1 + turned) * full.time_limit + 1e-15);
      }
      // A margin found in double is off by some units itself.
      ASSERT_GT(full.decision_margin, margin_cap / 2);
    }
    if (family.thermal) {
      EXPECT_GT(settled, 0.99 * count);
    }
  }
}

// Found among ten million: next to a parallel root arms change so fast that a root in double does
// not determine them.
TEST(Oracle, DoublesLeaveArmsNextToAParallelRootToMoreDigits) {
  NeedlePair pair;
  pair.first = {{-1.3737114472236875, -2.0194753677257364, -0.38186888999200702},
                {-0.99251771350766238, 0.030898154796689937, -0.11812659481963214},
                {1.1014638937548424, 1.0554476917085001, -0.42615407670483402},
                {0.003386548425402616, -0.01794000565229879, -0.033146831816666028}};
  pair.second = {{0.030002275034505369, -0.10842579895420341, -1.6835998295758594},
                 {-0.98366014375974398, 0.075277004310513929, -0.16354233152488279},
                 {-1.1962923490196586, -0.88881185153030196, 0.82068083272508496},
                 {0.00010338179923683588, 0.030247545690538953, 0.013300850315312758}};
  pair.horizon = 1.4788885894496069;
  const OracleAnswer answer = ask(pair, {.digits = Digits::fewest});
  EXPECT_TRUE(answer.contact);
  EXPECT_GT(answer.digits, std::numeric_limits<double>::digits10);
}

struct Sample {
  double f, arm_first, arm_second;
};

Sample sample(const NeedlePair& pair, double t) {
  std::array<Vec<double>, 2> u;
  const std::array<const FreeNeedle*, 2> needles = {&pair.first, &pair.second};
  for (int i = 0; i < 2; ++i) {
    const Vec<double>&a = needles[i]->orientation, &w = needles[i]->angular_velocity;
    const double spin = norm(w);
    u[i] = std::cos(spin * t) * a;
    if (spin > 0) u[i] = u[i] + (std::sin(spin * t) / spin) * cross(w, a);
  }
  const Vec<double> r = (pair.first.position - pair.second.position) +
                        t * (pair.first.velocity - pair.second.velocity);
  const Vec<double> x = cross(u[0], u[1]);
  return {dot(r, x), dot(cross(u[1], r), x) / dot(x, x), dot(cross(u[0], r), x) / dot(x, x)};
}

TEST(Oracle, BruteForceFindsNothingEarlier) {
  int contacts = 0, unseen = 0;
  for (const char* family : {"thermal-k6", "thermal-k2", "still"}) {
    for (const NeedlePair& pair : draw_pairs(family, 300, 13)) {
      const OracleAnswer answer = ask(pair);
      const int steps = 3000;
      double found = never;
      Sample last = sample(pair, 0);
      for (int step = 1; step <= steps && found == never; ++step) {
        const Sample next = sample(pair, pair.horizon * step / steps);
        const bool inside = std::abs(next.arm_first) < 0.5 && std::abs(next.arm_second) < 0.5 &&
                            std::abs(last.arm_first) < 0.5 && std::abs(last.arm_second) < 0.5;
        if (inside && (next.f > 0) != (last.f > 0)) found = pair.horizon * step / steps;
        last = next;
      }
      contacts += answer.contact;
      // Two roots between samples, and tips that come by just then, are missed by samples.
      if (found == never) {
        unseen += answer.contact;
      } else {
        EXPECT_TRUE(answer.contact) << csv_line(0, pair);
        EXPECT_LE(answer.time, found * (1 + 1e-12)) << csv_line(0, pair);
        unseen += answer.time < found - 1.5 * pair.horizon / steps;
      }
    }
  }
  EXPECT_GT(contacts, 200);
  EXPECT_LE(unseen, 5);
}

/// The margin is in units of the inputs' noise: a change of every number by one ulp must not flip
/// what is 8 units away, and does flip some of what is nearer than one.
TEST(Oracle, UlpsFlipOnlyDecisionsNearTheLimit) {
  Random random(16);
  int flipped = 0, near = 0;
  for (const PairFamily& family : pair_families()) {
    for (const NeedlePair& pair : draw_pairs(family.name, 400, 17)) {
      const OracleAnswer answer = ask(pair);
      NeedlePair other = pair;
      for (FreeNeedle* needle : {&other.first, &other.second}) {
        for (auto* vector : {&needle->position, &needle->orientation, &needle->velocity,
                             &needle->angular_velocity}) {
          for (double& value : *vector) {
            value = std::nextafter(value, random.coin() ? never : -never);
          }
        }
      }
      const OracleAnswer moved = ask(other);
      const bool flips = answer.contact != moved.contact ||
                         (answer.contact && std::abs(answer.time - moved.time) >
                                                (1e-14 + 16 * answer.input_limit) * answer.time);
      if (answer.decision_margin >= 8) {
        EXPECT_FALSE(flips) << answer.time << " and " << moved.time << "\n" << csv_line(0, pair);
      }
      near += answer.decision_margin < 1;
      flipped += answer.decision_margin < 1 && flips;
    }
  }
  EXPECT_GT(flipped, near / 10);
}

TEST(Oracle, DoublesGiveTheSignOfFBeyondTheLimit) {
  for (const PairFamily& family : pair_families()) {
    if (family.name == "slow") continue;  // sample() underflows
    for (const NeedlePair& pair : draw_pairs(family.name, 400, 18)) {
      const OracleAnswer answer = ask(pair);
      if (!answer.contact || answer.decision_margin < 8) continue;
      const double reach = 4 * answer.time_limit + 1e-15;
      // A second root as near as the rounding cannot be resolved in double.
      if (answer.root_depth < 32) continue;
      const double before = sample(pair, answer.time * (1 - reach)).f;
      const double after = sample(pair, answer.time * (1 + reach)).f;
      EXPECT_LE(before * after, 0) << csv_line(0, pair);
    }
  }
}

/// Needles that pass through each other cross as often as the elastic gas collides, at every
/// density: per passage of the bounding spheres (rate 4 sqrt(pi) n) they do so, at k = 6,
/// 1.237662397803 / (4 sqrt(pi)) times.
TEST(Oracle, CrossingsOfFreePassesHaveTheExactRate) {
  const int passages = 20000;
  int crossings = 0;
  double squares = 0;
  for (NeedlePair pair : draw_pairs("thermal-k6", passages, 14)) {
    int here = 0;
    for (OracleAnswer answer = ask(pair); answer.contact; answer = ask(pair)) {
      ++here;
      pair = advanced(pair, answer.time);
      pair.just_collided = true;
      if (pair.horizon <= 0) break;
    }
    crossings += here;
    squares += here * here;
  }
  const double rate = static_cast<double>(crossings) / passages;
  const double expected = 1.237662397803 / (4 * std::sqrt(std::numbers::pi));
  const double error = std::sqrt((squares / passages - rate * rate) / passages);
  EXPECT_NEAR(rate, expected, 4 * error);
  EXPECT_LT(error, 0.02 * expected);
}

}  // namespace
}  // namespace needlework::test
