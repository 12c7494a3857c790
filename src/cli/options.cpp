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
          "WORD"};
}

std::string filled(const std::string& text) {
  std::istringstream words(text);
  std::string lines, line;
  for (std::string word; words >> word;) {
    if (line.size() + 1 + word.size() > 78) {
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
                  "replace a key of the scene, such as needles.count=500; may be repeated")
      ->option_text("SECTION.KEY=VALUE")
      ->allow_extra_args(false);
}

void add_isa(CLI::App& command, std::optional<std::string>& isa) {
  command.add_option("--isa", isa, "instruction set; auto is the widest of this CPU")
      ->option_text("auto|scalar|sse4|avx2|avx512");
}

void add_engine_options(CLI::App& command, EngineOptions& engine) {
  command
      .add_option("--threads", engine.threads,
                  "number of threads; auto takes one for each core, if each then has 4000 "
                  "needles or more, else fewer")
      ->option_text("N|auto")
      ->check(auto_or(number_in(1, 1024)));
  add_isa(command, engine.isa);
}

void add_scene_arguments(CLI::App& command, SceneArguments& arguments) {
  add_scene(command, arguments.path, arguments.overrides, true);
  add_engine_options(command, arguments.engine);
}

void add_log(CLI::App& command, std::optional<std::string>& log) {
  command
      .add_option("--log", log,
                  "append start, progress, checkpoints, warnings and end to a file, as JSON Lines")
      ->option_text("FILE");
}

void add_progress_every(CLI::App& command, std::optional<double>& every) {
  command
      .add_option("--progress-every", every,
                  "wall time between two lines of progress [s]; by default 10, on a terminal 1")
      ->option_text("S")
      ->check(number_in(0.0, 1e6));
}

void add_printing(CLI::App& command, Printing& printing) {
  command.add_flag("--json", printing.json, "print the result as one JSON object");
  CLI::Option* quiet = command.add_flag("--quiet", printing.quiet, "no progress, no summary");
  command
      .add_flag("--watch", printing.watch,
                "draw energy, T_tr/T_rot and collision rate on the terminal while the run lasts")
      ->excludes(quiet)
      ->check(terminal_on_stderr());
  add_progress_every(command, printing.progress_every);
  add_log(command, printing.log);
}

}  // namespace needlework::cli
