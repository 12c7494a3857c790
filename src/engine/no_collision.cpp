// Why a state can have no collision.
#include <algorithm>
#include <string>

#include "kernels/body_state.h"
#include "needlework/simulation.h"
#include "src/physics/collisionless.h"
#include "src/physics/vectors.h"
#include "src/scene/confinement.h"

namespace needlework {
namespace {

// Whether all of so many needles pass through each other.
bool are_passing(const Composition& composition, std::size_t count) {
  return count > 1 && !composition.any_meet();
}

// Whether a gas of so many needles changes without collisions, by walls or driving, so that needles
// may collide later, or another end may be met.
bool goes_on(const Scene& scene, const Composition& composition, std::size_t count) {
  const bool may_end = (count > 1 && !are_passing(composition, count)) ||
                       scene.until.energy_ratio || scene.until.wall_s;
  return count > 0 && may_end && acts_on_single_needles(scene);
}

}  // namespace

std::string why_no_collision(const Scene& scene, const State& initial) {
  const std::size_t count = initial.size();
  const Composition composition = scene.composition();
  if (goes_on(scene, composition, count)) return "";
  if (initial.velocity.size() != count || initial.orientation.size() != count ||
      initial.angular_velocity.size() != count) {
    return "";  // it cannot be simulated
  }
  if (are_passing(composition, count)) return words_for(Collisionless::passing);
  if (count > 1 && composition.has_width()) return "";
  const auto reason = collisionless(count, [&](std::size_t i) {
    return kernels::BodyState{{},
                              vector_of(initial.velocity[i]),
                              vector_of(initial.orientation[i]),
                              vector_of(initial.angular_velocity[i])};
  });
  return reason ? words_for(*reason) : "";
}

std::string why_no_collision(const Scene& drawn) {
  const Composition composition = drawn.composition();
  if (goes_on(drawn, composition, composition.count())) return "";
  if (composition.count() == 0) return words_for(Collisionless::no_needles);
  if (composition.count() == 1) return words_for(Collisionless::one_needle);
  if (are_passing(composition, composition.count())) return words_for(Collisionless::passing);
  const bool at_rest = std::ranges::all_of(composition.species(), [](const Species& species) {
    return species.t_tr == 0 && species.t_rot == 0;
  });
  return at_rest ? words_for(Collisionless::alike) : "";
}

}  // namespace needlework
