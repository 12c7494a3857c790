#include "src/runs/explanation.h"

#include <cmath>
#include <limits>

#include "src/calendar/choice.h"
#include "src/runs/engine_choice.h"
#include "src/runs/estimates.h"
#include "src/scene/accuracy.h"
#include "src/scene/check.h"
#include "src/search/choice.h"

namespace needlework::runs {
namespace {

constexpr double undefined = std::numeric_limits<double>::quiet_NaN();

double collisions_of(const std::optional<Forecast>& expected, const Scene& scene) {
  if (!expected) return undefined;
  return 0.5 * expected->collisions_per_needle * static_cast<double>(scene.needles.count);
}

}  // namespace

Explanation::Explanation(const LoadedScene& loaded)
    : scene(loaded.scene),
      density(density_of(scene)),
      initial(initial_temperatures(loaded)),
      mean_free_time(1 / initial_collision_rate(loaded)),
      // The cooling of a mixture is not forecast.
      expected(scene.species.size() > 1
                   ? std::nullopt
                   : forecast({scene.needles.k, scene.collisions.epsilon, scene.collisions.beta},
                              initial, theory_density_of(scene), scene.until)),
      collisions(collisions_of(expected, scene)),
      seconds(expected && std::isfinite(expected->time)
                  ? estimated_setup_seconds(scene, density) +
                        collisions * estimated_seconds_per_collision(scene, density)
                  : undefined),
      memory(estimated_memory(scene)),
      search(chosen_search(scene.engine.search, density, scene.composition())),
      calendar(chosen_calendar(scene.engine.queue, scene.engine.threads.value_or(1))),
      accuracy(accuracy_name(scene.engine)),
      isa(resolved_isa(scene.engine)),
      threads(scene.engine.threads.value_or(1)),
      warnings(all_warnings(loaded)) {}

}  // namespace needlework::runs
