// Figure 3 and other ratios of temperatures: those of rough needles, and the way to equipartition.
#include <fmt/format.h>

#include <cmath>
#include <map>

#include "needlework/theory.h"
#include "src/reproduce/all_figures.h"
#include "src/reproduce/course.h"

namespace needlework::reproduce {
namespace {

using picture::Curve;

constexpr double settled = 0.1;  // E/E(0) below which the ratio of temperatures is constant

theory::Gas gas_of(const Scene& scene) {
  return {scene.needles.k, scene.collisions.epsilon, scene.collisions.beta};
}

// T_tr / T_rot over the samples where the gas has lost most of its energy, as a geometric mean.
double late_ratio(const FinishedRun& run) {
  double sum = 0, count = 0;
  for (const Totals& sample : run.series) {
    if (sample.energy > settled * run.series.front().energy) continue;
    sum += std::log(sample.t_tr / sample.t_rot);
    ++count;
  }
  return std::exp(sum / count);
}

// Points with error bars and the curve of theory over x, in one colour.
void add_pair(picture::Panel& panel, Curve points, Curve line, std::size_t colour) {
  points.style = Curve::Style::points;
  points.colour = line.colour = colour;
  points.name.clear();
  panel.curves.push_back(std::move(line));
  panel.curves.push_back(std::move(points));
}

bool is_equipartition_k(double k) { return std::abs(k / theory::equipartition_k() - 1) < 1e-4; }

}  // namespace

FigureResult make_ratio(const PaperRuns& runs) {
  const std::vector<Point> points = runs.points("ratio");
  FigureResult result;
  result.table.columns = {"epsilon", "k", "ratio_theory", "ratio", "ratio_error", "seeds"};
  const std::vector<double> epsilons = steps(0, 0.99, 33), ks = steps(0.5, 16.5, 32);
  picture::Map map{epsilons, ks, {}};
  for (std::size_t j = 0; j + 1 < ks.size(); ++j) {
    for (std::size_t i = 0; i + 1 < epsilons.size(); ++i) {
      const double epsilon = (epsilons[i] + epsilons[i + 1]) / 2, k = (ks[j] + ks[j + 1]) / 2;
      map.values.push_back(theory::asymptotic_ratio({k, epsilon}));
    }
  }

  Curve simulated{"simulation", Curve::Style::points};
  std::map<double, Curve> by_epsilon;
  std::size_t seeds = points.front().runs.size();
  for (const Point& point : points) {
    const Scene& scene = *point.scene;
    const double epsilon = scene.collisions.epsilon, k = scene.needles.k;
    const double c = theory::asymptotic_ratio(gas_of(scene));
    const Measured ratio = measure(point, late_ratio);
    result.table.rows.push_back(
        {epsilon, k, c, ratio.value, ratio.error, static_cast<double>(point.runs.size())});
    simulated.x.push_back(epsilon), simulated.y.push_back(k),
        simulated.values.push_back(ratio.value);
    Curve& curve = by_epsilon[epsilon];
    curve.x.push_back(k), curve.y.push_back(ratio.value), curve.error.push_back(ratio.error);
    const std::string variant = fmt::format("epsilon = {:g}, k = {:g}", epsilon, k);
    result.measurements.push_back(
        {"ratio-surface", variant, {ratio.value / c, ratio.error / c, ratio.seeds}});
    if (is_equipartition_k(k)) result.measurements.push_back({"equipartition", variant, ratio});
    seeds = std::min(seeds, point.runs.size());
  }

  picture::Panel lines{.title = "Cuts at constant ε", .x = {"k"}, .y = {"T_{tr} / T_{rot}"}};
  for (const auto& [epsilon, curve] : by_epsilon) {
    Curve line{fmt::format("ε = {:g}", epsilon)};
    for (const double k : ks) {
      line.x.push_back(k), line.y.push_back(theory::asymptotic_ratio({k, epsilon}));
    }
    add_pair(lines, curve, line, lines.curves.size() / 2);
  }
  result.chart = {.title = "Long-time ratio T_{tr} / T_{rot}",
                  .description =
                      "Ratio of the temperatures of translation and rotation as a function of "
                      "restitution and k: theory as colours and lines, simulations as points.",
                  .panels = {{.title = "Theory (colours) and simulation (points)",
                              .x = {"ε"},
                              .y = {"k"},
                              .curves = {simulated},
                              .map = map,
                              .colours = {.label = "T_{tr} / T_{rot}"}},
                             lines}};

  // In how many of the points each seed has the hotter of the two motions on the right side.
  std::vector<double> shares;
  for (std::size_t seed = 0; seed < seeds; ++seed) {
    double right = 0, all = 0;
    for (const Point& point : points) {
      const double k = point.scene->needles.k;
      if (is_equipartition_k(k)) continue;
      right += (late_ratio(point.runs[seed]) > 1) == (k > theory::equipartition_k());
      ++all;
    }
    shares.push_back(right / all);
  }
  result.measurements.push_back({"order-of-temperatures", "", mean_of(shares)});
  result.measurements.push_back({"equipartition-k", "", {theory::equipartition_k(), 0, {}}});
  return result;
}

FigureResult make_rough_ratio(const PaperRuns& runs) {
  FigureResult result;
  result.table.columns = {"epsilon", "beta", "ratio_theory", "ratio", "ratio_error", "seeds"};
  std::map<double, Curve> by_epsilon;
  double k = 0;
  for (const Point& point : runs.points("rough")) {
    const Scene& scene = *point.scene;
    k = scene.needles.k;
    const double c = theory::asymptotic_ratio(gas_of(scene));
    const Measured ratio = measure(point, late_ratio);
    result.table.rows.push_back({scene.collisions.epsilon, scene.collisions.beta, c, ratio.value,
                                 ratio.error, static_cast<double>(point.runs.size())});
    Curve& curve = by_epsilon[scene.collisions.epsilon];
    curve.x.push_back(scene.collisions.beta), curve.y.push_back(ratio.value);
    curve.error.push_back(ratio.error);
    result.measurements.push_back({"rough-ratio",
                                   fmt::format("epsilon = {:g}, beta = {:g}",
                                               scene.collisions.epsilon, scene.collisions.beta),
                                   {ratio.value / c, ratio.error / c, ratio.seeds}});
  }
  picture::Panel panel{.title = fmt::format("Theory (lines) and simulation (points), k = {:g}", k),
                       .x = {"β"},
                       .y = {"T_{tr} / T_{rot}"}};
  for (const auto& [epsilon, curve] : by_epsilon) {
    Curve line{fmt::format("ε = {:g}", epsilon)};
    for (const double beta : steps(-0.98, 0.98, 98)) {
      line.x.push_back(beta);
      line.y.push_back(theory::asymptotic_ratio({k, epsilon, beta}));
    }
    add_pair(panel, curve, line, panel.curves.size() / 2);
  }
  result.chart = {.title = "Rough needles: long-time ratio T_{tr} / T_{rot}",
                  .description =
                      "Ratio of temperatures against tangential restitution: theory as "
                      "lines, simulations as points.",
                  .panels = {panel}};
  return result;
}

namespace {

constexpr double fit_from = 0.75, fit_to = 0.08;  // of the initial difference of temperatures

double difference(double t_tr, double t_rot) { return std::abs(t_tr - t_rot); }

// The rate at which |T_tr - T_rot| falls in tau = gamma t, divided by sqrt(E): the slope of its
// logarithm from the first sample below `fit_from` of its start to the first one below `fit_to`.
double relaxation_rate(std::span<const double> taus, std::span<const double> differences,
                       double energy) {
  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (std::size_t i = 0; i < taus.size(); ++i) {
    const double share = differences[i] / differences[0];
    if (share < fit_to) break;
    if (share > fit_from) continue;
    const double y = std::log(differences[i]);
    n += 1, sx += taus[i], sy += y, sxx += taus[i] * taus[i], sxy += taus[i] * y;
  }
  return -(n * sxy - sx * sy) / (n * sxx - sx * sx) / std::sqrt(energy);
}

std::vector<double> differences_of(const FinishedRun& run) {
  std::vector<double> all;
  for (const Totals& sample : run.series) all.push_back(difference(sample.t_tr, sample.t_rot));
  return all;
}

double rate_of(const FinishedRun& run) {
  return relaxation_rate(taus_of(run), differences_of(run), run.series.front().energy);
}

double theory_rate(const Point& point, std::vector<double>& differences) {
  const Scene& scene = *point.scene;
  const std::vector<double> taus = taus_of(point.runs.front());
  for (const auto& now :
       theory::cooling_curve(gas_of(scene), {scene.initial.t_tr, scene.initial.t_rot}, taus)) {
    differences.push_back(difference(now.t_tr, now.t_rot));
  }
  return relaxation_rate(taus, differences, point.runs.front().series.front().energy);
}

// T_tr / T_rot over the samples from the first on at which theory has so little left of the
// difference of temperatures; NaN if the run is too short.
constexpr double relaxed = 1e-3;

double final_ratio(const FinishedRun& run, std::span<const double> theory) {
  double sum = 0, count = 0;
  for (std::size_t n = 0; n < run.series.size(); ++n) {
    if (theory[n] > relaxed * theory[0]) continue;
    sum += run.series[n].t_tr / run.series[n].t_rot;
    ++count;
  }
  return sum / count;
}

}  // namespace

FigureResult make_relaxation(const PaperRuns& runs) {
  FigureResult result;
  result.table.columns = {"k", "density", "tau", "difference", "difference_error", "theory"};
  picture::Panel panel{
      .title = "T_{rot}(0) = 0.4 T_{tr}(0)", .x = {"τ"}, .y = {"|T_{tr} − T_{rot}|", true}};
  std::map<double, Measured> at_full_density;
  for (const Point& point : runs.points("relaxation")) {
    const Scene& scene = *point.scene;
    const auto& box = scene.needles.box;
    const double density = static_cast<double>(scene.needles.count) / (box[0] * box[1] * box[2]);
    std::vector<double> theory;
    const double expected = theory_rate(point, theory);
    const Measured rate = measure(point, rate_of);
    const std::string variant = fmt::format("k = {:g}, n = {:.2g}", scene.needles.k, density);

    Curve simulated{fmt::format("k = {:g}, n = {:.2g}", scene.needles.k, density),
                    Curve::Style::points};
    Curve line{.style = Curve::Style::line};
    simulated.colour = line.colour = panel.curves.size() / 2;
    const std::vector<double> taus = taus_of(point.runs.front());
    for (std::size_t n = 0; n < taus.size(); ++n) {
      if (theory[n] < 0.3 * fit_to * theory[0]) continue;
      const Measured d =
          measure(point, [&](const FinishedRun& run) { return differences_of(run).at(n); });
      result.table.rows.push_back({scene.needles.k, density, taus[n], d.value, d.error, theory[n]});
      if (n % 2 == 0) simulated.x.push_back(taus[n]), simulated.y.push_back(d.value);
      line.x.push_back(taus[n]), line.y.push_back(theory[n]);
    }
    panel.curves.push_back(line);
    panel.curves.push_back(simulated);

    result.measurements.push_back({"relaxation-rate", variant, rate});
    result.measurements.push_back(
        {"relaxation-theory", variant, {rate.value / expected, rate.error / expected, rate.seeds}});
    if (theory.back() <= relaxed * theory[0]) {
      result.measurements.push_back(
          {"elastic-equipartition", variant,
           measure(point, [&](const FinishedRun& run) { return final_ratio(run, theory); })});
    }
    const auto [full, is_first] = at_full_density.try_emplace(scene.needles.k, rate);
    if (is_first) continue;
    const double ratio = rate.value / full->second.value;
    const double error =
        ratio * std::hypot(rate.error / rate.value, full->second.error / full->second.value);
    result.measurements.push_back({"relaxation-density",
                                   fmt::format("k = {:g}", scene.needles.k),
                                   {ratio, error, rate.seeds}});
  }
  result.chart = {.title = "Elastic relaxation to equipartition",
                  .description =
                      "Difference of the temperatures of translation and rotation "
                      "against scaled time: simulations as points, theory as lines.",
                  .panels = {panel}};
  return result;
}

}  // namespace needlework::reproduce
