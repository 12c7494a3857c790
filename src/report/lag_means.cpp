#include "src/report/lag_means.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace needlework::report {
namespace {

constexpr double tolerance = 1e-6;  // of times, which are sums of many steps

bool are_close(double a, double b) { return std::abs(a - b) <= tolerance * std::abs(b); }

// The median distance of two samples, and 0 if it is not that of most.
double usual_step(const std::vector<double>& times) {
  std::vector<double> steps;
  for (std::size_t n = 1; n < times.size(); ++n) steps.push_back(times[n] - times[n - 1]);
  if (steps.empty()) return 0;
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::ranges::nth_element(steps, middle);
  const double step = *middle;
  const auto usual =
      std::ranges::count_if(steps, [&](double each) { return are_close(each, step); });
  return 2 * usual > static_cast<std::ptrdiff_t>(steps.size()) ? step : 0;
}

}  // namespace

LagMeans::LagMeans(const io::Contents& contents, const std::string& group) : contents_(contents) {
  const std::vector<double> lag = contents.numbers(group + "/lag");
  const std::vector<double> in_samples = contents.numbers(group + "/samples");
  const std::vector<double> times = contents.numbers(group + "/lag/time");
  const double step = usual_step(times);
  rows_ = times.size();
  is_mean_ = step > 0;
  const std::size_t width = rows_ == 0 ? 0 : lag.size() / rows_;
  counts_.resize(lag.size());
  for (std::size_t n = 0; n < lag.size(); ++n) {
    counts_[n] = is_mean_ ? are_close(lag[n], step * in_samples[n % in_samples.size()])
                          : n + width >= lag.size();
  }
}

std::vector<double> LagMeans::of(const std::string& dataset) const {
  const std::vector<double> values = contents_.numbers(dataset);
  const std::size_t width = counts_.size() / std::max<std::size_t>(rows_, 1);
  std::vector<double> sum(width), count(width);
  for (std::size_t n = 0; n < std::min(values.size(), counts_.size()); ++n) {
    if (!counts_[n] || std::isnan(values[n])) continue;
    sum[n % width] += values[n];
    ++count[n % width];
  }
  for (std::size_t n = 0; n < width; ++n) {
    sum[n] = count[n] > 0 ? sum[n] / count[n] : std::numeric_limits<double>::quiet_NaN();
  }
  return sum;
}

}  // namespace needlework::report
