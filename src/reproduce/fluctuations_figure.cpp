// Fluctuations of the dilute gas, local density, flow and energy, beside those of an elastic gas.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "src/reproduce/all_figures.h"
#include "src/reproduce/course.h"

namespace needlework::reproduce {
namespace {

using picture::Curve;

constexpr double cold = 1e-5;  // E/E(0) of the late part of the cooling gas

// What a cell has of a local quantity, in units in which an ideal gas has variance 1.
enum Local { density, velocity, energy };
constexpr std::array local_names{"density", "velocity", "energy"};
constexpr std::array local_labels{"(ρ − ⟨ρ⟩) / ⟨ρ⟩ · n^{1/2}", "U_{x} (n m / T_{tr})^{1/2}",
                                  "(e − ⟨e⟩) / ⟨e⟩ · (3 n / 2)^{1/2}"};

/// Sums over cells of a quantity.
struct Spread {
  static constexpr std::size_t bins = 40;

  double low = -5, high = 5;
  std::vector<double> counts = std::vector<double>(bins, 0.0);
  double n = 0, square = 0;

  void add(double x) {
    n += 1, square += x * x;
    const double bin = (x - low) / (high - low) * bins;
    if (bin >= 0 && bin < bins) ++counts[static_cast<std::size_t>(bin)];
  }
  double variance() const { return square / n; }
};

using Spreads = std::array<Spread, 3>;

double needles_per_cell(const Scene& scene) {
  double cells = 1;
  for (const int along : *scene.output.grid) cells *= along;
  return static_cast<double>(scene.needles.count) / cells;
}

// Of the density, a bin for each number of needles in a cell.
Spreads no_spreads(double mean) {
  Spreads spreads;
  spreads[density].low = (-0.5 - mean) / std::sqrt(mean);
  spreads[density].high = (Spread::bins - 0.5 - mean) / std::sqrt(mean);
  return spreads;
}

// Over all cells and the samples that `counts_in` chooses.
Spreads spreads_of(const FinishedRun& run, const std::function<bool(const Totals&)>& counts_in) {
  const io::RecordedField rho = run.field("fields/density"), flow = run.field("fields/flow"),
                          thermal = run.field("fields/thermal_tr");
  const double n = needles_per_cell(*run.scene);
  Spreads spreads = no_spreads(n);
  for (std::size_t sample = 0; sample < rho.times.size(); ++sample) {
    const Totals& now = run.series[sample];
    if (!counts_in(now)) continue;
    const auto density_row = rho.row(sample), flow_row = flow.row(sample),
               thermal_row = thermal.row(sample);
    double mean = 0;
    for (const double x : density_row) mean += x / static_cast<double>(density_row.size());
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
  SpreadsOfRuns all{no_spreads(needles_per_cell(*point.scene)), {}};
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

Curve histogram(const Spread& spread, const char* name) {
  Curve curve{name, Curve::Style::steps, steps(spread.low, spread.high, Spread::bins)};
  const double width = (spread.high - spread.low) / Spread::bins;
  for (const double count : spread.counts) curve.y.push_back(count / spread.n / width);
  return curve;
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
  result.table.rows.resize(Spread::bins);
  result.chart.title = "Local fluctuations: cooling gas and elastic gas";
  result.chart.description =
      "Histograms over the cells of the density, the flow velocity and the energy of translation, "
      "of the cooling gas after it has lost all but 1e-5 of its energy, and of an elastic gas.";
  for (std::size_t q = 0; q < 3; ++q) {
    const Curve cool = histogram(cooled.pooled[q], "cooling"),
                warm = histogram(equal.pooled[q], "elastic");
    for (const char* column : {"value", "cooling", "elastic"}) {
      result.table.columns.push_back(fmt::format("{}_{}", local_names[q], column));
    }
    for (std::size_t bin = 0; bin < Spread::bins; ++bin) {
      const double middle = (cool.x[bin] + cool.x[bin + 1]) / 2;
      auto& row = result.table.rows[bin];
      row.insert(row.end(), {middle, cool.y[bin], warm.y[bin]});
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
