// Files that survive a power failure.
#pragma once

#include <string>
#include <string_view>

namespace needlework::runs {

/// Writes a new file and waits until its bytes are on the disk. Throws IoError, "PATH: reason", and
/// then leaves no file.
void write_durably(const std::string& path, std::string_view bytes);

/// Waits until the names in a folder are on the disk: of new, renamed and removed files. File
/// systems that cannot do so are taken at their word.
void sync_folder_of(const std::string& path);

}  // namespace needlework::runs
