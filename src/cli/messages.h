// Messages to people, on stderr.
#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>

namespace needlework::cli {

/// Prints "needlework: MESSAGE" as one line.
void print_error(std::string_view message);

/// Prints "needlework: warning: MESSAGE" as one line.
void print_warning(std::string_view message);

/// A word as a shell takes it, in quotes where it needs them.
std::string shell_word(std::string_view word);

/// A warning that names the place, if the name of a file that is to be written, of this kind ("a
/// page of HTML"), has none of these endings; else nothing.
std::optional<std::string> warning_of_name(std::string_view place, std::string_view file,
                                           std::string_view kind,
                                           std::initializer_list<std::string_view> endings);

}  // namespace needlework::cli
