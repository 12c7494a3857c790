// The contact function and its error bounds against many digits.
#include "kernels/contact_function.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "tests/kernels/precise_contact.h"
#include "tests/support/kernel_pair.h"
#include "tests/support/random.h"

namespace needlework::kernels {
namespace {

using boost::multiprecision::cpp_bin_float_50;
using test::axes_swapped;
using test::exchanged;
using test::KernelPair;
using test::power_of_two;
using test::precise_contact;
using test::Random;
using test::real;
using test::slowed;
using test::vec3;
using test::Wide;

constexpr std::uint64_t function_seed = 303;

// The same quotient of time and rate for both needles' records as in a run: one of them older.
void age(KernelPair& pair, Random& random, double radians) {
  const Flight& older = random.coin() ? pair.first : pair.second;
  const double rate = std::max(older.omega, std::sqrt(dot(older.v, older.v)));
  const double hi = radians * random.uniform() / rate;
  const DoubleDouble elapsed = two_sum(hi, hi * random.uniform(-0x1p-54, 0x1p-54));
  (&older == &pair.first ? pair.elapsed_first : pair.elapsed_second) = elapsed;
  // Bring the centres of then near each other.
  const Vec3d travelled = older.v * hi;
  Flight& moved = &older == &pair.first ? pair.first : pair.second;
  moved.r -= travelled;
}

void move_into_box(KernelPair& pair, Random& random, double box) {
  const Vec3d corner = vec3(random.direction()) * box;
  pair.first.r += corner;
  pair.second.r += corner;
  const double boxes = random.below(3) - 1;
  pair.shift = {two_prod(boxes, box / 3), DoubleDouble(), two_prod(-boxes, box / 7)};
  pair.first.r += to_double(pair.shift);
}

enum class Kind { thermal, parallel, aligned, fast_spin, aged, boxed, still };

const char* name(Kind kind) {
  constexpr const char* names[] = {"thermal", "parallel", "aligned", "fast_spin",
                                   "aged",    "boxed",    "still"};
  return names[static_cast<int>(kind)];
}

KernelPair draw_kind(Kind kind, Random& random) {
  const auto needle = [&](double spin) {
    return test::flight(vec3(random.normal_vector(0.4)), vec3(random.direction()),
                        vec3(random.normal_vector(1)), vec3(random.normal_vector(spin)));
  };
  KernelPair pair;
  const double rod = 3.4641016151377544;
  pair.first = needle(rod);
  pair.second = needle(rod);
  switch (kind) {
    case Kind::thermal:
      break;
    case Kind::parallel: {
      const Vec3d tilted =
          pair.first.u * (random.coin() ? 1 : -1) +
          vec3(random.direction()) * std::ldexp(random.uniform(), -random.below(50));
      pair.second = test::flight(pair.second.r, tilted, pair.second.v, pair.second.w);
      break;
    }
    case Kind::aligned: {
      // At s = 0 along one line, with the centres too.
      const double off = std::ldexp(random.uniform(), -random.below(100));
      const double along = random.uniform(-1, 1);
      pair.second =
          test::flight(pair.first.r + pair.first.u * along + vec3(random.direction()) * off,
                       pair.first.u * (random.coin() ? 1 : -1) +
                           vec3(random.direction()) * off * random.uniform(),
                       pair.second.v, pair.second.w);
      break;
    }
    case Kind::fast_spin:
      pair.first = needle(random.log_uniform(1, 1e6));
      break;
    case Kind::aged:
      age(pair, random, 0x1p10);
      break;
    case Kind::boxed:
      age(pair, random, 10);
      move_into_box(pair, random, random.log_uniform(2, 1e3));
      break;
    case Kind::still:
      pair.first = needle(0);
      break;
  }
  return pair;
}

// Bounds over errors, for f and its derivatives.
class Looseness {
 public:
  void take(int derivative, double error, double bound, const std::string& where) {
    EXPECT_LE(error, bound) << where << ", derivative " << derivative;
    errors_[derivative] += error;
    bounds_[derivative] += bound;
  }
  double mean(int derivative) const { return bounds_[derivative] / errors_[derivative]; }
  void print(const std::string& of) const {
    std::printf("%-10s mean bound over mean error: f %.0f, f' %.0f, f'' %.0f\n", of.c_str(),
                mean(0), mean(1), mean(2));
  }

