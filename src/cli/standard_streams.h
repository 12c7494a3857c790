// Standard input, output and error of the program, of which any may be closed: cron, daemons and
// some launchers leave them so.
#pragma once

#include <string_view>

namespace needlework::cli {

/// Opens /dev/null in place of those that are closed, so that no file takes their place, and of
/// standard output also where it is open for reading only. To be called before anything is opened.
/// Returns whether what is printed goes anywhere.
bool open_standard_streams();

/// Writes to stderr. What cannot be written is lost: a run does not end because nobody listens.
void write_stderr(std::string_view text);

}  // namespace needlework::cli
