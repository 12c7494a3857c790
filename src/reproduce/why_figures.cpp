// Whether what the paper leaves open explains differences: the contact time t_c and the cells.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "needlework/h5md.h"
#include "needlework/theory.h"
#include "src/observe/grid.h"
#include "src/observe/vector.h"
#include "src/reproduce/all_figures.h"
#include "src/reproduce/cells.h"
#include "src/reproduce/course.h"

namespace needlework::reproduce {
namespace {

using picture::Curve;

constexpr double standard_energy = 1e-4;     // E/E(0) at which dilute gases are compared
constexpr double standard_collisions = 400;  // per needle, at which dense gases are

std::vector<double> theory_energies(const Scene& scene, std::span<const double> taus) {
  std::vector<double> energies;
  for (const auto& now : theory::cooling_curve({scene.needles.k, scene.collisions.epsilon},
                                               {scene.initial.t_tr, scene.initial.t_rot}, taus)) {
    energies.push_back(now.energy());
  }
  return energies;
}

// E / E_theory at the scaled time at which theory has lost all but `standard_energy`.
double energy_over_theory(const FinishedRun& run) {
  const std::vector<double> theory = theory_energies(*run.scene, taus_of(run));
  std::size_t n = 0;
  while (n + 1 < theory.size() && theory[n] > standard_energy * theory[0]) ++n;
  return run.series[n].energy / theory[n];
}

double tc_share(const FinishedRun& run) {
  const Totals& last = run.series.back();
  return static_cast<double>(last.tc_collisions) / static_cast<double>(last.collisions);
}

// A point with those of its runs whose seeds another one has too, so that means are over the same
// initial states.
Point with_seeds_of(Point point, const Point& other) {
  std::erase_if(point.runs, [&](const FinishedRun& run) {
    return std::none_of(other.runs.begin(), other.runs.end(),
                        [&](const FinishedRun& its) { return its.seed == run.seed; });
  });
  return point;
}

struct Case {
  std::string name;
  Point point;
};

Case case_of(Point point) {
  const double tc = *point.scene->collisions.tc_relative;
  return {fmt::format("t_c = {:g} mean free times", tc), std::move(point)};
}

// Those of a set and, with the same seeds, the first point of another one.
std::vector<Case> cases_of(const PaperRuns& runs, const std::string& set,
                           const std::string& reference) {
  std::vector<Case> cases;
  for (Point& point : runs.points(set)) cases.push_back(case_of(point));
  cases.push_back(case_of(with_seeds_of(runs.points(reference).front(), cases.front().point)));
  return cases;
}

// The mean over seeds of a number of flow_order over its start.
MeanCurve growth_curve(const Point& point, const std::string& name,
                       std::span<const double> places) {
  return mean_curve(point, places, [&](const FinishedRun& run) {
    std::vector<double> values = run.field("flow_order/" + name).values;
    const double start = values.front();
    for (double& value : values) value /= start;
    return std::pair{collisions_of(run), values};
  });
}

// S of a frame with another number of cells along each axis.
double flow_order_of(const State& state, int cells) {
  const observe::CellMeans means =
      observe::means_in_cells(observe::Grid(state.box, {cells, cells, cells}), state);
  double flow = 0, thermal = 0;
  for (std::size_t cell = 0; cell < means.count.size(); ++cell) {
    flow += means.count[cell] * observe::dot(means.flow[cell], means.flow[cell]);
    thermal += means.count[cell] * means.flow_v2[cell];
  }
  return flow / thermal;
}

// The growth of S until the frame next to 600 collisions per needle, with so many cells.
double growth_with_cells(const FinishedRun& run, int cells) {
  const io::FrameFile frames(run.file);
  const std::size_t frame = frame_near(run, frames, shown_collisions);
  return flow_order_of(frames.read(frame), cells) / flow_order_of(frames.read(0), cells);
}

}  // namespace

FigureResult make_cells(const PaperRuns& runs) {
  const Point point = runs.points("dense").front();
  FigureResult result;
  result.table.columns = {"cells", "needles_per_cell", "growth", "error"};
  Curve curve{"", Curve::Style::points};
  for (const int cells : {8, 9, 10, 12}) {
    const Measured growth =
        measure(point, [&](const FinishedRun& run) { return growth_with_cells(run, cells); });
    const double occupation =
        static_cast<double>(point.scene->needles.count) / (cells * cells * cells);
    result.table.rows.push_back(
        {static_cast<double>(cells), occupation, growth.value, growth.error});
    curve.x.push_back(occupation), curve.y.push_back(growth.value);
    curve.error.push_back(growth.error);
    result.measurements.push_back(
        {"flow-order-growth", fmt::format("test, {} cells along each axis", cells), growth});
  }
  result.chart = {.title = "Growth of S and the size of the cells",
                  .description =
                      "S over S at the start, about 600 collisions per needle, against "
                      "the mean number of needles in a cell.",
                  .panels = {{.x = {"needles per cell"}, .y = {"S / start"}, .curves = {curve}}}};
  return result;
}

FigureResult make_contact_time_dilute(const PaperRuns& runs) {
  FigureResult result;
  result.table.columns = {"tc_relative", "tau", "energy_over_theory", "error"};
  picture::Panel panel{.x = {"τ", true}, .y = {"E / theory"}};
  for (const Case& one : cases_of(runs, "dilute-tc", "dilute")) {
    Curve curve{one.name};
    const std::vector<double> taus = taus_of(one.point.runs.front());
    const std::vector<double> theory = theory_energies(*one.point.scene, taus);
    for (std::size_t n = 1; n < taus.size(); ++n) {
      if (taus[n] < 1 || theory[n] < 2e-5 * theory[0]) continue;
      const Measured off = measure(
          one.point, [&](const FinishedRun& run) { return run.series.at(n).energy / theory[n]; });
      curve.x.push_back(taus[n]), curve.y.push_back(off.value);
      result.table.rows.push_back(
          {*one.point.scene->collisions.tc_relative, taus[n], off.value, off.error});
    }
    panel.curves.push_back(curve);
    result.measurements.push_back(
        {"energy-theory", "test, " + one.name, measure(one.point, energy_over_theory)});
    result.measurements.push_back(
        {"tc-share", "dilute, " + one.name, measure(one.point, tc_share)});
  }
  result.chart = {.title = "Energy of the dilute gas over theory, for three contact times",
                  .description =
                      "Simulated energy divided by that of theory against scaled time; "
                      "means over the same three seeds.",
                  .panels = {panel},
                  .panel_width = 560};
  return result;
}

FigureResult make_contact_time_dense(const PaperRuns& runs) {
  FigureResult result;
  result.table.columns = {"tc_relative", "collisions", "s", "s_error", "moment", "moment_error"};
  picture::Panel s{
      .title = "Order of the flow", .x = {"collisions per needle"}, .y = {"S / start"}};
  picture::Panel moment{.title = "Second moment of the density",
                        .x = {"collisions per needle"},
                        .y = {"second moment / start"}};
  const std::vector<double> places = steps(0, standard_collisions, 40);
  for (const Case& one : cases_of(runs, "dense-tc", "dense")) {
    const MeanCurve s_curve = growth_curve(one.point, "translational", places),
                    moment_curve = growth_curve(one.point, "second_moment", places);
    s.curves.push_back({one.name, Curve::Style::line, s_curve.x, s_curve.mean});
    moment.curves.push_back({one.name, Curve::Style::line, moment_curve.x, moment_curve.mean});
    for (std::size_t n = 0; n < places.size(); ++n) {
      result.table.rows.push_back({*one.point.scene->collisions.tc_relative, places[n],
                                   s_curve.mean[n], s_curve.error[n], moment_curve.mean[n],
                                   moment_curve.error[n]});
    }
    const std::string variant = fmt::format("test, {}, at {:g}", one.name, standard_collisions);
    const std::size_t seeds = one.point.runs.size();
    result.measurements.push_back(
        {"flow-order-growth", variant, {s_curve.mean.back(), s_curve.error.back(), seeds}});
    result.measurements.push_back(
        {"moment-growth", variant, {moment_curve.mean.back(), moment_curve.error.back(), seeds}});
    result.measurements.push_back({"tc-share", "dense, " + one.name, measure(one.point, tc_share)});
  }
  result.chart = {.title = "The dense gas with another contact time",
                  .description =
                      "Growth of the order of the flow and of the second moment of the "
                      "density, for two contact times; k = 6, T_rot(0) = 1.",
                  .panels = {s, moment}};
  return result;
}

}  // namespace needlework::reproduce
