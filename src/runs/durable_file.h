// Files that survive a power failure.
#pragma once

#include <string>
#include <string_view>

namespace needlework::runs {

/// Writes a new file and waits until its bytes are on the disk. Throws IoError, "PATH: reason", and
/// then leaves no file.
void write_durably(const std::string& path, std::string_view bytes);

}  // namespace needlework::runs
