// Reads text files, as a whole or as a stream, with a limit of their size.
#pragma once

#include <cstddef>
#include <cstdio>
#include <memory>
#include <string>

#include "src/io/formats/compression.h"

namespace needlework::io {

/// Largest text that is read as a rule [bytes].
inline constexpr std::size_t max_text_bytes = std::size_t{1} << 32;

/// A file that is read from its beginning, and decompressed if its content, not its name, says that
/// it is compressed with bzip2 or gzip. All members throw IoError if it cannot be read, and
/// InputError if the text is larger than `most`, or if compressed data is damaged, cut short or
/// expands to over a hundred times its size (text of up to 64 MiB may be smaller still when
/// compressed).
class InputText {
 public:
  explicit InputText(const std::string& path, std::size_t most = max_text_bytes);
  ~InputText();

  /// Reads the next `size` bytes, at most 2^32 - 1, or fewer at the end of the text.
  std::size_t read(char* to, std::size_t size);
  /// Goes to this offset of the text, or to its end. Compressed text is decompressed again from the
  /// beginning.
  void seek(std::size_t offset);

 private:
  class Decompressor;

  std::size_t read_file(char* to, std::size_t size);
  void rewind();
  bool is_compressed() const { return compression_ != Compression::none; }

  std::string path_;
  std::size_t most_;
  std::size_t bytes_ = 0;   ///< of the file
  std::size_t offset_ = 0;  ///< in the text
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
  Compression compression_ = Compression::none;
  std::unique_ptr<Decompressor> decompressor_;  ///< null if it is not
};

/// The text of a whole file; see InputText.
std::string read_text_file(const std::string& path, std::size_t most = max_text_bytes);

}  // namespace needlework::io
