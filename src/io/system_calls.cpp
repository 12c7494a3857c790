#include "src/io/system_calls.h"

#include <fcntl.h>
#include <unistd.h>

#include "src/machine/descriptors.h"

namespace needlework::io {

int write_fully(int descriptor, const void* bytes, std::size_t size, std::uint64_t offset) {
  const auto* const begin = static_cast<const std::byte*>(bytes);
  std::size_t done = 0;
  while (done < size) {
    const ssize_t put = uninterrupted([&] {
      return pwrite(descriptor, begin + done, size - done, static_cast<off_t>(offset + done));
    });
    if (put < 0) return errno;
    if (put == 0) return ENOSPC;
    done += static_cast<std::size_t>(put);
  }
  return 0;
}

int sync_file(int descriptor) {
  return uninterrupted([&] { return fsync(descriptor); }) == 0 ? 0 : errno;
}

int sync_folder(const std::string& folder) {
  const int descriptor = open_descriptor(folder, O_RDONLY | O_DIRECTORY);
  if (descriptor < 0) return errno;
  const int error = sync_file(descriptor);
  close(descriptor);
  return error == EINVAL ? 0 : error;
}

// Linux has closed the file also when it says EINTR, so that a second call could close another one.
int close_written(int descriptor) { return close(descriptor) == 0 || errno == EINTR ? 0 : errno; }

}  // namespace needlework::io
