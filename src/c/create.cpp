// Simulations made and destroyed by C callers.
#include <algorithm>
#include <array>
#include <utility>

#include "needlework/error.h"
#include "needlework/parse.h"
#include "src/c/handle.h"
#include "src/c/vectors.h"

namespace needlework::c {
namespace {

/// How messages name a scene that has no file.
constexpr const char* scene_name = "scene";

State state_of(const needlework_initial& initial, const std::array<double, 3>& box_of_scene) {
  const std::size_t count = initial.count;
  if (count > 0) {
    require(initial.position.data, "initial->position.data");
    require(initial.orientation.data, "initial->orientation.data");
  }
  State state;
  std::copy_n(initial.box, 3, state.box.begin());
  if (state.box == std::array<double, 3>{}) state.box = box_of_scene;
  state.position = rows_of(initial.position, count);
  state.velocity = rows_of(initial.velocity, count);
  state.orientation = rows_of(initial.orientation, count);
  state.angular_velocity = rows_of(initial.angular_velocity, count);
  if (initial.id) state.id.assign(initial.id, initial.id + count);
  return state;
}

template <class Load>
needlework_simulation* create(unsigned flags, needlework_error* error, Load&& load) noexcept {
  needlework_simulation* made = nullptr;
  guarded(error, [&] {
    if (flags & ~unsigned{NEEDLEWORK_REPLACE}) {
      throw UsageError("flags = " + std::to_string(flags) + ": expected 0 or NEEDLEWORK_REPLACE");
    }
    made = new needlework_simulation(load(), flags & NEEDLEWORK_REPLACE);
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
  return c::create(flags, error, [&] {
    c::require(path, "path");
    return runs::complete_scene(read_scene(path, {}, {.end = true}));
  });
}

needlework_simulation* needlework_create_from(const char* scene, const needlework_initial* initial,
                                              unsigned flags, needlework_error* error) {
  return c::create(flags, error, [&] {
    c::require(scene, "scene");
    c::require(initial, "initial");
    Scene parsed = parse_scene(scene, c::scene_name, {}, {.state = true, .end = true});
    State state = c::state_of(*initial, parsed.needles.box);
    return runs::complete_scene(std::move(parsed), std::move(state));
  });
}

void needlework_destroy(needlework_simulation* simulation) { delete simulation; }

const char* needlework_message(const needlework_simulation* simulation) {
  return simulation ? simulation->message.c_str() : "";
}
