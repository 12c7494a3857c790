#include "src/cli/watched_run.h"

#include <cmath>
#include <utility>

#include "src/observe/forecast.h"
#include "src/runs/loaded_scene.h"

namespace needlework::cli {
namespace {

// An instant is kept if it is later than the last one by this factor; about two hundred a decade.
constexpr double factor_between = 1.0115;
// A rate is measured over at least so many collisions, so that chance changes it by a tenth.
constexpr std::uint64_t collisions_of_a_rate = 100;

void add(picture::Curve& curve, double x, double y) {
  curve.x.push_back(x);
  curve.y.push_back(y);
}

picture::Panel panel(const char* title, const picture::Curve& measured,
                     const picture::Curve* theory) {
  picture::Panel panel;
  panel.title = title;
  panel.x = {"time", true, {}};
  panel.y.logarithmic = true;
  if (theory) {
    panel.curves.push_back(*theory);
    panel.curves.back().name = "theory";
    panel.curves.back().colour = 0;
  }
  panel.curves.push_back(measured);
  panel.curves.back().name = "run";
  panel.curves.back().style = picture::Curve::Style::points;
  panel.curves.back().colour = 1;
  return panel;
}

}  // namespace

WatchedRun::WatchedRun(const Scene& scene, const Totals& initial, bool theory_holds)
    : initial_(initial), last_rate_(initial), needles_(static_cast<double>(scene.needles.count)) {
  const Composition composition = scene.composition();
  if (!theory_holds || !composition.is_needle_gas() || !scene.initial.file.empty() ||
      !(initial.energy > 0))
    return;
  const Restitution& rule = composition.restitution(0, 0);
  const theory::Gas gas{composition[0].k, rule.epsilon, rule.beta};
  const double density = runs::theory_density_of(scene);
  theory_.emplace(Theory{theory::CoolingCurve(gas, {initial.t_tr, initial.t_rot}),
                         density,
                         theory_time_scale(density),
                         gas.k,
                         {},
                         {},
                         {}});
}

void WatchedRun::add(const Totals& now) {
  add_rate(now);
  if (!(now.time > 0) || (size() > 0 && now.time < factor_between * energy_.x.back())) return;
  cli::add(energy_, now.time, now.energy / initial_.energy);
  cli::add(ratio_, now.time, now.t_tr / now.t_rot);
  if (theory_) add_theory(now.time);
}

void WatchedRun::add_rate(const Totals& now) {
  const double time = now.time - last_rate_.time;
  const auto collisions = now.collisions - last_rate_.collisions;
  if (collisions < collisions_of_a_rate || now.time < factor_between * last_rate_.time) return;
  cli::add(rate_, (last_rate_.time + now.time) / 2,
           2 * static_cast<double>(collisions) / (needles_ * time));
  last_rate_ = now;
}

void WatchedRun::add_theory(double time) {
  const theory::Temperatures t = theory_->curve.at(theory_->time_scale * time);
  cli::add(theory_->energy, time, t.energy() / initial_.energy);
  cli::add(theory_->ratio, time, t.t_tr / t.t_rot);
  cli::add(theory_->rate, time, theory::collision_rate(theory_->density, t, theory_->k));
}

std::vector<picture::Panel> WatchedRun::panels() const {
  return {panel("E/E(0)", energy_, theory_ ? &theory_->energy : nullptr),
          panel("T_tr/T_rot", ratio_, theory_ ? &theory_->ratio : nullptr),
          panel("collision rate", rate_, theory_ ? &theory_->rate : nullptr)};
}

}  // namespace needlework::cli