 private:
  double errors_[3] = {}, bounds_[3] = {};
};

template <class Real, class T>
double distance_of(const T& computed, const Real& exact) {
  return std::abs(static_cast<double>(Real(real<Real>(computed) - exact)));
}

// s in scaled time, from close to 0 up to what a record's life leaves.
template <class T>
T draw_time(Random& random, Kind kind);
template <>
double draw_time(Random& random, Kind kind) {
  if (kind == Kind::aligned) return random.log_uniform(0x1p-100, 1);
  return random.coin() ? random.uniform() : random.log_uniform(1e-3, 0x1p11);
}
template <>
DoubleDouble draw_time(Random& random, Kind kind) {
  const double s = draw_time<double>(random, kind);
  return two_sum(s, s * random.uniform(-0x1p-54, 0x1p-54));
}

template <class T, class Real>
void expect_bounds_hold(Kind kind, int count, double loosest) {
  Random random(function_seed);
  Looseness looseness;
  for (int n = 0; n < count && !testing::Test::HasFailure(); ++n) {
    const KernelPair held = draw_kind(kind, random);
    const Pair pair = held.view();
    const PairScale scale = scale_of(pair);
    const Frame<T> frame = make_frame<T>(pair, scale);
    const T s = draw_time<T>(random, kind);
    const Sample<T> sample = evaluate(frame, s);
    const Estimate e = estimate(frame, s, sample);
    const test::PreciseContact<Real> exact = precise_contact(pair, scale, real<Real>(s));
    const std::string where = std::string(name(kind)) + ", seed " + std::to_string(function_seed) +
                              ", pair " + std::to_string(n);
    looseness.take(0, distance_of(sample.f, exact.f), e.error_f, where);
    looseness.take(1, distance_of(sample.df, exact.df), e.error_df, where);
    looseness.take(2, distance_of(sample.ddf, exact.ddf), e.error_ddf, where);
    for (int i = 0; i < 3; ++i) {
      const auto component = [i](const auto& a) { return i == 0 ? a.x : i == 1 ? a.y : a.z; };
      const double allowed = director_error(sample);
      EXPECT_LE(distance_of(component(sample.u[0]), exact.u[0][i]), allowed) << where;
      EXPECT_LE(distance_of(component(sample.u[1]), exact.u[1][i]), allowed) << where;
      EXPECT_LE(distance_of(component(sample.x), exact.x[i]), allowed) << where;
    }
    EXPECT_NEAR(e.distance, static_cast<double>(test::norm(exact.r)), 1e-13 * (1 + e.distance))
        << where;
    EXPECT_GE(frame.w_sum, (held.first.omega + held.second.omega) * scale.per_rate);
  }
  looseness.print(name(kind));
  for (int derivative = 0; derivative < 3; ++derivative) {
    EXPECT_LT(looseness.mean(derivative), loosest) << "derivative " << derivative;
  }
}

class ContactFunction : public testing::TestWithParam<Kind> {};

TEST_P(ContactFunction, ErrorBoundsHoldInDouble) {
  expect_bounds_hold<double, cpp_bin_float_50>(GetParam(), 4000, 2000);
}

TEST_P(ContactFunction, ErrorBoundsHoldInDoubleDouble) {
  expect_bounds_hold<DoubleDouble, Wide>(GetParam(), 1000, 2e4);
}

// Also of what is known to more digits than the expansion has.
template <class T>
void expect_expansion(Kind kind, int count) {
  Random random(function_seed + 2);
  Looseness far;  // where the third derivative counts, not rounding
  for (int n = 0; n < count && !testing::Test::HasFailure(); ++n) {
    const KernelPair held = draw_kind(kind, random);
    const Pair pair = held.view();
    const PairScale scale = scale_of(pair);
    const Frame<T> frame = make_frame<T>(pair, scale);
    const double s = draw_time<double>(random, kind);
    const Estimate e = estimate(frame, T(s), evaluate(frame, T(s)));
    for (const double size : {0.25, random.log_uniform(1e-15, 0.25)}) {
      const double off = random.coin() ? size : -size;
      const Estimate there = expanded(e, off, third_derivative_bound(frame, e, size));
      const auto exact = precise_contact(pair, scale, Wide(Wide(s) + Wide(off)));
      const std::string where = std::string(name(kind)) + ", seed " +
                                std::to_string(function_seed + 2) + ", pair " + std::to_string(n) +
                                ", off " + std::to_string(off);
      Looseness near;
      Looseness& looseness = size == 0.25 ? far : near;
      looseness.take(0, distance_of(there.f, exact.f), there.error_f, where);
      looseness.take(1, distance_of(there.df, exact.df), there.error_df, where);
      looseness.take(2, distance_of(there.ddf, exact.ddf), there.error_ddf, where);
    }
  }
  far.print(name(kind));
  for (int derivative = 0; derivative < 3; ++derivative) EXPECT_LT(far.mean(derivative), 30);
}

TEST_P(ContactFunction, ExpansionHoldsAtOtherTimes) {
  expect_expansion<double>(GetParam(), 2000);
  expect_expansion<DoubleDouble>(GetParam(), 1000);
}

TEST_P(ContactFunction, AmplitudeBoundsItsDerivatives) {
  Random random(function_seed + 1);
  double closest = 0;
  for (int n = 0; n < 300; ++n) {
    const KernelPair held = draw_kind(GetParam(), random);
    const Pair pair = held.view();
    const Frame<DoubleDouble> frame = make_frame<DoubleDouble>(pair, scale_of(pair));
    const Amplitude amplitude = kernels::amplitude(frame);
    for (int i = 0; i < 20; ++i) {
      const double s = random.uniform(0, 8), h = 0.01;
      const auto second = [&](double at) {
        return to_double(evaluate(frame, DoubleDouble(at)).ddf);
      };
      const double bound = amplitude.derivative_bound(2, s);
      ASSERT_LE(std::abs(second(s)), bound) << "seed " << function_seed + 1 << ", pair " << n;
      ASSERT_LE(std::abs(second(s + h) - second(s)), h * amplitude.derivative_bound(3, s + h))
          << "seed " << function_seed + 1 << ", pair " << n;
      if (bound > 0) closest = std::max(closest, std::abs(second(s)) / bound);
    }
  }
  EXPECT_GT(closest, 0.3);
}

// f, its derivatives and their bounds, times a sign.
template <class T>
void expect_same(const KernelPair& a, const KernelPair& b, const T& s, int sign) {
  const Pair pair_a = a.view(), pair_b = b.view();
  const Frame<T> frame_a = make_frame<T>(pair_a, scale_of(pair_a));
  const Frame<T> frame_b = make_frame<T>(pair_b, scale_of(pair_b));
  const Sample<T> sample_a = evaluate(frame_a, s), sample_b = evaluate(frame_b, s);
  const T factor = T(sign);
  ASSERT_EQ(sample_a.f, sample_b.f * factor);
  ASSERT_EQ(sample_a.df, sample_b.df * factor);
  ASSERT_EQ(sample_a.ddf, sample_b.ddf * factor);
  const Estimate e_a = estimate(frame_a, s, sample_a), e_b = estimate(frame_b, s, sample_b);
  ASSERT_EQ(e_a.error_f, e_b.error_f);
  ASSERT_EQ(e_a.error_df, e_b.error_df);
  ASSERT_EQ(e_a.error_ddf, e_b.error_ddf);
  ASSERT_EQ(e_a.distance, e_b.distance);
}

template <class T>
void expect_symmetric(Kind kind) {
  Random random(function_seed + 2);
  for (int n = 0; n < 300; ++n) {
    SCOPED_TRACE(name(kind) + (", seed " + std::to_string(function_seed + 2)) + ", pair " +
                 std::to_string(n));
    const KernelPair pair = draw_kind(kind, random);
    const T s = draw_time<T>(random, kind);
    ASSERT_NO_FATAL_FAILURE(expect_same<T>(pair, exchanged(pair), s, 1));
    ASSERT_NO_FATAL_FAILURE(expect_same<T>(pair, axes_swapped(pair), s, -1));
    for (const int power : {-60, 60, 1, -300}) {
      ASSERT_NO_FATAL_FAILURE(expect_same<T>(pair, slowed(pair, power), s, 1));
    }
  }
}

TEST_P(ContactFunction, KeepsItsSymmetries) {
  expect_symmetric<double>(GetParam());
  expect_symmetric<DoubleDouble>(GetParam());
}

INSTANTIATE_TEST_SUITE_P(Pairs, ContactFunction,
                         testing::Values(Kind::thermal, Kind::parallel, Kind::aligned,
                                         Kind::fast_spin, Kind::aged, Kind::boxed, Kind::still),
                         [](const auto& info) { return std::string(name(info.param)); });

// The reference of the tests above, by differences: no formula is shared with it.
TEST(PreciseContact, DerivativesAreThoseOfTheFunction) {
  Random random(function_seed);
  for (int n = 0; n < 10; ++n) {
    const KernelPair held = draw_kind(Kind::aged, random);
    const Pair pair = held.view();
    const PairScale scale = scale_of(pair);
    const Wide s = random.uniform(0, 3), h = Wide(1e-25);
    const auto exact = precise_contact(pair, scale, s);
    const Wide before = precise_contact(pair, scale, Wide(s - h)).f;
    const Wide after = precise_contact(pair, scale, Wide(s + h)).f;
    EXPECT_LT(abs((after - before) / (2 * h) - exact.df), 1e-40);
    EXPECT_LT(abs((after - 2 * exact.f + before) / (h * h) - exact.ddf), 1e-40);
  }
}

TEST(PairScale, BringsTheRateBetweenOneAndTwo) {
  Random random(function_seed);
  for (int n = 0; n < 1000; ++n) {
    KernelPair held = draw_kind(Kind::thermal, random);
    held = slowed(held, random.below(1200) - 600);
    const Pair pair = held.view();
    const PairScale scale = scale_of(pair);
    ASSERT_TRUE(scale.moves);
    const Vec3d v = held.first.v - held.second.v;
    const double rate = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}) +
                        (held.first.omega + held.second.omega);
    ASSERT_GE(rate * scale.per_rate, 1) << "seed " << function_seed;
    ASSERT_LT(rate * scale.per_rate, 2) << "seed " << function_seed;
    ASSERT_EQ(scale.per_rate * scale.per_time, 1);
  }
}

