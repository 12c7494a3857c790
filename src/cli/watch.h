// `run --watch`: the course of a run as charts on the terminal, drawn again and again in place.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "src/cli/watched_run.h"
#include "src/picture/terminal_chart.h"
#include "src/runs/run_monitor.h"

namespace needlework::cli {

/// Whether stderr is a terminal that can move its cursor.
bool can_watch();

/// The charts side by side, as many as fit into the columns, or one below another if there are rows
/// enough; none if even one does not fit.
std::vector<std::string> watch_lines(const std::vector<picture::Panel>& panels,
                                     picture::TerminalSize terminal, bool colours);

/// Draws on stderr; signals stop the run. The last charts stay on the terminal. Colours are left
/// out if NO_COLOR is set.
class RunWatch : public runs::RunMonitor {
 public:
  /// The scene must outlive it.
  explicit RunWatch(const Scene& scene);
  void begin(const Totals& initial, std::span<const Totals> samples, bool theory_holds) override;
  bool is_due(double elapsed) const override { return elapsed >= next_record_; }
  void show(const runs::Progress& progress) override;
  void clear() override;
  bool stop_requested() const override;

 private:
  void draw();

  const Scene& scene_;
  std::optional<WatchedRun> run_;
  bool colours_;
  double next_record_ = 0, next_drawing_ = 0;  ///< [s]
  std::string progress_;
  std::size_t drawn_ = 0;    ///< lines above the cursor
  std::size_t columns_ = 0;  ///< of the terminal when they were drawn
};

}  // namespace needlework::cli
