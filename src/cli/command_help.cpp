#include "src/cli/command_help.h"

#include <algorithm>

namespace needlework::cli {

bool OptionHelp::is_named(std::string_view name) const {
  return std::find(names.begin(), names.end(), name) != names.end();
}

std::string description_of(const OptionHelp& option) {
  if (option.is_required && !option.is_positional) return option.description + " (required)";
  if (option.default_value.empty()) return option.description;
  return option.description + " (default: " + option.default_value + ")";
}

const OptionHelp* CommandHelp::find(std::string_view option_name) const {
  const auto found = std::find_if(options.begin(), options.end(), [&](const OptionHelp& option) {
    return option.is_named(option_name);
  });
  return found == options.end() ? nullptr : &*found;
}

std::string CommandHelp::usage() const {
  std::string line = "needlework " + name + " [OPTIONS]";
  for (const OptionHelp& option : options) {
    if (!option.is_positional) continue;
    line += option.is_required ? " " + option.names[0] : " [" + option.names[0] + "]";
  }
  return line;
}

const CommandHelp* ProgramHelp::find_command(std::string_view command_name) const {
  const auto found = std::find_if(commands.begin(), commands.end(),
                                  [&](const CommandHelp& c) { return c.name == command_name; });
  return found == commands.end() ? nullptr : &*found;
}

}  // namespace needlework::cli
