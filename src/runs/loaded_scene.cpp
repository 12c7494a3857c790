#include "src/runs/loaded_scene.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <memory>
#include <utility>

#include "needlework/error.h"
#include "needlework/h5md.h"
#include "needlework/theory.h"
#include "src/runs/engine_choice.h"
#include "src/runs/load_checkpoint.h"
#include "src/scene/adopt_state.h"
#include "src/scene/check.h"
#include "src/scene/confinement.h"
#include "src/scene/needed_memory.h"
#include "src/scene/own_bodies.h"

namespace needlework::runs {
namespace {

double square(const std::array<double, 3>& a) { return a[0] * a[0] + a[1] * a[1] + a[2] * a[2]; }

// Reads initial.file by read(); errors name the key, then the file and the place in it.
template <class Read>
auto reading(const Scene& scene, Read&& read) {
  const std::string place = place_of(scene, "initial.file", scene.initial.file);
  try {
    return read();
  } catch (const InputError& error) {
    throw InputError(place + ": " + error.what());
  } catch (const IoError& error) {
    throw IoError(place + ": cannot be read: " + error.what());
  }
}

// The last frame of initial.file. That it fits is checked before memory is taken for it.
State read_initial_state(const Scene& scene) {
  const auto file =
      reading(scene, [&] { return std::make_unique<io::FrameFile>(scene.initial.file); });
  require_count(scene, file->needles());
  Scene sized = scene;
  sized.needles.count = file->needles();
  require_memory(sized);
  return reading(scene, [&] { return file->read(file->count() - 1); });
}

// A file of needles that are beyond an open side must not be taken for one of a periodic box.
void require_walls(const Scene& scene, const State& initial) {
  const std::array<bool, 3> periodic = scene.periodic();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (initial.periodic[axis] || !periodic[axis]) continue;
    throw InputError(fmt::format(
        "{}: its box is not periodic along {}: expected [[walls]] along that axis in the scene",
        place_of(scene, "initial.file", scene.initial.file), "xyz"[axis]));
  }
}

}  // namespace

LoadedScene complete_scene(Scene given) {
  choose_engine(given);
  require_memory(given);
  if (given.initial.file.empty()) return {.scene = std::move(given), .initial = {}};
  State initial = read_initial_state(given);
  require_walls(given, initial);
  return complete_scene(std::move(given), std::move(initial));
}

LoadedScene complete_scene(Scene given, State initial) {
  LoadedScene loaded{.scene = std::move(given), .initial = std::move(initial)};
  adopt_state(loaded.scene, *loaded.initial);
  choose_engine(loaded.scene);
  require_memory(loaded.scene);
  return loaded;
}

// The velocity of a needle beside the flow of [shear], if there is one.
static std::array<double, 3> velocity_of(const State& state, const Scene& scene, std::size_t i) {
  if (state.velocity.empty()) return state.peculiar_velocity.at(i);
  std::array<double, 3> out = state.velocity[i];
  if (!scene.shear) return out;
  const double rate = state.shear_rate != 0 ? state.shear_rate : scene.shear->rate;
  out[0] -= rate * state.position[i][1];
  return out;
}

// The drift beside the flow stays for ever, as if it were heat.
static std::string warning_of_drift(const LoadedScene& loaded) {
  constexpr double most_share = 0.01;  // of the temperature
  const State& state = *loaded.initial;
  if (!keeps_drift(loaded.scene) || state.shear_rate != 0 || state.velocity.empty()) return "";
  const Members members = members_of(loaded);
  double mass = 0, momentum = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < state.size(); ++i) {
    if (members.species_of(i).fixed) continue;
    ++count;
    mass += members.body(i).mass;
    momentum += members.body(i).mass * velocity_of(state, loaded.scene, i)[0];
  }
  const double t_tr = totals_of(state, loaded.scene).t_tr;
  const double of_drift = momentum * momentum / (3 * mass * static_cast<double>(count));
  if (!(of_drift > most_share * t_tr)) return "";
  return fmt::format(
      "{}: says no flow, so its velocities are taken to have that of [shear]: beside it the gas "
      "drifts with {:.4g} along x, which is {:.3g} of T_tr = {:.4g} and stays; if they are "
      "velocities of a gas without a flow, pass them as peculiar_velocity from Python, C or a pipe",
      loaded.scene.initial.file.empty()
          ? "the state"
          : place_of(loaded.scene, "initial.file", loaded.scene.initial.file),
      momentum / mass, of_drift, t_tr);
}

