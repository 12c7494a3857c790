// Compressed data, as streams: bzip2 and gzip.
#pragma once

#include <cstddef>
#include <memory>
#include <string_view>

namespace needlework::io {

enum class Compression { none, bzip2, gzip };

/// What a file with this beginning is compressed with.
Compression compression_of_content(std::string_view beginning);
/// What the ending of a file's name asks for: .bz2 or .gz.
Compression compression_of_name(std::string_view path);
/// The name without the ending that asks for compression.
std::string_view without_compression(std::string_view path);
/// "bzip2" or "gzip".
std::string_view name_of(Compression compression);

/// Bytes that a stream takes and gives. A step moves the pointers forward.
struct Buffers {
  const char* in = nullptr;
  std::size_t in_left = 0;
  char* out = nullptr;
  std::size_t out_left = 0;
};

/// Compresses or decompresses one stream of data. Throws std::bad_alloc where memory is short.
class CompressedStream {
 public:
  enum class Progress { more, end, damaged };

  virtual ~CompressedStream() = default;
  /// Takes what it can of the input and gives what it can to the output. `last`: no more input
  /// follows, which a compressor must know. end: the stream is complete.
  virtual Progress step(Buffers& buffers, bool last) = 0;
};

/// nullptr for Compression::none.
std::unique_ptr<CompressedStream> make_decompressor(Compression compression);
std::unique_ptr<CompressedStream> make_compressor(Compression compression);

}  // namespace needlework::io
