// The audit's contact finder against the other oracle, over thermal pairs and all hard families.
//
// Law: if the inputs would have to change by more than `clear` units of their noise to reverse the
// decision, the audit finds a contact with certainty and reports an interval that contains its
// time, and it finds none where there is none. Exempt are contacts where an error of time within
// the condition limit could move a tip or a neighbouring root there. If a smaller change reverses
// the decision, the result may be doubtful; beyond one unit it is never the opposite with
// certainty.
#include "src/audit/contact_finder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "tests/support/by_build.h"
#include "tests/support/oracle.h"
#include "tests/support/pair_families.h"
#include "tests/support/pairs_csv.h"
#include "tests/support/random.h"

namespace needlework::test {

namespace {

constexpr std::size_t count = test::by_build<std::size_t>(2000, 100);
constexpr std::uint64_t seed = 77;
constexpr double clear = 48, few = 64;

audit::Needle needle_of(const FreeNeedle& needle) {
  return audit::Needle(
      {{}, {needle.position}, {needle.velocity}, {needle.orientation}, {needle.angular_velocity}});
}

/// In units of time in which the pair's fastest motion is about 1, as the audit has its epochs.
NeedlePair in_own_time(const NeedlePair& pair) {
  double fastest = 0;
  for (const FreeNeedle* needle : {&pair.first, &pair.second}) {
    for (int axis = 0; axis < 3; ++axis) {
      fastest = std::max(
          {fastest, std::abs(needle->velocity[axis]), std::abs(needle->angular_velocity[axis])});
    }
  }
  return slowed(pair, std::ilogb(fastest));
}

class ContactFinderOracle : public testing::TestWithParam<PairFamily> {};

void expect_the_same_contacts(const PairFamily& family, std::size_t count) {
  std::size_t contacts = 0, doubtful = 0, near = 0, escalated = 0;
  int longest = 0;
  for (const NeedlePair& drawn : draw_pairs(family.name, count, seed)) {
    const NeedlePair pair = in_own_time(drawn);
    const OracleAnswer truth =
        first_contact(pair.first, pair.second, pair.horizon, pair.just_collided);
    const audit::Needle first = needle_of(pair.first), second = needle_of(pair.second);
    const audit::Space space{{64, 64, 64}};
    audit::Start start;
    if (pair.just_collided) {
      audit::PairFlight before(first, second, {}, space, {});
      start = {audit::Start::collided, before.precise(0).df > 0 ? 1 : -1};
    }
    audit::PairFlight flown(first, second, {}, space, start);
    audit::ContactFinder finder(flown);
    const auto found = finder.first(0, pair.horizon);
    contacts += truth.contact;
    longest = std::max(longest, finder.looked_at());
    doubtful += found && !found->certain;
    escalated += flown.needed_quad();
    if (truth.decision_margin < 1) continue;
    const std::string text =
        csv_line(0, pair) + "\nmargin " + std::to_string(truth.decision_margin);
    if (found && found->certain) {
      ASSERT_TRUE(truth.contact) << text;
      const double off = std::max(1e-12, 4 * truth.time_limit) * truth.time;
      EXPECT_GE(truth.time, found->begin - off) << text;
      EXPECT_LE(truth.time, found->end + off) << text;
      EXPECT_LT(found->end - found->begin, 16 * off) << text;
      continue;
    }
    ASSERT_FALSE(truth.contact && !found) << text;
    if (truth.decision_margin < clear) {
      ++near;
    } else if (truth.contact && found->end >= truth.time) {
      const double inside = 0.5 - std::max(std::abs(truth.arm_first), std::abs(truth.arm_second));
      EXPECT_TRUE(inside < few * truth.arm_limit || truth.root_depth < few)
          << text << " inside " << inside << " arm limit " << truth.arm_limit << " depth "
          << truth.root_depth << " begin " << found->begin << " end " << found->end;
    }
    if (testing::Test::HasFailure()) break;
  }
  std::printf("%-14.*s contacts %zu, doubtful %zu, near %zu, with 113 bits %zu, stretches %d\n",
              static_cast<int>(family.name.size()), family.name.data(), contacts, doubtful, near,
              escalated, longest);
  if (family.thermal) {
    EXPECT_EQ(doubtful, 0u);
  }
}

TEST_P(ContactFinderOracle, FindsTheSameContacts) {
  expect_the_same_contacts(GetParam(), count / 4);
}

TEST_P(ContactFinderOracle, FindsTheSameContactsOfMany_long) {
  expect_the_same_contacts(GetParam(), count);
}

// Two needles that fly and turn in one plane, but for `off` times a generic motion, since records
// of times up to `latest`.
std::pair<audit::Needle, audit::Needle> nearly_in_one_plane(Random& random, double off,
                                                            double latest = 0) {
  const auto unit = [&](const Vec<double>& a) { return 1 / std::sqrt(dot(a, a)) * a; };
  const Vec<double> e1 = random.direction();
  const Vec<double> e2 = unit(cross(e1, random.direction())), normal = cross(e1, e2);
  const auto draw = [&] {
    const auto near_plane = [&](double size) {
      const double a = size * random.normal(), b = size * random.normal();
      return a * e1 + b * e2 + off * random.normal_vector(size);
    };
    const double spin = random.coin() ? 3 * random.normal() : 0;
    const Vec<double> r = near_plane(0.3), u = unit(near_plane(1)), v = near_plane(1);
    const Vec<double> w = spin * normal + off * random.normal_vector(1);
    return audit::Needle({{0, random.uniform(0, latest)}, {r}, {v}, {u}, {w}});
  };
  const audit::Needle first = draw();
  return {first, draw()};
}

// |f'(b) - f'(a)| <= max |f''| (b - a), from shortly before 0 to any time, whenever the records
// were made, for any image, and just after a collision; much sharper by the coefficients when the
// needles lie in nearly one plane.
TEST(Bend, BoundsTheSecondDerivative) {
  Random random(seed);
  double tightest = 0;
  for (int n = 0; n < 3000; ++n) {
    const double off = std::pow(10, random.uniform(-18, 0));
    const auto [first, second] = nearly_in_one_plane(random, off, 0.7);
    const audit::Space space{{2.5, 2.5, 2.5}};
    const bool shifted = random.below(4) == 0;  // which takes them out of their plane
    const bool collided = random.coin();
    audit::PairFlight pair(first, second, {shifted ? 1 : 0, 0, 0}, space,
                           {collided ? audit::Start::collided : audit::Start::apart, 1});
    const double end = random.uniform(0, 4);
    const double begin = -random.uniform(0, 0.1);
    const double distance = pair.sample(0).distance + pair.speed() * std::max(end, -begin);
    const double general = pair.bend(begin, end, distance);
    pair.find_coefficients();
    const double bend = pair.bend(begin, end, distance);
    EXPECT_LE(bend, general);
    if (!shifted) {
      EXPECT_LE(bend, 1e3 * (off + 0x1p-50) * (1 + general));
    }
    const double a = random.uniform(begin, end), b = std::min(end, a + random.uniform(0, 0.1));
    const audit::Sample at_a = pair.precise(a), at_b = pair.precise(b);
    const double change = std::abs(at_b.df - at_a.df) - (at_a.df_error + at_b.df_error);
    EXPECT_LE(change, bend * (b - a)) << "off by " << off;
    if (bend < general && b > a) tightest = std::max(tightest, change / (bend * (b - a)));
    if (testing::Test::HasFailure()) break;
  }
  EXPECT_GT(tightest, 0.3);  // or the bound is worth nothing
}

// In any plane, f is distinguished from noise, or classified as noise, within a few intervals;
// halving by the general bound on f'' would take 1e7.
TEST(ContactFinder, EndsSoonForNeedlesInOnePlane_long) {
  Random random(seed);
  constexpr int pairs = 1000;
  int all = 0, given_up = 0;
  for (int n = 0; n < pairs; ++n) {
    const auto [first, second] = nearly_in_one_plane(random, std::pow(10, random.uniform(-18, -8)));
    const audit::Space space{{64, 64, 64}};
    audit::PairFlight pair(first, second, {}, space, {});
    audit::ContactFinder finder(pair);
    for (auto found = finder.first(0, 2); found && found->end < 2;) {
      found = finder.next(found->end, 2);
    }
    all += finder.looked_at();
    given_up += finder.looked_at() >= 10000;
  }
  std::printf("stretches %g a pair, given up %d\n", double(all) / pairs, given_up);
  EXPECT_LT(all, 150 * pairs);
  EXPECT_LE(given_up, pairs / 250);  // f stays next to the condition limit
}

std::string test_name(const testing::TestParamInfo<PairFamily>& info) {
  std::string text(info.param.name);
  std::replace(text.begin(), text.end(), '-', '_');
  return text;
}

INSTANTIATE_TEST_SUITE_P(Families, ContactFinderOracle, testing::ValuesIn(pair_families()),
                         test_name);

}  // namespace
}  // namespace needlework::test
