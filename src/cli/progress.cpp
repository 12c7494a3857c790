#include "src/cli/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "src/cli/json.h"
#include "src/cli/messages.h"
#include "src/cli/signals.h"
#include "src/cli/standard_streams.h"
#include "src/cli/terminal.h"
#include "src/runs/progress_text.h"

namespace needlework::cli {
namespace {

constexpr double terminal_interval = 1, line_interval = 10;  // [s]

}  // namespace

ProgressLine::ProgressLine(bool quiet, std::optional<double> every)
    : quiet_(quiet),
      terminal_(isatty(STDERR_FILENO) != 0),
      interval_(every.value_or(terminal_ ? terminal_interval : line_interval)),
      next_(interval_) {}

bool ProgressLine::is_due(double elapsed) const { return !quiet_ && elapsed >= next_; }

void ProgressLine::show(double elapsed, std::string line) {
  next_ = elapsed + interval_;
  if (!terminal_) {
    write_stderr(line + "\n");
    return;
  }
  line = runs::whole_items(std::move(line), terminal_size().columns - 1);
  write_stderr(fmt::format("\r{:<{}}", line, std::max(line.size(), drawn_)));
  drawn_ = line.size();
}

void ProgressLine::clear() {
  if (drawn_ > 0) write_stderr(fmt::format("\r{:<{}}\r", "", drawn_));
  drawn_ = 0;
}

void RunProgress::show(const runs::Progress& progress) {
  line_.show(progress.elapsed, runs::progress_text(progress));
}

bool RunProgress::stop_requested() const { return SignalGuard::received() != 0; }

void SweepProgress::log_to(LogFile& log, double every) {
  log_ = &log;
  log_interval_ = next_in_log_ = every;
}

void SweepProgress::show(double elapsed, double fraction, std::size_t finished,
                         std::size_t members) {
  const double left = elapsed * ((1 - fraction) / fraction);
  if (line_.is_due(elapsed)) {
    line_.show(elapsed, runs::progress_text(fraction, left,
                                            fmt::format("{} of {} members", finished, members)));
  }
  if (!log_ || elapsed < next_in_log_) return;
  next_in_log_ = elapsed + log_interval_;
  log_->write("progress", {{"elapsed_s", elapsed},
                           {"fraction", fraction},
                           {"left_s", number(left)},
                           {"finished", finished},
                           {"members", members}});
}

nlohmann::ordered_json json_of(const runs::MemberCost& cost) {
  const double us = 1e6 * cost.cpu_s / static_cast<double>(cost.collisions);
  return {
      {"collisions", cost.collisions}, {"wall_s", cost.wall_s}, {"us_per_collision", number(us)}};
}

void SweepProgress::report_finished(const runs::sweep::Member& member,
                                    const runs::MemberCost& cost) {
  costs_[member.name] = cost;
  if (!log_) return;
  nlohmann::ordered_json line{{"member", member.name}};
  line.update(json_of(cost));
  log_->write("member_finished", line);
}

void SweepProgress::report_failure(const runs::sweep::Member& member,
                                   const runs::Failure& failure) {
  line_.clear();
  print_error(fmt::format("member {}: {}", member.name, failure.message));
  if (!log_) return;
  const int code = failure.exit_code;
  log_->write("member_failed",
              {{"member", member.name}, {"exit_code", code}, {"message", failure.message}});
}

bool SweepProgress::stop_requested() const { return SignalGuard::received() != 0; }

}  // namespace needlework::cli
