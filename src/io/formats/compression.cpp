#include "src/io/formats/compression.h"

#include <bzlib.h>
#include <zlib.h>

#include <algorithm>
#include <new>

namespace needlework::io {
namespace {

using Progress = CompressedStream::Progress;

constexpr int largest_bzip2_blocks = 9;
constexpr int default_memory_of_zlib = 8;
// zlib reads and writes the head and the end of gzip files where 16 is added.
constexpr int gzip_window = MAX_WBITS + 16;

// Lends the buffers to a stream of bzip2 or zlib, whose members have the same names and other
// types, for one call. Returns the status of the call.
template <class Stream, class Call>
int lend(Stream& stream, Buffers& buffers, Call call) {
  constexpr std::size_t most = std::size_t{1} << 30;  // their sizes have 32 bits
  const auto in = static_cast<unsigned>(std::min(buffers.in_left, most));
  const auto out = static_cast<unsigned>(std::min(buffers.out_left, most));
  stream.next_in = reinterpret_cast<decltype(stream.next_in)>(const_cast<char*>(buffers.in));
  stream.next_out = reinterpret_cast<decltype(stream.next_out)>(buffers.out);
  stream.avail_in = in;
  stream.avail_out = out;
  const int status = call();
  buffers.in += in - stream.avail_in;
  buffers.in_left -= in - stream.avail_in;
  buffers.out += out - stream.avail_out;
  buffers.out_left -= out - stream.avail_out;
  return status;
}

class Bzip2Decompressor : public CompressedStream {
 public:
  Bzip2Decompressor() {
    if (BZ2_bzDecompressInit(&stream_, 0, 0) != BZ_OK) throw std::bad_alloc();
  }
  ~Bzip2Decompressor() override { BZ2_bzDecompressEnd(&stream_); }
  Progress step(Buffers& buffers, bool) override {
    const int status = lend(stream_, buffers, [&] { return BZ2_bzDecompress(&stream_); });
    if (status == BZ_MEM_ERROR) throw std::bad_alloc();
    return status == BZ_STREAM_END ? Progress::end
           : status == BZ_OK       ? Progress::more
                                   : Progress::damaged;
  }

 private:
  bz_stream stream_ = {};
};

class Bzip2Compressor : public CompressedStream {
 public:
  Bzip2Compressor() {
    if (BZ2_bzCompressInit(&stream_, largest_bzip2_blocks, 0, 0) != BZ_OK) throw std::bad_alloc();
  }
  ~Bzip2Compressor() override { BZ2_bzCompressEnd(&stream_); }
  Progress step(Buffers& buffers, bool last) override {
    const int status =
        lend(stream_, buffers, [&] { return BZ2_bzCompress(&stream_, last ? BZ_FINISH : BZ_RUN); });
    if (status == BZ_STREAM_END) return Progress::end;
    return status < 0 ? Progress::damaged : Progress::more;
  }

 private:
  bz_stream stream_ = {};
};

Progress progress_of_zlib(int status) {
  if (status == Z_MEM_ERROR) throw std::bad_alloc();
  if (status == Z_STREAM_END) return Progress::end;
  // Z_BUF_ERROR: it needs more input, or more room for its output.
  return status == Z_OK || status == Z_BUF_ERROR ? Progress::more : Progress::damaged;
}

class GzipDecompressor : public CompressedStream {
 public:
  GzipDecompressor() {
    if (inflateInit2(&stream_, gzip_window) != Z_OK) throw std::bad_alloc();
  }
  ~GzipDecompressor() override { inflateEnd(&stream_); }
  Progress step(Buffers& buffers, bool) override {
    return progress_of_zlib(lend(stream_, buffers, [&] { return inflate(&stream_, Z_NO_FLUSH); }));
  }

 private:
  z_stream stream_ = {};
};

class GzipCompressor : public CompressedStream {
 public:
  GzipCompressor() {
    if (deflateInit2(&stream_, Z_DEFAULT_COMPRESSION, Z_DEFLATED, gzip_window,
                     default_memory_of_zlib, Z_DEFAULT_STRATEGY) != Z_OK) {
      throw std::bad_alloc();
    }
  }
  ~GzipCompressor() override { deflateEnd(&stream_); }
  Progress step(Buffers& buffers, bool last) override {
    return progress_of_zlib(
        lend(stream_, buffers, [&] { return deflate(&stream_, last ? Z_FINISH : Z_NO_FLUSH); }));
  }

 private:
  z_stream stream_ = {};
};

}  // namespace

Compression compression_of_content(std::string_view beginning) {
  if (beginning.starts_with("BZh")) return Compression::bzip2;
  if (beginning.starts_with("\x1f\x8b")) return Compression::gzip;
  return Compression::none;
}

Compression compression_of_name(std::string_view path) {
  if (path.ends_with(".bz2")) return Compression::bzip2;
  if (path.ends_with(".gz")) return Compression::gzip;
  return Compression::none;
}

std::string_view without_compression(std::string_view path) {
  if (compression_of_name(path) == Compression::none) return path;
  return path.substr(0, path.rfind('.'));
}

std::string_view name_of(Compression compression) {
  return compression == Compression::gzip ? "gzip" : "bzip2";
}

std::unique_ptr<CompressedStream> make_decompressor(Compression compression) {
  if (compression == Compression::bzip2) return std::make_unique<Bzip2Decompressor>();
  if (compression == Compression::gzip) return std::make_unique<GzipDecompressor>();
  return nullptr;
}

std::unique_ptr<CompressedStream> make_compressor(Compression compression) {
  if (compression == Compression::bzip2) return std::make_unique<Bzip2Compressor>();
  if (compression == Compression::gzip) return std::make_unique<GzipCompressor>();
  return nullptr;
}

}  // namespace needlework::io
