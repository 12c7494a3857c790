#include "src/runs/progress_text.h"

#include <fmt/format.h>

#include <cmath>

#include "src/runs/duration_text.h"

namespace needlework::runs {

std::string progress_text(double fraction, double left, std::string_view more) {
  return fmt::format("{:4.1f} % done, {} left: {}", 100 * fraction, duration_text(left), more);
}

std::string whole_items(std::string text, std::size_t columns) {
  while (text.size() > columns) {
    const std::size_t last = text.rfind(", ");
    text.resize(last == std::string::npos ? columns : last);
  }
  return text;
}

std::string progress_text(const Progress& progress) {
  const Totals& now = progress.now;
  std::string text = fmt::format("{} collisions", now.collisions);
  if (const auto& growth = progress.growth) {
    text += fmt::format(", packing {:.4f}", growth->packing_fraction);
    if (!std::isnan(growth->pressure))
      text += fmt::format(", P V / (N T) {:.3g}", growth->pressure);
  }
  text += fmt::format(", drift E {:.0e}", progress.energy_drift);
  if (std::isfinite(progress.momentum_drift)) {
    text += fmt::format(", P {:.0e}", progress.momentum_drift);
  }
  text += fmt::format(", time {:.4g}", now.time);
  if (now.energy < 0.999 * progress.initial.energy) {
    text += fmt::format(", E/E(0) = {:.3g}", now.energy / progress.initial.energy);
  }
  text += fmt::format(", {:.3g}/s", progress.rate);
  if (progress.since_checkpoint) {
    text += fmt::format(", saved {} ago", duration_text(*progress.since_checkpoint));
  }
  return progress_text(progress.fraction, progress.left, text);
}

}  // namespace needlework::runs
