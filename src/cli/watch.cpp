#include "src/cli/watch.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "src/cli/signals.h"
#include "src/cli/standard_streams.h"
#include "src/cli/terminal.h"
#include "src/runs/progress_text.h"

namespace needlework::cli {
namespace {

constexpr double record_interval = 0.02, drawing_interval = 0.25;  // [s]
constexpr std::size_t least_columns = 38, gap = 2;                 // of a chart
constexpr std::size_t least_rows = 9, most_rows = 14;

std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

}  // namespace

bool can_watch() {
  return isatty(STDERR_FILENO) != 0 && environment("TERM") != "dumb" &&
         !environment("TERM").empty();
}

std::vector<std::string> watch_lines(const std::vector<picture::Panel>& panels,
                                     picture::TerminalSize terminal, bool colours) {
  using picture::smallest_terminal_chart;
  if (terminal.columns < smallest_terminal_chart.columns ||
      terminal.rows < smallest_terminal_chart.rows) {
    return {};
  }
  const std::size_t across =
      std::clamp((terminal.columns + gap) / (least_columns + gap), std::size_t{1}, panels.size());
  const std::size_t down =
      std::clamp(terminal.rows / least_rows, std::size_t{1}, (panels.size() + across - 1) / across);
  const picture::TerminalSize chart{(terminal.columns + gap) / across - gap,
                                    std::min(terminal.rows / down, most_rows)};
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < std::min(across * down, panels.size()); ++i) {
    const auto drawn = picture::terminal_lines(panels[i], chart, colours);
    const bool begins_row = i % across == 0;
    if (begins_row) lines.resize(lines.size() + drawn.size());
    for (std::size_t row = 0; row < drawn.size(); ++row) {
      std::string& line = lines[lines.size() - drawn.size() + row];
      line += (begins_row ? "" : std::string(gap, ' ')) + drawn[row];
    }
  }
  return lines;
}

RunWatch::RunWatch(const Scene& scene) : scene_(scene), colours_(environment("NO_COLOR").empty()) {}

void RunWatch::begin(const Totals& initial, std::span<const Totals> samples, bool theory_holds) {
  run_.emplace(scene_, initial, theory_holds);
  for (const Totals& sample : samples) run_->add(sample);
}

void RunWatch::show(const runs::Progress& progress) {
  next_record_ = progress.elapsed + record_interval;
  run_->add(progress.now);
  if (progress.elapsed < next_drawing_) return;
  next_drawing_ = progress.elapsed + drawing_interval;
  progress_ = runs::progress_text(progress);
  draw();
}

void RunWatch::draw() {
  const picture::TerminalSize terminal = terminal_size();
  // A row for the line of progress, one for the cursor.
  const std::size_t rows = terminal.rows - std::min<std::size_t>(terminal.rows, 2);
  std::vector<std::string> lines =
      watch_lines(run_->panels(), {terminal.columns - 1, rows}, colours_);
  if (!progress_.empty()) lines.push_back(runs::whole_items(progress_, terminal.columns - 1));
  // Lines of another width may have been broken: then new ones begin below them.
  const bool in_place = drawn_ > 0 && columns_ == terminal.columns;
  std::string text = in_place ? fmt::format("\033[{}A", drawn_) : "";
  for (const std::string& line : lines) text += "\r" + line + "\033[K\n";
  if (in_place && lines.size() < drawn_) text += "\033[J";
  write_stderr(text);
  drawn_ = lines.size();
  columns_ = terminal.columns;
}

void RunWatch::clear() {
  progress_.clear();
  if (run_) draw();
}

bool RunWatch::stop_requested() const { return SignalGuard::received() != 0; }

}  // namespace needlework::cli
