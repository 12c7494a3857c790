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
#include "src/io/system_calls.h"

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

// Whether lock_against_writers() would fail. A descriptor for reading is enough to ask.
bool is_locked_by_writer(int descriptor) {
#ifdef F_OFD_GETLK
  struct flock whole_file {};
  whole_file.l_type = F_WRLCK;
  whole_file.l_whence = SEEK_SET;
  return fcntl(descriptor, F_OFD_GETLK, &whole_file) == 0 && whole_file.l_type != F_UNLCK;
#else
  return false;
#endif
}

// What `ask` says of a file; false of one that cannot be opened. Locks that it takes end here.
template <class Ask>
bool is_true_of(const std::string& name, const Ask& ask) {
  const int descriptor = open(name.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0) return false;
  const bool answer = ask(descriptor);
  close(descriptor);
  return answer;
}

constexpr const char* opened_elsewhere =
    ": another program or simulation has the file open for writing";

// Those of all locks of the process. Used in a session, so that no other thread is about to change
// them when hdf5::fork_process() forks.
std::set<int>& descriptors() {
  static std::set<int>* const descriptors = new std::set<int>;
  return *descriptors;
}

}  // namespace

bool is_being_written(const std::string& name) { return is_true_of(name, is_locked_by_writer); }

void require_not_being_written(const std::string& name, const std::string& place) {
  const bool written = is_true_of(name, [](int descriptor) {
    return !lock_against_hdf5(descriptor) || is_locked_by_writer(descriptor);
  });
  if (written) throw IoError(place + opened_elsewhere);
}

WriteLock::WriteLock(const std::string& name, const std::string& place)
    : place_(place),
      descriptor_(
          uninterrupted([&] { return open(name.c_str(), O_RDWR | O_CLOEXEC | O_NONBLOCK); })) {
  if (descriptor_ < 0) fail_lock(place_, errno);
  struct stat status;
  const bool regular = fstat(descriptor_, &status) == 0 && S_ISREG(status.st_mode);
  if (regular && lock_against_hdf5(descriptor_) && lock_against_writers(descriptor_)) {
    const hdf5::Session session;
    descriptors().insert(descriptor_);
    return;
  }
  close(descriptor_);
  throw IoError(place_ + (regular ? opened_elsewhere : ": not a regular file"));
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
  if (const int error = sync_file(descriptor_)) fail_lock(place_, error);
}

void WriteLock::require_named(const std::string& name) const {
  struct stat locked, named;
  const bool same = fstat(descriptor_, &locked) == 0 && stat(name.c_str(), &named) == 0 &&
                    locked.st_dev == named.st_dev && locked.st_ino == named.st_ino;
  if (same) return;
  throw IoError(place_ + ": the file has been removed, renamed or replaced while it was written");
}

}  // namespace needlework::io
