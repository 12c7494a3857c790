#include "src/runs/loaded_scene.h"

#include <cmath>
#include <memory>
#include <utility>

#include "needlework/error.h"
#include "needlework/h5md.h"
#include "src/runs/engine_choice.h"
#include "src/runs/estimates.h"
#include "src/scene/check.h"

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

}  // namespace

LoadedScene complete_scene(Scene given) {
  choose_engine(given);
  require_memory(given);
  if (given.initial.file.empty()) return {.scene = std::move(given), .initial = {}};
  State initial = read_initial_state(given);
  return complete_scene(std::move(given), std::move(initial));
}

LoadedScene complete_scene(Scene given, State initial) {
  LoadedScene loaded{.scene = std::move(given), .initial = std::move(initial)};
  adopt_count_and_box(loaded.scene, *loaded.initial);
  choose_engine(loaded.scene);
  require_memory(loaded.scene);
  return loaded;
}

Totals totals_of(const State& state, const Scene& scene) {
  const Scene::Species species = scene.one_species();
  const double inertia = species.mass * (species.length * species.length) / (2 * species.k);
  Totals totals;
  const double count = static_cast<double>(state.size());
  for (std::size_t i = 0; i < state.size(); ++i) {
    totals.t_tr += species.mass * square(state.velocity[i]) / (3 * count);
    totals.t_rot += inertia * square(state.angular_velocity[i]) / (2 * count);
    for (int axis = 0; axis < 3; ++axis)
      totals.momentum[axis] += species.mass * state.velocity[i][axis];
  }
  totals.energy = 1.5 * totals.t_tr + totals.t_rot;
  return totals;
}

theory::Temperatures initial_temperatures(const LoadedScene& loaded) {
  if (!loaded.initial) return {loaded.scene.initial.t_tr, loaded.scene.initial.t_rot};
  const Totals totals = totals_of(*loaded.initial, loaded.scene);
  return {totals.t_tr, totals.t_rot};
}

bool starts_in_equilibrium(const Scene& scene) {
  const Scene::Collisions& c = scene.collisions;
  const Scene::Initial& initial = scene.initial;
  return c.epsilon == 1 && std::abs(c.beta) == 1 && initial.file.empty() &&
         initial.t_tr == initial.t_rot && initial.t_tr > 0 && scene.needles.count >= 2;
}

double density_of(const Scene& scene) {
  const auto& box = scene.needles.box;
  const double length = scene.one_species().length;
  return static_cast<double>(scene.needles.count) * (length * length * length) /
         (box[0] * box[1] * box[2]);
}

double theory_density_of(const Scene& scene) {
  const Scene::Species species = scene.one_species();
  return density_of(scene) / (species.length * std::sqrt(species.mass));
}

}  // namespace needlework::runs
