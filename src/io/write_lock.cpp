#include "src/io/write_lock.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <set>
#include <system_error>

#include "needlework/error.h"
#include "src/io/hdf5.h"

namespace needlework::io {
namespace {

[[noreturn]] void fail_lock(const std::string& place, int error) {
  throw IoError(fmt::format("{}: {}", place, std::generic_category().message(error)));
}

// HDF5 takes a shared lock of this kind for reading and an exclusive one for writing. A shared one
// is therefore compatible with readers, but also with other locks of this class.
bool lock_against_hdf5(int descriptor) {
  return flock(descriptor, LOCK_SH | LOCK_NB) == 0 || errno != EWOULDBLOCK;
}

// HDF5 does not know this kind of lock. It belongs to the open file and not to the process, so that
// it also excludes other writers of the same process.
bool lock_against_writers(int descriptor) {
#ifdef F_OFD_SETLK
  struct flock whole_file {};
  whole_file.l_type = F_WRLCK;
  whole_file.l_whence = SEEK_SET;
  return fcntl(descriptor, F_OFD_SETLK, &whole_file) == 0 || (errno != EAGAIN && errno != EACCES);
#else
  return true;
#endif
}

// Those of all locks of the process. Used in a session, so that no other thread is about to change
// them when hdf5::fork_process() forks.
std::set<int>& descriptors() {
  static std::set<int>* const descriptors = new std::set<int>;
  return *descriptors;
}

}  // namespace

WriteLock::WriteLock(const std::string& name, const std::string& place)
    : place_(place), descriptor_(open(name.c_str(), O_RDWR | O_CLOEXEC | O_NONBLOCK)) {
  if (descriptor_ < 0) fail_lock(place_, errno);
  struct stat status;
  const bool regular = fstat(descriptor_, &status) == 0 && S_ISREG(status.st_mode);
  if (regular && lock_against_hdf5(descriptor_) && lock_against_writers(descriptor_)) {
    const hdf5::Session session;
    descriptors().insert(descriptor_);
    return;
  }
  close(descriptor_);
  throw IoError(place_ + (regular ? ": another program has the file open for writing"
                                  : ": not a regular file"));
}

WriteLock::~WriteLock() {
  const hdf5::Session session;
  descriptors().erase(descriptor_);
  close(descriptor_);
}

void WriteLock::leave_to_parent() {
  for (const int descriptor : descriptors()) close(descriptor);
}

void WriteLock::sync() {
  if (fsync(descriptor_) != 0) fail_lock(place_, errno);
}

}  // namespace needlework::io
