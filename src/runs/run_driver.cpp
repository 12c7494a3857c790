#include "src/runs/run_driver.h"

#include <algorithm>
#include <cmath>

#include "needlework/error.h"
#include "src/observe/completion.h"
#include "src/runs/loaded_scene.h"

namespace needlework::runs {
namespace {

/// Longest time in the event loop between two checks of wall time and signals [s].
constexpr double longest_step = 0.25;
/// Longest time for which results are not yet safe in the file [s].
constexpr double flush_interval = 10;
/// Series begin at this share of the mean free time.
constexpr double first_sample = 0.01;

Schedule frame_schedule(const Scene::Output& output, double start) {
  if (output.file.empty()) return {};
  if (output.frames_per_decade) return Schedule::logarithmic(*output.frames_per_decade, start);
  return Schedule::at(output.frame_times);
}

}  // namespace

RunDriver::RunDriver(Simulation& simulation, const Scene& scene, io::Writer* writer,
                     RunMonitor& monitor)
    : simulation_(simulation), scene_(scene), writer_(writer), monitor_(monitor) {
  const double start = first_sample * simulation.mean_free_time();
  series_ = Schedule::logarithmic(scene.output.series_per_decade, start);
  frames_ = frame_schedule(scene.output, start);
}

Course RunDriver::run() {
  start_ = std::chrono::steady_clock::now();
  listen_to_collisions();
  course_.initial = simulation_.totals();
  sample(true, true);
  series_.pass(0);
  frames_.pass(0);
  try {
    step_until_end();
  } catch (const InvalidStateError& error) {
    course_.failure = error.what();
    course_.loop.stop();
  }
  monitor_.clear();
  sample_end();
  if (rate_) course_.system_rate = rate_->estimate(course_.last.time);
  return std::move(course_);
}

double RunDriver::elapsed() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

void RunDriver::listen_to_collisions() {
  const bool events = writer_ && scene_.output.events;
  if (starts_in_equilibrium(scene_)) rate_.emplace(simulation_.mean_free_time());
  if (!rate_ && !events) return;
  simulation_.on_collision([this, events](const Collision& collision) {
    if (rate_) rate_->add(collision.time);
    if (events) writer_->write_event(collision);
  });
}

void RunDriver::step_until_end() {
  for (;;) {
    if (monitor_.stop_requested()) {
      course_.stop = Stop::interrupted;
      return;
    }
    if (scene_.until.wall_s && elapsed() >= *scene_.until.wall_s) {
      course_.stop = Stop::wall_time;
      return;
    }
    if (const auto stop = step()) {
      course_.stop = *stop;
      return;
    }
    keep_safe();
    if (monitor_.is_due(elapsed())) show_progress();
  }
}

// One call of the event loop; returns a value when one of the scene's own conditions is met.
std::optional<Stop> RunDriver::step() {
  Scene::Until until = scene_.until;
  const double next = std::min(series_.next(), frames_.next());
  const bool to_sample = std::isfinite(next) && !(until.time && *until.time <= next);
  if (to_sample) until.time = next;
  until.wall_s = longest_step;
  if (scene_.until.wall_s) {
    until.wall_s = std::clamp(*scene_.until.wall_s - elapsed(), 0.0, longest_step);
  }

  course_.loop.start();
  const Stop stop = simulation_.advance(until);
  course_.loop.stop();

  if (stop == Stop::wall_time || stop == Stop::interrupted) return std::nullopt;
  if (stop != Stop::time || !to_sample) return stop;
  sample(series_.next() <= next, frames_.next() <= next);
  series_.pass(next);
  frames_.pass(next);
  return std::nullopt;
}

void RunDriver::sample(bool series, bool frame) {
  const Totals totals = simulation_.totals();
  if (series) {
    course_.samples.push_back(totals);
    if (writer_) writer_->write_series(totals);
  }
  if (frame && writer_) {
    writer_->write_frame(totals, simulation_.copy());
    last_frame_ = totals.time;
    writer_->flush();
    last_flush_ = elapsed();
  }
}

// The end belongs to the series and to the frames, unless it has just been sampled.
void RunDriver::sample_end() {
  course_.last = simulation_.totals();
  const Totals& sampled = course_.samples.back();
  const bool series =
      sampled.time != course_.last.time || sampled.collisions != course_.last.collisions;
  const bool frame = last_frame_ != course_.last.time;
  sample(series, frame);
  if (writer_) writer_->flush();
}

void RunDriver::keep_safe() {
  if (!writer_ || elapsed() - last_flush_ < flush_interval) return;
  writer_->flush();
  last_flush_ = elapsed();
}

void RunDriver::show_progress() {
  const Totals now = simulation_.totals();
  const double fraction = completed_fraction(scene_.until, course_.initial, now,
                                             static_cast<double>(scene_.needles.count), elapsed());
  monitor_.show(elapsed(), fraction, now, course_.initial.energy);
}

}  // namespace needlework::runs
