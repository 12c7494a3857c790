// Figure 8, and alignment inside clusters.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include "needlework/h5md.h"
#include "src/observe/grid.h"
#include "src/reproduce/all_figures.h"
#include "src/reproduce/cells.h"
#include "src/reproduce/course.h"

namespace needlework::reproduce {
namespace {

using picture::Curve;
using Matrix = std::array<std::array<double, 3>, 3>;

// Share of random directors with Q below a value: sqrt((Q + 1) / 3).
double random_below(double q) { return std::sqrt((q + 1) / 3); }

// The mean of Q by its histogram, less that of random directors by the same bins.
double mean_q(std::span<const double> counts, std::span<const double> borders) {
  const double all = std::accumulate(counts.begin(), counts.end(), 0.0);
  double mean = 0;
  for (std::size_t bin = 0; bin < counts.size(); ++bin) {
    const double middle = (borders[bin] + borders[bin + 1]) / 2;
    const double random = random_below(borders[bin + 1]) - random_below(borders[bin]);
    mean += middle * (counts[bin] / all - random);
  }
  return mean;
}

// The largest eigenvalue of a symmetric matrix with trace 0, by the trigonometric formula.
double largest_eigenvalue(const Matrix& m) {
  const double p2 = (m[0][0] * m[0][0] + m[1][1] * m[1][1] + m[2][2] * m[2][2] +
                     2 * (m[0][1] * m[0][1] + m[0][2] * m[0][2] + m[1][2] * m[1][2])) /
                    6;
  if (p2 == 0) return 0;
  const double determinant = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                             m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                             m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
  const double p = std::sqrt(p2);
  return 2 * p * std::cos(std::acos(std::clamp(determinant / (2 * p * p * p), -1.0, 1.0)) / 3);
}

double nematic_order(std::span<const double> tensor) {
  Matrix m;
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t b = 0; b < 3; ++b) m[a][b] = tensor[3 * a + b];
  }
  return largest_eigenvalue(m);
}

}  // namespace

FigureResult make_alignment(const PaperRuns& runs) {
  FigureResult result;
  result.table.columns = {"k", "t_rot0", "q", "start", "after", "random"};
  result.chart = {.title = "Directors and velocities: Q = 3 (u · v/|v|)^{2} − 1",
                  .description =
                      "Histograms of Q over all needles and seeds, at the start and "
                      "after 600 collisions per needle, and the law of random directors.",
                  .columns = 2};
  for (const Point& point : runs.points("dense")) {
    const Scene& scene = *point.scene;
    const std::vector<double> borders = point.runs.front().field("alignment/borders").values;
    std::vector<double> start(borders.size() - 1, 0.0), after = start;
    const auto add = [](std::vector<double>& sum, std::span<const double> row) {
      for (std::size_t bin = 0; bin < sum.size(); ++bin) sum[bin] += row[bin];
    };
    for (const FinishedRun& run : point.runs) {
      const io::RecordedField q = run.field("alignment/along_velocity");
      add(start, q.row(0));
      add(after, q.row(sample_near(run, shown_collisions)));
    }
    Curve before{"start", Curve::Style::steps, borders, {}}, then = before, random{"random"};
    then.name = "after 600";
    const double all = std::accumulate(start.begin(), start.end(), 0.0);
    for (std::size_t bin = 0; bin < start.size(); ++bin) {
      const double width = borders[bin + 1] - borders[bin];
      const double middle = (borders[bin] + borders[bin + 1]) / 2;
      const double law = (random_below(borders[bin + 1]) - random_below(borders[bin])) / width;
      before.y.push_back(start[bin] / all / width), then.y.push_back(after[bin] / all / width);
      random.x.push_back(middle), random.y.push_back(law);
      result.table.rows.push_back(
          {scene.needles.k, scene.initial.t_rot, middle, before.y.back(), then.y.back(), law});
    }
    result.chart.panels.push_back({.title = start_in_chart(scene),
                                   .x = {"Q"},
                                   .y = {"probability density", true},
                                   .curves = {before, then, random}});
    const auto mean_at = [&](double collisions) {
      return measure(point, [&](const FinishedRun& run) {
        return mean_q(run.field("alignment/along_velocity").row(sample_near(run, collisions)),
                      borders);
      });
    };
    const auto order_at = [&](double collisions) {
      return measure(point, [&](const FinishedRun& run) {
        return nematic_order(run.field("alignment/order_tensor").row(sample_near(run, collisions)));
      });
    };
    for (const double collisions : {shown_collisions, shown_collisions_once}) {
      const std::string variant = fmt::format("{}, at {:g}", start_of(scene), collisions);
      result.measurements.push_back({"velocity-alignment", variant, mean_at(collisions)});
      result.measurements.push_back({"global-order", variant, order_at(collisions)});
    }
  }
  return result;
}

namespace {

/// Sums over needles of Q along the velocity, and over pairs of needles of one cell of
/// P2 = (3 (u . u')^2 - 1) / 2, which is the square of the nematic order of the cell on average,
/// and vanishes for random directors however few there are.
struct Alignment {
  double needles = 0, q = 0, pairs = 0, p2 = 0;

