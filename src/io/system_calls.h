// Calls of the operating system that signals may interrupt or that may do a part of their work.
#pragma once

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <string>

namespace needlework::io {

/// Makes a call again for as long as a signal interrupts it. `call` returns a negative number when
/// it fails, and sets errno.
template <class Call>
auto uninterrupted(Call call) {
  for (;;) {
    const auto result = call();
    if (result >= 0 || errno != EINTR) return result;
  }
}

/// Writes all bytes to an open file, from `offset` on. Returns 0 or the errno of the failure.
int write_fully(int descriptor, const void* bytes, std::size_t size, std::uint64_t offset);

/// Returns when the bytes of an open file are on the disk: 0, or the errno of the failure.
int sync_file(int descriptor);

/// Returns when the names in a folder are on the disk: of new, renamed and removed files. 0, or the
/// errno of the failure. File systems that cannot do so are taken at their word.
int sync_folder(const std::string& folder);

/// Closes a file that has been written. Returns 0 or the errno of the failure: some file systems
/// report only here that they are full.
int close_written(int descriptor);

}  // namespace needlework::io
