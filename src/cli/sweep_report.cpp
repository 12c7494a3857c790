#include "src/cli/sweep_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "src/cli/csv.h"
#include "src/cli/json.h"

namespace needlework::cli {
namespace {

using Json = nlohmann::ordered_json;

Json json_of_value(const Value& value) {
  if (const auto* boolean = value.as<bool>()) return *boolean;
  if (const auto* integer = value.as<std::int64_t>()) return *integer;
  if (const auto* real = value.as<double>()) return number(*real);
  if (const auto* text = value.as<std::string>()) return *text;
  Json array = Json::array();
  if (const auto* elements = value.as<Value::Array>()) {
    for (const Value& element : *elements) array.push_back(json_of_value(element));
  }
  return array;
}

Json json_of_estimate(const runs::sweep::Estimate& estimate) {
  return {{"mean", number(estimate.mean)}, {"standard_error", number(estimate.standard_error)}};
}

Json json_of_series(const runs::sweep::Series& series) {
  Json means = Json::array(), errors = Json::array();
  for (std::size_t at = 0; at < series.estimates.size(); at += series.width) {
    Json mean = Json::array(), error = Json::array();
    for (std::size_t component = 0; component < series.width; ++component) {
      mean.push_back(number(series.estimates[at + component].mean));
      error.push_back(number(series.estimates[at + component].standard_error));
    }
    means.push_back(series.width == 1 ? mean[0] : mean);
    errors.push_back(series.width == 1 ? error[0] : error);
  }
  return {{"mean", means}, {"standard_error", errors}};
}

std::string text_of(const runs::sweep::Estimate& estimate) {
  return fmt::format("{:.6g} +- {:.1e}", estimate.mean, estimate.standard_error);
}

const runs::sweep::Estimate& result(const runs::sweep::PointSummary& point, std::string_view name) {
  return std::find_if(point.results.begin(), point.results.end(),
                      [&](const runs::sweep::Result& r) { return r.name == name; })
      ->estimate;
}

}  // namespace

Json json_of(const runs::sweep::Grid& grid, std::span<const runs::sweep::PointSummary> summary) {
  Json points = Json::array();
  for (std::size_t p = 0; p < summary.size(); ++p) {
    const runs::sweep::PointSummary& point = summary[p];
    Json parameters = Json::object(), results = Json::object(), series = Json::object();
    for (std::size_t k = 0; k < grid.parameters.size(); ++k) {
      parameters[grid.parameters[k].key] = json_of_value(grid.value(k, p));
    }
    for (const runs::sweep::Result& result : point.results) {
      results[result.name] = json_of_estimate(result.estimate);
    }
    series["time"] = point.times;
    for (const runs::sweep::Series& one : point.series) series[one.name] = json_of_series(one);
    points.push_back({{"name", grid.name_of_point(p)},
                      {"parameters", parameters},
                      {"seeds", point.seeds},
                      {"results", results},
                      {"series", series}});
  }
  return points;
}

std::string csv_of(const runs::sweep::Grid& grid,
                   std::span<const runs::sweep::PointSummary> summary) {
  std::vector<std::string> fields;
  std::string out;
  const auto end_line = [&] {
    out += fmt::format("{}\n", fmt::join(fields, ","));
    fields.clear();
  };
  const auto number_or_none = [](double x) {
    return std::isfinite(x) ? fmt::format("{}", x) : std::string();
  };
  for (const auto& parameter : grid.parameters) fields.push_back(quoted(parameter.key));
  fields.push_back("members");
  for (const runs::sweep::Result& result : summary.front().results) {
    fields.push_back(result.name);
    fields.push_back(result.name + "_error");
  }
  end_line();
  for (std::size_t p = 0; p < summary.size(); ++p) {
    for (std::size_t k = 0; k < grid.parameters.size(); ++k) {
      const auto* text = grid.value(k, p).as<std::string>();
      fields.push_back(quoted(text ? *text : runs::sweep::toml_of(grid.value(k, p))));
    }
    fields.push_back(fmt::to_string(summary[p].seeds.size()));
    for (const runs::sweep::Result& result : summary[p].results) {
      fields.push_back(number_or_none(result.estimate.mean));
      fields.push_back(number_or_none(result.estimate.standard_error));
    }
    end_line();
  }
  return out;
}

std::string table_of(const runs::sweep::Grid& grid,
                     std::span<const runs::sweep::PointSummary> summary) {
  std::size_t width = 5;
  for (std::size_t p = 0; p < summary.size(); ++p) {
    width = std::max(width, grid.name_of_point(p).size());
  }
  std::string table = fmt::format("{:{}}  {:>7}  {:24}  {:24}  {}\n", "point", width, "members",
                                  "collisions per needle", "time", "E/E(0)");
  for (std::size_t p = 0; p < summary.size(); ++p) {
    const runs::sweep::PointSummary& point = summary[p];
    const std::string name = grid.name_of_point(p);
    table += fmt::format("{:{}}  {:>7}  {:24}  {:24}  {}\n", name.empty() ? "all" : name, width,
                         point.seeds.size(), text_of(result(point, "collisions_per_needle")),
                         text_of(result(point, "time")), text_of(result(point, "energy_ratio")));
  }
  return table;
}

}  // namespace needlework::cli
