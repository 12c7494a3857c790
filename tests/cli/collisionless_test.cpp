// Needles that never collide: all commands say so, and no run goes on for ever.
#include "needlework/h5md.h"
#include "needlework/initial_state.h"
#include "tests/cli/program.h"

namespace needlework {
namespace {

class NeverColliding : public ProgramTest {
 protected:
  void write_state(const State& state, const Scene& scene) const {
    io::Writer writer(path("state.h5"), true, scene, {.isa = "scalar", .epoch_length = 1});
    writer.write_frame({}, state);
    writer.close();
  }
};

TEST_F(NeverColliding, StatesAreNamedAndNeedALimitOnTime_long) {
  Scene scene;
  scene.needles.count = 500;
  scene.needles.box = {8, 8, 8};
  State flat = draw_initial_state(scene);
  flat.id.resize(flat.size());
  for (std::size_t i = 0; i < flat.size(); ++i) {
    flat.id[i] = static_cast<std::uint32_t>(i);
    flat.position[i][2] = 1;
    flat.velocity[i][2] = 0;
    flat.orientation[i] = i % 2 == 0 ? std::array{1.0, 0.0, 0.0} : std::array{0.6, 0.8, 0.0};
    flat.angular_velocity[i] = {0, 0, 1.5};
  }
  State parallel = flat;
  for (std::size_t i = 0; i < flat.size(); ++i) {
    parallel.position[i][2] = 0.01 * static_cast<double>(i);
    parallel.velocity[i][2] = 0.3;
    parallel.velocity[i][1] = 0.01 * static_cast<double>(i);
    parallel.orientation[i] = {0, 0, 1};
    parallel.angular_velocity[i] = {};
  }
  write("gas.toml", "initial.file = 'state.h5'\nuntil.collisions_per_needle = 10\n");
  for (const auto& [state, why] :
       {std::pair(flat, "all needles lie and move in planes normal to the z axis"),
        std::pair(parallel, "all needles are parallel and do not rotate")}) {
    write_state(state, scene);
    for (const std::string command : {"check", "run", "audit"}) {
      const Outcome refused = run(command + " gas.toml");
      EXPECT_EQ(refused.exit_code, 3) << command;
      EXPECT_TRUE(contains(refused.err, std::string("nothing can ever happen, as ") + why));
    }
    const std::string with_time =
        " gas.toml --set until.collisions_per_needle=none --set until.time=0.1";
    for (const std::string command : {"check", "run --quiet", "audit --quiet"}) {
      const Outcome warned = run(command + with_time);
      EXPECT_EQ(warned.exit_code, 0) << warned.err;
      EXPECT_TRUE(contains(warned.err, std::string(why) + ": nothing collides"));
    }
  }
}

}  // namespace
}  // namespace needlework
