#include "src/cli/options.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <sstream>
#include <utility>

#include "src/cli/watch.h"

namespace needlework::cli {
namespace {

CLI::Validator terminal_on_stderr() {
  return {[](const std::string&) -> std::string {
            return can_watch() ? ""
                               : "expected a terminal on standard error, and its name in TERM; "
                                 "without --watch, a line is printed every 10 s";
          },
          "TERMINAL"};
}

}  // namespace

CLI::Validator auto_or(CLI::Validator check) {
  return {[=](const std::string& text) -> std::string {
            std::string value = text;
            const std::string error = text == "auto" ? "" : check(value);
            return error.empty() ? "" : error + " or auto";
          },
          "WORD"};
}

CLI::Validator one_of(std::vector<std::string> words) {
  return {[=](const std::string& text) -> std::string {
            const bool known = std::find(words.begin(), words.end(), text) != words.end();
            return known ? "" : fmt::format("{}: expected one of {}", text, fmt::join(words, ", "));
          },
          fmt::format("{}", fmt::join(words, "|"))};
}

std::string filled(const std::string& text, std::size_t width) {
  std::istringstream words(text);
  std::string lines, line;
  for (std::string word; words >> word;) {
    if (line.size() + 1 + word.size() > width) {
      lines += line + "\n";
      line.clear();
    }
    line += (line.empty() ? "" : " ") + word;
  }
  return lines + line;
}

void add_choice(CLI::Option* option, const std::vector<std::string>& words) {
  option->option_text(fmt::format("{}", fmt::join(words, "|")))->check(one_of(words));
}

void add_scene(CLI::App& command, std::string& path, std::vector<std::string>& overrides,
               bool required) {
  command.add_option("SCENE.toml", path, "scene file")->required(required);
  command
      .add_option("--set", overrides,
                  "replace a key of the scene, such as needles.count=500; repeatable")
      ->option_text("SECTION.KEY=VALUE")
      ->allow_extra_args(false);
}

void add_isa(CLI::App& command, std::optional<std::string>& isa) {
  command
      .add_option("--isa", isa,
                  "instruction set (default: auto, the widest of this CPU, unless the scene or "
                  "NEEDLEWORK_ISA names one)")
      ->option_text("auto|scalar|sse4|avx2|avx512");
}

void add_engine_options(CLI::App& command, EngineOptions& engine) {
  command
      .add_option("--threads", engine.threads,
                  "number of threads; auto: one per core, but at least 4000 needles for each "
                  "(default: that of the scene or of OMP_NUM_THREADS, else 1)")
      ->option_text("N|auto")
      ->check(auto_or(number_in(1, 1024)));
  add_isa(command, engine.isa);
}

void add_scene_arguments(CLI::App& command, SceneArguments& arguments) {
  add_scene(command, arguments.path, arguments.overrides, true);
  add_engine_options(command, arguments.engine);
}

CLI::Option* add_json(CLI::App& command, bool& json) {
  return command.add_flag("--json", json, "print the result as one JSON object");
}

CLI::Option* add_quiet(CLI::App& command, bool& quiet) {
  return command.add_flag("--quiet", quiet, "print no progress and no summary");
}

CLI::Option* add_force(CLI::App& command, bool& force) {
  return command.add_flag("--force", force, "replace existing files");
}

void add_log(CLI::App& command, std::optional<std::string>& log) {
  command
      .add_option("--log", log,
                  "append start, progress, checkpoints, warnings and end to a file, as JSON lines")
      ->option_text("FILE");
}

void add_progress_every(CLI::App& command, std::optional<double>& every) {
  command
      .add_option("--progress-every", every,
                  "wall time between two lines of progress [s] (default: 10, on a terminal 1)")
      ->option_text("S")
      ->check(number_in(0.0, 1e6));
}

void add_printing(CLI::App& command, Printing& printing) {
  add_json(command, printing.json);
  CLI::Option* quiet = add_quiet(command, printing.quiet);
  command
      .add_flag(
          "--watch", printing.watch,
          "draw energy, T_tr/T_rot and collision rate on the terminal while the run lasts; not "
          "with --quiet")
      ->excludes(quiet)
      ->check(terminal_on_stderr());
  add_progress_every(command, printing.progress_every);
  add_log(command, printing.log);
}

}  // namespace needlework::cli
