#include "src/observe/completion.h"

#include <algorithm>
#include <cmath>

namespace needlework {
namespace {

double fraction_of_time(double time, double end, double energy_ratio) {
  if (!(end > 0)) return 1;
  const double slowing = 1 / std::sqrt(energy_ratio) - 1;  // t / t0
  const bool cools = std::isfinite(slowing) && slowing > 1e-6;
  return cools ? std::log1p(slowing) / std::log1p(slowing * (end / time)) : time / end;
}

}  // namespace

double completed_fraction(const Scene::Until& until, const Totals& initial, const Totals& now,
                          double count, double elapsed) {
  double fraction = 0;
  const auto reach = [&](double part) {
    if (part > fraction) fraction = std::min(part, 1.0);  // false for NaN
  };
  const double energy_ratio = initial.energy > 0 ? now.energy / initial.energy : 1;
  if (until.time) reach(fraction_of_time(now.time, *until.time, energy_ratio));
  if (until.collisions_per_needle) {
    reach(2 * static_cast<double>(now.collisions) / (count * *until.collisions_per_needle));
  }
  if (until.energy_ratio) reach(std::log(energy_ratio) / std::log(*until.energy_ratio));
  if (until.wall_s) reach(elapsed / *until.wall_s);
  return fraction;
}

}  // namespace needlework
