#include "src/runs/sweep_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <numeric>
#include <system_error>

#include "needlework/error.h"
#include "src/machine/stop_request.h"
#include "src/runs/explanation.h"
#include "src/runs/prepared_run.h"
#include "src/scene/needed_memory.h"

namespace needlework::runs {
namespace {

/// What a member costs if nothing is known of it, and at least [s].
constexpr double least_cost = 1e-3;

/// The progress of all members together, of which several threads report.
class SharedProgress {
 public:
  SharedProgress(SweepMonitor& monitor, std::size_t members, double cost)
      : monitor_(monitor), members_(members), cost_(cost) {}

  /// Some more work is done, perhaps the last of a member.
  void advance(double cost, bool finished) {
    const std::lock_guard lock(mutex_);
    done_ += cost;
    finished_ += finished;
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start_;
    if (!monitor_.is_due(elapsed.count())) return;
    monitor_.show(elapsed.count(), std::clamp(done_ / cost_, 0.0, 1.0), finished_, members_);
  }

  void report_finished(const sweep::Member& member, const MemberCost& cost) {
    const std::lock_guard lock(mutex_);
    monitor_.report_finished(member, cost);
  }

  void report_failure(const sweep::Member& member, const Failure& failure) {
    const std::lock_guard lock(mutex_);
    monitor_.report_failure(member, failure);
  }

  bool stop_requested() const { return monitor_.stop_requested(); }

 private:
  std::mutex mutex_;
  SweepMonitor& monitor_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::size_t members_, finished_ = 0;
  double cost_, done_ = 0;
};

/// The part of one member in it, from the beginning to the end of its life.
class MemberMonitor : public RunMonitor {
 public:
  MemberMonitor(SharedProgress& sweep, double cost) : sweep_(sweep), cost_(cost) {}
  ~MemberMonitor() override { sweep_.advance(cost_ - reported_, true); }

  bool is_due(double elapsed) const override { return elapsed >= next_; }
  void show(const Progress& progress) override {
    next_ = progress.elapsed + 1;
    sweep_.advance(progress.fraction * cost_ - reported_, false);
    reported_ = progress.fraction * cost_;
  }
  bool stop_requested() const override { return sweep_.stop_requested(); }
  void report_finished(const sweep::Member& member, const MemberCost& cost) {
    sweep_.report_finished(member, cost);
  }

