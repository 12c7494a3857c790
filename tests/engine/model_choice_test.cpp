// The model that simulates a scene has every effect of the scene, whoever has checked the scene.
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

#include "needlework/initial_state.h"
#include "src/engine/initial_gas.h"
#include "src/engine/loops/with_model.h"
#include "src/engine/run.h"
#include "tests/support/runs.h"

namespace needlework {
namespace {

std::string model_of(const Effects& effects) {
  try {
    return with_model(effects, []<class M>() -> std::string {
      EXPECT_TRUE(M::has_effects || !M::has_sliding);
      return !M::Law::has_axes      ? "spheres"
             : M::Law::mixes        ? "mixed"
             : M::Law::has_distance ? "rods"
             : M::has_sliding       ? "sliding"
             : M::has_effects       ? "any"
                                    : "plain";
    });
  } catch (const std::logic_error&) {
    return "none";
  }
}

TEST(ModelChoice, LeavesNoEffectOut) {
  EXPECT_EQ(model_of({}), "plain");
  bool Effects::*const all[] = {&Effects::rough,   &Effects::contact_time, &Effects::table,
                                &Effects::passing, &Effects::width,        &Effects::spheres,
                                &Effects::mixed,   &Effects::sliding,      &Effects::sources,
                                &Effects::kicks,   &Effects::gravity,      &Effects::shear,
                                &Effects::stress,  &Effects::growth};
  static_assert(sizeof(Effects) == sizeof all / sizeof all[0], "an effect is missing above");
  for (unsigned set = 1; set < 1u << std::size(all); ++set) {
    Effects effects;
    for (std::size_t n = 0; n < std::size(all); ++n) effects.*all[n] = (set >> n & 1u) != 0;
    const bool impossible =
        ((effects.spheres || effects.mixed) && !effects.width) ||
        (effects.spheres && effects.mixed) || (effects.width && effects.sliding) ||
        (effects.growth && !effects.width) ||
        (effects.sliding &&
         (effects.rough || effects.contact_time || effects.shear || effects.stress));
    const std::string expected = impossible        ? "none"
                                 : effects.spheres ? "spheres"
                                 : effects.mixed   ? "mixed"
                                 : effects.width   ? "rods"
                                 : effects.sliding ? "sliding"
                                                   : "any";
    EXPECT_EQ(model_of(effects), expected) << set;
  }
}

// No valid scene is like this: gravity is allowed beside walls alone.
TEST(ModelChoice, HasGravityWithoutWalls) {
  Scene scene = test::scene_of(20, 5);
  const State state = draw_initial_state(scene);
  scene.forces.gravity = {0, 0, -1};
  const needlework::Run run(scene, make_gas(scene, state));
  EXPECT_TRUE(run.gas.falls);
  EXPECT_EQ(model_of(run.effects), "any");
}

}  // namespace
}  // namespace needlework
