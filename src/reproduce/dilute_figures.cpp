// Figure 2: cooling of the dilute gas.
#include <algorithm>
#include <cmath>

#include "needlework/theory.h"
#include "src/reproduce/all_figures.h"
#include "src/reproduce/course.h"

namespace needlework::reproduce {
namespace {

using picture::Curve;

constexpr double first_tau = 1;   // what is earlier is the start
constexpr double late_tau = 100;  // both temperatures fall as one from here on

std::vector<theory::Temperatures> theory_of(const Scene& scene, std::span<const double> taus) {
  return theory::cooling_curve({scene.needles.k, scene.collisions.epsilon, scene.collisions.beta},
                               {1.0, scene.initial.t_rot / scene.initial.t_tr}, taus);
}

// The slope of ln y over ln x where x is at least `from`, by least squares.
double exponent(std::span<const double> x, std::span<const double> y, double from) {
  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (x[i] < from) continue;
    const double lx = std::log(x[i]), ly = std::log(y[i]);
    n += 1, sx += lx, sy += ly, sxx += lx * lx, sxy += lx * ly;
  }
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

std::vector<double> energies_of(const FinishedRun& run) {
  std::vector<double> energies;
  for (const Totals& sample : run.series)
    energies.push_back(sample.energy / run.scene->initial.t_tr);
  return energies;
}

// Samples that all runs of the point have, without the start: they are at the same times.
std::size_t common_samples(const Point& point) {
  std::size_t count = point.runs.empty() ? 0 : point.runs.front().series.size();
  for (const FinishedRun& run : point.runs) count = std::min(count, run.series.size() - 1);
  return count;
}

// The time at which T_rot / T_tr has come as near to 1 / c as 1 - 1/e of its way from 0.
double time_to_share(const FinishedRun& run, double c) {
  std::vector<double> log_taus, shares;
  const std::vector<double> taus = taus_of(run);
  for (std::size_t n = 1; n < taus.size(); ++n) {
    log_taus.push_back(std::log10(taus[n]));
    shares.push_back(run.series[n].t_rot / run.series[n].t_tr);
    if (shares.back() > (1 - std::exp(-1)) / c) break;
  }
  return interpolated(shares, log_taus, (1 - std::exp(-1)) / c);
}

double log_tc_collisions(const FinishedRun& run) {
  return std::log10(static_cast<double>(run.series.back().tc_collisions));
}

// T_tr / T_rot from `late_tau` on, over c.
double late_ratio_over_theory(const FinishedRun& run, double c) {
  const std::vector<double> taus = taus_of(run);
  double sum = 0, count = 0;
  for (std::size_t n = 0; n < taus.size(); ++n) {
    if (taus[n] < late_tau) continue;
    sum += std::log(run.series[n].t_tr / run.series[n].t_rot);
    ++count;
  }
  return std::exp(sum / count) / c;
}

/// Curves of figure 2, and where they are farthest from theory.
struct Cooling {
  Curve energy{"simulation", Curve::Style::points}, energy_theory{"theory"};
  Curve ratio{"simulation", Curve::Style::points}, ratio_theory{"theory"};
  Curve energy_over_theory{"E", Curve::Style::points},
      ratio_over_theory{"T_{tr} / T_{rot}", Curve::Style::points};
  Measured farthest{1, 0, {}}, farthest_ratio{1, 0, {}};
};

void add(Curve& curve, double x, const Measured& y) {
  curve.x.push_back(x), curve.y.push_back(y.value), curve.error.push_back(y.error);
}

void add(Curve& curve, double x, double y) { curve.x.push_back(x), curve.y.push_back(y); }

Measured operator/(const Measured& measured, double number) {
  return {measured.value / number, measured.error / number, measured.seeds};
}

void keep_farthest(Measured& farthest, const Measured& now) {
  if (std::abs(now.value - 1) >= std::abs(farthest.value - 1)) farthest = now;
}

Cooling cooling_of(const Point& point, Table& table) {
  Cooling curves;
  const std::vector<double> taus = taus_of(point.runs.front());
  const auto theory = theory_of(*point.scene, taus);
  for (std::size_t n = 1; n < common_samples(point); ++n) {
    const Measured e = measure(point, [&](const FinishedRun& run) { return energies_of(run)[n]; });
    const Measured q = measure(
        point, [&](const FinishedRun& run) { return run.series[n].t_tr / run.series[n].t_rot; });
    const double e_theory = theory[n].energy(), q_theory = theory[n].t_tr / theory[n].t_rot;
    table.rows.push_back({taus[n], e.value, e.error, e_theory, q.value, q.error, q_theory});
    add(curves.energy, taus[n], e), add(curves.energy_theory, taus[n], e_theory);
    add(curves.ratio, taus[n], q), add(curves.ratio_theory, taus[n], q_theory);
    if (taus[n] < first_tau) continue;
    add(curves.energy_over_theory, taus[n], e / e_theory);
    add(curves.ratio_over_theory, taus[n], q / q_theory);
    keep_farthest(curves.farthest, e / e_theory);
    keep_farthest(curves.farthest_ratio, q / q_theory);
  }
  return curves;
}

}  // namespace

FigureResult make_cooling(const PaperRuns& runs) {
  const Point point = runs.points("dilute").front();
  const Scene& scene = *point.scene;
  const double c = theory::asymptotic_ratio({scene.needles.k, scene.collisions.epsilon});

  FigureResult result;
  result.table.columns = {"tau",   "energy",      "energy_error", "energy_theory",
                          "ratio", "ratio_error", "ratio_theory"};
  const Cooling curves = cooling_of(point, result.table);
  result.chart = {.title = "Cooling of the dilute gas: simulation and theory",
                  .description =
                      "Energy of the needles and ratio of their temperatures against scaled time, "
                      "simulated and by kinetic theory, and both divided by theory.",
                  .panels = {{.title = "Energy",
                              .x = {"τ", true},
                              .y = {"E / T_{tr}(0)", true},
                              .curves = {curves.energy, curves.energy_theory}},
                             {.title = "Ratio of temperatures",
                              .x = {"τ", true},
                              .y = {"T_{tr} / T_{rot}", true},
                              .curves = {curves.ratio, curves.ratio_theory}},
                             {.title = "Simulation over theory",
                              .x = {"τ", true},
                              .y = {"simulation / theory"},
                              .curves = {curves.energy_over_theory, curves.ratio_over_theory}}}};

  const auto over_seeds = [&](double (*number)(const FinishedRun&, double)) {
    return measure(point, [&](const FinishedRun& run) { return number(run, c); });
  };
  const Measured haff = measure(point, [](const FinishedRun& run) {
    const std::vector<double> taus = taus_of(run);
    return exponent(taus, energies_of(run), taus.back() / 1000);
  });
  result.measurements = {{"energy-theory", "", curves.farthest},
                         {"ratio-theory", "", over_seeds(late_ratio_over_theory)},
                         {"ratio-theory-start", "", curves.farthest_ratio},
                         {"ratio-time", "", over_seeds(time_to_share)},
                         {"haff-dilute", "", haff},
                         {"tc-instances", "dilute", measure(point, log_tc_collisions)}};
  return result;
}

}  // namespace needlework::reproduce
