// What one sample of each observable costs, per needle. Names are OBSERVABLE/needles; the gas is
// that of the dense scene of docs/performance.md, n L^3 = 11.6. `copy` is the copy of all needles
// that a sample of any observable but collision_statistics needs once.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "needlework/simulation.h"
#include "src/observe/observation.h"
#include "src/observe/registry.h"
#include "src/scene/observable_names.h"

namespace needlework {
namespace {

Scene dense_scene(std::int64_t count) {
  Scene scene;
  scene.needles.count = static_cast<std::uint64_t>(count);
  const double edge = 12 * std::cbrt(static_cast<double>(count) / 20000);
  scene.needles.box = {edge, edge, edge};
  return scene;
}

void show_per_needle(benchmark::State& state) {
  state.SetItemsProcessed(state.iterations() * state.range(0));
}

void copy(benchmark::State& state) {
  const Simulation simulation(dense_scene(state.range(0)));
  State needles;
  for (auto _ : state) simulation.copy(needles);
  show_per_needle(state);
}

void sample(benchmark::State& state, const std::string& name) {
  Scene scene = dense_scene(state.range(0));
  scene.output.observables = {name};
  if (std::ranges::find(wall_observable_names, name) != wall_observable_names.end()) {
    Scene::Wall& walls = scene.walls.emplace_back();
    walls.axis = "z";
    walls.side = "both";
  }
  const Simulation simulation(scene);
  const State needles = simulation.copy();
  const Totals totals = simulation.totals();
  observe::SpeciesSums sums;
  sums.walls = simulation.wall_totals();
  sums.energy = simulation.energy_budget();
  observe::Observation observation(scene);
  for (int n = 0; n < 8; ++n) observation.sample(needles, totals, sums);  // all references
  for (auto _ : state) benchmark::DoNotOptimize(observation.sample(needles, totals, sums).data());
  show_per_needle(state);
}

// Collisions as they come from a run; an item is a collision.
void collisions(benchmark::State& state) {
  Scene scene = dense_scene(state.range(0));
  scene.output.observables = {"collision_statistics"};
  Simulation simulation(scene);
  std::vector<Collision> recorded;
  simulation.on_collision([&](const Collision& collision) { recorded.push_back(collision); });
  Scene::Until until;
  until.collisions_per_needle = 4;
  simulation.advance(until);
  observe::Observation observation(scene);
  observation.sample({}, simulation.totals());
  for (auto _ : state) {
    for (const Collision& collision : recorded) observation.collision(collision);
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(recorded.size()));
}

const bool registered = [] {
  const auto add = [](const std::string& name, auto function) {
    benchmark::RegisterBenchmark(name.c_str(), function)->Arg(2000)->Arg(20000);
  };
  add("copy", copy);
  for (const observe::Entry& entry : observe::registry()) {
    const std::string name(entry.name);
    add(name, [name](benchmark::State& state) { sample(state, name); });
  }
  add("collisions", collisions);
  return true;
}();

}  // namespace
}  // namespace needlework
