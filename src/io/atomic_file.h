// Files that appear under their final name only when they are complete.
#pragma once

#include <string>

namespace needlework::io {

/// A file that is written under a temporary name in the folder of its final name. Other programs
/// never see an incomplete file under the final name, and a failure leaves no file behind. Messages
/// of errors have the form "PATH: reason".
class AtomicFile {
 public:
  /// Creates the temporary file, which is empty. Throws IoError if `path` exists and `force` is
  /// false, if it is open for writing elsewhere (see write_lock.h), if it is a directory, a device
  /// or anything else that is not a regular file, and if the folder cannot be written. If `path` is
  /// a symbolic link to a file and `force` is true, that file is replaced and the link stays.
  AtomicFile(std::string path, bool force);
  /// Removes the temporary file unless it was published.
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  const std::string& temporary() const { return temporary_; }

  /// Renames the file to its final name in one atomic step. If `force` is false and a file of that
  /// name has appeared since the construction, that file is kept and IoError is thrown.
  void publish();

 private:
  std::string path_;    // the name as given, for messages
  std::string target_;  // the name with symbolic links followed
  std::string temporary_;
  bool force_;
};

/// Returns when the name of an existing file is on the disk, which is in its folder and not in the
/// file. Throws IoError if it cannot be written.
void sync_name(const std::string& path);

/// The name of a file wherever the process goes; as it is where that is unknown, as for an empty
/// one.
std::string absolute_name(const std::string& name);

/// The shortest name of the same file for a message: relative if it is below the folder in which
/// the process is now.
std::string name_from_here(const std::string& absolute);

}  // namespace needlework::io
