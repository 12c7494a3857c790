// Free flight by SIMD: the same bits as one needle at a time.
#include "kernels/free_flight.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "kernels/contact_function.h"
#include "tests/support/random.h"

namespace needlework::kernels {
namespace {

using test::Random;
using C = FlightColumns;

constexpr std::uint64_t flight_seed = 1212;
constexpr double untouched = -77;

struct FlyingNeedle {
  Flight flight;
  double elapsed;
};

/// Columns with a guard beyond the room that they have to have, at any address of a double.
class Table {
 public:
  explicit Table(const std::vector<FlyingNeedle>& needles)
      : room_((needles.size() + flights_at_once - 1) / flights_at_once * flights_at_once) {
    for (auto& column : storage_) column.assign(room_ + 1, untouched);
    for (std::size_t n = 0; n < needles.size(); ++n) {
      view().put(n, needles[n].flight, needles[n].elapsed);
    }
  }
  FlightColumns view() {
    FlightColumns out;
    for (int c = 0; c < C::columns; ++c) out.column[c] = storage_[c].data();
    return out;
  }
  bool guarded() const {
    return std::all_of(std::begin(storage_), std::end(storage_),
                       [&](const auto& column) { return column[room_] == untouched; });
  }

 private:
  std::size_t room_;
  std::vector<double> storage_[C::columns];
};

void expect_same_bits(const Vec3d& a, const Vec3d& b) {
  for (const auto component : {&Vec3d::x, &Vec3d::y, &Vec3d::z}) {
    const double x = a.*component, y = b.*component;
    if (std::isnan(x) && std::isnan(y)) continue;
    EXPECT_EQ(std::bit_cast<std::uint64_t>(x), std::bit_cast<std::uint64_t>(y)) << x << ", " << y;
  }
}

/// On every instruction set, what one needle at a time gives.
void expect_flight(const std::vector<FlyingNeedle>& needles) {
  for (const Isa isa : available()) {
    SCOPED_TRACE(std::string(name_of(isa)) + ", " + std::to_string(needles.size()) + " needles");
    Table table(needles);
    const FlightColumns flown = table.view();
    fly(isa, flown, needles.size());
    for (std::size_t n = 0; n < needles.size(); ++n) {
      const auto& [flight, elapsed] = needles[n];
      expect_same_bits(flown.centre(n), centre_after(flight, elapsed));
      expect_same_bits(flown.director(n), director_after(flight, elapsed));
      expect_same_bits(flown.at(C::v_x, n), flight.v);
      expect_same_bits(flown.at(C::p_x, n), flight.p);
    }
    EXPECT_TRUE(table.guarded());
    if (testing::Test::HasFailure()) return;
  }
}

FlyingNeedle draw_needle(Random& random) {
  const auto vector = [&](double scale) {
    const auto a = random.normal_vector(scale);
    return Vec3d{a[0], a[1], a[2]};
  };
  const auto u = random.direction();
  FlyingNeedle out;
  out.flight.r = vector(random.log_uniform(1e-3, 1e3));
  out.flight.v = vector(random.log_uniform(1e-3, 1e3));
  out.flight.u = {u[0], u[1], u[2]};
  out.flight.w = cross(out.flight.u, vector(random.log_uniform(1e-3, 1e3)));
  if (random.below(8) == 0) out.flight.w = {};
  set_rotation(out.flight);
  // Phases of up to 2^12 and, now and then, of 2^40 radians; and none.
  out.elapsed = random.below(8) == 0 ? 0 : random.log_uniform(1e-6, random.coin() ? 4 : 1e9);
  return out;
}

TEST(Fly, GivesTheBitsOfOneNeedleAtATime) {
  Random random(flight_seed);
  for (std::size_t count = 0; count <= 40; ++count) {
    for (int n = 0; n < 50; ++n) {
      std::vector<FlyingNeedle> needles;
      while (needles.size() < count) needles.push_back(draw_needle(random));
      expect_flight(needles);
      ASSERT_FALSE(HasFailure()) << "seed " << flight_seed;
    }
  }
}

TEST(Fly, GivesTheSameBitsOfAnyNumbers) {
  Random random(flight_seed + 1);
  const auto any = [&] {
    switch (random.below(6)) {
      case 0:
        return std::bit_cast<double>(random.bits());
      case 1:
        return random.coin() ? 0.0 : -0.0;
      case 2:
        return std::numeric_limits<double>::infinity();
      default:
        return random.normal() * std::ldexp(1.0, random.below(200) - 100);
    }
  };
  for (int n = 0; n < 3000; ++n) {
    std::vector<FlyingNeedle> needles(1 + random.below(20));
    for (auto& [flight, elapsed] : needles) {
      flight.r = {any(), any(), any()};
      flight.v = {any(), any(), any()};
      flight.u = {any(), any(), any()};
      flight.p = {any(), any(), any()};
      flight.omega = any();
      elapsed = any();
    }
    expect_flight(needles);
    ASSERT_FALSE(HasFailure()) << n << ", seed " << flight_seed + 1;
  }
}

}  // namespace
}  // namespace needlework::kernels
