#include "src/runs/estimates.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "needlework/error.h"
#include "src/runs/amount_text.h"
#include "src/runs/engine_choice.h"
#include "src/runs/resources.h"
#include "src/scene/check.h"
#include "src/search/choice.h"

namespace needlework::runs {
namespace {

// Peak resident memory, measured from N = 1e3 to 1e6 with the SIMD searches, and what frames
// add. The scalar search takes a quarter less.
constexpr double base_bytes = 12e6;
constexpr double bytes_per_needle = 580;
constexpr double bytes_per_needle_of_own_numbers = 100;
constexpr double bytes_per_needle_of_a_frame = 100;
constexpr double bytes_per_needle_of_a_checkpoint = 400;  // while it is written
constexpr double bytes_per_needle_of_displacement = 500;  // eight references, of 48 each, and more
constexpr double bytes_per_needle_of_time_correlation = 4500;  // 40 states of 96 each, and more

}  // namespace

double estimated_memory(const Scene& scene) {
  double per_needle = bytes_per_needle;
  // Without drawing them: there may be too many.
  const auto may_differ = [](const Species& s) { return s.sizes || s.drawn != DrawnSizes{}; };
  if (std::ranges::any_of(scene.species, may_differ)) per_needle += bytes_per_needle_of_own_numbers;
  if (!scene.output.file.empty()) {
    per_needle += bytes_per_needle_of_a_frame;
    if (scene.output.checkpoint_every > 0) per_needle += bytes_per_needle_of_a_checkpoint;
    const auto& names = scene.output.observables;
    const auto observes = [&](const char* name) {
      return std::find(names.begin(), names.end(), name) != names.end();
    };
    if (observes("displacement"))
      per_needle += (scene.output.size_classes ? 2 : 1) * bytes_per_needle_of_displacement;
    if (observes("time_correlation")) per_needle += bytes_per_needle_of_time_correlation;
  }
  return base_bytes + per_needle * static_cast<double>(scene.needles.count);
}

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

void require_memory(const Scene& scene) {
  const double needed = estimated_memory(scene);
  const double available = available_memory();
  if (needed <= available) return;
  throw InputError(
      fmt::format("{}: expected fewer: the run needs about {} of memory, and {} are available here",
                  place_of(scene, "needles.count", fmt::to_string(scene.needles.count)),
                  bytes_text(needed), bytes_text(available)));
}

}  // namespace needlework::runs
