// Messages to people, on stderr.
#pragma once

#include <string>
#include <string_view>

namespace needlework::cli {

/// Prints "needlework: MESSAGE" as one line.
void print_error(std::string_view message);

/// Prints "needlework: warning: MESSAGE" as one line.
void print_warning(std::string_view message);

/// A time span for people, such as "1.25 s", "3 min 20 s" or "2 h 05 min"; [s] in.
std::string duration_text(double seconds);

/// Bytes for people, such as "12.5 MB".
std::string bytes_text(double bytes);

}  // namespace needlework::cli
