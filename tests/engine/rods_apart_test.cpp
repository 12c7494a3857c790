// Rods never overlap by more than 1e-13 of their diameter, and an overlap is found and reported.
#include "src/engine/rods_apart.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "needlework/error.h"
#include "needlework/initial_state.h"
#include "src/engine/initial_gas.h"
#include "src/engine/make_loop.h"
#include "src/engine/run.h"
#include "tests/support/by_build.h"
#include "tests/support/rods.h"
#include "tests/support/runs.h"
#include "tests/support/scenes.h"

namespace needlework {
namespace {

using test::rods_and_spheres;
using test::rods_of;

constexpr int instants = test::by_build(100, 10);

TEST(RodsApart, NoOverlapIsDeeperThanRoundingExplains) {
  std::vector<Scene> scenes = {rods_of(100, 0, 0.45),   rods_of(100, 1, 0.3),
                               rods_of(130, 5, 0.25),   rods_of(50, 100, 4e-4),
                               rods_and_spheres(40, 9), rods_of(20, 0, 1e-5)};
  scenes.emplace_back(test::inelastic(rods_of(100, 5, 0.2), 0.5, 1e-4));
  Scene& walled = scenes.emplace_back(rods_of(60, 2, 0.05));
  walled.walls = {{.axis = "z", .side = "both", .epsilon = 0.9}};
  walled.forces.gravity = {0, 0, -1};
  for (const Scene& scene : scenes) {
    needlework::Run run(scene, make_gas(scene, draw_initial_state(scene)));
    const auto loop = make_loop(run, {.search = "linked-cells", .calendar = "tournament"});
    for (int n = 1; n <= instants; ++n) {
      ASSERT_EQ(loop->advance(StopConditions(run, test::until_collisions(0.5 * n))),
                Stop::collisions);
      const double most = explained_overlap(run.gas, run.now);
      // The dilute ones fly thousands of diameters, in the unit of the clock a share of that.
      EXPECT_LT(most, scene.species[0].count == 20 ? 2e-11 : 1e-12);
      EXPECT_NO_THROW(require_rods_apart(run.gas, run.now, kernels::Isa::scalar, most));
    }
  }
}

kernels::Flight& flight_of(Gas& gas, std::uint32_t id) {
  Needle i{0};
  while (gas.ids[i].value != id) ++i;
  return gas.records[i].flight;
}

// Puts rod 1 onto rod 0, crosswise, their axes 0.9312 apart.
void plant_overlap(Gas& gas) {
  kernels::Flight &first = flight_of(gas, 0), &second = flight_of(gas, 1);
  first.u = {1, 0, 0};
  second.u = {0, 1, 0};
  first.w = second.w = {};
  set_rotation(first);
  set_rotation(second);
  second.r = first.r + Vec3d{0, 0, 0.9312};
}

TEST(RodsApart, AnOverlapIsFoundAndNamed) {
  const Scene scene = rods_of(10, 5, 0.001);
  needlework::Run run(scene, make_gas(scene, draw_initial_state(scene)));
  plant_overlap(run.gas);
  const auto found = find_overlap(run.gas, run.now, kernels::Isa::scalar, 1e-13);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->first, 0u);
  EXPECT_EQ(found->second, 1u);
  EXPECT_NEAR(found->depth, 0.0688, 1e-12);
  EXPECT_FALSE(find_overlap(run.gas, run.now, kernels::Isa::scalar, 0.0689));
  try {
    require_rods_apart(run.gas, run.now, kernels::Isa::scalar, 1e-13);
    FAIL();
  } catch (const InvalidStateError& error) {
    EXPECT_EQ(std::string(error.what()),
              "rods 0 and 1 overlap by 0.0688 at time 0, expected at most 1e-13: a contact was "
              "missed; this is a defect of the program");
  }
  // As small as the limit.
  flight_of(run.gas, 1).r = flight_of(run.gas, 0).r + Vec3d{0, 0, 1 - 5e-13};
  EXPECT_TRUE(
      find_overlap(run.gas, run.now, kernels::Isa::scalar, explained_overlap(run.gas, run.now)));
  EXPECT_FALSE(find_overlap(run.gas, run.now, kernels::Isa::scalar, 1e-12));
}

// In every build: whoever predicts the pair sees it.
TEST(RodsApart, AnOverlapEndsTheRun) {
  for (const char* search : {"all-pairs", "linked-lists", "linked-cells", "capsules"}) {
    const Scene scene = rods_of(10, 5, 0.001);
    needlework::Run run(scene, make_gas(scene, draw_initial_state(scene)));
    plant_overlap(run.gas);
    const auto loop = make_loop(run, {.search = search, .calendar = "tournament"});
    try {
      loop->advance(StopConditions(run, test::until_collisions(1)));
      ADD_FAILURE() << search;
    } catch (const UnfinishedEventError& error) {
      EXPECT_EQ(std::string(error.what()).substr(0, 37), "rods 0 and 1 overlap by 0.0688 at tim");
    }
  }
}

}  // namespace
}  // namespace needlework
