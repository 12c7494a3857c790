// How far the work is, on stderr while it lasts.
#pragma once

#include <cstddef>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "src/cli/log_file.h"
#include "src/runs/run_monitor.h"
#include "src/runs/sweep_run.h"

namespace needlework::cli {

/// Interval of progress in a log, unless an option gives another one [s].
constexpr double log_interval = 10;

/// On a terminal one line, drawn again every second; elsewhere a line every 10 s. Plain text
/// without colours or other escape sequences, so there is nothing that NO_COLOR would have to turn
/// off.
class ProgressLine {
 public:
  /// `every`: another interval [s].
  explicit ProgressLine(bool quiet, std::optional<double> every = {});
  ~ProgressLine() { clear(); }

  /// Whether it is time for another line, `elapsed` seconds of wall time into the work.
  bool is_due(double elapsed) const;

  /// Shows a line.
  void show(double elapsed, std::string line);

  /// Takes the line off a terminal, before anything else is printed.
  void clear();

 private:
  bool quiet_;
  bool terminal_;
  double interval_, next_;
  std::size_t drawn_ = 0;  ///< columns of the line on the terminal
};

/// Shows the progress of the only run; signals stop it.
class RunProgress : public runs::RunMonitor {
 public:
  explicit RunProgress(bool quiet, std::optional<double> every = {}) : line_(quiet, every) {}
  bool is_due(double elapsed) const override { return line_.is_due(elapsed); }
  void show(const runs::Progress& progress) override;
  void clear() override { line_.clear(); }
  bool stop_requested() const override;

 private:
  ProgressLine line_;
};

/// In JSON: its collisions, time and time per collision; null for that of none.
nlohmann::ordered_json json_of(const runs::MemberCost& cost);

/// Shows the progress of a sweep and its errors, and logs them where there is a log; signals stop
/// it.
class SweepProgress : public runs::SweepMonitor {
 public:
  explicit SweepProgress(bool quiet, std::optional<double> every = {}) : line_(quiet, every) {}
  /// From now on. The log must outlive this object; `every`: the interval of progress in it [s].
  void log_to(LogFile& log, double every);
  bool is_due(double elapsed) const override {
    return line_.is_due(elapsed) || (log_ && elapsed >= next_in_log_);
  }
  void show(double elapsed, double fraction, std::size_t finished, std::size_t members) override;
  void report_finished(const runs::sweep::Member& member, const runs::MemberCost& cost) override;
  void report_failure(const runs::sweep::Member& member, const runs::Failure& failure) override;
  bool stop_requested() const override;
  /// What the members that have finished have cost, by their names.
  const std::map<std::string, runs::MemberCost>& costs() const { return costs_; }

 private:
  ProgressLine line_;
  std::map<std::string, runs::MemberCost> costs_;
  LogFile* log_ = nullptr;
  double log_interval_ = 0, next_in_log_ = 0;
};

}  // namespace needlework::cli
