// How far the work is, on stderr while it lasts.
#pragma once

#include <cstddef>
#include <string_view>

#include "src/runs/run_monitor.h"
#include "src/runs/sweep_run.h"

namespace needlework::cli {

/// On a terminal one line, drawn again and again; elsewhere a line every 10 s. Plain text without
/// colours or other escape sequences, so there is nothing that NO_COLOR would have to turn off.
class ProgressLine {
 public:
  explicit ProgressLine(bool quiet);
  ~ProgressLine() { clear(); }

  /// Whether it is time for another line, `elapsed` seconds of wall time into the work.
  bool is_due(double elapsed) const;

  /// Shows the share done (of [0, 1]), the time left that follows from it, and more.
  void show(double elapsed, double fraction, std::string_view more);

  /// Takes the line off a terminal, before anything else is printed.
  void clear();

 private:
  bool quiet_;
  bool terminal_;
  double next_;
  std::size_t drawn_ = 0;  ///< columns of the line on the terminal
};

/// Shows the progress of the only run; signals stop it.
class RunProgress : public runs::RunMonitor {
 public:
  explicit RunProgress(bool quiet) : line_(quiet) {}
  bool is_due(double elapsed) const override { return line_.is_due(elapsed); }
  void show(double elapsed, double fraction, const Totals& now, double initial_energy) override;
  void clear() override { line_.clear(); }
  bool stop_requested() const override;

 private:
  ProgressLine line_;
};

/// Shows the progress of a sweep and its errors; signals stop it.
class SweepProgress : public runs::SweepMonitor {
 public:
  explicit SweepProgress(bool quiet) : line_(quiet) {}
  bool is_due(double elapsed) const override { return line_.is_due(elapsed); }
  void show(double elapsed, double fraction, std::size_t finished, std::size_t members) override;
  void report_failure(const runs::sweep::Member& member, const runs::Failure& failure) override;
  bool stop_requested() const override;

 private:
  ProgressLine line_;
};

}  // namespace needlework::cli
