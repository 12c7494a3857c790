#include <algorithm>
#include <utility>
#include <vector>

#include "needlework/scene.h"
#include "src/composition/rough_spheres.h"
#include "src/scene/own_bodies.h"

namespace needlework {
Composition Scene::composition() const {
  const Restitution everywhere{collisions.epsilon, collisions.beta};
  std::vector<Species> all = species;
  if (all.empty()) {
    all.push_back({.name = {},
                   .count = needles.count,
                   .length = 1,
                   .mass = 1,
                   .k = needles.k,
                   .t_tr = initial.t_tr,
                   .t_rot = initial.t_rot,
                   .diameter = needles.diameter,
                   .given_inertia = {}});
  }
  Composition out(std::move(all), everywhere);
  const auto index_of = [&](const std::string& name) {
    const auto found = std::find_if(species.begin(), species.end(),
                                    [&](const Species& each) { return each.name == name; });
    return static_cast<std::size_t>(found - species.begin());
  };
  for (const Pair& pair : pairs) {
    const std::size_t a = index_of(pair.between[0]), b = index_of(pair.between[1]);
    if (a >= species.size() || b >= species.size()) continue;  // refused where scenes are checked
    out.set_restitution(
        a, b, {pair.epsilon.value_or(everywhere.epsilon), pair.beta.value_or(everywhere.beta)});
    out.set_meets(a, b, pair.meet);
  }
  for (std::size_t a = 0; a < out.size(); ++a) {
    for (std::size_t b = 0; b <= a; ++b) {
      if (out[a].fixed && out[b].fixed) out.set_meets(a, b, false);
    }
  }
  set_q_of_spheres(out);
  std::uint64_t first = 0;
  for (std::size_t n = 0; n < out.size(); ++n) {
    Species each = out[n];
    const bool is_rough_sphere = each.q > 0;
    each = completed(each, needles.seed, first);
    first += each.count;
    if (each.fixed) each.t_tr = 0;
    if (!each.turns() || each.fixed) each.t_rot = 0;
    if (each.given_inertia && (each.has_axis() || is_rough_sphere))
      each.set_inertia(*each.given_inertia);
    out.set_species(n, each);
  }
  return out;
}

}  // namespace needlework
