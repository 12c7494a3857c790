// Opens files that people have written, of which any may turn out to be something else.
#pragma once

#include <cstdio>
#include <memory>
#include <string>

namespace needlework {

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

/// Opens a file for reading, or a pipe into which a program writes. Throws IoError, "PATH: cannot
/// be read: REASON", also for a folder, and for a named pipe that no program has opened to write:
/// others would wait for one without end.
std::unique_ptr<std::FILE, CloseFile> open_text(const std::string& path);

}  // namespace needlework
