// The commands and options of the program as plain data. Messages on wrong usage, the manual and
// the completions are made of it.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace needlework::cli {

struct OptionHelp {
  std::vector<std::string> names;  ///< such as "-h" and "--help"; of a positional, its only name
  std::string value;  ///< what stands for it, such as "FILE.h5", "fast|standard"; none for a flag
  std::string description;
  std::string default_value;         ///< empty if there is none
  std::vector<std::string> choices;  ///< all words that may be given, if `value` does not name them
  bool is_positional = false, is_required = false;

  bool is_named(std::string_view name) const;
};

/// With the default, if there is one, and whether it has to be given.
std::string description_of(const OptionHelp& option);

struct CommandHelp {
  std::string name, description;
  std::string details;  ///< paragraphs, see reference.h
  std::vector<OptionHelp> options;

  /// The option of this name, or null.
  const OptionHelp* find(std::string_view option_name) const;
  /// Such as "needlework run [OPTIONS] SCENE.toml".
  std::string usage() const;
};

struct ProgramHelp : CommandHelp {
  std::vector<CommandHelp> commands;

  /// The command of this name, or null.
  const CommandHelp* find_command(std::string_view command_name) const;
};

}  // namespace needlework::cli
