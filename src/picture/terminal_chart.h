// Curves drawn with the characters of a terminal.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "src/picture/chart.h"

namespace needlework::picture {

struct TerminalSize {
  std::size_t columns = 80, rows = 24;
};

/// The title, axes and curves of a panel as lines of text in UTF-8, as many and as long as the size
/// says, which must be at least smallest_terminal_chart. Lines are of braille dots, eight to a
/// character, points are `o`, so that they are distinct without colours too. `colours` adds escape
/// sequences that colour them. Maps, arrows and error bars are not shown.
std::vector<std::string> terminal_lines(const Panel& panel, TerminalSize size, bool colours);

constexpr TerminalSize smallest_terminal_chart{24, 6};

}  // namespace needlework::picture
