#include "src/io/formats/input_text.h"

#include <bzlib.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <memory>
#include <new>
#include <system_error>

#include "needlework/error.h"

namespace needlework::io {
namespace {

constexpr std::size_t block_size = std::size_t{1} << 20;

// Numbers and tags are compressed to a fifth or so. Far smaller files are made to exhaust the
// memory.
constexpr std::size_t largest_expansion = 100;
constexpr std::size_t always_allowed = std::size_t{1} << 26;

std::string read_bytes(const std::string& path, std::size_t most) {
  const auto fail = [&](int error) {
    throw IoError(
        fmt::format("{}: cannot be read: {}", path, std::generic_category().message(error)));
  };
  struct stat status;
  if (stat(path.c_str(), &status) != 0) fail(errno);
  if (S_ISDIR(status.st_mode)) fail(EISDIR);
  if (!S_ISREG(status.st_mode)) throw IoError(path + ": cannot be read: not a regular file");
  const auto size = static_cast<std::size_t>(status.st_size);
  if (size > most) {
    throw InputError(fmt::format("{}: {} bytes: expected at most {}", path, size, most));
  }
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(
      std::fopen(path.c_str(), "rb"), [](std::FILE* f) { return f ? std::fclose(f) : 0; });
  if (!file) fail(errno);
  std::string bytes(size, '\0');
  errno = 0;
  bytes.resize(std::fread(bytes.data(), 1, size, file.get()));
  if (std::ferror(file.get())) fail(errno);
  return bytes;
}

class Decompressor {
 public:
  explicit Decompressor(const std::string& bytes) {
    if (BZ2_bzDecompressInit(&stream_, 0, 0) != BZ_OK) throw std::bad_alloc();
    stream_.next_in = const_cast<char*>(bytes.data());
    left_ = bytes.size();
  }
  ~Decompressor() { BZ2_bzDecompressEnd(&stream_); }
  Decompressor(const Decompressor&) = delete;
  Decompressor& operator=(const Decompressor&) = delete;

  // Appends the next block. Returns BZ_OK, BZ_STREAM_END or an error.
  int append_to(std::string& text) {
    const auto given = static_cast<unsigned>(std::min(left_, block_size));
    const std::size_t before = text.size();
    text.resize(before + block_size);
    stream_.avail_in = given;
    stream_.next_out = text.data() + before;
    stream_.avail_out = static_cast<unsigned>(block_size);
    const int status = BZ2_bzDecompress(&stream_);
    left_ -= given - stream_.avail_in;
    text.resize(text.size() - stream_.avail_out);
    // No input is left, and still it asks for more.
    const bool stuck = left_ == 0 && text.size() == before;
    return status == BZ_OK && stuck ? BZ_UNEXPECTED_EOF : status;
  }
  std::size_t left() const { return left_; }
  // Goes on with the stream that follows in the same file.
  void restart() {
    char* const next = stream_.next_in;
    BZ2_bzDecompressEnd(&stream_);
    stream_ = {};
    if (BZ2_bzDecompressInit(&stream_, 0, 0) != BZ_OK) throw std::bad_alloc();
    stream_.next_in = next;
  }

 private:
  bz_stream stream_ = {};
  std::size_t left_ = 0;
};

std::string decompressed(const std::string& bytes, const std::string& path, std::size_t most) {
  const std::size_t limit =
      std::min(most, std::max(always_allowed, largest_expansion * bytes.size()));
  std::string text;
  Decompressor decompressor(bytes);
  for (;;) {
    const int status = decompressor.append_to(text);
    if (text.size() > limit) {
      throw InputError(
          fmt::format("{}: more than {} bytes when decompressed: expected less, from "
                      "{} compressed bytes",
                      path, limit, bytes.size()));
    }
    if (status == BZ_STREAM_END) {
      if (decompressor.left() == 0) return text;
      decompressor.restart();
    } else if (status != BZ_OK) {
      throw InputError(path + (status == BZ_UNEXPECTED_EOF
                                   ? ": cut short: expected a complete bzip2 file"
                                   : ": damaged: expected a bzip2 file"));
    }
  }
}

}  // namespace

std::string read_text_file(const std::string& path, std::size_t most) {
  std::string bytes = read_bytes(path, most);
  return bytes.starts_with("BZh") ? decompressed(bytes, path, most) : bytes;
}

}  // namespace needlework::io
