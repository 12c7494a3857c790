// [until]: the ends of a run.
#include <fmt/format.h>

#include <limits>

#include "src/scene/confinement.h"
#include "src/scene/read_value.h"
#include "src/scene/sections/sections.h"

namespace needlework {
namespace {

std::optional<Violation> no_end_is_ever_met(const Scene& scene) {
  const Scene::Until& until = scene.until;
  if (until.time || until.collisions_per_needle || until.wall_s || !until.energy_ratio) return {};
  if (*until.energy_ratio >= 1 || scene.composition().is_inelastic() || exchanges_energy(scene))
    return {};
  return Violation{.key = "until.energy_ratio",
                   .value = fmt::to_string(*until.energy_ratio),
                   .reason =
                       "is never met, as collisions keep the energy: expected another end, or "
                       "collisions.epsilon < 1"};
}

}  // namespace

SceneSection until_section() {
  using namespace from_value;
  using V = const Value&;
  using R = const ValueRange&;
  return {
      .name = "until",
      .keys =
          {
              {"time",
               Aspect::output,
               {0},
               "a time >= 0",
               [](Scene& s, V v, R r) { return store(s.until.time, number(v, r)); }},
              {"collisions_per_needle",
               Aspect::output,
               {0},
               "a number >= 0",
               [](Scene& s, V v, R r) {
                 return store(s.until.collisions_per_needle, number(v, r));
               }},
              {"energy_ratio",
               Aspect::output,
               {std::numeric_limits<double>::denorm_min()},
               "a number > 0",
               [](Scene& s, V v, R r) { return store(s.until.energy_ratio, number(v, r)); }},
              {"wall_s",
               Aspect::output,
               {0},
               "a number >= 0 of seconds",
               [](Scene& s, V v, R r) { return store(s.until.wall_s, number(v, r)); }},
          },
      .rules = {{Aspect::end, no_end_is_ever_met}},
  };
}

}  // namespace needlework
