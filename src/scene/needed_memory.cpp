#include "src/scene/needed_memory.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "needlework/error.h"
#include "src/machine/available_memory.h"
#include "src/scene/check.h"

namespace needlework {
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

std::string bytes_text(double bytes) {
  static constexpr const char* units[] = {"bytes", "kB", "MB", "GB", "TB"};
  std::size_t unit = 0;
  while (bytes >= 999.5 && unit + 1 < std::size(units)) {
    bytes /= 1000;
    ++unit;
  }
  return fmt::format("{:.3g} {}", bytes, units[unit]);
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

}  // namespace needlework
