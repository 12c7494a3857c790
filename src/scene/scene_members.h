// The members of a scene, with the names of their keys.
#pragma once

#include <string_view>

#include "needlework/scene.h"

namespace needlework {

// Each structured binding names all members of its struct, so that this file does not compile when
// one is added and forgotten here.

/// Calls visit(section, key, member) for each member of Scene::Species, constant or not, but for
/// `q` and `sizes`, which no key gives.
template <class Species, class Visit>
void visit_species(Species& species, Visit&& visit) {
  auto& [name, count, length, mass, k, t_tr, t_rot, diameter, given_inertia, q, drawn, fixed,
         overlap, sizes] = species;
  visit("species", "name", name);
  visit("species", "count", count);
  visit("species", "length", length);
  visit("species", "mass", mass);
  visit("species", "k", k);
  visit("species", "t_tr", t_tr);
  visit("species", "t_rot", t_rot);
  visit("species", "diameter", diameter);
  visit("species", "inertia", given_inertia);
  visit("species", "drawn", drawn);
  visit("species", "fixed", fixed);
  visit("species", "overlap", overlap);
  static_cast<void>(q);
  static_cast<void>(sizes);
}

/// The same for each member of Scene::Pair.
template <class Pair, class Visit>
void visit_pair(Pair& pair, Visit&& visit) {
  auto& [between, epsilon, beta, meet] = pair;
  visit("pairs", "between", between);
  visit("pairs", "epsilon", epsilon);
  visit("pairs", "beta", beta);
  visit("pairs", "meet", meet);
}

/// The same for each member of Scene::WallMotion.
template <class Motion, class Visit>
void visit_motion(Motion& motion, Visit&& visit) {
  auto& [amplitude, frequency, phase, velocity, stop_at, tangential] = motion;
  visit("walls", "motion.amplitude", amplitude);
  visit("walls", "motion.frequency", frequency);
  visit("walls", "motion.phase", phase);
  visit("walls", "motion.velocity", velocity);
  visit("walls", "motion.stop_at", stop_at);
  visit("walls", "motion.tangential", tangential);
}

/// The same for each member of Scene::Wall.
template <class Wall, class Visit>
void visit_wall(Wall& wall, Visit&& visit) {
  auto& [axis, side, epsilon, temperature, motion] = wall;
  visit("walls", "axis", axis);
  visit("walls", "side", side);
  visit("walls", "epsilon", epsilon);
  visit("walls", "temperature", temperature);
  visit("walls", "motion", motion);
}

/// The same for each member of Scene::Shear.
template <class Shear, class Visit>
void visit_shear(Shear& shear, Visit&& visit) {
  auto& [rate, offset] = shear;
  visit("shear", "rate", rate);
  visit("shear", "offset", offset);
}

/// The same for each member of Scene::Kicks.
template <class Kicks, class Visit>
void visit_kicks(Kicks& kicks, Visit&& visit) {
  auto& [every, translational, rotational] = kicks;
  visit("driving", "kicks.every", every);
  visit("driving", "kicks.translational", translational);
  visit("driving", "kicks.rotational", rotational);
}

/// The same for each member of Scene::Andersen.
template <class Andersen, class Visit>
void visit_andersen(Andersen& andersen, Visit&& visit) {
  auto& [rate, temperature] = andersen;
  visit("driving", "andersen.rate", rate);
  visit("driving", "andersen.temperature", temperature);
}

/// The same for each member of Scene::Growth that is a key.
template <class Growth, class Visit>
void visit_growth(Growth& growth, Visit&& visit) {
  auto& [rate, until_packing, until_pressure, cool_every, from] = growth;
  visit("driving", "growth.rate", rate);
  visit("driving", "growth.until_packing", until_packing);
  visit("driving", "growth.until_pressure", until_pressure);
  visit("driving", "growth.cool_every", cool_every);
  static_cast<void>(from);
}

/// The same for each member of a Scene, or of its parts. Those of all species, pairs and walls have
/// the key "". Left out are text and places, which say where a scene comes from, and whether
/// `threads` was chosen.
template <class AnyScene, class Visit>
void visit_members(AnyScene& scene, Visit&& visit) {
  auto& [title, needles, species, pairs, initial, collisions, walls, forces, shear, driving, engine,
         until, output, text, places] = scene;
  visit("", "title", title);
  visit("species", "", species);
  visit("pairs", "", pairs);
  {
    auto& [count, box, k, diameter, seed] = needles;
    visit("needles", "count", count);
    visit("needles", "box", box);
    visit("needles", "k", k);
    visit("needles", "diameter", diameter);
    visit("needles", "seed", seed);
  }
  {
    auto& [t_tr, t_rot, file, packing] = initial;
    visit("initial", "t_tr", t_tr);
    visit("initial", "t_rot", t_rot);
    visit("initial", "file", file);
    visit("initial", "packing", packing);
  }
  {
    auto& [epsilon, beta, tc, tc_relative, sliding, sliding_below, elastic_strikes] = collisions;
    visit("collisions", "epsilon", epsilon);
    visit("collisions", "beta", beta);
    visit("collisions", "tc", tc);
    visit("collisions", "tc_relative", tc_relative);
    visit("collisions", "sliding", sliding);
    visit("collisions", "sliding_below", sliding_below);
    visit("collisions", "elastic_strikes", elastic_strikes);
  }
  visit("walls", "", walls);
  {
    auto& [gravity] = forces;
    visit("forces", "gravity", gravity);
  }
  visit("shear", "", shear);
  {
    auto& [kicks, andersen, growth] = driving;
    visit("driving", "kicks", kicks);
    visit("driving", "andersen", andersen);
    visit("driving", "growth", growth);
  }
  {
    auto& [search, queue, accuracy, isolation, escalation, filter, root_tolerance, sampling_step,
           threads, threads_by_size, team, isa, cell_side, capsule_radius, storage] = engine;
    visit("engine", "search", search);
    visit("engine", "queue", queue);
    visit("engine", "accuracy", accuracy);
    visit("engine", "isolation", isolation);
    visit("engine", "escalation", escalation);
    visit("engine", "filter", filter);
    visit("engine", "root_tolerance", root_tolerance);
    visit("engine", "sampling_step", sampling_step);
    visit("engine", "threads", threads);
    static_cast<void>(threads_by_size);
    visit("engine", "team", team);
    visit("engine", "isa", isa);
    visit("engine", "cell_side", cell_side);
    visit("engine", "capsule_radius", capsule_radius);
    visit("engine", "storage", storage);
  }
  {
    auto& [time, collisions_per_needle, energy_ratio, wall_s] = until;
    visit("until", "time", time);
    visit("until", "collisions_per_needle", collisions_per_needle);
    visit("until", "energy_ratio", energy_ratio);
    visit("until", "wall_s", wall_s);
  }
  {
    auto& [file, series_per_decade, series_every, frame_times, frames_per_decade, frames_every,
           observables, grid, size_classes, events, checkpoint_every] = output;
    visit("output", "file", file);
    visit("output", "series_per_decade", series_per_decade);
    visit("output", "series_every", series_every);
    visit("output", "frames", frame_times);
    visit("output", "frames", frames_per_decade);
    visit("output", "frames_every", frames_every);
    visit("output", "observables", observables);
    visit("output", "grid", grid);
    visit("output", "size_classes", size_classes);
    visit("output", "events", events);
    visit("output", "checkpoint_every", checkpoint_every);
  }
}

}  // namespace needlework
