#include "tests/engine/effect_scenes.h"

#include <algorithm>
#include <type_traits>

#include "tests/support/rods.h"
#include "tests/support/scenes.h"
#include "tests/support/wall.h"

namespace needlework::test {
namespace {

Scene cooling(std::uint64_t count, double side) { return inelastic(scene_of(count, side, 3), 0.8); }

// Rough inelastic needles of three species, whose lengths differ by a factor of five.
Scene mixture() {
  Scene scene = inelastic(scene_of(0, 7, 21), 0.9);
  scene.species = {{.name = "short", .count = 150, .length = 0.6, .mass = 0.5, .k = 4},
                   {.name = "long", .count = 12, .length = 3, .mass = 7, .k = 6, .t_tr = 0.3},
                   {.name = "middle", .count = 60, .length = 1, .mass = 1, .k = 2, .t_rot = 2}};
  scene.pairs = {{.between = {"short", "long"}, .epsilon = 0.6, .beta = 0.2},
                 {.between = {"middle", "middle"}, .epsilon = 1, .beta = {}}};
  return scene;
}

Scene two_lengths(double side) {
  Scene scene = cooling(0, side);
  scene.species = {{.name = "short", .count = 120, .length = 0.7, .mass = 0.3, .k = 3},
                   {.name = "long", .count = 40, .length = 1.8, .mass = 4}};
  return scene;
}

// All effects of needles together, but for the thermostat, which knows no gravity, and sliding.
Scene shaken() {
  Scene scene = two_lengths(5);
  scene.collisions.beta = 0.2;
  scene.forces.gravity = {0.4, 0, -2};
  scene.driving.kicks = {.every = 0.07, .translational = 0.5, .rotational = 1};
  scene.walls = {{.axis = "z", .side = "low", .epsilon = 0.9},
                 {.axis = "x", .side = "high", .temperature = 1.5},
                 {.axis = "x", .side = "low", .epsilon = 0.7}};
  scene.walls[0].motion = {.amplitude = 0.1, .frequency = 2, .phase = 1};
  return scene;
}

// Above a thermal wall, with gravity along periodic axes: needles cross the box ever faster, and
// its border in all cells.
Scene chute() {
  Scene scene = two_lengths(5);
  scene.walls = {{.axis = "z", .side = "low", .temperature = 1}};
  scene.forces.gravity = {3, -0.7, -1};
  return scene;
}

Scene kicked(double every, double translational, double rotational) {
  Scene scene = cooling(160, 5);
  scene.driving.kicks = {.every = every, .translational = translational, .rotational = rotational};
  return scene;
}

Scene thermostat(double rate, double temperature) {
  Scene scene = cooling(160, 5);
  scene.driving.andersen = {.rate = rate, .temperature = temperature};
  return scene;
}

Scene sliding(std::uint64_t count, double side, double epsilon) {
  Scene scene = scene_of(count, side, 3);
  scene.collisions.epsilon = epsilon;
  scene.collisions.sliding = true;
  return scene;
}

Scene sliding_mixture(Scene scene) {
  scene.needles.count = 0;
  scene.species = {{.name = "long", .count = 40, .length = 1.5, .mass = 2.5, .k = 3},
                   {.name = "short", .count = 80, .length = 0.4, .mass = 0.3, .t_rot = 2}};
  scene.pairs = {{.between = {"long", "short"}, .epsilon = 0.3, .beta = {}}};
  return scene;
}

Scene sliding_between(const Scene::Wall& low, const Scene::Wall& high) {
  Scene scene = sliding(50, 3, 0.2);
  scene.walls = {low, high};
  for (Scene::Wall& wall : scene.walls) wall.axis = "z";
  scene.walls[0].side = "low";
  scene.walls[1].side = "high";
  scene.forces.gravity = {0, 0, -2};
  return scene;
}

// Rods between walls under gravity, and rods and spheres whose walls and thermostat drive them.
Scene falling_rods() {
  Scene scene = inelastic(rods_of(60, 2, 0.05), 0.95, 0);
  scene.walls = {{.axis = "x", .side = "both"}, {.axis = "z", .side = "low", .epsilon = 0.9}};
  scene.forces.gravity = {0, 0, -1};
  scene.collisions.tc = 1e-4;
  return scene;
}

Scene driven_rods() {
  Scene scene = scene_of(0, 8);
  scene.species = {
      {.name = "balls", .count = 20, .length = 0, .mass = 2, .t_rot = 0, .diameter = 1.2},
      {.name = "rods", .count = 20, .length = 2, .diameter = 0.8}};
  scene.walls = {{.axis = "z", .side = "low"}, {.axis = "z", .side = "high", .temperature = 2}};
  scene.walls[0].motion = Scene::WallMotion{.amplitude = 0.1, .frequency = 0.5};
  scene.driving.andersen = {.rate = 0.5, .temperature = 1.5};
  scene.driving.kicks = {.every = 0.5, .translational = 0.1, .rotational = 0.2};
  return scene;
}

// Between walls that close in, of which one soon stops.
Scene pistons() {
  Scene scene = cooling(120, 5);
  scene.needles.box[2] = 8;
  scene.walls = {piston("z", "low", 0.5, 0.25, 0.9), piston("z", "high", -0.8)};
  scene.forces.gravity = {0, 0, -1};
  return scene;
}

// Cooled now and then.
Scene growing(Scene scene, double rate) {
  scene.driving = {};
  scene.driving.growth = Scene::Growth{};
  Scene::Growth& growth = *scene.driving.growth;
  growth.rate = rate;
  growth.until_packing = 0.6;
  growth.cool_every = 2;
  return scene;
}

// Beside walls that leave it, one of them faster than needles follow until it stops.
Scene released() {
  Scene scene = mixture();
  scene.walls = {piston("y", "low", -0.1, {}, 0.8), piston("y", "high", 6, 10.0)};
  return scene;
}

Scene pressed_rods() {
  Scene scene = rods_and_spheres(50, 8, 3);
  scene.needles.box[2] = 14;
  scene.walls = {piston("z", "both", -0.7), piston("x", "low", 1.5), wall("x", "high", 0.9)};
  return scene;
}

Scene belts() {
  Scene scene = two_lengths(5);
  scene.walls = {belt("z", "low", 1, 2, -0.5), belt("z", "high", 0.5, -1, 0)};
  scene.forces.gravity = {0.8, -0.3, -0.5};
  return scene;
}

Scene sheared(Scene scene, double rate, double offset) {
  scene.shear = Scene::Shear{.rate = rate, .offset = offset};
  return scene;
}

Distribution lognormal(double mean, double width) {
  return {.shape = Distribution::Shape::lognormal, .mean = mean, .width = width};
}

// Needles that differ, among others that do not, with rough collisions and a thermostat.
Scene sizes() {
  Scene scene = two_lengths(6);
  scene.collisions.beta = 0.3;
  scene.species[0].drawn.length = lognormal(0.7, 0.6);
  scene.species[0].drawn.density = 0.4;
  scene.species.push_back({.name = "few", .count = 30});
  scene.species[2].drawn.length = {
      .shape = Distribution::Shape::powerlaw, .least = 0.1, .greatest = 2.5, .exponent = 2};
  scene.species[2].drawn.k = {.shape = Distribution::Shape::uniform, .mean = 5, .width = 0.3};
  scene.driving.andersen = {.rate = 0.3, .temperature = 1};
  return scene;
}

Scene sizes_of_rods() {
  Scene scene = scene_of(0, 8);
  scene.species = {{.name = "rods", .count = 60}, {.name = "balls", .count = 40, .length = 0}};
  scene.species[0].drawn.length = lognormal(1, 0.3);
  scene.species[0].drawn.aspect = 4;
  scene.species[0].drawn.density = 5;
  scene.species[1].drawn.diameter = lognormal(0.8, 0.4);
  scene.walls = {{.axis = "z", .side = "low"}, {.axis = "z", .side = "high", .temperature = 2}};
  scene.driving.kicks = {.every = 0.5, .translational = 0.1, .rotational = 0.2};
  return scene;
}

Scene sizes_of_spheres() {
  Scene scene = scene_of(0, 8);
  scene.species = {{.name = "balls", .count = 300, .length = 0}};
  scene.species[0].drawn.diameter = lognormal(0.9, 0.2);
  scene.species[0].drawn.density = 2;
  scene.collisions.epsilon = 0.9;
  scene.collisions.tc = 1e-4;
  return scene;
}

// Rough spheres of two kinds, one of them of many sizes, which are smooth to each other.
Scene rough_spheres(double edge) {
  Scene scene = scene_of(0, edge);
  scene.species = {
      {.name = "hollow", .count = 60, .length = 0, .mass = 2, .t_rot = 3, .diameter = 1.2},
      {.name = "solid", .count = 90, .length = 0}};
  scene.species[0].given_inertia = 2 * 1.2 * 1.2 / 6;
  scene.species[1].drawn.diameter = lognormal(0.8, 0.2);
  scene.collisions = {.epsilon = 0.8, .beta = 0.4};
  scene.collisions.tc = 3e-3;
  scene.pairs = {{.between = {"hollow", "solid"}, .epsilon = 0.9, .beta = -1},
                 {.between = {"solid", "solid"}, .epsilon = {}, .beta = -0.6}};
  return scene;
}

Scene rough_spheres_in_all() {
  Scene scene = rough_spheres(6);
  scene.walls = {wall("x", "low", 0.8),
                 {.axis = "x", .side = "high", .temperature = 1.5},
                 {.axis = "z", .side = "low", .epsilon = 0.9}};
  scene.walls[2].motion = Scene::WallMotion{.amplitude = 0.1, .frequency = 0.5};
  scene.forces.gravity = {0.4, 0, -1};
  scene.driving.kicks = {.every = 0.3, .translational = 0.3, .rotational = 0.6};
  return scene;
}

// Rough spheres among smooth rods, or among thin rough needles, with a thermostat.
Scene rough_spheres_among(double diameter) {
  Scene scene = rough_spheres(9);
  scene.species.push_back({.name = "rods", .count = 60, .length = 2, .diameter = diameter});
  scene.collisions.beta = -1;
  scene.pairs = {{.between = {"hollow", "hollow"}, .epsilon = {}, .beta = 0.4},
                 {.between = {"hollow", "solid"}, .epsilon = 0.9, .beta = 1}};
  if (diameter == 0)
    scene.pairs.push_back({.between = {"rods", "rods"}, .epsilon = {}, .beta = 0.3});
  scene.walls = {{.axis = "z", .side = "low"}, {.axis = "z", .side = "high", .temperature = 2}};
  scene.driving.andersen = {.rate = 0.3, .temperature = 1.5};
  return scene;
}

// Needles among fixed ones, which differ, and which only some of them meet.
Scene among_fixed() {
  Scene scene = scene_of(0, 5, 3);
  scene.species = {{.name = "moving", .count = 60},
                   {.name = "lonely", .count = 40, .mass = 2},
                   {.name = "still", .count = 100, .fixed = true}};
  scene.species[2].drawn.length = lognormal(0.8, 0.3);
  scene.pairs = {{.between = {"lonely", "moving"}, .epsilon = {}, .beta = {}, .meet = false},
                 {.between = {"still", "moving"}, .epsilon = 0.9, .beta = 0.2}};
  scene.walls = {{.axis = "z", .side = "both"}};
  scene.driving.kicks = {.every = 0.3, .translational = 0.3, .rotational = 0.3};
  return scene;
}

}  // namespace

std::vector<EffectScene> effect_scenes() {
  std::vector<EffectScene> out;
  const auto add = [&](const char* name, const Scene& scene, const Scene::Until& end) -> Scene& {
    out.push_back({name, scene, end});
    return out.back().scene;
  };
  add("cooling", cooling(160, 5), until_time(2));
  add("mixture", mixture(), until_collisions(10));
  add("short_needles", with_species(inelastic(scene_of(160, 6, 5), 0.85, 1e-3, 0.25), 0.037, 2.9),
      until_collisions(10));
  add("long_needles", with_species(inelastic(scene_of(160, 3, 5), 0.85, 1e-3, 0.25), 21.3, 2.9),
      until_collisions(10));

  add("kicked", kicked(0.11, 1, 2), until_time(0.6));
  add("often_kicked", kicked(1e-3, 1, 2), until_time(0.3));
  Scene& at_rest = add("kicked_from_rest", kicked(0.2, 8, 0), until_time(0.6));
  at_rest.initial.t_tr = at_rest.initial.t_rot = 0;
  add("thermostat", thermostat(0.9, 2), until_time(0.6));
  Scene& both = add("driven_mixture", two_lengths(6), until_time(0.6));
  both.driving.kicks = {.every = 0.07, .translational = 0.5, .rotational = 1};
  both.driving.andersen = {.rate = 0.3, .temperature = 1};

  Scene& box = add("thermostat_between_walls", thermostat(0.8, 2), until_time(1.5));
  box.driving.kicks = {.every = 0.11, .translational = 1, .rotational = 0};
  box.walls = {{.axis = "y", .side = "both", .epsilon = 0.5}};
  add("shaken", shaken(), until_time(3));
  // Heights count from the low edges, from where the energy is negative.
  Scene& ceiling = add("ceiling", shaken(), until_time(2));
  ceiling.forces.gravity[2] = 3;
  ceiling.walls[0].side = "high";
  Scene& channel = add("channel", shaken(), until_time(2));
  channel.forces.gravity[1] = -1.5;  // along the periodic axis, beside a thermal wall
  add("chute", chute(), until_time(3));

  add("pistons", pistons(), until_time(3));
  add("released", released(), until_time(2.5));
  add("pressed_rods", pressed_rods(), until_time(2));
  add("belts", belts(), until_time(2));

  add("rods", rods_of(120, 5, 0.15), until_time(1.5));
  add("spheres", rods_of(150, 0, 0.3), until_time(1.5));
  add("rods_and_spheres", rods_and_spheres(60, 11), until_time(1.5));
  add("falling_rods", falling_rods(), until_time(3));
  add("driven_rods", driven_rods(), until_time(3));

  add("sheared", sheared(cooling(160, 5), 0.8, 1.3), until_time(2));
  add("sheared_back", sheared(cooling(160, 3.2), -2.5, 0), until_time(0.5));
  add("sheared_mixture", sheared(mixture(), -0.7, 4.1), until_collisions(10));
  add("sheared_rods", sheared(rods_of(120, 5, 0.15), 1, 2), until_time(1.5));
  add("sheared_spheres", sheared(rods_of(150, 0, 0.3), 0.5, 2), until_time(1.5));
  Scene& driven = add("sheared_and_driven", sheared(two_lengths(5), 1, 0.4), until_time(2));
  driven.collisions.beta = 0.2;
  driven.forces.gravity = {0, 0, -2};
  driven.driving.kicks = {.every = 0.07, .translational = 0.5, .rotational = 1};
  driven.walls = {{.axis = "z", .side = "low", .epsilon = 0.9},
                  {.axis = "z", .side = "high", .temperature = 1.5}};
  driven.walls[0].motion = {.amplitude = 0.1, .frequency = 2, .phase = 1};

  add("sizes", sizes(), until_collisions(8));
  add("sizes_of_rods", sizes_of_rods(), until_collisions(8));
  add("sizes_of_spheres", sizes_of_spheres(), until_collisions(12));
  add("sheared_sizes", sheared(sizes(), 0.7, 1.1), until_collisions(6)).driving = {};
  add("rough_spheres", rough_spheres_in_all(), until_collisions(12));
  add("rough_spheres_with_obstacles", rough_spheres(6), until_collisions(12)).species[0] = {
      .name = "hollow", .count = 40, .length = 0, .diameter = 1, .fixed = true};
  add("rough_spheres_among_rods", rough_spheres_among(0.5), until_collisions(10));
  add("rough_spheres_among_needles", rough_spheres_among(0), until_collisions(10));
  add("sheared_rough_spheres", sheared(rough_spheres(6), 0.5, 2), until_collisions(12))
      .driving.kicks = {.every = 0.3, .translational = 0.3, .rotational = 0.6};
  add("among_fixed", among_fixed(), until_collisions(8));

  add("growing_spheres", growing(rods_of(150, 0, 0.3), 0.05), until_collisions(30));
  add("growing_rods", growing(rods_of(120, 3, 0.15), 0.02), until_collisions(12));
  add("growing_sizes", growing(sizes_of_spheres(), 0.3), until_collisions(12)).collisions.tc = 1e-3;
  Scene& settling =
      add("growing_between_walls", growing(rods_and_spheres(40, 9), 0.05), until_collisions(10));
  settling.walls = {wall("z", "both", 0.8), {.axis = "x", .side = "both", .temperature = 1}};
  settling.forces.gravity = {0, 0.2, -0.5};

  add("sliding", sliding(100, 5, 0), until_time(1));
  add("sliding_after_bounces", sliding(100, 5, 0.5), until_collisions(12));
  add("sliding_mixture", sliding_mixture(sliding(0, 5, 0.2)), until_collisions(12));
  add("elastic_strikes", sliding(100, 5, 0.2), until_collisions(10)).collisions.elastic_strikes =
      true;
  add("sliding_kicked", sliding(100, 5, 0.2), until_collisions(10)).driving.kicks = {
      .every = 0.02, .translational = 0.3, .rotational = 0.3};
  add("sliding_thermostat", sliding(100, 5, 0.2), until_collisions(10)).driving.andersen = {
      .rate = 3, .temperature = 1};
  add("sliding_on_a_floor", sliding_between({}, {}), until_collisions(12));
  add("sliding_between_inelastic_walls", sliding_between({.epsilon = 0.7}, {.epsilon = 0.7}),
      until_time(0.8));
  add("sliding_on_a_shaken_floor",
      sliding_between({.motion = Scene::WallMotion{.amplitude = 0.1, .frequency = 2}}, {}),
      until_collisions(12));
  add("sliding_between_thermal_walls", sliding_between({.temperature = 1}, {.temperature = 1}),
      until_time(1.2));
  add("sliding_on_a_piston", sliding_between(piston("z", "low", 0.5), {}), until_time(0.8));
  add("sliding_mixture_on_a_floor", sliding_mixture(sliding_between({}, {})), until_collisions(8))
      .needles.box = {5, 5, 5};
  return out;
}

Scene effect_scene(const std::string& name) {
  const auto all = effect_scenes();
  return std::ranges::find(all, name, &EffectScene::name)->scene;
}

std::vector<double> numbers_of(const EnergyBudget& budget) {
  std::vector<double> out;
  budget.for_each([&](const Described&, const auto& energy) {
    if constexpr (std::is_arithmetic_v<std::decay_t<decltype(energy)>>) {
      out.push_back(energy);
    } else {
      out.insert(out.end(), energy.begin(), energy.end());
    }
  });
  return out;
}

}  // namespace needlework::test
