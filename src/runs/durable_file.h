// Files that survive a power failure.
#pragma once

#include <string>
#include <string_view>

namespace needlework::runs {

// All throw IoError, "PATH: reason".

/// Writes a new file and returns when its bytes are on the disk. Leaves no file when it throws.
void write_durably(const std::string& path, std::string_view bytes);

/// Returns when the bytes of an existing file are on the disk.
void sync_bytes(const std::string& path);

/// Renames a file whose bytes are on the disk, and returns when its new name is as well. A file
/// that has this name is replaced: there is always the old one or the new one.
void rename_durably(const std::string& from, const std::string& to);

/// Replaces a file, or makes it, by way of "PATH.part". There is always the old one or the new one,
/// which is on the disk when this returns.
void replace_durably(const std::string& path, std::string_view bytes);

}  // namespace needlework::runs
