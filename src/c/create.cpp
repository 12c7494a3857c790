// Simulations made and destroyed by C callers.
#include <algorithm>
#include <array>
#include <utility>

#include "needlework/parse.h"
#include "src/c/handle.h"
#include "src/c/vectors.h"
#include "src/runs/load_checkpoint.h"
#include "src/runs/output_path.h"
#include "src/scene/needed_memory.h"

namespace needlework::c {
namespace {

/// How messages name a scene that has no file.
constexpr const char* scene_name = "scene";

/// Ids are 32 bits wide, and one of them stands for none.
constexpr std::size_t most_needles = (std::size_t{1} << 32) - 2;

/// Before the state is copied: a count that is wrong must not fill the memory.
void require_possible(const needlework_initial& initial, const Scene& scene) {
  if (initial.count > most_needles) {
    throw UsageError("initial->count = " + std::to_string(initial.count) + ": expected at most " +
                     std::to_string(most_needles));
  }
  if (initial.count > 0) {
    require(initial.position.data, "initial->position.data");
    require(initial.orientation.data, "initial->orientation.data");
  }
  Scene sized = scene;
  sized.needles.count = initial.count;
  require_memory(sized);
}

State state_of(const needlework_initial& initial, const int32_t* image, const uint8_t* species,
               const needlework_bodies& bodies, const std::array<double, 3>& box_of_scene) {
  constexpr std::array<double, 3> not_given{};
  const std::size_t count = initial.count;
  State state;
  std::copy_n(initial.box, 3, state.box.begin());
  if (state.box == not_given) state.box = box_of_scene;
  if (state.box == not_given) {
    throw UsageError("initial->box = 0: expected its edges, as the scene has no needles.box");
  }
  state.position = rows_of(initial.position, count);
  if (initial.velocity.data && initial.peculiar_velocity.data)
    throw UsageError("initial->velocity and peculiar_velocity: expected one of them");
  if (initial.peculiar_velocity.data)
    state.peculiar_velocity = rows_of(initial.peculiar_velocity, count);
  else
    state.velocity = rows_of(initial.velocity, count);
  state.slide = initial.slide;
  std::copy_n(initial.low, 3, state.low.begin());
  state.orientation = rows_of(initial.orientation, count);
  state.angular_velocity = rows_of(initial.angular_velocity, count);
  if (initial.id) state.id.assign(initial.id, initial.id + count);
  if (species) state.species.assign(species, species + count);
  OwnBodies& own = state.own_bodies;
  for (const auto& [numbers, column] : {std::pair(bodies.length, &own.length),
                                        {bodies.diameter, &own.diameter},
                                        {bodies.mass, &own.mass},
                                        {bodies.inertia, &own.inertia}}) {
    if (numbers) column->assign(numbers, numbers + count);
  }
  if (image) {
    state.image.resize(count);
    for (std::size_t n = 0; n < count; ++n) std::copy_n(image + 3 * n, 3, state.image[n].begin());
  }
  return state;
}

template <class Load>
needlework_simulation* create(unsigned flags, needlework_error* error, Load&& load,
                              const char* path = nullptr) noexcept {
  needlework_simulation* made = nullptr;
  guarded(error, [&] {
    require_flags(flags);
    const bool replaces = flags & NEEDLEWORK_REPLACE;
    runs::LoadedScene loaded = load();
    runs::require_writable_output(loaded.scene, replaces, path ? path : "", "NEEDLEWORK_REPLACE");
    const std::string warning = runs::warning_of_state(loaded);
    made = new needlework_simulation(std::move(loaded), replaces);
    report_warning(runs::joined(warning, made->run.warning()), error);
  });
  return made;
}

}  // namespace
}  // namespace needlework::c

using namespace needlework;

needlework_simulation* needlework_create(const char* scene, unsigned flags,
                                         needlework_error* error) {
  return c::create(flags, error, [&] {
    c::require(scene, "scene");
    return runs::complete_scene(parse_scene(scene, c::scene_name, {}, {.end = true}));
  });
}

needlework_simulation* needlework_open(const char* path, unsigned flags, needlework_error* error) {
  const auto load = [&] {
    c::require(path, "path");
    return runs::complete_scene(read_scene(path, {}, {.end = true}));
  };
  return c::create(flags, error, load, path);
}

needlework_simulation* needlework_create_from(const char* scene, const needlework_initial* initial,
                                              unsigned flags, needlework_error* error) {
  return needlework_create_with_images(scene, initial, nullptr, flags, error);
}

needlework_simulation* needlework_create_with_images(const char* scene,
                                                     const needlework_initial* initial,
                                                     const int32_t* image, unsigned flags,
                                                     needlework_error* error) {
  return needlework_create_with_species(scene, initial, image, nullptr, flags, error);
}

needlework_simulation* needlework_create_with_species(const char* scene,
                                                      const needlework_initial* initial,
                                                      const int32_t* image, const uint8_t* species,
                                                      unsigned flags, needlework_error* error) {
  return needlework_create_with_bodies(scene, initial, image, species, nullptr, flags, error);
}

needlework_simulation* needlework_create_with_bodies(const char* scene,
                                                     const needlework_initial* initial,
                                                     const int32_t* image, const uint8_t* species,
                                                     const needlework_bodies* bodies,
                                                     unsigned flags, needlework_error* error) {
  return c::create(flags, error, [&] {
    c::require(scene, "scene");
    c::require(initial, "initial");
    Scene parsed = parse_scene(scene, c::scene_name, {}, {.state = true, .end = true});
    c::require_possible(*initial, parsed);
    const needlework_bodies own = bodies ? *bodies : needlework_bodies{};
    State state = c::state_of(*initial, image, species, own, parsed.needles.box);
    return runs::complete_scene(std::move(parsed), std::move(state));
  });
}

needlework_simulation* needlework_resume(const char* file, needlework_error* error) {
  needlework_simulation* made = nullptr;
  c::guarded(error, [&] {
    c::require(file, "file");
    auto [saved, warning] = runs::load_checkpoint(file);
    made = new needlework_simulation(std::move(saved));
    c::report_warning(runs::joined(warning, made->run.warning()), error);
  });
  return made;
}

void needlework_destroy(needlework_simulation* simulation) { delete simulation; }

const char* needlework_message(const needlework_simulation* simulation) {
  if (!simulation) return "simulation is NULL: expected a pointer";
  if (simulation->busy) return "another call uses the simulation: expected one call at a time";
  return simulation->last.message;
}
