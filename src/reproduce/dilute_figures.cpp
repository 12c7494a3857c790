// Figure 2 and what the text says of the dilute gas.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "needlework/theory.h"
#include "src/reproduce/all_figures.h"
#include "src/reproduce/course.h"

namespace needlework::reproduce {
namespace {

using picture::Curve;

constexpr double first_tau = 1;   // what is earlier is the start
constexpr double late_tau = 100;  // both temperatures fall as one from here on
constexpr double cold = 1e-5;     // E/E(0) of the late part of the cooling gas

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

}  // namespace

FigureResult make_cooling(const PaperRuns& runs) {
  const Point point = runs.points("dilute").front();
  const Scene& scene = *point.scene;
  const double c = theory::asymptotic_ratio({scene.needles.k, scene.collisions.epsilon});

  FigureResult result;
  result.table.columns = {"tau",   "energy",      "energy_error", "energy_theory",
                          "ratio", "ratio_error", "ratio_theory"};
  Curve energy{"simulation", Curve::Style::points}, energy_theory{"theory"};
  Curve ratio = energy, ratio_theory = energy_theory;
  ratio_theory.colour = energy_theory.colour = 1;
  ratio.colour = energy.colour = 0;
  const std::vector<double> taus = taus_of(point.runs.front());
  const auto theory = theory_of(scene, taus);
  Measured worst{1, 0, point.runs.size()};
  for (std::size_t n = 1; n < common_samples(point); ++n) {
    const Measured e = measure(point, [&](const FinishedRun& run) { return energies_of(run)[n]; });
    const Measured q = measure(
        point, [&](const FinishedRun& run) { return run.series[n].t_tr / run.series[n].t_rot; });
    const double e_theory = theory[n].energy(), q_theory = theory[n].t_tr / theory[n].t_rot;
    result.table.rows.push_back({taus[n], e.value, e.error, e_theory, q.value, q.error, q_theory});
    energy.x.push_back(taus[n]), energy.y.push_back(e.value), energy.error.push_back(e.error);
    ratio.x.push_back(taus[n]), ratio.y.push_back(q.value), ratio.error.push_back(q.error);
    energy_theory.x.push_back(taus[n]), energy_theory.y.push_back(e_theory);
    ratio_theory.x.push_back(taus[n]), ratio_theory.y.push_back(q_theory);
    const double off = e.value / e_theory;
    if (taus[n] >= first_tau && std::abs(off - 1) > std::abs(worst.value - 1)) {
      worst = {off, e.error / e_theory, e.seeds};
    }
  }
  result.chart = {.title = "Cooling of the dilute gas: simulation and theory",
                  .description =
                      "Energy of the needles and ratio of their temperatures against scaled time, "
                      "simulated and by kinetic theory.",
                  .panels = {{.title = "Energy",
                              .x = {"τ", true},
                              .y = {"E / T_{tr}(0)", true},
                              .curves = {energy, energy_theory}},
                             {.title = "Ratio of temperatures",
                              .x = {"τ", true},
                              .y = {"T_{tr} / T_{rot}", true},
                              .curves = {ratio, ratio_theory}}}};

  const Measured late_ratio = measure(point, [&](const FinishedRun& run) {
    const std::vector<double> times = taus_of(run);
    double sum = 0, count = 0;
    for (std::size_t n = 0; n < times.size(); ++n) {
      if (times[n] < late_tau) continue;
      sum += std::log(run.series[n].t_tr / run.series[n].t_rot);
      ++count;
    }
    return std::exp(sum / count) / c;
  });
  result.measurements = {
      {"energy-theory", "", worst},
      {"ratio-theory", "", late_ratio},
      {"ratio-time", "",
       measure(point, [&](const FinishedRun& run) { return time_to_share(run, c); })},
      {"haff-dilute", "",
       measure(point,
               [&](const FinishedRun& run) {
                 const std::vector<double> times = taus_of(run);
                 return exponent(times, energies_of(run), times.back() / 1000);
               })},
      {"tc-instances", "dilute", measure(point, log_tc_collisions)}};
  return result;
}

namespace {

// What a cell has of a local quantity, in units in which an ideal gas has variance 1.
enum Local { density, velocity, energy };
constexpr std::array local_names{"density", "velocity", "energy"};
constexpr std::array local_labels{"(ρ − ⟨ρ⟩) / ⟨ρ⟩ · n^{1/2}", "U_{x} (n m / T_{tr})^{1/2}",
                                  "(e − ⟨e⟩) / ⟨e⟩ · (3 n / 2)^{1/2}"};

/// Sums over cells of a quantity.
struct Spread {
  std::vector<double> counts = std::vector<double>(bins, 0.0);
  double n = 0, square = 0;
  static constexpr std::size_t bins = 40;
  static constexpr double limit = 5;

