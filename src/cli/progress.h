// How far a run is, on stderr while it lasts.
#pragma once

#include <cstddef>

#include "src/engine/simulation.h"

namespace needlework::cli {

/// On a terminal one line, drawn again and again; elsewhere a line every 10 s. Plain text without
/// colours or other escape sequences, so there is nothing that NO_COLOR would have to turn off.
class Progress {
 public:
  explicit Progress(bool quiet);
  ~Progress() { clear(); }

  /// Whether it is time for another line, `elapsed` seconds of wall time into the run.
  bool is_due(double elapsed) const;

  /// Shows the share done (of [0, 1]) and the time left that follows from it.
  void show(double elapsed, double fraction, const Totals& now, double initial_energy);

  /// Takes the line off a terminal, before anything else is printed.
  void clear();

 private:
  bool quiet_;
  bool terminal_;
  double next_;
  std::size_t drawn_ = 0;  ///< columns of the line on the terminal
};

}  // namespace needlework::cli
