#include "src/runs/prepared_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <utility>

#include "needlework/error.h"
#include "src/io/atomic_file.h"
#include "src/io/output_file.h"
#include "src/io/write_lock.h"
#include "src/observe/cooling_theory.h"
#include "src/runs/failure.h"
#include "src/runs/state_file.h"
#include "src/scene/check.h"
#include "src/scene/confinement.h"
#include "src/scene/validity.h"
#include "src/trajectory/saved_totals.h"

namespace needlework::runs {

void require_events(const LoadedScene& loaded, const std::string& path) {
  const Scene& scene = loaded.scene;
  require_rules(scene, Aspect::end);
  if (scene.until.time || scene.driving.growth) return;  // which ends by itself
  const std::string why =
      loaded.initial ? why_no_collision(scene, *loaded.initial) : why_no_collision(scene);
  if (!why.empty()) {
    throw InputError(fmt::format(
        "{}: nothing can ever happen, as {}: expected needles that can collide, or until.time",
        path, why));
  }
}

namespace {

constexpr const char* cut_off_by_an_error =
    "an error came in the middle of an event: expected a state that is sound";
[[noreturn]] void throw_damaged(const RunCheckpoint::Origin& origin) {
  throw InputError(origin.path +
                   ": damaged: its parts do not belong together: expected a checkpoint that this "
                   "version of the program has written");
}

LoadedScene with_events(LoadedScene loaded, const std::string& path) {
  require_events(loaded, path);
  return loaded;
}

// Where kinetic theory has something to say: of a drawn, uniform gas that moves by itself. One that
// is continued goes to its place by itself.
observe::ObservablePointer cooling_theory(const Scene& scene, const Totals& initial,
                                          const Simulation& simulation, bool drawn) {
  if (!drawn || !(initial.energy > 0) || acts_on_single_needles(scene)) return nullptr;
  const Composition composition = scene.composition();
  if (composition.has_width()) return nullptr;  // it is that of low density alone
  if (beyond_cooling_theory(composition)) return nullptr;
  if (composition.is_mixture()) {
    if (!has_mixture_theory(composition)) return nullptr;
    std::vector<theory::Temperatures> now;
    for (const SpeciesTotals& each : simulation.species_totals()) {
      now.push_back({each.count > 0 ? each.t_tr : 0, each.count > 0 ? each.t_rot : 0});
    }
    return observe::make_mixture_theory(composition, volume_of(scene), now);
  }
  return observe::make_cooling_theory(
      {composition[0].k, composition.restitution(0, 0).epsilon, composition.restitution(0, 0).beta},
      {initial.t_tr, initial.t_rot}, theory_density_of(scene));
}

}  // namespace

// Makes the writer by open(run_info), if there is a file to write.
template <class Open>
void PreparedRun::open_output(Open&& open) {
  const std::string& file = scene_.output.file;
  if (file.empty()) return;
  output_file_ = io::absolute_name(file);
  observe();
  try {
    io::RunInfo info = run_info(simulation_, scene_);
    info.series = observation_->groups();
    writer_.emplace(open(info));
  } catch (const IoError& error) {
    throw IoError(fmt::format("{}: cannot be written: {}", place_of(scene_, "output.file", file),
                              error.what()));
  }
}

void PreparedRun::observe() {
  if (observation_) return;
  observe::SpeciesById species;
  const Composition& composition = simulation_.composition();
  const bool may_differ = composition.is_mixture() || composition.has_own_sizes();
  if ((may_differ && !scene_.output.observables.empty()) || scene_.output.size_classes) {
    State state = simulation_.copy();
    species = {std::move(state.id), std::move(state.species), simulation_.own_bodies_at_start()};
  }
  observation_.emplace(scene_, cooling_theory(scene_, initial_, simulation_, drawn_),
                       std::move(species));
}

Output PreparedRun::output() {
  Output out;
  if (observation_) out.observation = &*observation_;
  if (!writer_) return out;
  out.writer = &*writer_;
  if (scene_.output.checkpoint_every > 0) out.save_checkpoint = [this] { save_checkpoint(); };
  out.saves_start = saves_ == Saves::start_and_end;
  return out;
}

PreparedRun::PreparedRun(LoadedScene loaded, bool force, const std::string& path, Saves saves)
    : PreparedRun(with_events(std::move(loaded), path), force, true, saves) {}

PreparedRun::PreparedRun(LoadedScene loaded, bool force)
    : PreparedRun(std::move(loaded), force, false, Saves::start_and_end) {}

PreparedRun::PreparedRun(LoadedScene loaded, bool force, bool keeps_result, Saves saves)
    : scene_(std::move(loaded.scene)),
      saves_(saves),
      drawn_(!loaded.initial),
      simulation_(make_simulation(loaded)),
      initial_(simulation_.totals()) {
  loaded.initial.reset();
  open_output(
      [&](const io::RunInfo& info) { return io::Writer(scene_.output.file, force, scene_, info); });
  // Those of an older run, whose file has just been replaced.
  if (writer_) checkpoints().remove();
  driver_.emplace(simulation_, scene_, initial_, output(), keeps_result);
}

PreparedRun::PreparedRun(RunCheckpoint saved, Saves saves)
    : scene_(std::move(saved.scene)),
      saves_(saves),
      drawn_(saved.drawn),
      velocities_set_(saved.velocities_set),
      data_(std::move(saved.data)),
      simulation_(continue_simulation(saved)),
      initial_(saved.initial) {
  require_consistent(saved);
  observe();
  open_output([&](io::RunInfo info) {
    info.ids = simulation_.copy().id;
    // While the file is locked, and before it is changed.
    return io::Writer::resume(scene_.output.file, scene_, info, saved.output, [&] {
      CheckpointFiles::require_unchanged(saved.origin);
      if (scene_.output.checkpoint_every > 0) checkpoints().require_writable();
      // Whether it can be restored has to be known as well.
      RunDriver driver(simulation_, scene_, initial_, {}, true);
      restore(saved, driver);
    });
  });
  // A run that is saved again keeps its course for the one who continues it next.
  driver_.emplace(simulation_, scene_, initial_, output(), writer_.has_value());
  restore(saved, *driver_);
  // The only whole one is kept until there is another.
  if (saved.origin.instead_of_newest) save_checkpoint(CheckpointFiles::Newest::is_replaced);
}

void PreparedRun::require_consistent(const RunCheckpoint& saved) const {
  const double energy = simulation_.initial_energy();
  // That of heights may cancel the rest.
  const double scale = std::max(std::abs(energy), 1.5 * initial_.t_tr + initial_.t_rot);
  const bool consistent =
      simulation_.needles() == scene_.needles.count &&
      are_possible(initial_, simulation_.composition().turning_share(), has_gravity(scene_)) &&
      initial_.time == 0 && initial_.collisions == 0 &&
      (scene_.needles.count == 0 || std::abs(initial_.energy - energy) <= 1e-9 * scale);
  if (!consistent) throw_damaged(saved.origin);
}

void PreparedRun::restore(const RunCheckpoint& saved, RunDriver& driver) {
  try {
    Archive archive = Archive::from(saved.observation);
    observation_->transfer(archive);
    driver.transfer(archive);
    archive.require_end();
  } catch (const InputError&) {
    throw_damaged(saved.origin);
  }
}

Simulation PreparedRun::make_simulation(const LoadedScene& loaded) {
  setup_.start();
  Simulation simulation = loaded.initial ? Simulation(scene_, *loaded.initial) : Simulation(scene_);
  setup_.stop();
  return simulation;
}

Simulation PreparedRun::continue_simulation(const RunCheckpoint& saved) {
  setup_.start();
  try {
    Simulation simulation(scene_, saved.simulation);
    setup_.stop();
    return simulation;
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", saved.origin.path, error.what()));
  }
}

std::string PreparedRun::warning() const {
  return writer_ ? io::warning_without_locks(output_file_, scene_.output.file) : "";
}

CheckpointFiles PreparedRun::checkpoints() const { return CheckpointFiles(output_file_); }

std::string PreparedRun::why_no_output() const {
  if (scene_.output.file.empty()) {
    return "the simulation has no output file: expected output.file in its scene";
  }
  if (!writer_) return "the simulation is closed: expected one that can be run";
  if (cut_off_) return cut_off_by_an_error;
  return {};
}

std::string PreparedRun::why_not_saved() const {
  if (scene_.output.file.empty()) {
    return "the simulation has no output file, beside which checkpoints are written: expected "
           "output.file in its scene";
  }
  if (scene_.output.checkpoint_every == 0) {
    return place_of(scene_, "output.checkpoint_every", "0") +
           ": turns checkpoints off: expected a number > 0";
  }
  return why_no_output();
}

void PreparedRun::save_checkpoint() { save_checkpoint(CheckpointFiles::Newest::becomes_older); }

void PreparedRun::save_checkpoint(CheckpointFiles::Newest present) {
  if (!why_not_saved().empty()) return;
  // First the rows that the checkpoint counts.
  writer_->sync();
  RunCheckpoint saved{.scene = scene_,
                      .drawn = drawn_,
                      .initial = initial_,
                      .simulation = simulation_.checkpoint(),
                      .output = writer_->position(),
                      .velocities_set = velocities_set_,
                      .data = data_};
  Archive archive = Archive::to(saved.observation);
  observation_->transfer(archive);
  driver_->transfer(archive);
  checkpoints().write(saved, present);
  set_since_saved_ = false;
}

// What a failed run leaves: the message, the needles that it is about, and the name of the bundle,
// or none; then the message says why.
struct PreparedRun::Kept {
  std::string message;
  InvalidStateError::Needles needles;
  std::string bundle;
};

// The last checkpoint in a file, or else the start; nothing if the start is not known any more.
std::optional<RunCheckpoint> PreparedRun::before_failure() const {
  try {
    return checkpoints().latest().checkpoint;
  } catch (const InputError&) {
  } catch (const IoError&) {
  }
  if (!drawn_ && scene_.initial.file.empty()) return std::nullopt;
  return RunCheckpoint{.drawn = drawn_, .initial = initial_};
}

// Keeps a bundle that shows the same failure: it may begin earlier.
void PreparedRun::write_bundle(const RunFailure& failure) {
  CheckpointFiles files = checkpoints();
  try {
    if (CheckpointFiles::read(files.bundle()).failure == failure) return;
  } catch (const InputError&) {
  } catch (const IoError&) {
  }
  if (set_since_saved_) throw IoError("a caller has set velocities since the last checkpoint");
  auto checkpoint = before_failure();
  if (!checkpoint) throw IoError("its start is in no file");
  checkpoint->scene = scene_;
  checkpoint->failure = failure;
  files.write_bundle(*checkpoint);
}

PreparedRun::Kept PreparedRun::keep_failure(const std::string& message,
                                            const InvalidStateError::Needles& needles) {
  if (!writer_) return {message, needles, {}};
  try {
    write_bundle({.message = message,
                  .needles = needles,
                  .time = simulation_.time(),
                  .collisions = simulation_.collisions(),
                  .trajectory_hash = simulation_.trajectory_hash(),
                  .version = NEEDLEWORK_VERSION});
    return {message, needles, io::name_from_here(checkpoints().bundle())};
  } catch (const std::exception& error) {
    return {
        fmt::format("{}; no bundle for needlework replay: {}", message, error.what()), needles, {}};
  }
}

// Notes whether the exception being handled, which has ended an advance, came in the middle of an
// event, and keeps it. Throws it again if it is not about the state of the run.
PreparedRun::Kept PreparedRun::keep_current_failure() {
  InvalidStateError::Needles needles;
  try {
    throw;
  } catch (const UnfinishedEventError& error) {
    cut_off_ = true;
    needles = error.needles;
  } catch (const InvalidStateError& error) {
    needles = error.needles;
  } catch (const InputError&) {  // of the conditions, before any event
    throw;
  } catch (const IoError&) {  // of the output, after an event
    throw;
  } catch (...) {
    cut_off_ = true;
  }
  const Failure failure = current_failure();
  if (failure.exit_code != invalid_state) throw;
  return keep_failure(failure.message, needles);
}

// What a front end is told of the exception being handled.
std::exception_ptr PreparedRun::error_for_caller() {
  try {
    auto [message, needles, bundle] = keep_current_failure();
    if (!bundle.empty()) message += fmt::format("; needlework replay {} shows it again", bundle);
    if (cut_off_) return std::make_exception_ptr(UnfinishedEventError(message, needles));
    return std::make_exception_ptr(InvalidStateError(message, needles));
  } catch (...) {
    return std::current_exception();
  }
}

RunResult PreparedRun::drive(RunMonitor& monitor, double spent) {
  std::optional<Kept> kept;
  try {
    Scene::Until until = scene_.until;
    if (until.wall_s) until.wall_s = std::max(0.0, *until.wall_s - spent);
    driver_->advance(until, monitor);
  } catch (const std::exception&) {
    kept = keep_current_failure();
  }
  monitor.clear();
  // Before the sample and the frame of this end, which the continued run does not have.
  const bool stopped = driver_->stop() == Stop::interrupted || driver_->stop() == Stop::wall_time;
  const bool saves = why_not_saved().empty() && (stopped || saves_ == Saves::start_and_end);
  if (saves && !driver_->is_saved()) driver_->save_checkpoint(&monitor);
  RunResult result = cut_off_ ? driver_->abandon() : driver_->finish();
  if (kept) {
    result.failure = std::move(kept->message);
    result.bundle = std::move(kept->bundle);
  }
  if (writer_) writer_->close();
  return result;
}

Stop PreparedRun::advance(const Scene::Until& until, RunMonitor& monitor) {
  if (cut_off_) throw InvalidStateError(cut_off_by_an_error);
  if (writer_) io::require_process(process_, scene_.output.file);
  Stop stop{};
  std::exception_ptr failure;
  try {
    stop = driver_->advance(until, monitor);
  } catch (...) {
    failure = error_for_caller();
  }
  const auto flush = [&](auto& batches) {
    try {
      if (batches) batches->flush();
    } catch (...) {
      // An error of the caller does not replace that of the run.
      if (!failure) failure = std::current_exception();
    }
  };
  flush(collisions_);
  flush(happenings_);
  if (failure) std::rethrow_exception(failure);
  return stop;
}

void PreparedRun::set_velocities(std::span<const std::array<double, 3>> velocity,
                                 std::span<const std::array<double, 3>> angular_velocity) {
  if (cut_off_) throw InvalidStateError(cut_off_by_an_error);
  // A file that cannot be written must not lack what has been done.
  if (writer_) writer_->require_writable();
  const Totals before = simulation_.totals();
  simulation_.set_velocities(velocity, angular_velocity);
  if (!velocities_set_) velocities_set_ = before.time;
  set_since_saved_ = true;
  const bool closed = !output_file_.empty() && !writer_;
  if (!closed) driver_->velocities_set(before, simulation_.totals());
}

void PreparedRun::sample(bool frame) {
  if (const std::string why = why_no_output(); !why.empty()) throw InputError(why);
  writer_->require_writable();
  driver_->sample_now(frame);
}

void PreparedRun::set_data(const std::string& name, std::optional<UserData> data) {
  require_valid_data(name, data.value_or(UserData{}));
  const auto found = data_.find(name);
  const bool same = found == data_.end() ? !data : data && found->second == *data;
  if (same) return;
  if (writer_) writer_->write_data(simulation_.totals(), name, data ? &*data : nullptr);
  if (data) {
    data_[name] = *std::move(data);
  } else {
    data_.erase(found);
  }
}

void PreparedRun::on_collisions(std::size_t batch, Batches<Collision>::Callback callback) {
  collisions_.reset();
  if (callback) collisions_.emplace(simulation_, batch, std::move(callback));
  listen();
}

void PreparedRun::on_happenings(std::size_t batch, Batches<Happening>::Callback callback) {
  happenings_.reset();
  if (callback) happenings_.emplace(simulation_, batch, std::move(callback));
  listen();
}

void PreparedRun::listen() {
  if (!collisions_ && !happenings_) return driver_->on_happening({});
  driver_->on_happening([this](const Happening& happening) {
    if (collisions_ && happening.is_collision()) collisions_->add(happening.event);
    if (happenings_) happenings_->add(happening);
  });
}

void PreparedRun::close() {
  if (!writer_) return;
  // Also after an error: as long as there is a writer, nobody else can continue the file.
  struct Release {
    ~Release() { writer.reset(); }
    std::optional<io::Writer>& writer;
  } const release{writer_};
  save_checkpoint();
  if (!cut_off_) driver_->finish();
  writer_->close();
}

}  // namespace needlework::runs
