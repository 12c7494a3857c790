// Reads whole text files into memory, with a limit of their size.
#pragma once

#include <cstddef>
#include <string>

namespace needlework::io {

/// Largest text that is read as a rule [bytes].
inline constexpr std::size_t max_text_bytes = std::size_t{1} << 32;

/// Reads a file, and decompresses it if its content, not its name, says that it is compressed with
/// bzip2. Throws IoError if it cannot be read. Throws InputError if the text is larger than `most`,
/// or if compressed data is damaged, cut short or expands to over a hundred times its size (text of
/// up to 64 MiB may be smaller still when compressed).
std::string read_text_file(const std::string& path, std::size_t most = max_text_bytes);

}  // namespace needlework::io
