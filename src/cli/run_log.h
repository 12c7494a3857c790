// `run --log`: the course of a run as JSON Lines, which docs/commands.md names and docs/json.md
// describes.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "src/cli/log_file.h"
#include "src/runs/failure.h"
#include "src/runs/prepared_run.h"
#include "src/runs/run_monitor.h"

namespace needlework::cli {

/// Writes the lines of one run. Without a file it writes nothing.
class RunLog {
 public:
  RunLog() = default;
  /// Throws IoError as LogFile does, and if the log would be the output file of the run.
  RunLog(const std::string& path, const std::string& output_file);

  explicit operator bool() const { return file_ != nullptr; }

  /// `scene` is the name of the scene file, or none for a run that is continued.
  void start(const std::optional<std::string>& scene, const runs::PreparedRun& run);
  void warning(const std::string& message);
  void progress(const runs::Progress& progress);
  void checkpoint(double time, std::uint64_t collisions, double seconds);
  /// The message is the one on stderr, or empty.
  void end(const runs::PreparedRun& run, const runs::RunResult& result, int exit_code,
           const std::string& message);
  /// Of a run that was ended by an error.
  void end(const runs::Failure& failure);

 private:
  std::unique_ptr<LogFile> file_;
};

/// Passes on what a monitor is told, and writes it to a log.
class LoggedRun : public runs::RunMonitor {
 public:
  /// Both must outlive it. `every`: the interval of progress in the log [s].
  LoggedRun(runs::RunMonitor& shown, RunLog& log, double every)
      : shown_(shown), log_(log), every_(every), next_(every) {}

  void begin(const Totals& initial, std::span<const Totals> samples, bool theory_holds) override {
    shown_.begin(initial, samples, theory_holds);
  }
  bool is_due(double elapsed) const override { return shown_.is_due(elapsed) || elapsed >= next_; }
  void show(const runs::Progress& progress) override;
  void saved(double time, std::uint64_t collisions, double seconds) override;
  void clear() override { shown_.clear(); }
  bool stop_requested() const override { return shown_.stop_requested(); }

 private:
  runs::RunMonitor& shown_;
  RunLog& log_;
  double every_, next_;
};

}  // namespace needlework::cli
