// Messages to people, on stderr.
#pragma once

#include <string_view>

namespace needlework::cli {

/// Prints "needlework: MESSAGE" as one line.
void print_error(std::string_view message);

/// Prints "needlework: warning: MESSAGE" as one line.
void print_warning(std::string_view message);

}  // namespace needlework::cli
