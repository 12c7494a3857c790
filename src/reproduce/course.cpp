#include "src/reproduce/course.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "src/runs/sweep_summary.h"

namespace needlework::reproduce {
namespace {

double density_of(const Scene& scene) {
  const auto& box = scene.needles.box;
  return static_cast<double>(scene.needles.count) / (box[0] * box[1] * box[2]);
}

}  // namespace

double time_scale(const Scene& scene) {
  const double gamma = 2.0 / 3.0 * std::sqrt(std::numbers::pi) * density_of(scene);
  return gamma * std::sqrt(scene.initial.t_tr);
}

std::vector<double> taus_of(const FinishedRun& run) {
  const double scale = time_scale(*run.scene);
  std::vector<double> taus;
  for (const Totals& sample : run.series) taus.push_back(scale * sample.time);
  return taus;
}

std::vector<double> collisions_of(const FinishedRun& run) {
  std::vector<double> collisions;
  for (const Totals& sample : run.series) {
    collisions.push_back(2 * static_cast<double>(sample.collisions) /
                         static_cast<double>(run.scene->needles.count));
  }
  return collisions;
}

double interpolated(std::span<const double> x, std::span<const double> y, double place) {
  const auto above = std::lower_bound(x.begin(), x.end(), place);
  if (above == x.end()) return std::numeric_limits<double>::quiet_NaN();
  const auto n = static_cast<std::size_t>(above - x.begin());
  if (x[n] == place) return y[n];
  if (n == 0) return std::numeric_limits<double>::quiet_NaN();
  return std::lerp(y[n - 1], y[n], (place - x[n - 1]) / (x[n] - x[n - 1]));
}

std::size_t sample_near(const FinishedRun& run, double collisions) {
  const std::vector<double> all = collisions_of(run);
  const auto nearest = std::min_element(all.begin(), all.end(), [&](double a, double b) {
    return std::abs(a - collisions) < std::abs(b - collisions);
  });
  return static_cast<std::size_t>(nearest - all.begin());
}

std::size_t frame_near(const FinishedRun& run, const io::FrameFile& frames, double collisions) {
  const double time = run.series[sample_near(run, collisions)].time;
  std::size_t nearest = 0;
  for (std::size_t frame = 1; frame < frames.count(); ++frame) {
    if (std::abs(*frames.time(frame) - time) < std::abs(*frames.time(nearest) - time)) {
      nearest = frame;
    }
  }
  return nearest;
}

Measured mean_of(std::span<const double> values) {
  const runs::sweep::Estimate estimate = runs::sweep::estimate(values);
  return {estimate.mean, estimate.standard_error, values.size()};
}

Measured measure(const Point& point, const std::function<double(const FinishedRun&)>& number) {
  std::vector<double> values;
  for (const FinishedRun& run : point.runs) values.push_back(number(run));
  return mean_of(values);
}

MeanCurve mean_curve(
    const Point& point, std::span<const double> places,
    const std::function<std::pair<std::vector<double>, std::vector<double>>(const FinishedRun&)>&
        curve) {
  std::vector<std::pair<std::vector<double>, std::vector<double>>> curves;
  for (const FinishedRun& run : point.runs) curves.push_back(curve(run));
  MeanCurve result;
  for (const double place : places) {
    std::vector<double> values;
    for (const auto& [x, y] : curves) values.push_back(interpolated(x, y, place));
    const Measured mean = mean_of(values);
    result.x.push_back(place);
    result.mean.push_back(mean.value);
    result.error.push_back(mean.error);
  }
  return result;
}

std::vector<double> steps(double first, double last, std::size_t count) {
  std::vector<double> all;
  for (std::size_t n = 0; n <= count; ++n) {
    all.push_back(std::lerp(first, last, static_cast<double>(n) / static_cast<double>(count)));
  }
  return all;
}

std::string start_of(const Scene& scene) {
  return fmt::format("k = {:g}, T_rot(0) = {:g}", scene.needles.k, scene.initial.t_rot);
}

std::string start_in_chart(const Scene& scene) {
  return fmt::format("k = {:g}, T_{{rot}}(0) = {:g}", scene.needles.k, scene.initial.t_rot);
}

}  // namespace needlework::reproduce
