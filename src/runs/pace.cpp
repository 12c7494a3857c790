#include "src/runs/pace.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "src/composition/total_mass.h"
#include "src/observe/completion.h"
#include "src/scene/growth_plan.h"

namespace needlework::runs {
namespace {

// The change of the total momentum, over that of so many needles by chance.
double momentum_drift(const Totals& initial, const Totals& now, const Scene& scene) {
  const Composition composition = scene.composition();
  if (!scene.walls.empty() || scene.driving.andersen || composition.has_fixed()) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  double square = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double change = now.momentum[axis] - initial.momentum[axis];
    square += change * change;
  }
  const double scale = std::sqrt(total_mass(composition) * now.t_tr);
  return scale > 0 ? std::sqrt(square) / scale : 0;
}

}  // namespace

Pace::Pace(const Simulation& simulation, const Scene& scene, const Scene::Until& until,
           const Totals& initial)
    : simulation_(simulation),
      scene_(scene),
      until_(until),
      initial_(initial),
      fraction_before_(fraction_of(simulation.totals(), 0)),
      collisions_before_(simulation.collisions()) {}

double Pace::fraction_of(const Totals& now, double elapsed) const {
  const double count = static_cast<double>(scene_.needles.count);
  return std::max(completed_fraction(until_, initial_, now, count, elapsed), fraction_grown());
}

// By sizes and by the logarithm of the pressure, which collisions of bodies that are about to jam
// raise evenly.
double Pace::fraction_grown() const {
  const auto now = simulation_.growth();
  if (!now) return 0;
  const GrowthPlan plan = growth_plan(scene_, simulation_.composition(), simulation_.box());
  const double grown = plan.start < 1 ? (now->scale - plan.start) / (1 - plan.start)
                                      : (now->scale - 1) / (plan.largest - 1);
  const auto& most = scene_.driving.growth->until_pressure;
  const double pressed = most && now->pressure > 1 ? std::log(now->pressure) / std::log(*most) : 0;
  return std::clamp(std::max(grown, pressed), 0.0, 1.0);
}

Progress Pace::after(double elapsed) const {
  Progress progress;
  progress.elapsed = elapsed;
  progress.initial = initial_;
  progress.now = simulation_.totals();
  progress.fraction = fraction_of(progress.now, elapsed);
  const double done = std::max(progress.fraction - fraction_before_, 0.0);
  progress.left = elapsed * ((1 - progress.fraction) / done);  // infinite if nothing is done yet
  progress.rate = static_cast<double>(progress.now.collisions - collisions_before_) / elapsed;
  progress.growth = simulation_.growth();
  progress.energy_drift = simulation_.energy_drift();
  progress.momentum_drift = momentum_drift(initial_, progress.now, scene_);
  return progress;
}

}  // namespace needlework::runs
