// Needles that never collide: all commands say so, and no run goes on for ever.
#include "needlework/h5md.h"
#include "needlework/initial_state.h"
#include "tests/cli/program.h"

namespace needlework {
namespace {

using NeverColliding = ProgramTest;

// engine/collisionless_test.cpp has which states these are, and the words about them.
TEST_F(NeverColliding, StatesAreNamedAndNeedALimitOnTime_long) {
  Scene scene;
  scene.needles.count = 500;
  scene.needles.box = {8, 8, 8};
  State parallel = draw_initial_state(scene);
  parallel.orientation.assign(500, {0, 0, 1});
  parallel.angular_velocity.assign(500, {});
  parallel.id.clear();
  io::Writer writer(path("state.h5"), true, scene, {.isa = "scalar", .epoch_length = 1});
  writer.write_frame({}, parallel);
  writer.close();
  write("gas.toml", "initial.file = 'state.h5'\nuntil.collisions_per_needle = 10\n");
  const std::string why = "all needles are parallel and do not rotate";
  for (const std::string command : {"check", "run", "audit"}) {
    const Outcome refused = run(command + " gas.toml");
    EXPECT_EQ(refused.exit_code, 3) << command;
    EXPECT_TRUE(contains(refused.err, "nothing can ever happen, as " + why));
  }
  for (const std::string command : {"check", "run --quiet", "audit --quiet"}) {
    const Outcome warned =
        run(command + " gas.toml --set until.collisions_per_needle=none --set until.time=0.1");
    EXPECT_EQ(warned.exit_code, 0) << warned.err;
    EXPECT_TRUE(contains(warned.err, why + ": nothing collides"));
  }
}

}  // namespace
}  // namespace needlework
