#include "src/cli/reference.h"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

#include "needlework/error.h"

namespace needlework::cli {
namespace {

std::string replaced(std::string text, std::string_view from, std::string_view to) {
  for (auto at = text.find(from); at != text.npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
  return text;
}

// Its names and what follows, such as "-h, --help" or "--out FILE.h5".
std::string synopsis(const OptionHelp& option) {
  if (option.is_positional) {
    return option.value == option.names[0] ? option.value
                                           : option.names[0] + " (" + option.value + ")";
  }
  std::string text;
  for (const std::string& name : option.names) text += (text.empty() ? "" : ", ") + name;
  return option.value.empty() ? text : text + " " + option.value;
}

// Text as troff takes it: no hyphens made of minus signs, no line that begins with a request.
std::string troff(const std::string& text) {
  std::string out = replaced(replaced(text, "\\", "\\e"), "-", "\\-");
  out = replaced(out, "|", "|\\:");  // where a line may end: choices can be longer than one
  if (out.starts_with('.') || out.starts_with('\'')) out.insert(0, "\\&");
  return replaced(replaced(out, "\n.", "\n\\&."), "\n'", "\n\\&'");
}

std::string capitals(std::string text) {
  for (char& c : text) {
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  }
  return text;
}

// Positionals first. That --help helps is said once, with the options of the program.
std::vector<OptionHelp> listed_options(const CommandHelp& command) {
  std::vector<OptionHelp> options;
  for (const bool positional : {true, false}) {
    for (const OptionHelp& option : command.options) {
      const bool is_listed = command.name == "needlework" || !option.is_named("--help");
      if (option.is_positional == positional && is_listed) options.push_back(option);
    }
  }
  return options;
}

std::string troff_options(const CommandHelp& command) {
  std::string out;
  for (const OptionHelp& option : listed_options(command)) {
    out += fmt::format(".TP\n\\fB{}\\fR\n{}\n", troff(synopsis(option)),
                       troff(description_of(option)));
  }
  return out;
}

// `heading`: the request before a heading, .SH or .PP.
std::string troff_details(const CommandHelp& command, bool is_program) {
  std::string out;
  for (const Piece& piece : pieces_of(command.details)) {
    switch (piece.kind) {
      case Piece::Kind::paragraph:
        out += ".PP\n" + troff(piece.text) + "\n";
        break;
      case Piece::Kind::heading:
        out += is_program ? fmt::format(".SH {}\n", capitals(piece.text))
                          : fmt::format(".PP\n\\fI{}\\fR\n", troff(piece.text));
        break;
      case Piece::Kind::verbatim:
        out += ".PP\n.nf\n" + troff(piece.text) + "\n.fi\n";
        break;
    }
  }
  return out;
}

std::string markdown_cell(const std::string& text) { return replaced(text, "|", "\\|"); }

std::string markdown_table(const std::vector<OptionHelp>& options) {
  if (options.empty()) return "";
  std::string out = "| argument | meaning |\n|---|---|\n";
  for (const OptionHelp& option : options) {
    out += fmt::format("| `{}` | {} |\n", markdown_cell(synopsis(option)),
                       markdown_cell(description_of(option)));
  }
  return out;
}

bool are_same(const OptionHelp& a, const OptionHelp& b) {
  return synopsis(a) == synopsis(b) && description_of(a) == description_of(b);
}

bool contains(const std::vector<OptionHelp>& options, const OptionHelp& option) {
  return std::any_of(options.begin(), options.end(),
                     [&](const OptionHelp& other) { return are_same(other, option); });
}

// Arguments that several commands have with the same meaning.
std::vector<OptionHelp> common_arguments(const ProgramHelp& program) {
  std::vector<OptionHelp> seen, common;
  for (const CommandHelp& command : program.commands) {
    for (const OptionHelp& option : listed_options(command)) {
      if (contains(common, option)) continue;
      (contains(seen, option) ? common : seen).push_back(option);
    }
  }
  return common;
}

// Those of `common` are only named.
std::string markdown_options(const CommandHelp& command, const std::vector<OptionHelp>& common) {
  std::vector<OptionHelp> own;
  std::string named;
  for (const OptionHelp& option : listed_options(command)) {
    if (contains(common, option)) {
      named += fmt::format("{}`{}`", named.empty() ? "" : ", ", option.names[0]);
    } else {
      own.push_back(option);
    }
  }
  const std::string table = markdown_table(own);
  if (named.empty()) return table;
  return table + (table.empty() ? "" : "\n") + "[Common](#common-arguments): " + named + ".\n";
}

std::string markdown_details(const CommandHelp& command) {
  std::string out;
  for (const Piece& piece : pieces_of(command.details)) {
    switch (piece.kind) {
      case Piece::Kind::paragraph:
        out += "\n" + piece.text + "\n";
        break;
      case Piece::Kind::heading:
        out += "\n" + piece.text + ":\n";
        break;
      case Piece::Kind::verbatim:
        out += "\n    " + replaced(piece.text, "\n", "\n    ") + "\n";
        break;
    }
  }
  return out;
}

}  // namespace

std::vector<Piece> pieces_of(const std::string& details) {
  std::vector<Piece> pieces;
  bool begins = true;  // a piece of its own
  std::istringstream lines(details);
  for (std::string line; std::getline(lines, line); begins = line.empty()) {
    if (line.empty()) continue;
    const bool verbatim = line.starts_with("  ");
    const Piece::Kind kind = verbatim ? Piece::Kind::verbatim : Piece::Kind::paragraph;
    const std::string text = verbatim ? line.substr(2) : line;
    if (verbatim && !begins && pieces.back().kind == Piece::Kind::paragraph &&
        pieces.back().text.ends_with(':')) {
      pieces.back().kind = Piece::Kind::heading;
      pieces.back().text.pop_back();
    }
    if (begins || pieces.empty() || pieces.back().kind != kind) {
      pieces.push_back({kind, text});
    } else {
      pieces.back().text += (verbatim ? "\n" : " ") + text;
    }
  }
  return pieces;
}

std::string man_page(const ProgramHelp& program) {
  std::string out = ".\\\" Printed by needlework --print-reference man.\n";
  out += fmt::format(".TH NEEDLEWORK 1 \"\" \"needlework {}\" \"User Commands\"\n",
                     NEEDLEWORK_VERSION);
  out += ".ad l\n";  // choices have no spaces that could be widened
  out += fmt::format(".SH NAME\nneedlework \\- {}\n", troff(program.description));
  out += ".SH SYNOPSIS\n\\fBneedlework\\fR \\fICOMMAND\\fR [\\fIOPTIONS\\fR] [\\fIFILE\\fR]\n";
  out += ".SH COMMANDS\n";
  for (const CommandHelp& command : program.commands) {
    out += fmt::format(".TP\n\\fB{}\\fR\n{}\n", command.name, troff(command.description));
  }
  out += ".SH OPTIONS\n" + troff_options(program) + troff_details(program, true);
  for (const CommandHelp& command : program.commands) {
    out += fmt::format(".SH NEEDLEWORK {}\n\\fB{}\\fR\n.PP\n{}\n", capitals(command.name),
                       troff(command.usage()), troff(command.description));
    out += troff_options(command) + troff_details(command, false);
  }
  return out;
}

std::string markdown(const ProgramHelp& program) {
  std::string out = "# Commands\n\n<!-- Printed by needlework --print-reference markdown. -->\n\n";
  out += "`needlework COMMAND [OPTIONS] [FILE]`: " + program.description + ".\n\n";
  out += "| command | what it does |\n|---|---|\n";
  for (const CommandHelp& command : program.commands) {
    out += fmt::format("| [`{}`](#needlework-{}) | {} |\n", command.name, command.name,
                       markdown_cell(command.description));
  }
  const std::vector<OptionHelp> common = common_arguments(program);
  out += "\n" + markdown_table(listed_options(program)) + markdown_details(program);
  out += "\n## Common arguments\n\n" + markdown_table(common);
  for (const CommandHelp& command : program.commands) {
    out += fmt::format("\n## needlework {}\n\n`{}`\n", command.name, command.usage());
    const std::string options = markdown_options(command, common);
    out += (options.empty() ? "" : "\n") + options + markdown_details(command);
  }
  return out;
}

std::string reference(const ProgramHelp& program, std::string_view form) {
  if (form == "man") return man_page(program);
  if (form == "markdown") return markdown(program);
  if (form == "bash") return bash_completion(program);
  if (form == "zsh") return zsh_completion(program);
  if (form == "fish") return fish_completion(program);
  throw InputError(
      fmt::format("--print-reference {}: expected man, markdown, bash, zsh or fish", form));
}

}  // namespace needlework::cli