std::string warning_of_state(const LoadedScene& loaded) {
  if (!loaded.initial) return "";
  const std::string unknown = loaded.scene.initial.file.empty()
                                  ? ""
                                  : warning_of_unknown_bodies(loaded.scene, loaded.initial->bodies);
  return joined(unknown, warning_of_drift(loaded));
}

std::vector<std::array<double, 3>> peculiar_velocities(const State& state, const Scene& scene) {
  std::vector<std::array<double, 3>> out;
  for (std::size_t i = 0; i < state.size(); ++i) out.push_back(velocity_of(state, scene, i));
  return out;
}

Members members_of(const LoadedScene& loaded) {
  if (!loaded.initial) return drawn_members(loaded.scene);
  return members_of(loaded.scene.composition(), *loaded.initial);
}

Totals totals_of(const State& state, const Scene& scene) {
  const Members members = needlework::members_of(scene.composition(), state);
  const Composition& composition = members.composition;
  Totals totals;
  const double count = static_cast<double>(state.size() - composition.fixed());
  const std::array<double, 3>& gravity = scene.forces.gravity;
  const std::array<bool, 3> periodic = scene.periodic();
  double fall = 0;  // potential energy
  for (std::size_t i = 0; i < state.size(); ++i) {
    if (members.species_of(i).fixed) continue;
    const BodyNumbers body = members.body(i);
    const std::array<double, 3> velocity = velocity_of(state, scene, i);
    totals.t_tr += body.mass * square(velocity) / (3 * count);
    totals.t_rot += body.inertia * square(state.angular_velocity[i]) / (2 * count);
    for (int axis = 0; axis < 3; ++axis) {
      totals.momentum[axis] += body.mass * velocity[axis];
      if (!periodic[axis])
        fall -= body.mass * gravity[axis] * (state.position[i][axis] - state.low[axis]);
    }
  }
  const double turning = composition.turning_share();
  if (turning > 0) totals.t_rot /= turning;
  totals.energy = 1.5 * totals.t_tr + turning * totals.t_rot;
  if (fall != 0) totals.energy += fall / count;
  return totals;
}

theory::Temperatures initial_temperatures(const LoadedScene& loaded) {
  const Composition composition = loaded.scene.composition();
  if (!loaded.initial) {
    const double turning = composition.turning_share();
    if (!composition.is_mixture()) return {composition[0].t_tr, composition[0].t_rot, turning};
    return theory::mean_of_species(composition, temperatures_by_species(loaded));
  }
  const Totals totals = totals_of(*loaded.initial, loaded.scene);
  return {totals.t_tr, totals.t_rot, composition.turning_share()};
}

std::vector<theory::Temperatures> temperatures_by_species(const LoadedScene& loaded) {
  const Composition composition = loaded.scene.composition();
  std::vector<theory::Temperatures> out;
  if (!loaded.initial) {
    for (const Species& each : composition.species()) out.push_back({each.t_tr, each.t_rot});
    return out;
  }
  out.assign(composition.size(), {0, 0});
  const State& state = *loaded.initial;
  const Members members = needlework::members_of(composition, state);
  for (std::size_t i = 0; i < state.size(); ++i) {
    const Species& species = members.species_of(i);
    if (species.fixed) continue;
    const BodyNumbers body = members.body(i);
    const double count = static_cast<double>(species.count);
    theory::Temperatures& of = out[members.species[i]];
    of.t_tr += body.mass * square(velocity_of(state, loaded.scene, i)) / (3 * count);
    const int rotations = std::max(2, species.rotations());  // smooth spheres do not turn
    of.t_rot += body.inertia * square(state.angular_velocity[i]) / (rotations * count);
  }
  return out;
}

const char* beyond_cooling_theory(const Composition& composition) {
  if (composition.has_fixed()) return "fixed bodies";
  if (composition.has_own_sizes()) return "bodies that differ within a species";
  return nullptr;
}

bool has_mixture_theory(const Composition& composition) {
  return !composition.is_needle_gas() && composition.size() <= theory::most_species_of_theory;
}

double volume_of(const Scene& scene) {
  const auto& box = scene.needles.box;
  return box[0] * box[1] * box[2];
}

double density_of(const Scene& scene) {
  const double length = scene.composition().longest();
  return static_cast<double>(scene.needles.count) * (length * length * length) / volume_of(scene);
}

double theory_density_of(const Scene& scene) {
  const Composition composition = scene.composition();
  const Species& species = composition[0];
  const double length = species.length;
  return static_cast<double>(scene.needles.count) * (length * length * length) / volume_of(scene) /
         (length * std::sqrt(species.mass));
}

}  // namespace needlework::runs
