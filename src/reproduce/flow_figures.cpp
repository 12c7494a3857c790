// Figures 4, 6 and 7: flow and density of the dense gas in space.
#include <fmt/format.h>

#include <cmath>

#include "src/reproduce/all_figures.h"
#include "src/reproduce/cells.h"
#include "src/reproduce/course.h"

namespace needlework::reproduce {
namespace {

using picture::Curve;

constexpr const char* axis_names[] = {"x", "y", "z"};

CellFields shown(const FinishedRun& run, double collisions = shown_collisions) {
  return cell_fields(run, sample_near(run, collisions));
}

// The means along the third axis of what the cells of two axes hold.
template <class Number>
std::vector<double> seen_along(const CellFields& fields, std::size_t across, std::size_t up,
                               Number number) {
  std::vector<double> values(fields.cells[across] * fields.cells[up], 0.0);
  for_each_cell(fields.cells, [&](const std::array<std::size_t, 3>& place) {
    values[place[up] * fields.cells[across] + place[across]] +=
        number(fields.index(place)) / static_cast<double>(fields.cells[3 - across - up]);
  });
  return values;
}

picture::Panel arrows_of(const CellFields& fields, const ShearWave& wave, std::string title) {
  const std::size_t across = wave.gradient, up = wave.along;
  picture::Arrows arrows;
  arrows.u =
      seen_along(fields, across, up, [&](std::size_t cell) { return fields.flow[cell][across]; });
  arrows.v =
      seen_along(fields, across, up, [&](std::size_t cell) { return fields.flow[cell][up]; });
  for (std::size_t row = 0; row < fields.cells[up]; ++row) {
    for (std::size_t column = 0; column < fields.cells[across]; ++column) {
      arrows.x.push_back(fields.middle(across, column));
      arrows.y.push_back(fields.middle(up, row));
    }
  }
  arrows.cell = fields.box[across] / static_cast<double>(fields.cells[across]);
  return {.title = std::move(title),
          .x = {axis_names[across], false, picture::Range{0, fields.box[across]}},
          .y = {axis_names[up], false, picture::Range{0, fields.box[up]}},
          .arrows = arrows,
          .equal_scales = true};
}

}  // namespace

FigureResult make_flow_field(const PaperRuns& runs) {
  FigureResult result;
  // Axes count from 0; x and u are along the first one, y and v along the second one.
  result.table.columns = {"k",           "t_rot0", "seed", "collisions", "first_axis",
                          "second_axis", "x",      "y",    "u",          "v"};
  result.chart = {
      .title = "Flow of the dense gas after 600 collisions per needle",
      .description =
          "Mean velocities in the cells, averaged along the third axis, for each start. "
          "The plane is that of the strongest shear flow.",
      .columns = 2,
      .panel_width = 300};
  for (const Point& point : runs.points("dense")) {
    const Scene& scene = *point.scene;
    const FinishedRun& first = point.runs.front();
    const CellFields fields = shown(first);
    const ShearWave wave = strongest_shear_wave(fields);
    result.chart.panels.push_back(arrows_of(fields, wave, start_in_chart(scene)));
    const picture::Arrows& arrows = *result.chart.panels.back().arrows;
    for (std::size_t n = 0; n < arrows.x.size(); ++n) {
      result.table.rows.push_back(
          {scene.needles.k, scene.initial.t_rot, static_cast<double>(first.seed), fields.collisions,
           static_cast<double>(wave.gradient), static_cast<double>(wave.along), arrows.x[n],
           arrows.y[n], arrows.u[n], arrows.v[n]});
    }
    for (const double collisions : {shown_collisions, shown_collisions_once}) {
      const std::string variant = fmt::format("{}, at {:g}", start_of(scene), collisions);
      result.measurements.push_back(
          {"shear-bands", variant, measure(point, [&](const FinishedRun& run) {
             return 2 * static_cast<double>(strongest_shear_wave(shown(run, collisions)).number);
           })});
      result.measurements.push_back(
          {"shear-share", variant, measure(point, [&](const FinishedRun& run) {
             return strongest_shear_wave(shown(run, collisions)).share;
           })});
    }
  }
  return result;
}

namespace {

// How many of the cells along z are dense.
std::vector<double> dense_along_z(const CellFields& fields) {
  const double depth = static_cast<double>(fields.cells[2]);
  return seen_along(fields, 0, 1, [&](std::size_t cell) {
    return fields.excess[cell] > dense_excess ? depth : 0;
  });
}

}  // namespace

FigureResult make_density_map(const PaperRuns& runs) {
  FigureResult result;
  result.table.columns = {"k", "t_rot0", "seed", "x", "y", "dense_start", "dense_after"};
  result.chart = {.title = "Cells with more than 1.5 times the mean density",
                  .description =
                      "How many of the cells along z are that dense, at the start and "
                      "after 600 collisions per needle, for each start.",
                  .columns = 4,
                  .panel_width = 260};
  for (const Point& point : runs.points("dense")) {
    const Scene& scene = *point.scene;
    const FinishedRun& first = point.runs.front();
    const CellFields start = shown(first, 0), after = shown(first);
    const auto dense_start = dense_along_z(start), dense_after = dense_along_z(after);
    for (std::size_t n = 0; n < dense_start.size(); ++n) {
      result.table.rows.push_back(
          {scene.needles.k, scene.initial.t_rot, static_cast<double>(first.seed),
           start.middle(0, n % start.cells[0]), start.middle(1, n / start.cells[0]), dense_start[n],
           dense_after[n]});
    }
    for (const double collisions : {0.0, shown_collisions}) {
      const double depth = static_cast<double>(start.cells[2]);
      picture::Map map{start.edges(0), start.edges(1), collisions == 0 ? dense_start : dense_after};
      result.chart.panels.push_back(
          {.title = fmt::format("{}, {}", start_in_chart(scene),
                                collisions == 0 ? "at the start" : "after 600"),
           .x = {"x"},
           .y = {"y"},
           .map = map,
           .colours = {.label = "dense cells along z", .range = picture::Range{0, depth}},
           .equal_scales = true});
      result.measurements.push_back({collisions == 0 ? "dense-cells-before" : "dense-cells-after",
                                     start_of(scene), measure(point, [&](const FinishedRun& run) {
                                       return dense_share(shown(run, collisions));
                                     })});
    }
  }
  return result;
}

namespace {

// Means over z of a number of the cells with y just below the middle of the box, "y = 6L", over x.
template <class Number>
std::vector<double> line_of(const CellFields& fields, Number number) {
  std::vector<double> line(fields.cells[0], 0.0);
  const std::size_t y = fields.cells[1] / 2 - 1;
  for (std::size_t x = 0; x < fields.cells[0]; ++x) {
    for (std::size_t z = 0; z < fields.cells[2]; ++z) {
      line[x] += number(fields.index({x, y, z})) / static_cast<double>(fields.cells[2]);
    }
  }
  return line;
}

}  // namespace

FigureResult make_line_profiles(const PaperRuns& runs) {
  FigureResult result;
  result.table.columns = {"k", "t_rot0", "seed", "collisions", "x", "uy", "uz", "excess"};
  result.chart = {.title = "Flow and density along x, after 600 collisions per needle",
                  .description =
                      "Components of the flow in units of the thermal velocity, and "
                      "deviation of the density from its mean, at y = 6 and averaged "
                      "over z, for each start.",
                  .columns = 2};
  for (const Point& point : runs.points("dense")) {
    const Scene& scene = *point.scene;
    for (const FinishedRun& run : point.runs) {
      const CellFields fields = shown(run);
      const double unit = std::sqrt(fields.t_tr);
      const auto uy =
          line_of(fields, [&](std::size_t cell) { return fields.flow[cell][1] / unit; });
      const auto uz =
          line_of(fields, [&](std::size_t cell) { return fields.flow[cell][2] / unit; });
      const auto excess = line_of(fields, [&](std::size_t cell) { return fields.excess[cell]; });
      Curve y{"U_{y} / (T_{tr}/m)^{1/2}"}, z{"U_{z} / (T_{tr}/m)^{1/2}"},
          density{"ρ / ⟨ρ⟩ − 1", Curve::Style::dashed};
      for (std::size_t n = 0; n < uy.size(); ++n) {
        const double x = fields.middle(0, n);
        result.table.rows.push_back({scene.needles.k, scene.initial.t_rot,
                                     static_cast<double>(run.seed), fields.collisions, x, uy[n],
                                     uz[n], excess[n]});
        y.x.push_back(x), z.x.push_back(x), density.x.push_back(x);
      }
      y.y = uy, z.y = uz, density.y = excess;
      if (&run != &point.runs.front()) continue;
      result.chart.panels.push_back({.title = start_in_chart(scene),
                                     .x = {"x", false, picture::Range{0, fields.box[0]}},
                                     .y = {"flow and density"},
                                     .curves = {y, z, density}});
    }
    for (const double collisions : {shown_collisions, shown_collisions_once}) {
      result.measurements.push_back({"density-flow-correlation",
                                     fmt::format("{}, at {:g}", start_of(scene), collisions),
                                     measure(point, [&](const FinishedRun& run) {
                                       return density_flow_correlation(shown(run, collisions));
                                     })});
    }
  }
  return result;
}

}  // namespace needlework::reproduce
