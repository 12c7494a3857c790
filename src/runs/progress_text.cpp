#include "src/runs/progress_text.h"

#include <fmt/format.h>

#include "src/runs/amount_text.h"

namespace needlework::runs {

std::string progress_text(double elapsed, double fraction, std::string_view more) {
  const double left = elapsed / fraction - elapsed;  // infinite at 0, and then not known
  return fmt::format("{:4.1f} % done, {} left: {}", 100 * fraction, duration_text(left), more);
}

std::string progress_of_run(const Totals& now, double initial_energy) {
  std::string text = fmt::format("{} collisions, time {:.4g}", now.collisions, now.time);
  if (now.energy < 0.999 * initial_energy) {
    text += fmt::format(", E/E(0) = {:.3g}", now.energy / initial_energy);
  }
  return text;
}

}  // namespace needlework::runs