TEST(PairScale, NeedlesThatMoveTogetherDoNotMove) {
  KernelPair held;
  held.first = test::flight({0, 0, 0}, {1, 0, 0}, {1, 2, 3}, {});
  held.second = test::flight({0.5, 0, 0}, {0, 1, 0}, {1, 2, 3}, {});
  EXPECT_FALSE(scale_of(held.view()).moves);
  held.second.w = {0, 0, 0x1p-1000};
  set_rotation(held.second);
  EXPECT_TRUE(scale_of(held.view()).moves);
}

TEST(SetRotation, FindsRateAndDirectionAtAnySize) {
  Random random(function_seed);
  for (const int power : {0, -1000, 1000, -60, 520}) {
    KernelPair held;
    held.first = test::flight({}, vec3(random.direction()), {}, vec3(random.normal_vector(1)));
    held.second = held.first;
    const Flight flight = slowed(held, power).first;
    const test::Vec<Wide> w = real<Wide>(flight.w), p = real<Wide>(flight.p);
    const test::Vec<Wide> turned = test::cross(w, real<Wide>(flight.u));
    const Wide omega = test::norm(w);
    EXPECT_LT(abs(flight.omega / omega - 1), 0x1p-51)
        << "2^" << power << ", seed " << function_seed;
    for (int i = 0; i < 3; ++i) {
      EXPECT_LT(abs(p[i] - turned[i] / omega), 0x1p-50)
          << "2^" << power << ", seed " << function_seed;
    }
  }
  Flight still = test::flight({}, {1, 2, 3}, {1, 0, 0}, {});
  EXPECT_EQ(still.omega, 0);
  EXPECT_EQ(still.p, Vec3d());
}

TEST(FreeFlight, CentreAndDirectorFollowTheLaw) {
  // A quarter turn about z in time 1, with a drift.
  const double quarter = 0x1.921fb54442d18p+0;
  const Flight turning = test::flight({1, 2, 3}, {1, 0, 0}, {0.5, 0, -1}, {0, 0, quarter});
  EXPECT_EQ(centre_after(turning, 2), (Vec3d{2, 2, 1}));
  const Vec3d u = director_after(turning, 1);
  EXPECT_NEAR(u.x, 0, 1e-16);
  EXPECT_NEAR(u.y, 1, 1e-16);
  EXPECT_EQ(u.z, 0);
  const Flight still = test::flight({1, 2, 3}, {0.6, 0, 0.8}, {0.5, 0, -1}, {});
  EXPECT_EQ(director_after(still, 1e6), still.u);
}

}  // namespace
}  // namespace needlework::kernels
