#include "src/cli/usage.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <string_view>
#include <utility>
#include <vector>

#include "src/scene/suggest.h"

namespace needlework::cli {
namespace {

// What other programs call such commands.
constexpr std::pair<std::string_view, std::string_view> synonyms[] = {
    {"simulate", "run"},  {"start", "run"},      {"execute", "run"},     {"validate", "check"},
    {"explain", "check"}, {"verify", "audit"},   {"show", "info"},       {"describe", "info"},
    {"inspect", "info"},  {"convert", "export"}, {"vtk", "export"},      {"benchmark", "bench"},
    {"measure", "bench"}, {"scan", "sweep"},     {"collide", "predict"}, {"version", "--version"}};

// Which command takes files of this kind.
constexpr std::pair<std::string_view, std::string_view> commands_by_ending[] = {
    {".toml", "run"}, {".h5", "info"}, {".csv", "predict"}};

// The command that a word may stand for, or empty.
std::string command_for(const std::string& word, std::span<const std::string> rest,
                        const std::vector<std::string_view>& commands) {
  for (const auto& [synonym, command] : synonyms) {
    if (word == synonym) return std::string(command);
  }
  const std::string_view nearest = nearest_word(word, commands);
  if (!nearest.empty()) return std::string(nearest);
  for (const auto& [ending, command] : commands_by_ending) {
    if (!rest.empty() && rest[0].ends_with(ending)) return std::string(command);
  }
  return {};
}

std::string did_you_mean(std::string_view word) {
  return word.empty() ? "" : fmt::format(", did you mean {}?", word);
}

bool looks_like_an_option(std::string_view word) {
  return word.size() > 1 && word[0] == '-' && !std::isdigit(static_cast<unsigned char>(word[1])) &&
         word[1] != '.';
}

std::string_view name_in(std::string_view word) { return word.substr(0, word.find('=')); }

// Whether it could follow --set.
bool looks_like_a_setting(std::string_view word) {
  const auto equals = word.find('=');
  return equals != word.npos && word.substr(0, equals).find('.') != word.npos;
}

std::string unknown_option_message(const CommandHelp& command, const std::string& word) {
  const std::string_view name = name_in(word);
  if (command.find("--set") && looks_like_a_setting(word)) {
    return fmt::format("{}: unknown option, did you mean --set {}?", word,
                       word.substr(word.find_first_not_of('-')));
  }
  std::vector<std::string_view> names, words;  // with and without dashes
  for (const OptionHelp& option : command.options) {
    if (option.is_positional) continue;
    for (const std::string& option_name : option.names) {
      names.push_back(option_name);
      if (option_name.starts_with("--")) words.push_back(names.back().substr(2));
    }
  }
  const bool one_letter = !name.starts_with("--");
  const auto found = std::find_if(words.begin(), words.end(),
                                  [&](std::string_view other) { return other[0] == name[1]; });
  const std::string_view nearest =
      one_letter ? (found == words.end() ? "" : *found) : nearest_word(name.substr(2), words);
  const std::string meant = nearest.empty() ? "" : fmt::format("--{}", nearest);
  if (!meant.empty()) return fmt::format("{}: unknown option{}", name, did_you_mean(meant));
  return fmt::format("{}: unknown option: expected one of {}", name, fmt::join(names, ", "));
}

std::string unexpected_word_message(const CommandHelp& command, const std::string& word) {
  if (command.find("--set") && looks_like_a_setting(word)) {
    return fmt::format("{}: unexpected argument, did you mean --set {}?", word, word);
  }
  return fmt::format("{}: unexpected argument: expected {}", word, command.usage());
}

// What the parser says, in the words of the other messages.
std::string reworded(const CommandHelp& command, const std::string& reason) {
  constexpr std::string_view required = " is required";
  if (reason.ends_with(required)) {
    return fmt::format("{} is missing: expected {}",
                       reason.substr(0, reason.size() - required.size()), command.usage());
  }
  const auto colon = reason.find(": ");
  if (colon == reason.npos) return reason;
  const std::string name = reason.substr(0, colon), rest = reason.substr(colon + 2);
  const OptionHelp* option = command.find(name);
  if (!option) return reason;
  if (rest.ends_with(" missing"))
    return fmt::format("{}: expected {} after it", name, option->value);
  return fmt::format("{} {}", name, rest);
}

std::string message_on(const CommandHelp& command, std::span<const std::string> arguments,
                       std::span<const std::string> unexpected, const std::string& reason) {
  for (const std::string& word : arguments) {
    const bool is_unexpected =
        std::find(unexpected.begin(), unexpected.end(), word) != unexpected.end();
    const bool is_option = looks_like_an_option(word);
    if (is_option && !command.find(name_in(word))) return unknown_option_message(command, word);
    if (is_unexpected) return unexpected_word_message(command, word);
  }
  return reworded(command, reason);
}

}  // namespace

std::string unknown_command_message(const ProgramHelp& program, const std::string& word,
                                    std::span<const std::string> rest) {
  for (const auto& [ending, command] : commands_by_ending) {
    if (!word.ends_with(ending)) continue;
    return fmt::format("{}: expected a command before a file, as in needlework {} {}", word,
                       command, word);
  }
  std::vector<std::string_view> commands;
  for (const CommandHelp& command : program.commands) commands.push_back(command.name);
  const std::string meant = command_for(word, rest, commands);
  if (!meant.empty()) return fmt::format("{}: unknown command{}", word, did_you_mean(meant));
  return fmt::format("{}: unknown command: expected one of {}", word, fmt::join(commands, ", "));
}

std::string usage_message(const ProgramHelp& program, std::span<const std::string> arguments,
                          std::span<const std::string> unexpected, const std::string& reason) {
  constexpr std::string_view see = "(see needlework --help)";
  if (arguments.empty()) {
    return fmt::format("expected a command, such as needlework run SCENE.toml {}", see);
  }
  const std::string& first = arguments[0];
  const auto rest = arguments.subspan(1);
  if (const CommandHelp* command = program.find_command(first)) {
    return fmt::format("{} (see needlework {} --help)",
                       message_on(*command, rest, unexpected, reason), first);
  }
  if (!looks_like_an_option(first)) {
    return fmt::format("{} {}", unknown_command_message(program, first, rest), see);
  }
  for (const CommandHelp& command : program.commands) {
    if (program.find(name_in(first)) || !command.find(name_in(first))) continue;
    return fmt::format("{}: expected a command before its options, as in {} {} {}", first,
                       command.usage(), name_in(first), see);
  }
  return fmt::format("{} {}", unknown_option_message(program, first), see);
}

}  // namespace needlework::cli
