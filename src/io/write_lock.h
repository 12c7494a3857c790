// The right to write a file, which one program at a time can have.
#pragma once

#include <string>

namespace needlework::io {

/// What locks show of a file.
struct LockState {
  bool may_grow = false;         ///< there is a WriteLock, or locks do not show whether there is
  bool opened_to_write = false;  ///< by a program, in this or another process
  bool hdf5_can_lock = true;     ///< false: HDF5 must not try to lock the file
  std::string reason = {};       ///< why locks do not show all; empty if they do
};

/// Of an open file, which has no lock then.
LockState lock_state(int descriptor);
/// Of a file that cannot be opened, nothing is shown.
LockState lock_state(const std::string& name);

/// Throws IoError, "PLACE: reason", if a program has this file open for writing, as far as locks
/// show that. Of a file that does not exist or may not be read, they show nothing.
void require_not_being_written(const std::string& name, const std::string& place);

/// Whether HDF5_USE_FILE_LOCKING says that no file is to be locked.
bool locks_turned_off();

/// A warning, "PLACE: ...", where locks on this file exclude nobody, because the file system has
/// none or they are turned off; else empty.
std::string warning_without_locks(const std::string& name, const std::string& place);

/// A lock of the operating system on an existing file. While it exists,
///
/// - no other WriteLock on the file can be made, in this or another process;
/// - HDF5 refuses to open the file for writing, and opens it for reading, in all programs.
///
/// It ends with the process, also by kill -9. On file systems without locks, and
/// where HDF5_USE_FILE_LOCKING is FALSE, it excludes nobody.
class WriteLock {
 public:
  /// Throws IoError, "PLACE: reason", if the file does not exist, is not a regular file, may not be
  /// written, or is open for writing in another program.
  WriteLock(const std::string& name, const std::string& place);
  ~WriteLock();
  WriteLock(const WriteLock&) = delete;
  WriteLock& operator=(const WriteLock&) = delete;

  /// Returns when the content of the file is on the disk. Throws IoError if it cannot be written.
  void sync();
  /// Throws IoError unless `name` leads to this file: what is written could not be found there.
  void require_named(const std::string& name) const;

  /// In a process that has just been forked: closes the descriptors of all locks, which would
  /// outlast them in the parent. They cannot be used here any more.
  static void leave_to_parent();

 private:
  std::string place_;
  int descriptor_;
};

}  // namespace needlework::io
