// Files that were given to the wrong command.
#pragma once

#include <string>

namespace needlework::cli {

enum class FileKind { scene, grid, pairs, h5md, configuration, unknown };

/// What a file holds, as far as its first bytes, its sections or its lines say. `configuration` is
/// a configuration of another program, which `needlework import` reads.
FileKind kind_of(const std::string& path);

/// Throws the exception being handled. If the file is of another kind than expected, the message of
/// an InputError or IoError says so, and names the command that takes it.
[[noreturn]] void rethrow_for(const std::string& path, FileKind expected);

/// Does what reads a file of this kind, with such messages where that fails.
template <class Action>
auto read_file(const std::string& path, FileKind expected, Action action) -> decltype(action()) {
  try {
    return action();
  } catch (...) {
    rethrow_for(path, expected);
  }
}

}  // namespace needlework::cli
