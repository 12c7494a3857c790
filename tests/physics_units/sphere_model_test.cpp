// What the model knows of spheres that have just collided.
#include <gtest/gtest.h>

#include <cmath>

#include "src/physics/needle_model.h"
#include "tests/support/kernel_pair.h"
#include "tests/support/random.h"
#include "tests/support/real.h"

namespace needlework {
namespace {

using test::Random;
using test::vec3;
using test::Wide;

constexpr std::uint64_t seed = 4711;
constexpr Needle a{0}, b{1};

Wide wide_product(const Gas& gas, const Shift& shift) {
  const kernels::Flight &first = gas.records[a].flight, &second = gas.records[b].flight;
  const auto along = [&](double r1, double r2, int axis, double v1, double v2) {
    return (Wide(r1) - r2 - Wide(shift[axis]) * gas.box.edge(axis)) * (Wide(v1) - v2);
  };
  return along(first.r.x, second.r.x, 0, first.v.x, second.v.x) +
         along(first.r.y, second.r.y, 1, first.v.y, second.v.y) +
         along(first.r.z, second.r.z, 2, first.v.z, second.v.z);
}

// Spheres of any size in contact, one perhaps at the other side of the box, with a velocity along
// their normal that rounding of places and velocities may hide.
TEST(SphereModel, LetsSpheresPartForGoodOnlyWhereTheyDo) {
  Random random(seed);
  const std::array<double, 3> edges{3, 7.3, 100.1};
  int parting = 0, at_once = 0, hidden = 0;
  for (int n = 0; n < 20000; ++n) {
    const double diameter = random.log_uniform(1e-8, 1);
    Gas gas;
    gas.resize(2);
    gas.ids = {Id{0}, Id{1}};
    gas.box = edges;
    gas.set_composition(
        Composition({{.name = "sphere", .count = 2, .length = 0, .diameter = diameter}}, {}));
    const NeedleModel<true, SphereContact> model(gas, {.width = true, .spheres = true},
                                                 standard_accuracy);
    Shift shift{};
    for (int& boxes : shift) boxes = random.below(3) - 1;
    const Vec3d normal = vec3(random.direction()), sideways = vec3(random.normal_vector(1));
    const double speed = random.log_uniform(1e-18, 1) * (random.coin() ? 1 : -1);
    const Vec3d v = (sideways - normal * dot(sideways, normal)) + normal * speed;
    const Vec3d first{random.uniform(0, 3), random.uniform(0, 7.3), random.uniform(0, 100.1)};
    const Vec3d second = first - normal * diameter - gas.box.image(shift).place;
    const Vec3d drift = vec3(random.normal_vector(1));
    gas.records[a].flight = test::flight(first, {0, 0, 1}, drift + v, {});
    gas.records[b].flight = test::flight(second, {0, 0, 1}, drift, {});
    const bool for_good = std::isinf(model.time_apart(a, b, shift));
    if (for_good) {
      ASSERT_GT(wide_product(gas, shift), 0) << "seed " << seed << ", pair " << n;
    }
    const bool clear = diameter > 1e-4 && speed > 1e-4;
    parting += clear;
    at_once += clear && for_good;
    hidden += !(wide_product(gas, shift) > 0) && speed > 0;
  }
  EXPECT_EQ(at_once, parting);
  EXPECT_GT(parting, 1000);
  EXPECT_GT(hidden, 100) << "expected pairs whose rounding changes the sign";
}

}  // namespace
}  // namespace needlework
