#include "src/scene/saved_scene.h"

namespace needlework {

// Each structured binding names all members of its struct, so that this file does not compile when
// one is added and forgotten here.

void transfer(Archive& archive, Scene::Species& species) {
  auto& [name, count, length, mass, k, t_tr, t_rot] = species;
  archive(name, count, length, mass, k, t_tr, t_rot);
}

void transfer(Archive& archive, Scene& scene) {
  auto& [title, needles, species, initial, collisions, engine, until, output, text, places] = scene;
  archive(title, species, text, places);
  {
    auto& [count, box, k, seed] = needles;
    archive(count, box, k, seed);
  }
  {
    auto& [t_tr, t_rot, file] = initial;
    archive(t_tr, t_rot, file);
  }
  {
    auto& [epsilon, beta, tc, tc_relative] = collisions;
    archive(epsilon, beta, tc, tc_relative);
  }
  {
    auto& [search, queue, accuracy, isolation, escalation, filter, root_tolerance, sampling_step,
           threads, team, isa, cell_side, capsule_radius, storage] = engine;
    archive(search, queue, accuracy, isolation, escalation, filter, root_tolerance, sampling_step,
            threads, team, isa, cell_side, capsule_radius, storage);
  }
  {
    auto& [time, collisions_per_needle, energy_ratio, wall_s] = until;
    archive(time, collisions_per_needle, energy_ratio, wall_s);
  }
  {
    auto& [file, series_per_decade, series_every, frame_times, frames_per_decade, observables, grid,
           events, checkpoint_every] = output;
    archive(file, series_per_decade, series_every, frame_times, frames_per_decade, observables,
            grid, events, checkpoint_every);
  }
}

}  // namespace needlework
