// Descriptors of files that are never those of standard input, output and error, where these are
// closed: what anybody prints or reads would go to the file.
#pragma once

#include <string>

namespace needlework {

/// Keeps the descriptors 0, 1 and 2 occupied: what is opened meanwhile gets another one. Those that
/// are closed lead to /dev/null until the last of these objects ends, and are then closed again.
/// Any thread may have some.
class StandardDescriptors {
 public:
  StandardDescriptors();
  ~StandardDescriptors();
  StandardDescriptors(const StandardDescriptors&) = delete;
  StandardDescriptors& operator=(const StandardDescriptors&) = delete;
};

/// Opens a file as open() does, again if a signal interrupts that, and with O_CLOEXEC. Returns a
/// descriptor above 2, or -1 with errno.
int open_descriptor(const std::string& path, int flags);

}  // namespace needlework
