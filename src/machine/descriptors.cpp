#include "src/machine/descriptors.h"

#include <fcntl.h>
#include <pthread.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <mutex>

namespace needlework {
namespace {

// The mutex protects the other members.
struct Shared {
  std::mutex mutex;
  int users = 0;
  std::array<bool, 3> occupied{};  // by this library
};

Shared& shared() {
  static Shared* const shared = [] {
    auto* made = new Shared;
    // A child that is forked must not find the mutex locked by a thread that it does not have.
    static Shared* const protects = made;
    pthread_atfork([] { protects->mutex.lock(); }, [] { protects->mutex.unlock(); },
                   [] { protects->mutex.unlock(); });
    return made;
  }();
  return *shared;
}

// The lowest descriptor that is free. The root folder is there where /dev/null is not.
int open_anything() {
  const int nothing = open("/dev/null", O_RDWR | O_CLOEXEC);
  return nothing >= 0 ? nothing : open("/", O_RDONLY | O_CLOEXEC);
}

bool is_closed(int descriptor) { return fcntl(descriptor, F_GETFD) < 0; }

// Returns false if another thread was faster.
bool occupy(int descriptor) {
  const int opened = open_anything();
  if (opened >= 0 && opened != descriptor) close(opened);
  return opened == descriptor;
}

}  // namespace

StandardDescriptors::StandardDescriptors() {
  Shared& all = shared();
  const std::lock_guard lock(all.mutex);
  ++all.users;
  for (int descriptor = 0; descriptor < 3; ++descriptor) {
    if (is_closed(descriptor)) all.occupied[descriptor] = occupy(descriptor);
  }
}

StandardDescriptors::~StandardDescriptors() {
  const int error = errno;
  Shared& all = shared();
  const std::lock_guard lock(all.mutex);
  if (--all.users > 0) return;
  for (int descriptor = 0; descriptor < 3; ++descriptor) {
    if (all.occupied[descriptor]) close(descriptor);
    all.occupied[descriptor] = false;
  }
  errno = error;
}

int open_descriptor(const std::string& path, int flags) {
  const StandardDescriptors occupied;
  for (;;) {
    const int descriptor = open(path.c_str(), flags | O_CLOEXEC, 0666);
    if (descriptor >= 0 || errno != EINTR) return descriptor;
  }
}

}  // namespace needlework
