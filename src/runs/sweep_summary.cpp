#include "src/runs/sweep_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <string_view>
#include <type_traits>
#include <utility>

#include "src/scene/confinement.h"

namespace needlework::runs::sweep {
namespace {

using Run = io::RecordedRun;

constexpr double undefined = std::numeric_limits<double>::quiet_NaN();

double collisions_per_needle(const Run& run) {
  const double count = static_cast<double>(run.needles);
  return run.needles ? 2 * static_cast<double>(run.series.back().collisions) / count : undefined;
}

struct ResultOf {
  const char* name;
  double (*value)(const Run&);
};

// Beside the totals.
constexpr ResultOf results[] = {
    {"collisions_per_needle", collisions_per_needle},
    {"collision_rate",
     [](const Run& run) {
       const double time = run.series.back().time;
       return time > 0 ? collisions_per_needle(run) / time : undefined;
     }},
    {"energy_ratio",
     [](const Run& run) {
       const double initial = run.series.front().energy;
       return initial > 0 ? run.series.back().energy / initial : undefined;
     }},
};

std::vector<double> times_of(const Run& run) {
  std::vector<double> times;
  for (const Totals& sample : run.series) times.push_back(sample.time);
  // A run may end at the time of a sample, with a second one there.
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

std::vector<double> common_times(std::span<const Run> runs) {
  std::vector<double> common;
  for (const Run& run : runs) {
    const std::vector<double> times = times_of(run);
    if (&run == &runs.front()) {
      common = times;
      continue;
    }
    std::vector<double> both;
    std::set_intersection(common.begin(), common.end(), times.begin(), times.end(),
                          std::back_inserter(both));
    common = std::move(both);
  }
  return common;
}

// The sample at a time that the run has; the first of two.
const Totals& sample_at(const Run& run, double time) {
  return *std::lower_bound(run.series.begin(), run.series.end(), time,
                           [](const Totals& sample, double t) { return sample.time < t; });
}

// Of the numbers that numbers_of(sample) gives, an array.
template <class NumbersOf>
Series series_over(const char* name, const NumbersOf& numbers_of, std::span<const Run> runs,
                   std::span<const double> times) {
  Series series{.name = name, .width = numbers_of(Totals{}).size(), .estimates = {}};
  std::vector<double> values(runs.size());
  for (const double time : times) {
    for (std::size_t component = 0; component < series.width; ++component) {
      std::transform(runs.begin(), runs.end(), values.begin(),
                     [&](const Run& run) { return numbers_of(sample_at(run, time))[component]; });
      series.estimates.push_back(estimate(values));
    }
  }
  return series;
}

// Scripts may take columns of `sweep --csv` by their places, which stay; others follow.
std::ptrdiff_t place_in_tables(const Result& result) {
  constexpr std::string_view places[] = {
      "time",           "collisions", "tc_collisions", "collisions_per_needle",
      "collision_rate", "energy",     "energy_ratio",  "t_tr",
      "t_rot"};
  return std::ranges::find(places, result.name) - std::begin(places);
}

// A number of each run, NaN where that has none.
void add_result(std::string name, std::span<const Run> runs, PointSummary& point,
                const std::function<std::optional<double>(const Run&)>& value_of) {
  std::vector<double> values;
  for (const Run& run : runs) values.push_back(value_of(run).value_or(undefined));
  point.results.push_back({std::move(name), estimate(values)});
}

// What hits on a wall have done until the end.
void add_wall(const WallTotals& wall, std::span<const Run> runs, PointSummary& point) {
  using Place = std::optional<std::size_t>;  // of the wall among those of a run
  const auto place_in = [wall](const Run& run) -> Place {
    const auto found = std::ranges::find_if(run.walls, [&](const WallTotals& each) {
      return each.axis == wall.axis && each.high == wall.high;
    });
    if (found == run.walls.end()) return {};
    return static_cast<std::size_t>(found - run.walls.begin());
  };
  const auto add = [&](const char* name, double (*value)(const Run&, std::size_t)) {
    add_result(fmt::format("{}_{}_{}", name, axis_name(wall), side_name(wall)), runs, point,
               [&](const Run& run) -> std::optional<double> {
                 const Place place = place_in(run);
                 if (!place) return {};
                 return value(run, *place);
               });
  };
  add("hits",
      [](const Run& run, std::size_t n) { return static_cast<double>(run.walls.at(n).hits); });
  add("impulse", [](const Run& run, std::size_t n) { return run.walls.at(n).impulse; });
  add("pressure", [](const Run& run, std::size_t n) { return run.pressure.at(n); });
  add("budget", [](const Run& run, std::size_t n) { return run.energy.walls.at(n); });
}

void add_budget(const Scene& scene, std::span<const Run> runs, PointSummary& point) {
  if (!acts_on_single_needles(scene)) return;
  add_result("budget_pairs", runs, point, [](const Run& run) { return run.energy.pairs; });
  if (scene.driving.andersen) {
    add_result("budget_thermostat", runs, point,
               [](const Run& run) { return run.energy.thermostat; });
  }
  if (scene.driving.kicks)
    add_result("budget_kicks", runs, point, [](const Run& run) { return run.energy.kicks; });
  if (has_gravity_along_periodic(scene))
    add_result("budget_gravity", runs, point, [](const Run& run) { return run.energy.gravity; });
  if (scene.shear)
    add_result("budget_shear", runs, point, [](const Run& run) { return run.energy.shear; });
  if (scene.driving.growth) {
    add_result("budget_growth", runs, point, [](const Run& run) { return run.energy.growth; });
    add_result("budget_cooling", runs, point, [](const Run& run) { return run.energy.cooling; });
  }
}

// Sizes, packing and pressure of bodies that grow, and their contacts.
void add_growth(std::span<const Run> runs, PointSummary& point) {
  if (runs.empty()) return;  // all have failed
  for (const auto& result : runs.front().growth) {
    const std::string& name = result.first;
    add_result(name, runs, point, [&](const Run& run) -> std::optional<double> {
      const auto found =
          std::ranges::find(run.growth, name, &std::pair<std::string, double>::first);
      if (found == run.growth.end()) return {};
      return found->second;
    });
  }
}

void add_estimates(PointSummary& point, std::span<const Run> runs, const Scene& scene) {
  Totals::for_each_member([&](const Described& total, auto member) {
    if constexpr (std::is_arithmetic_v<std::decay_t<decltype(Totals{}.*member)>>) {
      add_result(total.name, runs, point, [member](const Run& run) {
        return static_cast<double>(run.series.back().*member);
      });
    }
  });
  for (const ResultOf& result : results) add_result(result.name, runs, point, result.value);
  std::ranges::stable_sort(point.results, {}, place_in_tables);
  for (const Scene::WallSide& side : scene.wall_sides())
    add_wall({.axis = static_cast<int>(side.axis), .high = side.is_high}, runs, point);
  add_budget(scene, runs, point);
  add_growth(runs, point);
  point.times = common_times(runs);
  Totals::for_each_sum([&](const Described& sum, auto member) {
    const auto numbers_of = [member](const Totals& sample) {
      if constexpr (std::is_arithmetic_v<std::decay_t<decltype(sample.*member)>>) {
        return std::array{static_cast<double>(sample.*member)};
      } else {
        return sample.*member;
      }
    };
    point.series.push_back(series_over(sum.name, numbers_of, runs, point.times));
  });
}

}  // namespace

Estimate estimate(std::span<const double> values) {
  const double n = static_cast<double>(values.size());
  double sum = 0, squares = 0;
  for (const double x : values) sum += x;
  const double mean = values.empty() ? undefined : sum / n;
  for (const double x : values) squares += (x - mean) * (x - mean);
  return {mean, values.size() > 1 ? std::sqrt(squares / (n * (n - 1))) : undefined};
}

std::vector<PointSummary> summarise(const Grid& grid, const FinishedRun& finished_run) {
  std::vector<PointSummary> summary(grid.points());
  const Scene& scene = grid.members.front().scene;
  for (std::size_t point = 0; point < summary.size(); ++point) {
    std::vector<Run> runs;
    for (std::size_t seed = 0; seed < grid.seeds.size(); ++seed) {
      auto run = finished_run(grid.members[point * grid.seeds.size() + seed]);
      if (!run) continue;
      summary[point].seeds.push_back(grid.seeds[seed]);
      runs.push_back(*std::move(run));
    }
    add_estimates(summary[point], runs, scene);
  }
  return summary;
}

}  // namespace needlework::runs::sweep