  void add(double x) {
    n += 1, square += x * x;
    const double bin = (x + limit) / (2 * limit) * bins;
    if (bin >= 0 && bin < bins) ++counts[static_cast<std::size_t>(bin)];
  }
  double variance() const { return square / n; }
};

using Spreads = std::array<Spread, 3>;

// Over all cells and the samples that `counts_in` chooses.
Spreads spreads_of(const FinishedRun& run, const std::function<bool(const Totals&)>& counts_in) {
  const io::RecordedField rho = run.field("fields/density"), flow = run.field("fields/flow"),
                          thermal = run.field("fields/thermal_tr");
  Spreads spreads;
  for (std::size_t sample = 0; sample < rho.times.size(); ++sample) {
    const Totals& now = run.series[sample];
    if (!counts_in(now)) continue;
    const auto density_row = rho.row(sample), flow_row = flow.row(sample),
               thermal_row = thermal.row(sample);
    double mean = 0;
    for (const double x : density_row) mean += x / static_cast<double>(density_row.size());
    const double n =
        static_cast<double>(run.scene->needles.count) / static_cast<double>(density_row.size());
    for (std::size_t cell = 0; cell < density_row.size(); ++cell) {
      spreads[density].add((density_row[cell] / mean - 1) * std::sqrt(n));
      const double u[3] = {flow_row[3 * cell], flow_row[3 * cell + 1], flow_row[3 * cell + 2]};
      const double in_cell = density_row[cell] / mean * n;
      for (const double component : u) {
        spreads[velocity].add(component * std::sqrt(in_cell / now.t_tr));
      }
      const double e = thermal_row[cell] + (u[0] * u[0] + u[1] * u[1] + u[2] * u[2]) / 2;
      if (in_cell > 0) {
        spreads[energy].add((e / (1.5 * now.t_tr) - 1) * std::sqrt(1.5 * in_cell));
      }
    }
  }
  return spreads;
}

struct SpreadsOfRuns {
  Spreads pooled;
  std::array<std::vector<double>, 3> variances;  ///< of each run
};

SpreadsOfRuns spreads_of(const Point& point, const std::function<bool(const Totals&)>& counts_in) {
  SpreadsOfRuns all;
  for (const FinishedRun& run : point.runs) {
    const Spreads spreads = spreads_of(run, counts_in);
    for (std::size_t q = 0; q < 3; ++q) {
      all.variances[q].push_back(spreads[q].variance());
      all.pooled[q].n += spreads[q].n;
      for (std::size_t bin = 0; bin < Spread::bins; ++bin) {
        all.pooled[q].counts[bin] += spreads[q].counts[bin];
      }
    }
  }
  return all;
}

// The ratio of two means with its joint standard error.
Measured ratio_of(const Measured& a, const Measured& b) {
  const double ratio = a.value / b.value;
  return {ratio, std::abs(ratio) * std::hypot(a.error / a.value, b.error / b.value),
          std::min(*a.seeds, *b.seeds)};
}

}  // namespace

FigureResult make_fluctuations(const PaperRuns& runs) {
  const Point cooling = runs.points("dilute").front();
  const Point elastic = runs.points("elastic").front();
  const auto cold_part = [&](const Totals& now) {
    return now.energy <= cold * cooling.runs.front().series.front().energy;
  };
  const SpreadsOfRuns cooled = spreads_of(cooling, cold_part);
  const SpreadsOfRuns before =
      spreads_of(cooling, [&](const Totals& now) { return !cold_part(now); });
  const SpreadsOfRuns equal = spreads_of(elastic, [](const Totals&) { return true; });

  FigureResult result;
  result.table.columns = {"value"};
  for (const char* name : local_names) {
    result.table.columns.push_back(fmt::format("{}_cooling", name));
    result.table.columns.push_back(fmt::format("{}_elastic", name));
  }
  const std::vector<double> edges = steps(-Spread::limit, Spread::limit, Spread::bins);
  for (std::size_t bin = 0; bin < Spread::bins; ++bin) {
    result.table.rows.push_back({(edges[bin] + edges[bin + 1]) / 2});
  }
  result.chart.title = "Local fluctuations: cooling gas and elastic gas";
  result.chart.description =
      "Histograms over the cells of the density, the flow velocity and the energy of translation, "
      "of the cooling gas after it has lost all but 1e-5 of its energy, and of an elastic gas.";
  for (std::size_t q = 0; q < 3; ++q) {
    const auto density_of = [&](const Spread& spread, const char* name) {
      Curve curve{name, Curve::Style::steps, edges, {}};
      const double width = edges[1] - edges[0];
      for (const double count : spread.counts) curve.y.push_back(count / spread.n / width);
      return curve;
    };
    const Curve cool = density_of(cooled.pooled[q], "cooling"),
                warm = density_of(equal.pooled[q], "elastic");
    for (std::size_t bin = 0; bin < Spread::bins; ++bin) {
      result.table.rows[bin].push_back(cool.y[bin]);
      result.table.rows[bin].push_back(warm.y[bin]);
    }
    result.chart.panels.push_back({.title = local_names[q],
                                   .x = {local_labels[q]},
                                   .y = {"probability density"},
                                   .curves = {cool, warm}});
    const Measured here = mean_of(cooled.variances[q]);
    result.measurements.push_back(
        {"local-fluctuations", local_names[q], ratio_of(here, mean_of(equal.variances[q]))});
    result.measurements.push_back(
        {"stationary-fluctuations", local_names[q], ratio_of(here, mean_of(before.variances[q]))});
  }
  return result;
}

}  // namespace needlework::reproduce
