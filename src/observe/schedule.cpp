#include "src/observe/schedule.h"

#include <cmath>
#include <utility>

namespace needlework {

Schedule Schedule::logarithmic(double per_decade, double start) {
  Schedule schedule;
  if (!(start > 0) || !std::isfinite(start)) return schedule;
  schedule.per_decade_ = per_decade;
  // The logarithm is rounded, so this starts one too low and then increases to the start.
  schedule.n_ = std::ceil(std::log10(start) * per_decade) - 1;
  while (schedule.grid_time(schedule.n_) < start) ++schedule.n_;
  schedule.next_ = schedule.grid_time(schedule.n_);
  return schedule;
}

Schedule Schedule::linear(double step) {
  Schedule schedule;
  schedule.step_ = step;
  schedule.n_ = 1;
  schedule.next_ = step;
  return schedule;
}

Schedule Schedule::at(std::vector<double> times) {
  Schedule schedule;
  schedule.times_ = std::move(times);
  if (!schedule.times_.empty()) schedule.next_ = schedule.times_.front();
  return schedule;
}

double Schedule::grid_time(double n) const {
  return step_ > 0 ? n * step_ : std::pow(10.0, n / per_decade_);
}

double Schedule::time_of_next() const {
  if (per_decade_ > 0 || step_ > 0) return grid_time(n_);
  return position_ < times_.size() ? times_[position_] : std::numeric_limits<double>::infinity();
}

void Schedule::pass(double time) {
  while (next_ <= time) {
    per_decade_ > 0 || step_ > 0 ? void(++n_) : void(++position_);
    next_ = time_of_next();
  }
}

}  // namespace needlework
