// Completions for shells: commands, options, and what may follow an option.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "src/cli/reference.h"
#include "src/scene/schema.h"

namespace needlework::cli {
namespace {

/// What can stand for a value.
struct Values {
  enum class Kind { none, words, files, folders, keys } kind = Kind::none;
  std::vector<std::string> words;  ///< of `words`
  std::string ending;              ///< of `files`, such as ".h5"; empty: any
};

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == separator) {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

constexpr std::string_view repetition = "...";

// Whether several values may follow, such as "FILE...".
bool is_repeated(const OptionHelp& option) { return option.value.ends_with(repetition); }

// By the text that stands for the value, such as "fast|standard" or "[FILE.json]".
Values values_of(const OptionHelp& option) {
  if (!option.choices.empty()) return {Values::Kind::words, option.choices, {}};
  std::string text = option.value;
  if (text.starts_with('[') && text.ends_with(']')) text = text.substr(1, text.size() - 2);
  if (is_repeated(option)) text.resize(text.size() - repetition.size());
  if (text.find('|') != text.npos) return {Values::Kind::words, split(text, '|'), {}};
  if (text == "SECTION.KEY=VALUE") return {Values::Kind::keys, {}, {}};
  if (text == "DIR") return {Values::Kind::folders, {}, {}};
  if (text == "FILE") return {Values::Kind::files, {}, {}};
  const auto dot = text.rfind('.');
  if (dot != text.npos) return {Values::Kind::files, {}, text.substr(dot)};
  return {};
}

std::vector<std::string> scene_key_names() {
  std::vector<std::string> names;
  for (const SceneKey& key : scene_keys()) {
    names.push_back(key.section.empty() ? fmt::format("{}=", key.key)
                                        : fmt::format("{}.{}=", key.section, key.key));
  }
  return names;
}

std::vector<std::string> names_of(const ProgramHelp& program) {
  std::vector<std::string> names;
  for (const CommandHelp& command : program.commands) names.push_back(command.name);
  return names;
}

std::string joined(const std::vector<std::string>& words) {
  return fmt::format("{}", fmt::join(words, " "));
}

std::vector<std::string> flags_of(const CommandHelp& command) {
  std::vector<std::string> names;
  for (const OptionHelp& option : command.options) {
    if (!option.is_positional) names.insert(names.end(), option.names.begin(), option.names.end());
  }
  return names;
}

std::string bash_action(const Values& values) {
  switch (values.kind) {
    case Values::Kind::words:
      return fmt::format("_needlework_words '{}'", joined(values.words));
    case Values::Kind::files:
      return fmt::format("_needlework_files '{}'", values.ending);
    case Values::Kind::folders:
      return "compopt -o filenames; mapfile -t COMPREPLY < <(compgen -d -- \"$word\")";
    case Values::Kind::keys:
      return "_needlework_keys";
    default:
      return ":";
  }
}

std::string bash_command(const CommandHelp& command) {
  std::string out = fmt::format("    {})\n      case $before in\n", command.name);
  Values positional;
  for (const OptionHelp& option : command.options) {
    if (option.is_positional) {
      if (positional.kind == Values::Kind::none) positional = values_of(option);
    } else if (!option.value.empty()) {
      out += fmt::format("        {}) {}; return ;;\n", fmt::join(option.names, "|"),
                         bash_action(values_of(option)));
    }
  }
  out += fmt::format(
      "      esac\n      if [[ $word == -* ]]; then\n"
      "        _needlework_words '{}'\n      else\n        {}\n      fi\n      ;;\n",
      joined(flags_of(command)), bash_action(positional));
  return out;
}

// In single quotes, as zsh and fish have them.
std::string quoted(const std::string& text, std::string_view escaped_quote) {
  std::string out = "'";
  for (const char c : text) {
    if (c == '\'') {
      out += escaped_quote;
    } else {
      out += c;
    }
  }
  return out + "'";
}

std::string zsh_description(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '[' || c == ']' || c == ':' || c == '\\') out += '\\';
    out += c;
  }
  return out;
}

std::string zsh_action(const Values& values) {
  switch (values.kind) {
    case Values::Kind::words:
      return "(" + joined(values.words) + ")";
    case Values::Kind::files:
      return values.ending.empty() ? "_files" : fmt::format("_files -g \"*{}\"", values.ending);
    case Values::Kind::folders:
      return "_files -/";
    case Values::Kind::keys:
      return "_needlework_keys";
    default:
      return " ";
  }
}

