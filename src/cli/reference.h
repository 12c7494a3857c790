// The command reference: manual page, Markdown, and completions for shells.
#pragma once

#include <string>
#include <string_view>

#include "src/cli/command_help.h"

namespace needlework::cli {

/// The text in one of these forms: man, markdown, bash, zsh, fish. Throws InputError for others.
///
/// In the details of commands, lines that are indented by two spaces are kept as they are, a line
/// that ends with a colon before such lines is their heading, and other lines are joined to
/// paragraphs, which blank lines separate.
std::string reference(const ProgramHelp& program, std::string_view form);

/// The same completions and manual, by the names above.
std::string man_page(const ProgramHelp& program);
std::string markdown(const ProgramHelp& program);
std::string bash_completion(const ProgramHelp& program);
std::string zsh_completion(const ProgramHelp& program);
std::string fish_completion(const ProgramHelp& program);

/// A piece of the details.
struct Piece {
  enum class Kind { paragraph, heading, verbatim } kind;
  std::string text;  ///< lines of verbatim text without their indentation, one after the other
};
std::vector<Piece> pieces_of(const std::string& details);

}  // namespace needlework::cli
