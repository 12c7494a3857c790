// A file that appears under its name only when it is worth having.
#pragma once

#include <string>

namespace needlework::io {

/// A file being made under a temporary name in the folder of its final one, so that nobody ever
/// sees half of it and a failure leaves nothing behind. Messages read "PATH: reason".
class AtomicFile {
 public:
  /// Creates the empty temporary. Throws IoError when `path` exists and `force` is false, when it
  /// is a directory, a device or anything else that is not a file, and when the folder cannot be
  /// written. A symbolic link to a file is followed when `force` replaces that file.
  AtomicFile(std::string path, bool force);
  /// Removes the temporary unless published.
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  const std::string& temporary() const { return temporary_; }

  /// Gives the file its final name in one step. Without `force`, a file that appeared there in the
  /// meantime stays as it is and IoError is thrown.
  void publish();

 private:
  std::string path_;    // as given, for messages
  std::string target_;  // links followed
  std::string temporary_;
  bool force_;
};

}  // namespace needlework::io
