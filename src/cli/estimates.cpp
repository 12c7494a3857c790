#include "src/cli/estimates.h"

#include <fmt/format.h>

#include <cmath>

#include "src/cli/engine_choice.h"
#include "src/cli/messages.h"
#include "src/cli/resources.h"
#include "src/error.h"

#include "src/scene/check.h"
namespace needlework::cli {
namespace {

// Measured from N = 1e4 to 1e6, rounded up: peak resident memory, and what each frame adds.
constexpr double base_bytes = 16e6;
constexpr double bytes_per_needle = 700;
constexpr double bytes_per_needle_of_a_frame = 300;

}  // namespace

double estimated_memory(const Scene& scene) {
  const double per_needle =
      bytes_per_needle + (scene.output.file.empty() ? 0 : bytes_per_needle_of_a_frame);
  return base_bytes + per_needle * static_cast<double>(scene.needles.count);
}

double estimated_seconds_per_collision(const Scene& scene, double density) {
  // The number of candidates grows with the density, or with the number of needles.
  if (resolved_search(scene.engine, density) == "all-pairs") {
    return 40e-6 + 0.042e-6 * static_cast<double>(scene.needles.count);
  }
  return 70e-6 + 11e-6 * density;
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

}  // namespace needlework::cli
