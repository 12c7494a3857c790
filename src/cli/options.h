// Options that several commands have, and checks of their values.
#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "src/cli/run_command.h"
#include "src/cli/scene_arguments.h"

namespace needlework::cli {

template <class Number>
std::string number_text(Number number) {
  return fmt::format("{:g}", static_cast<double>(number));
}

/// A number from `least` to `most`. CLI::Range lets nan pass.
template <class Number>
CLI::Validator number_in(Number least, Number most) {
  const std::string expected =
      fmt::format("{} from {} to {}", std::is_integral_v<Number> ? "a whole number" : "a number",
                  number_text(least), number_text(most));
  return {[=](const std::string& text) -> std::string {
            Number value = 0;
            const bool fits =
                CLI::detail::lexical_cast(text, value) && least <= value && value <= most;
            return fits ? "" : fmt::format("{}: expected {}", text, expected);
          },
          "NUMBER"};
}

/// The word auto, or what another check accepts.
CLI::Validator auto_or(CLI::Validator check);

/// One of these words, which are its description, with | between them.
CLI::Validator one_of(std::vector<std::string> words);
/// Makes one of these words the value of an option.
void add_choice(CLI::Option* option, const std::vector<std::string>& words);

/// The words of a text in lines of at most `width` characters.
std::string filled(const std::string& text, std::size_t width = 78);

/// SCENE.toml and --set.
void add_scene(CLI::App& command, std::string& path, std::vector<std::string>& overrides,
               bool required);
void add_isa(CLI::App& command, std::optional<std::string>& isa);
/// --threads and --isa.
void add_engine_options(CLI::App& command, EngineOptions& engine);
/// All of these.
void add_scene_arguments(CLI::App& command, SceneArguments& arguments);
/// --json, --quiet and --force, as most commands have them.
CLI::Option* add_json(CLI::App& command, bool& json);
CLI::Option* add_quiet(CLI::App& command, bool& quiet);
CLI::Option* add_force(CLI::App& command, bool& force);
/// --log.
void add_log(CLI::App& command, std::optional<std::string>& log);
/// --progress-every.
void add_progress_every(CLI::App& command, std::optional<double>& every);
/// --json, --quiet, --watch, and both of these.
void add_printing(CLI::App& command, Printing& printing);

}  // namespace needlework::cli
