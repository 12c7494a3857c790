#include "src/cli/standard_streams.h"

#include <fcntl.h>
#include <unistd.h>

#include <cstdio>

#include "src/machine/descriptors.h"

namespace needlework::cli {
namespace {

bool is_open_for_writing(int descriptor) {
  const int flags = fcntl(descriptor, F_GETFL);
  return flags >= 0 && (flags & O_ACCMODE) != O_RDONLY;
}

}  // namespace

bool open_standard_streams() {
  const bool can_print = is_open_for_writing(STDOUT_FILENO);
  // Never destroyed: it keeps them occupied.
  static const StandardDescriptors* const occupied = new StandardDescriptors;
  static_cast<void>(occupied);
  if (!can_print) {
    if (const int nothing = open_descriptor("/dev/null", O_WRONLY); nothing >= 0) {
      dup2(nothing, STDOUT_FILENO);
      close(nothing);
    }
  }
  return can_print;
}

void write_stderr(std::string_view text) {
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

}  // namespace needlework::cli
