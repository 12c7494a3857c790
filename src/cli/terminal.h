// The terminal that shows progress.
#pragma once

#include "src/picture/terminal_chart.h"

namespace needlework::cli {

/// Of the terminal on stderr; 80 by 24 where it is not known.
picture::TerminalSize terminal_size();

}  // namespace needlework::cli
