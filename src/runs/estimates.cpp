#include "src/runs/estimates.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "src/runs/engine_choice.h"
#include "src/search/choice.h"

namespace needlework::runs {

double estimated_seconds_per_collision(const Scene& scene, double density) {
  // Fits to n L^3 = 0.01 to 50 at N = 1e4, and to 10000 in a box of 2.01. The number of candidates
  // grows with the density, or with the number of needles; a SIMD filter rules most out, which
  // matters from n L^3 = 100 on. On the long way to the next
  // collision of a dilute gas a needle leaves cells, whose side is about L or takes in some
  // needles.
  const std::string search =
      chosen_search(scene.engine.search, density, scene.composition(), scene.shear.has_value());
  const double count = static_cast<double>(scene.needles.count);
  if (density == 0) return 0;  // nothing to collide with
  if (search == "all-pairs") return 40e-6 + 0.042e-6 * count;
  if (search == "linked-lists") return 40e-6 + 7e-6 * density + 0.9e-6 / density;
  const double out_of_cache = 3e-6 * std::log10(std::max(1.0, count / 1e4));
  const double slowness = resolved_isa(scene.engine) == "scalar" ? 2 : 1;
  return (8e-6 + 0.5e-6 / std::cbrt(density * density) + 0.026e-6 * density + out_of_cache) *
         slowness;
}

double estimated_setup_seconds(const Scene& scene, double density) {
  // Fits to the same scenes, and to 1e6 needles in a box of 2.01; without AVX-512 on a slower CPU.
  const std::string search =
      chosen_search(scene.engine.search, density, scene.composition(), scene.shear.has_value());
  const double count = static_cast<double>(scene.needles.count);
  if (search == "all-pairs") return count * (20e-6 + 0.035e-6 * count);
  if (search == "linked-lists") return count * (1.5e-6 + 2.3e-6 * density);
  const std::string isa = resolved_isa(scene.engine);
  if (isa == "scalar") return count * (10e-6 + 0.1e-6 * density);
  if (isa == "avx512") return count * (3e-6 + 0.015e-6 * density);
  return count * (5e-6 + 0.037e-6 * density);
}

double estimated_placing_seconds(const Scene& scene, double density, const PlannedPlacement& plan) {
  constexpr double seconds_per_try = 0.4e-6;
  const double count = static_cast<double>(scene.needles.count);
  if (plan.way == PlannedPlacement::Way::inserted) return count * plan.tries * seconds_per_try;
  return 0.5 * count * plan.collisions * estimated_seconds_per_collision(scene, density);
}

}  // namespace needlework::runs
