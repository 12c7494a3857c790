#include "src/runs/prepared_run.h"

#include <fmt/format.h>

#include <new>
#include <utility>

#include "needlework/error.h"
#include "src/observe/cooling_theory.h"
#include "src/runs/state_file.h"
#include "src/scene/check.h"

namespace needlework::runs {

void require_events(Simulation& simulation, const Scene& scene, const std::string& path) {
  if (scene.until.time) return;
  Scene::Until at_once;
  at_once.collisions_per_needle = 0;
  if (simulation.advance(at_once) == Stop::nothing_can_happen) {
    throw InputError(path + ": nothing can ever happen: expected needles that move, or until.time");
  }
}

namespace {

// Where kinetic theory has something to say: of a drawn gas that moves.
observe::ObservablePointer cooling_theory(const Scene& scene, const Totals& initial, bool drawn) {
  if (!drawn || !(initial.energy > 0)) return nullptr;
  return observe::make_cooling_theory(
      {scene.needles.k, scene.collisions.epsilon, scene.collisions.beta},
      {initial.t_tr, initial.t_rot}, theory_density_of(scene));
}

}  // namespace

void PreparedRun::open_output(bool drawn, bool force) {
  const std::string& file = scene_.output.file;
  if (file.empty()) return;
  observation_.emplace(scene_, cooling_theory(scene_, simulation_.totals(), drawn));
  try {
    io::RunInfo info = run_info(simulation_, scene_);
    info.series = observation_->groups();
    writer_.emplace(file, force, scene_, info);
  } catch (const IoError& error) {
    throw IoError(fmt::format("{}: cannot be written: {}", place_of(scene_, "output.file", file),
                              error.what()));
  }
}

PreparedRun::PreparedRun(LoadedScene loaded, bool force, const std::string& path)
    : PreparedRun(std::move(loaded), force, &path) {}

PreparedRun::PreparedRun(LoadedScene loaded, bool force)
    : PreparedRun(std::move(loaded), force, nullptr) {}

PreparedRun::PreparedRun(LoadedScene loaded, bool force, const std::string* path)
    : scene_(std::move(loaded.scene)), simulation_(make_simulation(loaded)) {
  const bool drawn = !loaded.initial;
  loaded.initial.reset();
  if (path) require_events(simulation_, scene_, *path);
  open_output(drawn, force);
  const Output output{.writer = writer_ ? &*writer_ : nullptr,
                      .observation = observation_ ? &*observation_ : nullptr};
  driver_.emplace(simulation_, scene_, output, path != nullptr);
}

Simulation PreparedRun::make_simulation(const LoadedScene& loaded) {
  setup_.start();
  Simulation simulation = loaded.initial ? Simulation(scene_, *loaded.initial) : Simulation(scene_);
  setup_.stop();
  return simulation;
}

Course PreparedRun::drive(RunMonitor& monitor) {
  std::optional<std::string> failure;
  try {
    driver_->advance(scene_.until, monitor);
  } catch (const InvalidStateError& error) {
    failure = error.what();
  }
  monitor.clear();
  Course course = driver_->finish();
  course.failure = std::move(failure);
  if (writer_) writer_->close();
  return course;
}

Stop PreparedRun::advance(const Scene::Until& until, RunMonitor& monitor) {
  if (!batches_) return driver_->advance(until, monitor);
  Stop stop{};
  try {
    stop = driver_->advance(until, monitor);
  } catch (const std::bad_alloc&) {
    throw;  // in the middle of an event, so that it must not be replaced by an error of the caller
  } catch (...) {
    batches_->flush();
    throw;
  }
  batches_->flush();
  return stop;
}

void PreparedRun::on_collisions(std::size_t batch, CollisionBatches::Callback callback) {
  driver_->on_collision({});
  batches_.reset();
  if (!callback) return;
  batches_.emplace(simulation_, batch, std::move(callback));
  driver_->on_collision([this](const Collision& collision) { batches_->add(collision); });
}

void PreparedRun::close() {
  if (!writer_) return;
  driver_->finish();
  writer_->close();
  writer_.reset();
}

}  // namespace needlework::runs
