#include "src/cli/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <string>

#include "src/cli/messages.h"
#include "src/cli/signals.h"
#include "src/cli/terminal.h"
#include "src/runs/progress_text.h"

namespace needlework::cli {
namespace {

constexpr double terminal_interval = 1, line_interval = 10;  // [s]

}  // namespace

ProgressLine::ProgressLine(bool quiet)
    : quiet_(quiet),
      terminal_(isatty(STDERR_FILENO) != 0),
      next_(terminal_ ? terminal_interval : line_interval) {}

bool ProgressLine::is_due(double elapsed) const { return !quiet_ && elapsed >= next_; }

void ProgressLine::show(double elapsed, double fraction, std::string_view more) {
  next_ = elapsed + (terminal_ ? terminal_interval : line_interval);
  std::string line = runs::progress_text(elapsed, fraction, more);
  if (!terminal_) {
    fmt::print(stderr, "{}\n", line);
    return;
  }
  line.resize(std::min(line.size(), terminal_size().columns - 1));
  fmt::print(stderr, "\r{:<{}}", line, std::max(line.size(), drawn_));
  drawn_ = line.size();
  std::fflush(stderr);
}

void ProgressLine::clear() {
  if (drawn_ > 0) fmt::print(stderr, "\r{:<{}}\r", "", drawn_);
  drawn_ = 0;
}

void RunProgress::show(double elapsed, double fraction, const Totals& now, double initial_energy) {
  line_.show(elapsed, fraction, runs::progress_of_run(now, initial_energy));
}

bool RunProgress::stop_requested() const { return SignalGuard::received() != 0; }

void SweepProgress::show(double elapsed, double fraction, std::size_t finished,
                         std::size_t members) {
  line_.show(elapsed, fraction, fmt::format("{} of {} members", finished, members));
}

void SweepProgress::report_failure(const runs::sweep::Member& member,
                                   const runs::Failure& failure) {
  line_.clear();
  print_error(fmt::format("member {}: {}", member.name, failure.message));
}

bool SweepProgress::stop_requested() const { return SignalGuard::received() != 0; }

}  // namespace needlework::cli
