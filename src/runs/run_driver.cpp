#include "src/runs/run_driver.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "src/runs/exact_rates.h"
#include "src/scene/confinement.h"
#include "src/trajectory/saved_totals.h"

namespace needlework::runs {
namespace {

/// Longest time in the event loop between two checks of wall time and of the monitor [s].
constexpr double longest_step = 0.1;
/// Longest time for which results are not yet safe in the file [s].
constexpr double flush_interval = 10;
/// Series begin at this share of the mean free time.
constexpr double first_sample = 0.01;

Schedule series_schedule(const Scene::Output& output, double start) {
  if (output.series_every) return Schedule::linear(*output.series_every);
  return Schedule::logarithmic(output.series_per_decade, start);
}

Schedule frame_schedule(const Scene::Output& output, double start) {
  if (output.frames_every) return Schedule::linear(*output.frames_every);
  if (output.frames_per_decade) return Schedule::logarithmic(*output.frames_per_decade, start);
  return Schedule::at(output.frame_times);
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Counts time from the beginning to the end of its life, also where an exception ends it.
class Timed {
 public:
  explicit Timed(Stopwatch& stopwatch) : stopwatch_(stopwatch) { stopwatch.start(); }
  ~Timed() { stopwatch_.stop(); }

 private:
  Stopwatch& stopwatch_;
};

}  // namespace

RunDriver::RunDriver(Simulation& simulation, const Scene& scene, const Totals& initial,
                     Output output, bool keeps_result)
    : simulation_(simulation),
      scene_(scene),
      output_(output),
      keeps_result_(keeps_result),
      collisions_before_(simulation.collisions()) {
  result_.initial = initial;
  if (!samples()) return;
  const double start = first_sample * simulation.mean_free_time();
  series_ = series_schedule(scene.output, start);
  // A run that is replayed has frames in its schedule, too, as it had when it was saved.
  if (output_.observation) frames_ = frame_schedule(scene.output, start);
}

// Without a mean free time logarithmic schedules have no beginning.
void RunDriver::schedule_if_set_in_motion() {
  const double start = first_sample * simulation_.mean_free_time();
  if (!std::isfinite(start)) return;
  const auto begin = [&](Schedule& schedule, auto make) {
    if (!schedule.is_empty()) return;
    schedule = make(scene_.output, start);
    schedule.pass(std::nextafter(simulation_.time(), 0));  // what is due now is to come
  };
  begin(series_, series_schedule);
  if (output_.observation) begin(frames_, frame_schedule);
}

Stop RunDriver::advance(const Scene::Until& until, RunMonitor& monitor) {
  const auto start = SteadyClock::now();
  if (!begun_) begin(&monitor);
  if (samples()) {
    sample_again();
    schedule_if_set_in_motion();
  }
  monitor.begin(result_.initial, result_.samples, result_.theory_holds);
  // A sum over all needles, which short advances that nobody follows can do without.
  pace_.reset();
  if (monitor.is_due(std::numeric_limits<double>::infinity())) {
    pace_.emplace(simulation_, scene_, until, result_.initial);
  }
  for (;;) {
    if (monitor.stop_requested()) return result_.stop = Stop::interrupted;
    if (until.wall_s && seconds_since(start) >= *until.wall_s) {
      return result_.stop = Stop::wall_time;
    }
    // Steps end at samples, so that the simulation cannot tell.
    const bool has_last_time = (until.time && std::isfinite(*until.time)) || scene_.driving.growth;
    if (!has_last_time && !simulation_.why_no_collision().empty()) {
      return result_.stop = Stop::nothing_can_happen;
    }
    if (const auto stop = step(until, start)) return result_.stop = *stop;
    flush_if_due();
    save_checkpoint_if_due(monitor);
    const double elapsed = seconds_since(start);
    if (pace_ && monitor.is_due(elapsed)) show_progress(elapsed, monitor);
  }
}

RunResult RunDriver::finish() {
  if (failure_) std::rethrow_exception(failure_);
  if (!begun_) begin(nullptr);
  take_last_totals();
  if (samples()) {
    // The end belongs to the series and to the frames, unless it has just been sampled.
    sample(!is_sampled(), !has_frame());
  }
  if (output_.writer) flush();
  if (rate_) result_.system_rate = rate_->estimate(result_.last.time);
  return std::move(result_);
}

void RunDriver::velocities_set(const Totals& before, const Totals& after) {
  if (output_.writer) output_.writer->write_velocities_set(before, after);
  if (output_.observation) output_.observation->velocities_set();
  result_.theory_holds = false;
  sample_is_old_ = last_sample_.has_value();
  frame_is_old_ = last_frame_.has_value();
}

void RunDriver::sample_now(bool frame) {
  if (failure_) std::rethrow_exception(failure_);
  if (!begun_) begin(nullptr);
  sample(!is_sampled(), frame && !has_frame());
}

bool RunDriver::is_sampled() const {
  return last_sample_ && !sample_is_old_ && last_sample_->time == simulation_.time() &&
         last_sample_->collisions == simulation_.collisions();
}

bool RunDriver::has_frame() const { return !frame_is_old_ && last_frame_ == simulation_.time(); }

// If the velocities of the present state were replaced after it was sampled.
void RunDriver::sample_again() {
  const bool series = std::exchange(sample_is_old_, false) && is_sampled();
  const bool frame = std::exchange(frame_is_old_, false) && has_frame();
  sample(series, frame);
}

RunResult RunDriver::abandon() {
  take_last_totals();
  return std::move(result_);
}

void RunDriver::take_last_totals() {
  result_.last = simulation_.totals();
  result_.collisions = result_.last.collisions - collisions_before_;
}

void RunDriver::on_happening(std::function<void(const Happening&)> callback) {
  callback_ = std::move(callback);
  listen();
}

void RunDriver::begin(RunMonitor* monitor) {
  if (keeps_result_ && starts_in_equilibrium(scene_)) rate_.emplace(simulation_.mean_free_time());
  listen();
  if (samples()) {
    sample(!last_sample_, !last_frame_);
    series_.pass(0);
    frames_.pass(0);
  }
  begun_ = true;
  if (output_.saves_start) save_checkpoint(monitor);
}

void RunDriver::transfer(Archive& archive) {
  if (failure_) std::rethrow_exception(failure_);  // what was lost must not count as saved
  bool has_rate = rate_.has_value();
  archive(begun_, series_, frames_, last_sample_, last_frame_, sample_is_old_, frame_is_old_,
          result_.theory_holds, result_.samples, has_rate);
  if (archive.reads()) {
    require_restored(archive);
    rate_.reset();
    if (has_rate) rate_.emplace(simulation_.mean_free_time());
  }
  if (rate_) rate_->transfer(archive);
  if (archive.reads() && !keeps_result_) {
    rate_.reset();
    result_.samples.clear();
  }
  if (archive.reads() && begun_) listen();
}

// Wrong schedules could take samples without end.
void RunDriver::require_restored(const Archive& archive) const {
  const double now = simulation_.time() * (1 - 0x1p-50);
  archive.require(series_.is_rest_of(series_schedule(scene_.output, 1), now) &&
                  frames_.is_rest_of(frame_schedule(scene_.output, 1), now));
  const double turning = simulation_.composition().turning_share();
  const bool falls = has_gravity(scene_);
  archive.require(std::ranges::all_of(
      result_.samples, [&](const Totals& sample) { return are_possible(sample, turning, falls); }));
  // A run begins with a sample, with which that of its end is compared.
  archive.require(!begun_ || last_sample_);
}

void RunDriver::listen() {
  const bool events = output_.writer && scene_.output.events;
  const bool observes = output_.observation && output_.observation->reads_collisions();
  if (rate_) {
    simulation_.on_collision_times([this](std::span<const double> times) {
      for (const double time : times) rate_->add(time);
    });
  } else {
    simulation_.on_collision_times({});
  }
  if (!events && !observes) {
    simulation_.on_happening(callback_);
    return;
  }
  simulation_.on_happening([this](const Happening& happening) {
    record(happening);
    if (callback_) callback_(happening);
  });
}

// The engine cannot continue from an exception in the middle of an event, so it is stopped after
// it. Observables of collisions are of pairs alone.
void RunDriver::record(const Happening& happening) {
  try {
    if (!failure_) {
      if (output_.writer && scene_.output.events) output_.writer->write_event(happening);
      if (happening.is_collision()) output_.observation->collision(happening.event);
    }
  } catch (...) {
    failure_ = std::current_exception();
  }
  if (failure_) simulation_.interrupt();
}

// One call of the event loop; returns a value when one of the conditions is met.
std::optional<Stop> RunDriver::step(const Scene::Until& until, SteadyClock::time_point start) {
  Scene::Until limits = until;
  const double next = std::min(series_.next(), frames_.next());
  const bool to_sample = std::isfinite(next) && !(until.time && *until.time <= next);
  if (to_sample) limits.time = next;
  limits.wall_s = longest_step;
  if (until.wall_s) {
    limits.wall_s = std::clamp(*until.wall_s - seconds_since(start), 0.0, longest_step);
  }

  const Stop stop = [&] {
    if (!prepared_) {
      const Timed timed(result_.setup);
      if (const auto early = simulation_.prepare(limits)) return *early;
      prepared_ = true;
    }
    const Timed timed(result_.loop);
    return simulation_.advance(limits);
  }();
  if (failure_) std::rethrow_exception(failure_);  // here and in every later call
  if (stop == Stop::wall_time) return std::nullopt;
  if (stop != Stop::time || !to_sample) return stop;
  sample(series_.next() <= next && !is_sampled(), frames_.next() <= next && !has_frame());
  series_.pass(next);
  frames_.pass(next);
  return std::nullopt;
}

void RunDriver::sample(bool series, bool frame) {
  if (!series && !frame) return;
  const Totals totals = simulation_.totals();
  io::Writer* const writer = output_.writer;
  observe::Observation* const observation = output_.observation;
  const bool reads_state = observation && series && observation->reads_state();
  State state;
  if (reads_state || (writer && frame)) simulation_.copy(state);
  if (series) {
    if (keeps_result_) result_.samples.push_back(totals);
    if (observation) {
      observe::SpeciesSums species;
      if (simulation_.composition().is_mixture()) {
        species = {simulation_.species_totals(), simulation_.collisions_by_pair()};
      }
      species.walls = simulation_.wall_totals();
      species.energy = simulation_.energy_budget();
      species.virial = simulation_.virial();
      if (simulation_.composition().has_width())
        species.t_tr_integral = simulation_.t_tr_integral();
      species.contacts = simulation_.sliding_contacts().value_or(SlidingContacts{});
      species.stress = simulation_.stress_sums().value_or(StressSums{});
      species.growth = simulation_.growth().value_or(GrowthTotals{});
      // Of a uniform flow, observables see what is beside it.
      if (!state.peculiar_velocity.empty()) state.velocity.swap(state.peculiar_velocity);
      const auto values = observation->sample(state, totals, species);
      if (!state.peculiar_velocity.empty()) state.velocity.swap(state.peculiar_velocity);
      if (writer) writer->write_series(totals, values);
    }
    last_sample_ = totals;
    sample_is_old_ = false;
  }
  if (frame && writer) {
    writer->write_frame(totals, state);
    last_frame_ = totals.time;
    frame_is_old_ = false;
    flush();
  }
}

void RunDriver::flush() {
  output_.writer->flush();
  last_flush_ = SteadyClock::now();
}

void RunDriver::flush_if_due() {
  if (output_.writer && seconds_since(last_flush_) >= flush_interval) flush();
}

void RunDriver::save_checkpoint(RunMonitor* monitor) {
  if (!output_.save_checkpoint) return;
  const auto start = SteadyClock::now();
  output_.save_checkpoint();
  saved_ = {simulation_.time(), simulation_.collisions()};
  last_checkpoint_ = last_flush_ = SteadyClock::now();
  if (!monitor) return;
  monitor->saved(simulation_.time(), simulation_.collisions(), seconds_since(start));
}

bool RunDriver::is_saved() const {
  return saved_ == std::pair(simulation_.time(), simulation_.collisions());
}

void RunDriver::save_checkpoint_if_due(RunMonitor& monitor) {
  if (seconds_since(last_checkpoint_) >= scene_.output.checkpoint_every) save_checkpoint(&monitor);
}

void RunDriver::show_progress(double elapsed, RunMonitor& monitor) const {
  Progress progress = pace_->after(elapsed);
  if (output_.save_checkpoint) progress.since_checkpoint = seconds_since(last_checkpoint_);
  monitor.show(progress);
}

}  // namespace needlework::runs