 private:
  SharedProgress& sweep_;
  double cost_, reported_ = 0, next_ = 1;
};

bool is_missing(const std::string& file) {
  std::error_code error;
  return std::filesystem::status(file, error).type() == std::filesystem::file_type::not_found;
}

// Continues a member from its last checkpoint, if there is one of the same scene, and begins it
// again if file or checkpoints are damaged or missing. What cannot be read at present, or is being
// written by another program, may be whole: it is kept, and the error passed on.
std::unique_ptr<PreparedRun> begin_or_continue(LoadedScene loaded, const std::string& grid) {
  const CheckpointFiles checkpoints(loaded.scene.output.file);
  try {
    if (checkpoints.exist() && !is_missing(loaded.scene.output.file)) {
      RunCheckpoint saved = checkpoints.latest().checkpoint;
      if (saved.scene.text == loaded.scene.text) {
        saved.scene.output.file = loaded.scene.output.file;
        saved.scene.engine = loaded.scene.engine;
        return std::make_unique<PreparedRun>(std::move(saved), Saves::when_stopped);
      }
    }
  } catch (const InputError&) {
    // Damaged, or of another version.
  }
  return std::make_unique<PreparedRun>(std::move(loaded), true, grid, Saves::when_stopped);
}

std::unique_ptr<PreparedRun> set_up(Scene scene, const std::string& grid,
                                    const RunMonitor& monitor) {
  const StopRequest request([&] { return monitor.stop_requested() ? "stopped" : ""; });
  return begin_or_continue(complete_scene(std::move(scene)), grid);
}

ExitCode run_member(const MemberRuns& runs, const sweep::Member& member, MemberMonitor& monitor) {
  const SweepFolder& folder = runs.folder;
  const Claim claim(folder, member);
  if (!claim.granted()) return stopped;
  // Another process may have been faster.
  if (folder.state(member) == SweepFolder::State::finished) return ok;

  Scene scene = member.scene;
  scene.output.file = folder.unfinished_file(member);
  const RunResult result = [&] {
    try {
      return set_up(std::move(scene), runs.grid.name, monitor)->drive(monitor);
    } catch (...) {
      // What can be continued later, as when there is room again, is kept.
      if (!CheckpointFiles(folder.unfinished_file(member)).exist()) {
        folder.remove_unfinished(member);
      }
      throw;
    }
  }();
  if (result.failure) {
    folder.keep(member, SweepFolder::State::failed);
    const std::string file = folder.failed_file(member);
    const std::string replay =
        result.bundle.empty()
            ? ""
            : fmt::format("; needlework replay {} shows it again", CheckpointFiles(file).bundle());
    throw InvalidStateError(fmt::format("{} (saved in {}{})", *result.failure, file, replay));
  }
  if (result.stop == Stop::interrupted) return stopped;
  folder.keep(member, SweepFolder::State::finished);
  monitor.report_finished(member, {.collisions = result.collisions,
                                   .wall_s = result.loop.wall(),
                                   .cpu_s = result.loop.thread_cpu()});
  return ok;
}

}  // namespace

std::vector<double> estimated_costs(const sweep::Grid& grid) {
  std::vector<double> costs;
  for (const sweep::Member& member : grid.members) {
    if (!costs.empty() && member.point == grid.members[costs.size() - 1].point) {
      costs.push_back(costs.back());
      continue;
    }
    const LoadedScene loaded{.scene = member.scene, .initial = {}};
    const bool known = member.scene.initial.file.empty();
    const double seconds = known ? Explanation(loaded).seconds : 0;
    costs.push_back(std::isfinite(seconds) ? std::max(seconds, least_cost) : least_cost);
  }
  return costs;
}

std::vector<std::size_t> share_of(std::span<const std::size_t> members,
                                  std::span<const double> costs, std::size_t k, std::size_t m) {
  std::vector<std::size_t> longest_first(members.begin(), members.end());
  std::stable_sort(longest_first.begin(), longest_first.end(),
                   [&](std::size_t a, std::size_t b) { return costs[a] > costs[b]; });
  std::vector<double> loads(m, 0.0);
  std::vector<std::size_t> share;
  for (const std::size_t member : longest_first) {
    const auto least = std::min_element(loads.begin(), loads.end());
    *least += costs[member];
    if (least - loads.begin() == static_cast<std::ptrdiff_t>(k)) share.push_back(member);
  }
  return share;
}

void run_members(const MemberRuns& runs, SweepMonitor& monitor, std::span<int> exit_codes) {
  const double cost =
      std::accumulate(runs.members.begin(), runs.members.end(), 0.0,
                      [&](double sum, std::size_t member) { return sum + runs.costs[member]; });
  SharedProgress all(monitor, runs.members.size(), cost);
  const auto run_one = [&](std::size_t index) -> int {
    if (all.stop_requested()) return stopped;
    const sweep::Member& member = runs.grid.members[index];
    try {
      MemberMonitor its_monitor(all, runs.costs[index]);
      return run_member(runs, member, its_monitor);
    } catch (const StoppedEarly&) {
      return stopped;
    } catch (const std::exception&) {
      const Failure failure = current_failure();
      all.report_failure(member, failure);
      return failure.exit_code;
    }
  };
#pragma omp parallel for schedule(dynamic, 1) num_threads(runs.threads)
  for (std::size_t n = 0; n < runs.members.size(); ++n) {
    exit_codes[runs.members[n]] = run_one(runs.members[n]);
  }
}

double estimated_memory(const MemberRuns& runs) {
  std::vector<double> needs;
  for (const std::size_t member : runs.members) {
    needs.push_back(estimated_memory(runs.grid.members[member].scene));
  }
  std::sort(needs.begin(), needs.end(), std::greater<>());
  const std::size_t at_once = std::min<std::size_t>(runs.threads, needs.size());
  return std::accumulate(needs.begin(), needs.begin() + at_once, 0.0);
}

}  // namespace needlework::runs
