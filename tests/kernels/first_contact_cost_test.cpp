// The search for the first contact ends soon for every pair.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "kernels/first_contact.h"
#include "tests/kernels/planar_pair.h"
#include "tests/support/by_build.h"
#include "tests/support/kernel_pair.h"
#include "tests/support/pair_families.h"
#include "tests/support/random.h"

namespace needlework::kernels {
namespace {

using test::flight;
using test::KernelPair;
using test::nearly_planar;
using test::Random;
using test::vec3;

constexpr std::uint64_t cost_seed = 606;
constexpr int cost_thin = test::by_build(1, 10);

/// Evaluations that a search may take on top of `per_interval` for each half unit of scaled time
/// that it covers, for any degenerate pair.
constexpr double most = 3000;
constexpr double per_interval = 8;

// Evaluations in both precisions, and what they may be.
struct Cost {
  double spent, allowed;
  Contact contact;
};

Cost cost(const KernelPair& pair, double until) {
  EvaluationCounters counters;
  Cost out;
  out.contact = first_contact(pair.view(), 0, until, counters);
  out.spent = static_cast<double>(counters.evaluated + counters.escalated);
  const Vec3d v = pair.first.v - pair.second.v;
  // Centres stay within reach of each other for 2 / |v|.
  const double meeting = dot(v, v) > 0 ? 2 / std::sqrt(dot(v, v)) : until;
  const double scaled = scale_of(pair.view()).per_time * std::min(until, meeting);
  out.allowed = most + per_interval * 2 * scaled;
  return out;
}

double expect_soon(const KernelPair& pair, double until) {
  const Cost c = cost(pair, until);
  EXPECT_LT(c.spent, c.allowed) << "seed " << cost_seed;
  return c.spent;
}

TEST(FirstContactCost, IsSmallForAllFamiliesOfPairs) {
  for (const test::PairFamily& family : test::pair_families()) {
    double worst = 0, sum = 0;
    const auto pairs = test::draw_pairs(family.name, 2000 / cost_thin, cost_seed);
    for (const test::NeedlePair& pair : pairs) {
      const KernelPair held = test::kernel_pair(pair);
      const double spent = cost(held, pair.horizon).spent;
      // Needles of one plane that turn together: f'' is small, and its bound is not.
      if (held.first.omega != held.second.omega) expect_soon(held, pair.horizon);
      worst = std::max(worst, spent);
      sum += spent;
    }
    std::printf("%-14s mean %.1f, most %.0f\n", std::string(family.name).c_str(),
                sum / static_cast<double>(pairs.size()), worst);
    if (family.thermal) {
      EXPECT_LT(sum, 25 * static_cast<double>(pairs.size()));
    }
  }
}

TEST(FirstContactCost, IsBoundedForNeedlesCloseToOnePlane) {
  Random random(cost_seed);
  double worst = 0;
  for (const double tilt : {1e-3, 1e-6, 1e-9, 1e-13, 1e-17, 1e-20}) {
    for (int n = 0; n < 500 / cost_thin; ++n) {
      worst = std::max(worst, expect_soon(nearly_planar(random, tilt, 0.3), 20));
    }
  }
  std::printf("most %.0f\n", worst);
}

TEST(FirstContactCost, IsBoundedForNeedlesInOnePlane) {
  Random random(cost_seed);
  for (int n = 0; n < 500 / cost_thin; ++n) {
    EXPECT_FALSE(cost(nearly_planar(random, 0, 0.3), 20).contact.found);
    EXPECT_LT(cost(nearly_planar(random, 0, 0.3), 1e6).spent, 200);
  }
}

TEST(FirstContactCost, IsBoundedForALongLife) {
  Random random(cost_seed);
  for (int n = 0; n < 100 / cost_thin; ++n) {
    KernelPair pair = nearly_planar(random, 1, 1);
    for (Flight* needle : {&pair.first, &pair.second}) {
      needle->w = needle->w * 1e6;
      set_rotation(*needle);
    }
    // A record lives for 2^10 radians.
    expect_soon(pair, 0x1p10 / std::max(pair.first.omega, pair.second.omega));
    pair.first.v = pair.second.v;
    expect_soon(pair, 0x1p10 / std::max(pair.first.omega, pair.second.omega));
  }
}

TEST(FirstContactCost, DoesNotGrowWithTheHorizonOncePastEachOther) {
  Random random(cost_seed);
  for (int n = 0; n < 300 / cost_thin; ++n) {
    const KernelPair pair = nearly_planar(random, 1, 1);
    EXPECT_EQ(cost(pair, 1e6).spent, cost(pair, 1e300).spent) << "seed " << cost_seed << ", " << n;
  }
}

// f, f' and f'' vanish together at s = 0, or close to it: f = (c + vx t) sin wt + (h + vz t) cos wt
// with vz = -c w, vx = 0.
KernelPair triple_root(double h, double vx, double spin) {
  KernelPair pair;
  pair.first = flight({0.25, 0, h}, {1, 0, 0}, {vx, 0, -0.125}, {0, 0.5, 0});
  pair.second = flight({0, 0, 0}, {0, 1, 0}, {}, {0, 0, spin});
  return pair;
}

TEST(FirstContactCost, IsBoundedAtTripleRoots) {
  for (const double off : {0.0, 1e-3, 1e-8, 1e-16, 1e-24, 1e-40, 0x1p-1000}) {
    for (const double h : {off, -off, off * off * off}) {
      for (const double vx : {off, -off, off * off}) {
        for (const double spin : {0.0, off}) {
          KernelPair pair = triple_root(h, vx, spin);
          expect_soon(pair, 4);
          // The same with the root in the midst of intervals.
          pair.first.r = centre_after(pair.first, -1.1);
          pair.first.u = director_after(pair.first, -1.1);
          set_rotation(pair.first);
          expect_soon(pair, 4);
          pair.first = triple_root(h, vx, spin).first;
          pair.elapsed_second = 3;
          expect_soon(pair, 4);
        }
      }
    }
  }
}

// A pair on a contact; what is left of its impulse and of its bend are powers of ten.
TEST(FirstContactCost, IsBoundedAfterCollisionsOfAnyStrength) {
  Random random(cost_seed);
  for (int n = 0; n < 3000 / cost_thin; ++n) {
    const double spin = random.coin() ? random.log_uniform(1e-20, 1) : 0;
    KernelPair pair;
    pair.first = flight({random.uniform(-0.4, 0.4), 0, 0}, {1, 0, 0},
                        {random.normal(), random.normal(), random.log_uniform(1e-30, 1)},
                        vec3(random.normal_vector(spin)));
    pair.second = flight({0, random.uniform(-0.4, 0.4), 0}, {0, 1, 0}, {},
                         vec3(random.normal_vector(random.coin() ? spin : 1)));
    pair.touch = {.touching = true, .collided = true, .side = 1, .gap = 0};
    expect_soon(pair, 10);
    pair.touch = {
        .touching = true, .collided = false, .side = 1, .gap = random.log_uniform(1e-40, 1e-13)};
    expect_soon(pair, 10);
  }
}

TEST(FirstContactCost, IsBoundedForParallelNeedlesThatDoNotTurn) {
  Random random(cost_seed);
  for (int n = 0; n < 300 / cost_thin; ++n) {
    KernelPair pair;
    const Vec3d u = vec3(random.direction());
    pair.first = flight(vec3(random.normal_vector(0.3)), u, vec3(random.normal_vector(1)), {});
    const Vec3d tilt = vec3(random.direction()) * std::ldexp(1.0, -n);
    pair.second = flight(vec3(random.normal_vector(0.3)), n % 2 ? u : u + tilt, {}, {});
    EXPECT_LT(cost(pair, 100).spent, 200) << n;
  }
}

}  // namespace
}  // namespace needlework::kernels
