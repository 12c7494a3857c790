// A disk that is watched, that may fill up or end the program, and processes to which that happens.
#pragma once

#include <functional>
#include <string>

namespace needlework::io {

/// What happens to writes in `folder`. Nothing while `folder` is empty.
struct Disk {
  enum class Event {
    full,       ///< the write `at` and all after it find the disk full
    full_once,  ///< only that one does
    kill  ///< the program is killed in that write, of which at most some pages are on the disk
  };

  std::string folder;
  int at = -1;  ///< writes and changes of sizes are counted from 0
  Event event = Event::full;
  bool sync_fails = false;

  int writes = 0;               ///< so far
  int torn = 0;                 ///< writes over a page boundary that need not have been
  std::string operations = {};  ///< 'w' for each write, 'f' and 'd' for fsync of a file and folder
};

/// The disk of this process. Forked processes begin with a copy.
extern Disk disk;

/// Runs `action` in a process of its own, so that users and disks may change, and returns the
/// message of its IoError, "no exception", or "killed". Output of the process to standard error,
/// where HDF5 has to stay silent, is part of the message.
std::string message_in_child(const std::function<void()>& prepare,
                             const std::function<void()>& action);

/// For `prepare`: continues as a user without rights if this is the superuser.
void become_nobody();

}  // namespace needlework::io
