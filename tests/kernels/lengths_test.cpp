// Needles of any two lengths: the kernels in double know no unit of length, and find the contacts
// of needles that are shorter, longer or unequal.
#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "kernels/first_contact.h"
#include "tests/kernels/precise_contact.h"
#include "tests/support/by_build.h"
#include "tests/support/collided_pair.h"
#include "tests/support/family_name.h"
#include "tests/support/oracle.h"
#include "tests/support/pair_families.h"
#include "tests/support/random.h"

namespace needlework::kernels {
namespace {

using test::cross;
using test::dot;
using test::draw_pairs;
using test::KernelPair;
using test::lengthened;
using test::Quad;
using test::Random;
using test::resized;
using test::slowed;
using test::Vec;
using test::operator*;
using test::operator+;
using test::operator-;

constexpr std::uint64_t lengths_seed = 2020;
constexpr int lengths_thin = test::by_build(1, 10);

Contact find_of_lengths(const KernelPair& pair, double until,
                        const Accuracy& accuracy = standard_accuracy) {
  EvaluationCounters counters;
  return first_contact(pair.view(), 0, until, counters, accuracy);
}

/// A pair of a family with the state after a collision, if it has just had one, or a gap that it
/// carries, if `gap` says so.
KernelPair pair_of(const test::NeedlePair& drawn, Random& random, bool gap) {
  KernelPair out = test::collided_pair(drawn);
  if (drawn.just_collided) return out;
  if (gap) {
    const int side = random.coin() ? 1 : -1;
    out.touch = {.touching = true,
                 .collided = false,
                 .side = side,
                 .gap = gap_at(out.view(), 0) + side * random.log_uniform(1e-18, 1e-14)};
  } else if (random.coin()) {
    out.touch_within = random.log_uniform(1e-14, 1);
  }
  return out;
}

class Lengths : public testing::TestWithParam<test::PairFamily> {};

// Lengths times 2^p and times times 2^q, at once.
TEST_P(Lengths, ByPowersOfTwoGiveTheSameBits) {
  Random random(lengths_seed);
  const struct {
    const char* name;
    Accuracy accuracy;
  } accuracies[] = {
      {"standard", standard_accuracy}, {"fast", fast_accuracy}, {"rigorous", rigorous_accuracy}};
  int contacts = 0, unknown = 0;
  for (const test::NeedlePair& drawn :
       draw_pairs(GetParam().name, 300 / lengths_thin, lengths_seed)) {
    KernelPair pair = pair_of(drawn, random, random.below(4) == 0);
    const int kind = random.below(3);
    if (kind > 0) pair.half_first = random.uniform(0.2, 1);
    if (kind > 1) pair.half_second = random.uniform(0.2, 1);
    for (const auto& [name, accuracy] : accuracies) {
      if (accuracy.isolation == Isolation::intervals && random.below(4) > 0) continue;
      const Contact truth = find_of_lengths(pair, drawn.horizon, accuracy);
      contacts += truth.found;
      unknown += truth.side_unknown;
      const ContactGeometry geometry = contact_geometry(pair.view(), truth.elapsed);
      for (const int p : {-1, 1, 7, -60, 60}) {
        const int q = random.below(3) * (random.below(200) - 100);
        SCOPED_TRACE(std::string(name) + ", lengths times 2^" + std::to_string(p) +
                     ", times times 2^" + std::to_string(q) + ", seed " +
                     std::to_string(lengths_seed));
        const KernelPair other = slowed(resized(pair, p), q);
        const Contact contact = find_of_lengths(other, std::ldexp(drawn.horizon, q), accuracy);
        ASSERT_EQ(contact.found, truth.found);
        ASSERT_EQ(contact.side, truth.side);
        ASSERT_EQ(contact.side_unknown, truth.side_unknown);
        ASSERT_EQ(contact.unresolvable, truth.unresolvable);
        ASSERT_EQ(contact.elapsed, test::power_of_two(truth.elapsed, q));
        const ContactGeometry at = contact_geometry(other.view(), contact.elapsed);
        if (!truth.found) continue;
        ASSERT_EQ(at.arm_first, std::ldexp(geometry.arm_first, p));
        ASSERT_EQ(at.arm_second, std::ldexp(geometry.arm_second, p));
        ASSERT_EQ(at.sin_angle, geometry.sin_angle);
        ASSERT_EQ(at.normal, geometry.normal);
        ASSERT_EQ(at.u_first, geometry.u_first);
        const DoubleDouble later = contact.elapsed * DoubleDouble(1.25);
        ASSERT_EQ(gap_at(other.view(), later),
                  std::ldexp(gap_at(pair.view(), truth.elapsed * DoubleDouble(1.25)), p));
        ASSERT_EQ(side_after(other.view()), side_after(pair.view()));
      }
    }
  }
  EXPECT_GT(contacts, 30 / lengths_thin);
}

class OddLengths : public testing::TestWithParam<test::PairFamily> {};

// Needles of one odd length are needles of length 1 but for rounding of the records.
TEST_P(OddLengths, AgreeWithTheOracle) {
  Random random(lengths_seed + 1);
  int contacts = 0;
  for (const test::NeedlePair& drawn :
       draw_pairs(GetParam().name, 400 / lengths_thin, lengths_seed + 1)) {
    const test::OracleAnswer oracle =
        test::first_contact(drawn.first, drawn.second, drawn.horizon, false);
    // Rounding the products adds about as much noise as the numbers have.
    if (oracle.decision_margin < 4 * test::least_margin) continue;
    const double length = random.log_uniform(0.1, 10);
    const KernelPair pair = lengthened(test::kernel_pair(drawn), length);
    const Contact contact = find_of_lengths(pair, drawn.horizon);
    ASSERT_EQ(contact.found, oracle.contact) << "length " << length << ", seed " << lengths_seed;
    if (!contact.found) continue;
    ++contacts;
    EXPECT_NEAR(contact.elapsed.hi, oracle.time, (16 * oracle.input_limit + 1e-14) * oracle.time)
        << "length " << length << ", seed " << lengths_seed;
    const ContactGeometry at = contact_geometry(pair.view(), contact.elapsed);
    EXPECT_NEAR(at.arm_first / length, oracle.arm_first, 16 * oracle.arm_limit + 1e-12);
    EXPECT_NEAR(at.arm_second / length, oracle.arm_second, 16 * oracle.arm_limit + 1e-12);
  }
  if (!GetParam().made_of_limits) {
    EXPECT_GT(contacts, 20 / lengths_thin);
  }
}

/// Those that do not begin on a contact, of which rounding moves a touch to either side.
std::vector<test::PairFamily> apart_at_first() {
  std::vector<test::PairFamily> out;
  for (const test::PairFamily& family : test::pair_families()) {
    if (!draw_pairs(family.name, 1, lengths_seed)[0].just_collided) out.push_back(family);
  }
  return out;
}

INSTANTIATE_TEST_SUITE_P(Families, Lengths, testing::ValuesIn(test::pair_families()),
                         test::family_name);
INSTANTIATE_TEST_SUITE_P(Families, OddLengths, testing::ValuesIn(apart_at_first()),
                         test::family_name);

Vec3d any_vector(Random& random, double size) {
  return Vec3d{random.uniform(-size, size), random.uniform(-size, size),
               random.uniform(-size, size)};
}

/// Half lengths from a tenth of the other's to ten times as long, anywhere near each other.
KernelPair unequal_pair(Random& random, bool turning) {
  KernelPair out;
  const double length = random.log_uniform(0.05, 20);
  out.half_first = length * random.log_uniform(0.1, 1);
  out.half_second = length * random.log_uniform(0.1, 1);
  const double size = out.half_first + out.half_second;
  for (Flight* needle : {&out.first, &out.second}) {
    const Vec3d w = turning ? any_vector(random, 2) : Vec3d{};
    const Vec3d r = any_vector(random, 0.5 * size);  // braces evaluate in order, arguments do not
    const Vec3d u = test::vec3(random.direction());
    *needle = test::flight(r, u, any_vector(random, size), w);
  }
  return out;
}

// The contact function of needles that do not turn is linear, so that its only root and the arms
// there are quotients.
TEST(UnequalLengths, StillOnesMeetWhereClosedFormsSay) {
  Random random(lengths_seed + 2);
  int contacts = 0, beyond_a_tip = 0;
  for (int n = 0; n < 20000 / lengths_thin; ++n) {
    const KernelPair pair = unequal_pair(random, false);
    const Vec<Quad> u1 = test::real<Quad>(pair.first.u), u2 = test::real<Quad>(pair.second.u);
    const Vec<Quad> x = cross(u1, u2);
    const Vec<Quad> r = test::real<Quad>(pair.first.r) - test::real<Quad>(pair.second.r);
    const Vec<Quad> v = test::real<Quad>(pair.first.v) - test::real<Quad>(pair.second.v);
    const Quad time = -dot(r, x) / dot(v, x), xx = dot(x, x);
    const Vec<Quad> at_root = r + Quad(time) * v;
    const Quad arm_first = dot(cross(u2, at_root), x) / xx;
    const Quad arm_second = dot(cross(u1, at_root), x) / xx;
    const auto inside = [](const Quad& arm, double half) { return Quad(half) - abs(arm); };
    const Quad least =
        std::min(inside(arm_first, pair.half_first), inside(arm_second, pair.half_second));
    if (abs(least) < 1e-12 || abs(time) < 1e-12) continue;
    const bool meets = least > 0 && time > 0;
    beyond_a_tip += time > 0 && !meets;
    const Contact contact = find_of_lengths(pair, 1e6);
    ASSERT_EQ(contact.found, meets) << "pair " << n << ", seed " << lengths_seed;
    if (!meets) continue;
    ++contacts;
    ASSERT_NEAR(contact.elapsed.hi, static_cast<double>(time), 1e-11 * static_cast<double>(time));
    const ContactGeometry at = contact_geometry(pair.view(), contact.elapsed);
    ASSERT_NEAR(at.arm_first, static_cast<double>(arm_first), 1e-10 * pair.half_first);
    ASSERT_NEAR(at.arm_second, static_cast<double>(arm_second), 1e-10 * pair.half_second);
  }
  EXPECT_GT(contacts, 500 / lengths_thin);
  EXPECT_GT(beyond_a_tip, 500 / lengths_thin);
}

/// The first change of sign between samples of the contact function with both arms inside by
/// `inside` of the half lengths; its own arithmetic, from the records. It may overlook two roots
/// between samples.
std::optional<double> sampled(const KernelPair& held, double until, int steps, double inside) {
  const Pair pair = held.view();
  const auto f = [&](double t) { return test::precise_contact(pair, PairScale{}, t).f; };
  double before = f(0);
  for (int n = 1; n <= steps; ++n) {
    double low = until * (n - 1) / steps, high = until * n / steps;
    const double after = f(high);
    if (before * after < 0) {
      for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        (f(middle) * before > 0 ? low : high) = middle;
      }
      const auto at = test::precise_contact(pair, PairScale{}, low);
      const double xx = dot(at.x, at.x);
      const double arm_first = dot(cross(at.u[1], at.r), at.x) / xx;
      const double arm_second = dot(cross(at.u[0], at.r), at.x) / xx;
      if (std::abs(arm_first) < inside * pair.half_first &&
          std::abs(arm_second) < inside * pair.half_second) {
        return low;
      }
    }
    before = after;
  }
  return std::nullopt;
}

// None of the contacts that sampling finds is missed, and each that is found is one.
TEST(UnequalLengths, TurningOnesMeetWhereFChangesSign) {
  Random random(lengths_seed + 3);
  int contacts = 0;
  for (int n = 0; n < 3000 / lengths_thin; ++n) {
    SCOPED_TRACE("pair " + std::to_string(n) + ", seed " + std::to_string(lengths_seed));
    const KernelPair pair = unequal_pair(random, true);
    const double until = 2;
    const Contact contact = find_of_lengths(pair, until);
    const double end = contact.found ? contact.elapsed.hi : until;
    const auto earlier = sampled(pair, end, 400, 1 - 1e-9);
    if (earlier) {
      ASSERT_NEAR(*earlier, end, 1e-11) << "a contact is missed";
    }
    if (!contact.found) continue;
    ++contacts;
    // In 113 bits: another sign a little before than after, both arms inside.
    const auto at = [&](double share) {
      return test::precise_contact(pair.view(), PairScale{}, Quad(end) * Quad(share));
    };
    ASSERT_LT(at(1 - 1e-9).f * at(1 + 1e-9).f, 0);
    ASSERT_EQ(at(1 - 1e-9).f > 0, contact.side > 0);
    const auto here = at(1);
    const Quad xx = dot(here.x, here.x);
    const auto first = static_cast<double>(dot(cross(here.u[1], here.r), here.x) / xx);
    const auto second = static_cast<double>(dot(cross(here.u[0], here.r), here.x) / xx);
    ASSERT_LT(std::abs(first), pair.half_first * (1 + 1e-9));
    ASSERT_LT(std::abs(second), pair.half_second * (1 + 1e-9));
    const ContactGeometry geometry = contact_geometry(pair.view(), contact.elapsed);
    ASSERT_NEAR(geometry.arm_first, first, 1e-9 * pair.half_first);
    ASSERT_NEAR(geometry.arm_second, second, 1e-9 * pair.half_second);
    ASSERT_LE(std::abs(geometry.arm_first), pair.half_first);
    ASSERT_LE(std::abs(geometry.arm_second), pair.half_second);
  }
  EXPECT_GT(contacts, 300 / lengths_thin);
}

// The time for which needles touch at the start is decided within their own lengths.
TEST(UnequalLengths, TouchWithinTheirLengths) {
  KernelPair pair;
  pair.first = test::flight({0.25, 0, 0}, {1, 0, 0}, {0, 0, 1}, {});
  pair.second = test::flight({0, 0.1, 0}, {0, 1, 0}, {}, {});
  pair.touch_within = 1e-12;
  EXPECT_TRUE(find_of_lengths(pair, 1).side_unknown);
  pair.half_first = 0.2;  // ends at x = 0.05
  EXPECT_FALSE(find_of_lengths(pair, 1).side_unknown);
  pair.half_first = 0.26;
  EXPECT_TRUE(find_of_lengths(pair, 1).side_unknown);
  pair.half_second = 0.05;  // ends at y = 0.05
  EXPECT_FALSE(find_of_lengths(pair, 1).side_unknown);
}

TEST(UnequalLengths, ScaleByTheirSum) {
  KernelPair pair;
  pair.first = test::flight({0, 0, 0}, {1, 0, 0}, {3, 0, 0}, {});
  pair.second = test::flight({0, 0.1, 0}, {0, 1, 0}, {}, {});
  EXPECT_EQ(scale_of(pair.view()).per_length, 1);
  pair.half_first = 3;
  const PairScale scale = scale_of(pair.view());
  EXPECT_EQ(scale.per_length, 0.5);
  EXPECT_EQ(scale.per_rate, 1);
  const auto frame = make_frame<double>(pair.view(), scale);
  EXPECT_EQ(frame.half[0], 1.5);
  EXPECT_EQ(frame.half[1], 0.25);
  EXPECT_EQ(frame.v.x, 1.5);
  pair.half_first = 0.1;
  EXPECT_EQ(scale_of(pair.view()).per_length, 2);
}

}  // namespace
}  // namespace needlework::kernels