// One or more specifications of _arguments.
std::string zsh_specifications(const OptionHelp& option) {
  const std::string description = zsh_description(option.description);
  const std::string what = zsh_description(option.names.back());
  const Values values = values_of(option);
  if (option.is_positional) {
    const char* const place = is_repeated(option) ? "*:" : option.is_required ? ":" : "::";
    return "      " + quoted(fmt::format("{}{}:{}", place, what, zsh_action(values)), "'\\''") +
           " \\\n";
  }
  std::string out;
  const std::string repeated =
      option.value == "SECTION.KEY=VALUE" || option.value == "T" ? "*" : "";
  const std::string colon = option.value.starts_with('[') ? "::" : ":";
  const std::string value =
      option.value.empty()
          ? ""
          : fmt::format("{}{}:{}", colon, zsh_description(option.value), zsh_action(values));
  for (const std::string& name : option.names) {
    out += "      " +
           quoted(fmt::format("{}{}[{}]{}", repeated, name, description, value), "'\\''") + " \\\n";
  }
  return out;
}

std::string fish_action(const Values& values) {
  switch (values.kind) {
    case Values::Kind::words:
      return fmt::format(" -x -a '{}'", joined(values.words));
    case Values::Kind::files:
      return values.ending.empty()
                 ? std::string(" -r -F")
                 : fmt::format(" -x -k -a '(__fish_complete_suffix {})'", values.ending);
    case Values::Kind::folders:
      return " -x -a '(__fish_complete_directories)'";
    case Values::Kind::keys:
      return fmt::format(" -x -a '{}'", joined(scene_key_names()));
    default:
      return " -x";
  }
}

std::string fish_option(const OptionHelp& option, const std::string& condition) {
  std::string out = "complete -c needlework -n " + condition;
  if (option.is_positional) return out + fish_action(values_of(option)) + "\n";
  for (const std::string& name : option.names) {
    out += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
  }
  if (option.value.starts_with('[')) {
    out += " -a '(__fish_complete_suffix .json)'";
  } else if (!option.value.empty()) {
    out += fish_action(values_of(option));
  }
  return out + " -d " + quoted(option.description, "\\'") + "\n";
}

}  // namespace

std::string bash_completion(const ProgramHelp& program) {
  std::string commands;
  for (const CommandHelp& command : program.commands) commands += bash_command(command);
  return fmt::format(R"(# Completion of needlework for bash.

# Words that may follow.
_needlework_words() {{
  mapfile -t COMPREPLY < <(compgen -W "$1" -- "$word")
}}

# Files of this ending, and folders.
_needlework_files() {{
  compopt -o filenames
  mapfile -t COMPREPLY < <(compgen -d -- "$word"; compgen -f -X "!*$1" -- "$word")
}}

# Keys of a scene. The part up to '=' is a word of its own for bash.
_needlework_keys() {{
  compopt -o nospace
  mapfile -t COMPREPLY < <(compgen -W '{}' -- "$word")
}}

_needlework() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD - 1]}} command=
  COMPREPLY=()
  ((COMP_CWORD > 1)) && command=${{COMP_WORDS[1]}}
  case $command in
    '') _needlework_words '{} {}' ;;
{}  esac
}}

complete -F _needlework needlework
)",
                     joined(scene_key_names()), joined(names_of(program)),
                     joined(flags_of(program)), commands);
}

std::string zsh_completion(const ProgramHelp& program) {
  std::string list, cases;
  for (const CommandHelp& command : program.commands) {
    list +=
        "    " + quoted(command.name + ":" + zsh_description(command.description), "'\\''") + "\n";
    cases += fmt::format("    {})\n      _arguments -s \\\n", command.name);
    for (const OptionHelp& option : command.options) cases += zsh_specifications(option);
    cases.erase(cases.size() - 3);
    cases += "\n      ;;\n";
  }
  std::string options;
  for (const OptionHelp& option : program.options) options += zsh_specifications(option);
  return fmt::format(R"(#compdef needlework
# Completion of needlework for zsh.

_needlework_keys() {{
  compadd -S '' -- {}
}}

_needlework() {{
  local context state state_descr line
  typeset -A opt_args
  local -a commands=(
{}  )
  _arguments -C \
{}      ':command:->command' \
      '*::argument:->argument'
  case $state in
    command) _describe command commands ;;
    argument)
      case $words[1] in
{}      esac
      ;;
  esac
}}

if [[ $funcstack[1] == _needlework ]]; then
  _needlework "$@"
else
  compdef _needlework needlework
fi
)",
                     joined(scene_key_names()), list, options, cases);
}

std::string fish_completion(const ProgramHelp& program) {
  const std::string no_command =
      fmt::format("'not __fish_seen_subcommand_from {}'", joined(names_of(program)));
  std::string out = "# Completion of needlework for fish.\ncomplete -c needlework -f\n";
  for (const OptionHelp& option : program.options) out += fish_option(option, no_command);
  for (const CommandHelp& command : program.commands) {
    out += fmt::format("complete -c needlework -n {} -a {} -d {}\n", no_command, command.name,
                       quoted(command.description, "\\'"));
  }
  for (const CommandHelp& command : program.commands) {
    const std::string condition = fmt::format("'__fish_seen_subcommand_from {}'", command.name);
    for (const OptionHelp& option : command.options) out += fish_option(option, condition);
  }
  return out;
}

}  // namespace needlework::cli
