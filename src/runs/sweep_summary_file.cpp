#include <fmt/format.h>

#include <algorithm>

#include "src/io/atomic_file.h"
#include "src/io/descriptions.h"
#include "src/io/hdf5.h"
#include "src/io/output_file.h"
#include "src/observe/observation.h"
#include "src/runs/sweep_summary.h"

namespace needlework::runs::sweep {
namespace {

using io::hdf5::create_group;
using io::hdf5::Handle;
using io::hdf5::Shape;
using io::hdf5::write_array;

std::optional<double> number_in(const Value& value) {
  if (const auto* integer = value.as<std::int64_t>()) return static_cast<double>(*integer);
  if (const auto* number = value.as<double>()) return *number;
  return std::nullopt;
}

void write_parameter(hid_t group, const Grid& grid, std::size_t parameter,
                     const std::string& place) {
  std::vector<double> numbers;
  std::vector<std::string> texts;
  for (std::size_t point = 0; point < grid.points(); ++point) {
    const Value& value = grid.value(parameter, point);
    texts.push_back(toml_of(value));
    if (const auto number = number_in(value)) numbers.push_back(*number);
  }
  const std::string& key = grid.parameters[parameter].key;
  if (numbers.size() == texts.size()) {
    write_array<double>(group, key, {numbers.size()}, numbers, place);
  } else {
    io::hdf5::write_array(group, key, texts, place);
  }
}

void write_members(hid_t group, std::span<const PointSummary> summary, const std::string& place) {
  std::vector<std::int64_t> count, seeds, points;
  for (const PointSummary& point : summary) {
    count.push_back(static_cast<std::int64_t>(point.seeds.size()));
    for (const std::uint64_t seed : point.seeds) {
      seeds.push_back(static_cast<std::int64_t>(seed));
      points.push_back(&point - summary.data());
    }
  }
  write_array<std::int64_t>(group, "count", {count.size()}, count, place);
  write_array<std::int64_t>(group, "seeds", {seeds.size()}, seeds, place);
  write_array<std::int64_t>(group, "point", {points.size()}, points, place);
}

void write_estimates(hid_t parent, const std::string& name, const Shape& shape,
                     std::span<const Estimate> estimates, const std::string& place) {
  std::vector<double> means, errors;
  for (const Estimate& estimate : estimates) {
    means.push_back(estimate.mean);
    errors.push_back(estimate.standard_error);
  }
  const Handle group = create_group(parent, name, place);
  write_array<double>(group.get(), "mean", shape, means, place);
  write_array<double>(group.get(), "standard_error", shape, errors, place);
}

void write_results(hid_t group, std::span<const PointSummary> summary, const std::string& place) {
  for (std::size_t r = 0; r < summary.front().results.size(); ++r) {
    std::vector<Estimate> estimates;
    for (const PointSummary& point : summary) estimates.push_back(point.results[r].estimate);
    write_estimates(group, summary.front().results[r].name, {summary.size()}, estimates, place);
  }
}

// Numbers of bodies that grow are described as in the files of the runs.
std::vector<io::Description> growth_descriptions(const Scene& scene) {
  std::vector<io::Description> out;
  if (!scene.driving.growth) return out;
  for (const SeriesGroup& group : observe::Observation(scene).groups()) {
    const std::string prefix = group.name == "growth"            ? "growth_"
                               : group.name == "contact_network" ? "network_"
                                                                 : "";
    if (prefix.empty()) continue;
    for (const SeriesField& field : group.fields)
      out.push_back({"/results/" + prefix + field.name, field.meaning, field.unit, ""});
  }
  return out;
}

void write_series(hid_t group, const PointSummary& point, const std::string& place) {
  write_array<double>(group, "time", {point.times.size()}, point.times, place);
  for (const Series& series : point.series) {
    Shape shape{point.times.size()};
    if (series.width > 1) shape.push_back(series.width);
    write_estimates(group, series.name, shape, series.estimates, place);
  }
}

}  // namespace

void write_summary(const std::string& path, const Grid& grid,
                   std::span<const PointSummary> summary) {
  const io::hdf5::Session session;
  io::AtomicFile atomic(path, true);
  io::OutputFile file(atomic.temporary(), path, io::OutputFile::Use::in_one_go);
  const auto group = [&](const char* name) { return create_group(file.get(), name, path); };
  {
    const Handle sweep = group("sweep");
    io::hdf5::write_scalar(sweep.get(), "grid", grid.text, path);
    io::hdf5::write_scalar(sweep.get(), "scene", grid.base, path);
    io::hdf5::write_scalar(sweep.get(), "version", std::string(NEEDLEWORK_VERSION), path);
    const Handle parameters = group("parameters");
    for (std::size_t p = 0; p < grid.parameters.size(); ++p) {
      write_parameter(parameters.get(), grid, p, path);
    }
    write_members(group("members").get(), summary, path);
    write_results(group("results").get(), summary, path);
    const Handle series = group("series");
    for (std::size_t point = 0; point < summary.size(); ++point) {
      write_series(create_group(series.get(), fmt::format("{:05}", point), path).get(),
                   summary[point], path);
    }
  }
  io::write_descriptions(file.get(), io::sweep_summary_descriptions(), path);
  io::write_descriptions(file.get(), growth_descriptions(grid.members.front().scene), path);
  file.close();
  atomic.publish();
}

}  // namespace needlework::runs::sweep
