// Text files that are written piece by piece and appear when they are complete.
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <iterator>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "src/io/atomic_file.h"
#include "src/io/formats/compression.h"

namespace needlework::io {

/// A file under a temporary name, which is written in large blocks, compressed if its name
/// ends in .bz2 or .gz. All members throw IoError, "PATH: reason".
class TextFile {
 public:
  /// See AtomicFile for `force`.
  TextFile(const std::string& path, bool force);
  ~TextFile();

  /// Appends formatted text. A number is written with the fewest digits from which a reader obtains
  /// the same number.
  template <class... Arguments>
  void print(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
    fmt::format_to(std::back_inserter(block_), format, std::forward<Arguments>(arguments)...);
    if (block_.size() >= block_size) write_block();
  }
  /// Appends bytes.
  void write(std::string_view bytes);

  /// Writes what is left, and renames the file to its final name.
  void publish();

 private:
  static constexpr std::size_t block_size = std::size_t{1} << 20;

  void write_block();
  void write_to_file(const char* bytes, std::size_t size);
  void compress(bool last);
  [[noreturn]] void fail(int error) const;

  std::string path_;
  AtomicFile atomic_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
  std::unique_ptr<CompressedStream> compressor_;  ///< null if it is not
  fmt::memory_buffer block_;
};

}  // namespace needlework::io
