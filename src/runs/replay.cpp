#include "src/runs/replay.h"

#include <algorithm>
#include <span>
#include <utility>

#include "needlework/error.h"
#include "src/runs/engine_choice.h"
#include "src/runs/failure.h"
#include "src/runs/loaded_scene.h"
#include "src/scene/confinement.h"

namespace needlework::runs {
namespace {

void make_ready(Scene& scene, const std::function<void(Scene&)>& change) {
  scene.output.file.clear();
  scene.until.wall_s.reset();
  const auto here = instruction_sets();
  if (std::find(here.begin(), here.end(), scene.engine.isa) == here.end())
    scene.engine.isa = "auto";
  if (change) change(scene);
  choose_engine(scene);
}

std::unique_ptr<PreparedRun> prepare(RunCheckpoint from) {
  if (!from.simulation.bytes.empty()) return std::make_unique<PreparedRun>(std::move(from));
  return std::make_unique<PreparedRun>(complete_scene(std::move(from.scene)), false);
}

}  // namespace

Replay::Replay(const std::string& path, std::size_t last, const std::function<void(Scene&)>& change)
    : most_(last) {
  RunCheckpoint from = CheckpointFiles::read(path);
  failure_ = std::move(from.failure);
  make_ready(from.scene, change);
  run_ = prepare(std::move(from));
  start_time_ = run_->simulation().time();
  noted_ = start_collisions_ = run_->simulation().collisions();
  if (!failure_ && !has_end(run_->scene())) {
    throw InputError(path +
                     ": a checkpoint of a run without end that has not failed: expected a bundle");
  }
}

Scene::Until Replay::end() const {
  const Scene::Until& until = run_->scene().until;
  if (!failure_) return until;
  return from_start({.time = until.time, .collisions = failure_->collisions + 1},
                    run_->simulation());
}

bool Replay::concerns(const Happening& happening) const {
  if (!failure_ || !failure_->needles) return true;
  const auto& needles = *failure_->needles;
  const auto is_one = [&](std::uint32_t id) {
    return std::find(needles.begin(), needles.end(), id) != needles.end();
  };
  const Collision& event = happening.event;
  return is_one(event.first) || (happening.has_two_needles() && is_one(event.second));
}

void Replay::note(const Happening& happening) {
  noted_ += happening.is_collision();
  if (most_ == 0 || !concerns(happening)) return;
  if (last_.size() == most_) last_.pop_front();
  last_.push_back({noted_, happening});
}

Replayed Replay::drive(RunMonitor& monitor) {
  Replayed out;
  run_->on_happenings(1, [this](std::span<const Happening> happenings) {
    for (const Happening& happening : happenings) note(happening);
  });
  try {
    out.stop = run_->advance(end(), monitor);
  } catch (const std::exception&) {
    const Failure failure = current_failure();
    if (failure.exit_code != invalid_state) throw;
    out.failure = failure.message;
  }
  monitor.clear();
  const Simulation& simulation = run_->simulation();
  out.time = simulation.time();
  out.collisions = simulation.collisions();
  out.trajectory_hash = simulation.trajectory_hash();
  out.same = failure_ && out.failure == failure_->message &&
             out.collisions == failure_->collisions &&
             out.trajectory_hash == failure_->trajectory_hash;
  out.last = std::move(last_);
  return out;
}

}  // namespace needlework::runs
