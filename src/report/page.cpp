#include "src/report/page.h"

// The file becomes part of the program as it is: compilers take seconds for a megabyte as an array.
asm(".section .rodata\n"
    ".global needlework_page_begin, needlework_page_end\n"
    "needlework_page_begin:\n"
    ".incbin \"" NEEDLEWORK_PAGE
    "\"\n"
    "needlework_page_end:\n"
    ".byte 0\n"
    ".text\n");

extern "C" const char needlework_page_begin[];
extern "C" const char needlework_page_end[];

namespace needlework::report {

std::string_view page_text() {
  return {needlework_page_begin,
          static_cast<std::size_t>(needlework_page_end - needlework_page_begin)};
}

}  // namespace needlework::report
