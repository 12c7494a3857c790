// Figure 5 and what the text says of the dense gas as it goes on.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "needlework/theory.h"
#include "src/reproduce/all_figures.h"
#include "src/reproduce/cells.h"
#include "src/reproduce/course.h"

namespace needlework::reproduce {
namespace {

using picture::Curve;

// A number of flow_order, such as "translational", at the samples.
std::vector<double> order_of(const FinishedRun& run, const std::string& name) {
  return run.field("flow_order/" + name).values;
}

double order_at(const FinishedRun& run, const std::string& name, double collisions) {
  return interpolated(collisions_of(run), order_of(run, name), collisions);
}

double last_collisions(const Point& point) {
  double last = INFINITY;
  for (const FinishedRun& run : point.runs) last = std::min(last, collisions_of(run).back());
  return last;
}

/// Points with a name for the legend.
struct NamedPoint {
  std::string name;
  const Point* point;
};

/// What a number of flow_order is divided by.
enum class Unit { one, start, random };

// That of random velocities, for C cells and N needles: C / (N - C). A gas that starts without
// rotation has no order of it at the start.
double random_order(const Scene& scene) {
  double cells = 1;
  for (const int along : *scene.output.grid) cells *= along;
  return cells / (static_cast<double>(scene.needles.count) - cells);
}

std::vector<double> order_in(Unit unit, const FinishedRun& run, const std::string& name) {
  std::vector<double> values = order_of(run, name);
  const double divisor = unit == Unit::start    ? values.front()
                         : unit == Unit::random ? random_order(*run.scene)
                                                : 1;
  for (double& value : values) value /= divisor;
  return values;
}

// The mean over seeds of a number of flow_order over collisions, with its rows in the table, after
// the numbers in `key`.
Curve order_curve(const NamedPoint& named, const std::string& name, Unit unit,
                  const std::vector<double>& key, Table& table) {
  const Point& point = *named.point;
  const double last = last_collisions(point);
  const MeanCurve mean = mean_curve(
      point, steps(0, last, static_cast<std::size_t>(last / 10)), [&](const FinishedRun& run) {
        return std::pair{collisions_of(run), order_in(unit, run, name)};
      });
  Curve curve{named.name};
  curve.x = mean.x, curve.y = mean.mean;
  for (std::size_t n = 0; n < mean.x.size(); ++n) {
    std::vector<double> row = key;
    row.insert(row.end(), {mean.x[n], mean.mean[n], mean.error[n]});
    table.rows.push_back(row);
  }
  return curve;
}

std::vector<double> key_of(const Scene& scene) { return {scene.needles.k, scene.initial.t_rot}; }

// A chart of one number of flow_order for all starts, of which the figures of it differ in their
// measurements.
FigureResult order_figure(const std::vector<Point>& points, const std::string& name, Unit unit,
                          const std::string& title, const std::string& label) {
  FigureResult result;
  result.table.columns = {"k", "t_rot0", "collisions", "value", "error"};
  picture::Panel panel{.x = {"collisions per needle"}, .y = {label}};
  for (const Point& point : points) {
    panel.curves.push_back(order_curve({start_in_chart(*point.scene), &point}, name, unit,
                                       key_of(*point.scene), result.table));
  }
  result.chart = {.title = title,
                  .description = title +
                                 " against collisions per needle, means over seeds, for "
                                 "each start.",
                  .panels = {panel},
                  .panel_width = 560};
  return result;
}

std::string at(const std::string& start, double collisions) {
  return fmt::format("{}, at {:g}", start, collisions);
}

}  // namespace

FigureResult make_flow_order(const PaperRuns& runs) {
  const std::vector<Point> points = runs.points("dense");
  FigureResult result =
      order_figure(points, "translational", Unit::one, "Order of the flow S", "S");
  for (const Point& point : points) {
    const std::string start = start_of(*point.scene);
    result.measurements.push_back(
        {"flow-order-start", start, measure(point, [](const FinishedRun& run) {
           return order_of(run, "translational").front();
         })});
    for (const double collisions : {shown_collisions, shown_collisions_once}) {
      const auto now = [&](const FinishedRun& run) {
        return order_at(run, "translational", collisions);
      };
      result.measurements.push_back({"flow-order", at(start, collisions), measure(point, now)});
      result.measurements.push_back(
          {"flow-order-growth", at(start, collisions), measure(point, [&](const FinishedRun& run) {
             return now(run) / order_of(run, "translational").front();
           })});
    }
    result.measurements.push_back(
        {"tc-instances", "dense, " + start, measure(point, [](const FinishedRun& run) {
           return std::log10(static_cast<double>(run.series.back().tc_collisions));
         })});
  }
  return result;
}

FigureResult make_second_moment(const PaperRuns& runs) {
  const std::vector<Point> points = runs.points("dense");
  FigureResult result =
      order_figure(points, "second_moment", Unit::start,
                   "Second moment of the density over its start", "second moment / start");
  for (const Point& point : points) {
    const std::string start = start_of(*point.scene);
    for (const double reading : {1.0, 2.0}) {
      const double collisions = 400 * reading;
      result.measurements.push_back(
          {"moment-growth", at(start, collisions), measure(point, [&](const FinishedRun& run) {
             return order_at(run, "second_moment", collisions) /
                    order_of(run, "second_moment").front();
           })});
    }
    result.measurements.push_back(
        {"moment-peak", start, measure(point, [](const FinishedRun& run) {
           const std::vector<double> moment = order_of(run, "second_moment");
           const auto last =
               moment.begin() + static_cast<std::ptrdiff_t>(sample_near(run, shown_collisions));
           const auto peak = std::max_element(moment.begin(), last + 1) - moment.begin();
           return collisions_of(run)[static_cast<std::size_t>(peak)];
         })});
  }
  return result;
}

FigureResult make_rotation(const PaperRuns& runs) {
  const std::vector<Point> points = runs.points("dense");
  FigureResult result =
      order_figure(points, "rotational", Unit::random,
                   "Order of the rotation over that of random velocities", "order / random order");
  for (const Point& point : points) {
    for (const double collisions : {shown_collisions, shown_collisions_once}) {
      result.measurements.push_back(
          {"rotation-growth", at(start_of(*point.scene), collisions),
           measure(point, [&](const FinishedRun& run) {
             return order_at(run, "rotational", collisions) / random_order(*run.scene) - 1;
           })});
    }
  }
  return result;
}

namespace {

// How much slower than theory a temperature has fallen, as the logarithm of measured over theory.
struct Departure {
  double t_tr, t_rot;
};

Departure departure(const FinishedRun& run, double collisions) {
  const Scene& scene = *run.scene;
  const std::size_t sample = sample_near(run, collisions);
  const double tau[] = {taus_of(run)[sample]};
  const theory::Temperatures theory =
      theory::cooling_curve({scene.needles.k, scene.collisions.epsilon},
                            {scene.initial.t_tr, scene.initial.t_rot}, tau)
          .front();
  return {std::log(run.series[sample].t_tr / theory.t_tr),
          std::log(run.series[sample].t_rot / theory.t_rot)};
}

// d ln E / d ln C, with the collisions per needle C, between two numbers of collisions.
double late_exponent(const FinishedRun& run, double from, double to) {
  const std::vector<double> collisions = collisions_of(run);
  std::vector<double> energies;
  for (const Totals& sample : run.series) energies.push_back(std::log(sample.energy));
  return (interpolated(collisions, energies, to) - interpolated(collisions, energies, from)) /
         std::log(to / from);
}

}  // namespace

FigureResult make_dense_cooling(const PaperRuns& runs) {
  FigureResult result;
  result.table.columns = {"k",     "t_rot0",      "tau",          "t_tr",
                          "t_rot", "t_tr_theory", "t_rot_theory", "collisions"};
  result.chart = {.title = "Cooling of the dense gas",
                  .description =
                      "Temperatures of translation and rotation against scaled time, and "
                      "the law of Haff, for each start; one seed.",
                  .columns = 2};
  for (const Point& point : runs.points("dense")) {
    const Scene& scene = *point.scene;
    const FinishedRun& first = point.runs.front();
    const std::vector<double> taus = taus_of(first), collisions = collisions_of(first);
    const auto theory = theory::cooling_curve({scene.needles.k, scene.collisions.epsilon},
                                              {scene.initial.t_tr, scene.initial.t_rot}, taus);
    Curve t_tr{"T_{tr}"}, t_rot{"T_{rot}"}, haff{"τ^{−2}", Curve::Style::dashed};
    for (std::size_t n = 1; n < taus.size(); ++n) {
      const Totals& now = first.series[n];
      result.table.rows.push_back({scene.needles.k, scene.initial.t_rot, taus[n], now.t_tr,
                                   now.t_rot, theory[n].t_tr, theory[n].t_rot, collisions[n]});
      t_tr.x.push_back(taus[n]), t_tr.y.push_back(now.t_tr);
      t_rot.x.push_back(taus[n]), t_rot.y.push_back(now.t_rot);
      if (taus[n] < 100) continue;  // the law holds late: through theory's last value
      const double scale = taus.back() / taus[n];
      haff.x.push_back(taus[n]), haff.y.push_back(theory.back().t_tr * scale * scale);
    }
    result.chart.panels.push_back({.title = start_in_chart(scene),
                                   .x = {"τ", true},
                                   .y = {"T / T_{tr}(0)", true},
                                   .curves = {t_tr, t_rot, haff}});
    for (const double at_collisions : {shown_collisions, shown_collisions_once}) {
      const std::string variant = at(start_of(scene), at_collisions);
      result.measurements.push_back(
          {"departure-translation", variant, measure(point, [&](const FinishedRun& run) {
             return departure(run, at_collisions).t_tr;
           })});
      result.measurements.push_back(
          {"departure-rotation", variant, measure(point, [&](const FinishedRun& run) {
             return departure(run, at_collisions).t_rot;
           })});
      result.measurements.push_back(
          {"late-exponent", variant, measure(point, [&](const FinishedRun& run) {
             return late_exponent(run, 0.8 * at_collisions, at_collisions);
           })});
    }
  }
  return result;
}

FigureResult make_box_sizes(const PaperRuns& runs) {
  std::vector<Point> points;
  for (const char* set : {"box-small", "box-middle", "box-large", "dense"}) {
    points.push_back(runs.points(set).front());
  }
  FigureResult result;
  result.table.columns = {"box", "needles", "collisions", "s", "s_error", "moment", "moment_error"};
  picture::Panel s{.title = "Order of the flow", .x = {"collisions per needle"}, .y = {"S"}};
  picture::Panel moment{.title = "Second moment of the density",
                        .x = {"collisions per needle"},
                        .y = {"second moment / start"}};
  for (const Point& point : points) {
    const Scene& scene = *point.scene;
    const double box = scene.needles.box[0];
    const NamedPoint named{fmt::format("box {:g}", box), &point};
    const double count = static_cast<double>(scene.needles.count);
    Table rows, moments;
    s.curves.push_back(order_curve(named, "translational", Unit::one, {box, count}, rows));
    moment.curves.push_back(order_curve(named, "second_moment", Unit::start, {}, moments));
    for (std::size_t n = 0; n < rows.rows.size(); ++n) {
      result.table.rows.push_back(rows.rows[n]);
      result.table.rows.back().insert(result.table.rows.back().end(), moments.rows[n].begin() + 1,
                                      moments.rows[n].end());
    }
    const double last = last_collisions(point);
    for (const double collisions : {shown_collisions, shown_collisions_once, 1500.0}) {
      if (collisions > last) continue;
      const std::string variant = fmt::format("box {:g}, at {:g}", box, collisions);
      result.measurements.push_back(
          {"sizes-flow-order", variant, measure(point, [&](const FinishedRun& run) {
             return order_at(run, "translational", collisions);
           })});
      result.measurements.push_back(
          {"sizes-moment", variant, measure(point, [&](const FinishedRun& run) {
             return order_at(run, "second_moment", collisions) /
                    order_of(run, "second_moment").front();
           })});
      result.measurements.push_back(
          {"sizes-late-exponent", variant, measure(point, [&](const FinishedRun& run) {
             return late_exponent(run, 0.8 * collisions, collisions);
           })});
    }
  }
  result.chart = {.title = "The dense gas in boxes of several sizes",
                  .description =
                      "Order of the flow and second moment of the density against "
                      "collisions per needle, means over seeds, at equal density.",
                  .panels = {s, moment}};
  return result;
}

}  // namespace needlework::reproduce