  double mean_q() const { return q / needles; }
  double mean_p2() const { return p2 / pairs; }
};

struct ClusterAlignment {
  Alignment dense, other;
};

ClusterAlignment alignment_in_clusters(const State& state, const std::array<int, 3>& cells) {
  const observe::Grid grid(state.box, cells);
  std::vector<std::vector<std::size_t>> members(grid.size());
  for (std::size_t i = 0; i < state.size(); ++i) {
    members[grid.cell_of(state.position[i])].push_back(i);
  }
  const double mean = static_cast<double>(state.size()) / static_cast<double>(grid.size());
  ClusterAlignment result;
  for (const std::vector<std::size_t>& cell : members) {
    const double n = static_cast<double>(cell.size());
    Alignment& sum = n > (1 + dense_excess) * mean ? result.dense : result.other;
    Matrix order{};
    for (const std::size_t i : cell) {
      const auto &u = state.orientation[i], &v = state.velocity[i];
      const double along = u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
      sum.q += 3 * along * along / (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) - 1;
      for (std::size_t a = 0; a < 3; ++a) {
        for (std::size_t b = 0; b < 3; ++b) order[a][b] += 1.5 * u[a] * u[b] - (a == b ? 0.5 : 0);
      }
    }
    double square = 0;
    for (const auto& row : order) {
      for (const double x : row) square += x * x;
    }
    sum.needles += n;
    sum.pairs += n * (n - 1);
    sum.p2 += 2.0 / 3.0 * square - n;  // the sum over all pairs, less that of each with itself
  }
  return result;
}

}  // namespace

FigureResult make_clusters(const PaperRuns& runs) {
  FigureResult result;
  result.table.columns = {"k",       "t_rot0",  "seed",     "frame_time", "dense_share",
                          "dense_q", "other_q", "dense_p2", "other_p2"};
  picture::Panel q{.title = "Along the velocity", .y = {"⟨Q⟩"}};
  picture::Panel p2{.title = "Among needles of a cell", .y = {"⟨P_{2}⟩"}};
  Curve dense{"dense cells", Curve::Style::points}, other{"other cells", Curve::Style::points};
  q.curves = p2.curves = {dense, other};
  double place = 0;
  for (const Point& point : runs.points("dense")) {
    const Scene& scene = *point.scene;
    std::vector<ClusterAlignment> all;
    for (const FinishedRun& run : point.runs) {
      const io::FrameFile frames(run.file);
      const std::size_t frame = frame_near(run, frames, shown_collisions);
      all.push_back(alignment_in_clusters(frames.read(frame), *scene.output.grid));
      const Alignment &in = all.back().dense, &out = all.back().other;
      result.table.rows.push_back({scene.needles.k, scene.initial.t_rot,
                                   static_cast<double>(run.seed), *frames.time(frame),
                                   in.needles / (in.needles + out.needles), in.mean_q(),
                                   out.mean_q(), in.mean_p2(), out.mean_p2()});
    }
    const auto over_seeds = [&](double (*number)(const ClusterAlignment&)) {
      std::vector<double> values;
      for (const ClusterAlignment& one : all) values.push_back(number(one));
      return mean_of(values);
    };
    ++place;
    const auto add = [&](picture::Panel& panel, std::size_t curve, const Measured& mean) {
      panel.curves[curve].x.push_back(place + 0.1 * static_cast<double>(curve));
      panel.curves[curve].y.push_back(mean.value);
      panel.curves[curve].error.push_back(mean.error);
    };
    add(q, 0, over_seeds([](const ClusterAlignment& one) { return one.dense.mean_q(); }));
    add(q, 1, over_seeds([](const ClusterAlignment& one) { return one.other.mean_q(); }));
    add(p2, 0, over_seeds([](const ClusterAlignment& one) { return one.dense.mean_p2(); }));
    add(p2, 1, over_seeds([](const ClusterAlignment& one) { return one.other.mean_p2(); }));
    result.measurements.push_back(
        {"cluster-velocity-alignment", start_of(scene), over_seeds([](const ClusterAlignment& one) {
           return one.dense.mean_q() - one.other.mean_q();
         })});
    result.measurements.push_back(
        {"cluster-order", start_of(scene), over_seeds([](const ClusterAlignment& one) {
           return one.dense.mean_p2() - one.other.mean_p2();
         })});
  }
  std::string starts;
  for (const Point& point : runs.points("dense")) {
    starts += fmt::format("{}{:g}, {:g}", starts.empty() ? "" : " | ", point.scene->needles.k,
                          point.scene->initial.t_rot);
  }
  for (picture::Panel* panel : {&q, &p2}) {
    panel->x = {.label = "start: k, T_{rot}(0) = " + starts,
                .range = picture::Range{0.5, place + 0.6}};
  }
  result.chart = {.title = "Alignment inside clusters",
                  .description =
                      "Means of Q along the velocity, and of P2 over pairs of needles of "
                      "one cell, after about 600 collisions per needle, inside dense "
                      "cells and elsewhere, for each start.",
                  .panels = {q, p2}};
  return result;
}

}  // namespace needlework::reproduce
