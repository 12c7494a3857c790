#include "src/cli/terminal.h"

#include <sys/ioctl.h>
#include <unistd.h>

namespace needlework::cli {

picture::TerminalSize terminal_size() {
  winsize size{};
  if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col <= 1) return {};
  return {size.ws_col, size.ws_row > 1 ? size.ws_row : picture::TerminalSize{}.rows};
}

}  // namespace needlework::cli
