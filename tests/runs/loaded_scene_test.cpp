// Scenes made ready to run.
#include "src/runs/loaded_scene.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <utility>

#include "needlework/error.h"
#include "needlework/h5md.h"
#include "needlework/initial_state.h"
#include "needlework/parse.h"
#include "src/runs/engine_choice.h"
#include "src/runs/state_file.h"
#include "tests/support/contains.h"
#include "tests/support/message_of.h"
#include "tests/support/runs.h"
#include "tests/support/temporary_folder.h"

namespace needlework::runs {
namespace {

TEST(LoadedScene, HasThreadsForItsNeedlesWhereTheyAreChosen) {
  const auto threads = [](std::uint64_t needles, const std::string& calendar) {
    Scene scene = test::scene_of(needles, 3);
    scene.engine.threads_by_size = true;
    scene.engine.queue = calendar;
    return complete_scene(scene).scene.engine.threads;
  };
  const int most = std::min(cores(), omp_get_max_threads());
  EXPECT_EQ(threads(100, "auto"), 1);
  EXPECT_EQ(threads(9000, "auto"), std::min(2, most));
  EXPECT_EQ(threads(4000000, "auto"), most);
  EXPECT_EQ(threads(9000, "tournament"), 1);
}

TEST(LoadedScene, ReadsTheInitialStateWhoseCountAndBoxTheSceneMayGive) {
  const test::TemporaryFolder folder;
  const std::string file = (folder.path() / "start.h5").string();
  const Scene drawn = test::scene_of(3, 3);
  const State state = draw_initial_state(drawn);
  io::Writer writer(file, true, drawn, {});
  writer.write_frame({}, state);
  writer.close();

  const auto load = [&](std::uint64_t count, std::array<double, 3> box) {
    Scene scene;
    scene.initial.file = file;
    scene.needles.count = count;
    scene.needles.box = box;
    return complete_scene(scene);
  };
  EXPECT_EQ(load(0, {}).initial->position, state.position);
  EXPECT_EQ(load(0, {}).scene.needles.count, 3u);
  EXPECT_EQ(load(3, {3, 3, 3}).initial->velocity, state.velocity);
  EXPECT_EQ(load(3, {3, 3, 3 - 1e-14}).initial->box, state.box);
  const auto refused = [&](std::uint64_t count, std::array<double, 3> box, const char* message) {
    EXPECT_EQ(test::message_of<InputError>([&] { load(count, box); }), message + file);
  };
  refused(2, {}, "needles.count = 2: expected 3, as in ");
  refused(0, {3, 3, 4}, "needles.box = [3, 3, 4]: expected [3, 3, 3], as in ");
  refused(0, {0, 3, 3}, "needles.box = [0, 3, 3]: expected [3, 3, 3], as in ");
}

// On the way through a file, which a scene without a word of its bodies starts from.
TEST(LoadedScene, HasTheBodiesOfTheFile) {
  const test::TemporaryFolder folder;
  const std::string file = (folder.path() / "rods.h5").string();
  const std::string text = "initial.file = \"" + file + "\"\nuntil.time = 1\n";
  const LoadedScene drawn = complete_scene(parse_scene(
      "needles.box = 9\nuntil.time = 1\n[[species]]\nname = \"rod\"\ncount = 4\nlength = 2\n"
      "mass = 4\nk = 2\ndiameter = 0.5\n[[species]]\nname = \"ball\"\ncount = 3\nlength = 0\n"
      "diameter = 1\n",
      "drawn.toml"));
  const Simulation simulation(drawn.scene);
  write_state(simulation, drawn.scene, {}, file, false);

  const LoadedScene again = complete_scene(parse_scene(text, "again.toml"));
  EXPECT_EQ(warning_of_state(again), "");
  const Simulation continued(again.scene, *again.initial);
  EXPECT_EQ(continued.totals().t_rot, simulation.totals().t_rot);
  EXPECT_EQ(continued.totals().energy, simulation.totals().energy);
  EXPECT_EQ(again.scene.species[1].name, "ball");
  EXPECT_THROW(complete_scene(parse_scene(text + "needles.k = 6", "other.toml")), InputError);
  // Nor can a program in C++ take it for one of needles.
  Scene needles = test::scene_of(7, 9);
  EXPECT_THROW(Simulation(needles, *again.initial), InputError);
}

TEST(LoadedScene, WarnsOfAFileThatDoesNotSayItsBodies) {
  const test::TemporaryFolder folder;
  const std::string file = (folder.path() / "start.h5").string();
  const Scene drawn = test::scene_of(3, 3);
  io::RunInfo info;
  info.assumed = {"length", "k"};
  io::Writer writer(file, true, drawn, info);
  writer.write_frame({}, draw_initial_state(drawn));
  writer.close();
  const std::string text = "initial.file = \"" + file + "\"\nuntil.time = 1\n";
  const LoadedScene loaded = complete_scene(parse_scene(text, "s.toml"));
  const std::string warning = warning_of_state(loaded);
  EXPECT_TRUE(test::contains(warning, ": says no length, no diameter, no k of its bodies"));
  // What was assumed may be said otherwise.
  const Scene other = complete_scene(parse_scene(text + "needles.k = 2", "s.toml")).scene;
  EXPECT_EQ(other.composition()[0].k, 2);
}

TEST(LoadedScene, WarnsOfAStateThatDriftsInAFlow) {
  Scene scene = test::scene_of(50, 5);
  const State state = draw_initial_state(scene);  // velocities of a gas that does not flow
  EXPECT_EQ(warning_of_state(complete_scene(scene, state)), "");
  scene.shear = Scene::Shear{.rate = 1, .offset = 0};
  EXPECT_TRUE(test::contains(warning_of_state(complete_scene(scene, state)),
                             "the state: says no flow, so its velocities are taken to have"));
  State beside = state;
  beside.peculiar_velocity = std::exchange(beside.velocity, {});
  EXPECT_EQ(warning_of_state(complete_scene(scene, beside)), "");
  scene.shear->rate = 0;
  EXPECT_EQ(warning_of_state(complete_scene(scene, state)), "");
}

TEST(LoadedScene, HasAnEngineThatIsOnOffer) {
  const LoadedScene loaded = complete_scene(test::scene_of(3, 3));
  EXPECT_FALSE(loaded.initial);
  EXPECT_GE(loaded.scene.engine.threads.value(), 1);
  EXPECT_EQ(resolved_isa(loaded.scene.engine), instruction_sets().back());
  Scene scene = test::scene_of(3, 3);
  scene.engine.isa = "bogus";
  EXPECT_THROW(complete_scene(scene), InputError);
}

TEST(LoadedScene, WarnsOfContactTimesByTheVelocitiesThatThereAre) {
  Scene scene = test::scene_of(50, 5);
  scene.collisions.epsilon = 0.9;
  State state = draw_initial_state(scene);
  const auto is_warned_of = [&](double tc, const State* given) {
    scene.collisions.tc = tc;
    const LoadedScene loaded = given ? complete_scene(scene, *given) : complete_scene(scene);
    const std::vector<std::string> all = all_warnings(loaded);
    return !all.empty() && all.back().find(" mean free times at the start: ") != std::string::npos;
  };
  EXPECT_FALSE(is_warned_of(0.05, nullptr));
  EXPECT_TRUE(is_warned_of(1, nullptr));
  EXPECT_TRUE(is_warned_of(1, &state));
  for (auto part : {&State::velocity, &State::angular_velocity}) {
    for (auto& row : state.*part) row = {1e-4 * row[0], 1e-4 * row[1], 1e-4 * row[2]};
  }
  EXPECT_FALSE(is_warned_of(1, &state));
  EXPECT_TRUE(is_warned_of(1e4, &state));
}

TEST(LoadedScene, WarnsOfMoreThreadsThanCoresInWordsThatFitTheTeam) {
  Scene scene = test::scene_of(3, 3);
  const auto all_warnings = [](const Scene& given) {
    return runs::all_warnings({.scene = given, .initial = {}});
  };
  scene.engine.threads = cores();
  EXPECT_TRUE(all_warnings(scene).empty());
  scene.engine.threads = cores() + 1;
  const std::string beginning = fmt::format(
      "engine.threads = {}: expected at most {}, the number of cores here: threads "
      "beyond these ",
      cores() + 1, cores());
  EXPECT_EQ(all_warnings(scene).back(), beginning + "are not used");
  scene.engine.team = "all";
  EXPECT_EQ(all_warnings(scene).back(), beginning + "make a run slower");
}

}  // namespace
}  // namespace needlework::runs
