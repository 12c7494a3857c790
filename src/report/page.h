// The page without its data, as the program carries it.
#pragma once

#include <string_view>

namespace needlework::report {

/// The text of page/page.html, which the sources in page/ are built to. It has one line
/// data_mark, in whose place the data go.
std::string_view page_text();

inline constexpr std::string_view data_mark = "<!-- data -->\n";

}  // namespace needlework::report
