#include "src/cli/messages.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

namespace needlework::cli {
namespace {

void print_line(std::string_view kind, std::string_view message) {
  std::string line(message);
  std::replace(line.begin(), line.end(), '\n', ' ');
  fmt::print(stderr, "needlework: {}{}\n", kind, line);
}

}  // namespace

void print_error(std::string_view message) { print_line("", message); }
void print_warning(std::string_view message) { print_line("warning: ", message); }

}  // namespace needlework::cli
