#include "src/cli/messages.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdio>

#include "src/cli/standard_streams.h"
#include "src/scene/printable.h"

namespace needlework::cli {
namespace {

// Messages quote untrusted files, whose control characters would reach the terminal.
void print_line(std::string_view kind, std::string_view message) {
  std::string line(message);
  std::replace(line.begin(), line.end(), '\n', ' ');
  write_stderr(fmt::format("needlework: {}{}\n", kind, printable(line)));
}

}  // namespace

void print_error(std::string_view message) { print_line("", message); }
void print_warning(std::string_view message) { print_line("warning: ", message); }

std::string shell_word(std::string_view word) {
  const auto is_plain = [](unsigned char c) {
    return std::isalnum(c) || std::string_view("_-+=./:,@%").find(c) != std::string_view::npos;
  };
  if (!word.empty() && std::all_of(word.begin(), word.end(), is_plain)) return std::string(word);
  std::string out = "'";
  for (const char c : word) {
    if (c == '\'') {
      out += "'\\''";
    } else {
      out += c;
    }
  }
  return out + "'";
}

std::optional<std::string> warning_of_name(std::string_view place, std::string_view file,
                                           std::string_view kind,
                                           std::initializer_list<std::string_view> endings) {
  const bool fits = std::any_of(endings.begin(), endings.end(),
                                [&](std::string_view ending) { return file.ends_with(ending); });
  if (fits) return std::nullopt;
  return fmt::format("{}: will be {} nevertheless: expected a name that ends in {}", place, kind,
                     *endings.begin());
}

}  // namespace needlework::cli
