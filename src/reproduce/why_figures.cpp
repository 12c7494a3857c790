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

// E / E_theory at the scaled time at which theory has lost all but `standard_energy`.
double energy_over_theory(const FinishedRun& run) {
  const Scene& scene = *run.scene;
  const std::vector<double> taus = taus_of(run);
  const auto theory = theory::cooling_curve({scene.needles.k, scene.collisions.epsilon},
                                            {scene.initial.t_tr, scene.initial.t_rot}, taus);
  std::size_t n = 0;
  while (n + 1 < taus.size() && theory[n].energy() > standard_energy * theory[0].energy()) ++n;
  return run.series[n].energy / theory[n].energy();
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

FigureResult make_tests_of_why(const PaperRuns& runs) {
  FigureResult result;
  result.table.columns = {"tc_relative", "collisions", "s", "s_error", "moment", "moment_error"};
  const Point reference = runs.points("dense").front(), dilute = runs.points("dilute").front();

  std::vector<Case> cases, dilute_cases;
  for (Point& point : runs.points("dense-tc")) cases.push_back(case_of(point));
  cases.push_back(case_of(with_seeds_of(reference, cases.front().point)));
  for (Point& point : runs.points("dilute-tc")) dilute_cases.push_back(case_of(point));
  dilute_cases.push_back(case_of(with_seeds_of(dilute, dilute_cases.front().point)));

  picture::Panel s{
      .title = "Order of the flow", .x = {"collisions per needle"}, .y = {"S / start"}};
  picture::Panel moment{.title = "Second moment of the density",
                        .x = {"collisions per needle"},
                        .y = {"second moment / start"}};
  const std::vector<double> places = steps(0, standard_collisions, 40);
  for (const Case& one : cases) {
    const auto growth = [&](const char* name) {
      return mean_curve(one.point, places, [&](const FinishedRun& run) {
        std::vector<double> values = run.field(std::string("flow_order/") + name).values;
        const double start = values.front();
        for (double& value : values) value /= start;
        return std::pair{collisions_of(run), values};
      });
    };
    const MeanCurve s_curve = growth("translational"), moment_curve = growth("second_moment");
    Curve line{one.name, Curve::Style::line, s_curve.x, s_curve.mean};
    s.curves.push_back(line);
    line.y = moment_curve.mean;
    moment.curves.push_back(line);
    for (std::size_t n = 0; n < places.size(); ++n) {
      result.table.rows.push_back({*one.point.scene->collisions.tc_relative, places[n],
                                   s_curve.mean[n], s_curve.error[n], moment_curve.mean[n],
                                   moment_curve.error[n]});
    }
    const auto add = [&](const char* claim, const std::function<double(const FinishedRun&)>& f) {
      result.measurements.push_back(
          {claim, fmt::format("test, dense, {}, at {:g}", one.name, standard_collisions),
           measure(one.point, f)});
    };
    const auto growth_of = [](const char* name) {
      return [name](const FinishedRun& run) {
        const std::vector<double> values = run.field(std::string("flow_order/") + name).values;
        return interpolated(collisions_of(run), values, standard_collisions) / values.front();
      };
    };
    add("flow-order-growth", growth_of("translational"));
    add("moment-growth", growth_of("second_moment"));
    add("tc-share", tc_share);
  }
  for (const int cells : {8, 9, 10, 12}) {
    result.measurements.push_back(
        {"flow-order-growth", fmt::format("test, dense, {} cells along each axis", cells),
         measure(reference,
                 [&](const FinishedRun& run) { return growth_with_cells(run, cells); })});
  }
  for (const Case& one : dilute_cases) {
    result.measurements.push_back(
        {"energy-theory", "test, dilute, " + one.name, measure(one.point, energy_over_theory)});
    result.measurements.push_back(
        {"tc-share", "test, dilute, " + one.name, measure(one.point, tc_share)});
  }
  result.chart = {.title = "Does the contact time matter?",
                  .description =
                      "Growth of the order of the flow and of the second moment of the "
                      "density, for two contact times; k = 6, "
                      "T_rot(0) = 1.",
                  .panels = {s, moment}};
  return result;
}

}  // namespace needlework::reproduce
