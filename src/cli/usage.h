// Answers to command lines that cannot be understood.
#pragma once

#include <span>
#include <string>

#include "src/cli/command_help.h"

namespace needlework::cli {

/// One line that says what is wrong with the arguments, what was expected, and where to read on.
/// `unexpected` are those for which the parser has no place, and `reason` is what it says itself.
std::string usage_message(const ProgramHelp& program, std::span<const std::string> arguments,
                          std::span<const std::string> unexpected, const std::string& reason);

/// The same for a word that is no command; `rest` are the arguments after it.
std::string unknown_command_message(const ProgramHelp& program, const std::string& word,
                                    std::span<const std::string> rest);

}  // namespace needlework::cli
