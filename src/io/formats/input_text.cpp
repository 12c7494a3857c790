#include "src/io/formats/input_text.h"

#include <bzlib.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <new>
#include <system_error>
#include <vector>

#include "needlework/error.h"
#include "src/machine/descriptors.h"

namespace needlework::io {
namespace {

constexpr std::size_t block_size = std::size_t{1} << 20;

// Numbers and tags are compressed to a fifth or so. Far smaller files are made to exhaust the
// memory.
constexpr std::size_t largest_expansion = 100;
constexpr std::size_t always_allowed = std::size_t{1} << 26;

[[noreturn]] void fail(const std::string& path, int error) {
  throw IoError(
      fmt::format("{}: cannot be read: {}", path, std::generic_category().message(error)));
}

std::size_t size_of(const std::string& path) {
  struct stat status;
  if (stat(path.c_str(), &status) != 0) fail(path, errno);
  if (S_ISDIR(status.st_mode)) fail(path, EISDIR);
  if (!S_ISREG(status.st_mode)) throw IoError(path + ": cannot be read: not a regular file");
  return static_cast<std::size_t>(status.st_size);
}

std::FILE* open_to_read(const std::string& path) {
  const StandardDescriptors occupied;
  return std::fopen(path.c_str(), "rb");
}

}  // namespace

class InputText::Decompressor {
 public:
  Decompressor() : block_(block_size) { begin(); }
  ~Decompressor() { BZ2_bzDecompressEnd(&stream_); }
  Decompressor(const Decompressor&) = delete;
  Decompressor& operator=(const Decompressor&) = delete;

  // Fills `to` from the bytes that more(to, size) reads, which returns 0 at the end of the file.
  // Sets `size` to what has come, and returns BZ_OK, BZ_STREAM_END (of the last stream) or an
  // error.
  template <class More>
  int read(char* to, std::size_t& size, More&& more) {
    stream_.next_out = to;
    stream_.avail_out = static_cast<unsigned>(size);
    int status = BZ_OK;
    while (status == BZ_OK && stream_.avail_out > 0) {
      if (stream_.avail_in == 0) fill(more);
      if (ended_) {  // another stream may follow in the same file
        if (stream_.avail_in == 0) {
          status = BZ_STREAM_END;
          break;
        }
        restart();
      }
      const unsigned wanted = stream_.avail_out;
      const bool starved = stream_.avail_in == 0;
      status = BZ2_bzDecompress(&stream_);
      ended_ = status == BZ_STREAM_END;
      if (ended_) status = BZ_OK;
      // No input is left, and still it asks for more.
      else if (status == BZ_OK && starved && stream_.avail_out == wanted)
        status = BZ_UNEXPECTED_EOF;
    }
    size -= stream_.avail_out;
    return status;
  }

 private:
  void begin() {
    if (BZ2_bzDecompressInit(&stream_, 0, 0) != BZ_OK) throw std::bad_alloc();
  }
  template <class More>
  void fill(More&& more) {
    stream_.next_in = block_.data();
    stream_.avail_in = static_cast<unsigned>(more(block_.data(), block_.size()));
  }
  void restart() {
    char* const next = stream_.next_in;
    char* const out = stream_.next_out;
    const unsigned in_left = stream_.avail_in, out_left = stream_.avail_out;
    BZ2_bzDecompressEnd(&stream_);
    stream_ = {};
    begin();
    stream_.next_in = next;
    stream_.avail_in = in_left;
    stream_.next_out = out;
    stream_.avail_out = out_left;
    ended_ = false;
  }

  std::vector<char> block_;
  bz_stream stream_ = {};
  bool ended_ = false;
};

InputText::InputText(const std::string& path, std::size_t most)
    : path_(path),
      most_(most),
      bytes_(size_of(path)),
      file_(open_to_read(path), [](std::FILE* f) { return f ? std::fclose(f) : 0; }) {
  if (bytes_ > most) {
    throw InputError(fmt::format("{}: {} bytes: expected at most {}", path, bytes_, most));
  }
  if (!file_) fail(path, errno);
  std::string beginning(3, '\0');
  beginning.resize(read_file(beginning.data(), beginning.size()));
  compressed_ = beginning == "BZh";
  if (compressed_) most_ = std::min(most, std::max(always_allowed, largest_expansion * bytes_));
  rewind();
}

InputText::~InputText() = default;

void InputText::rewind() {
  if (std::fseek(file_.get(), 0, SEEK_SET) != 0) fail(path_, errno);
  if (compressed_) decompressor_ = std::make_unique<Decompressor>();
  offset_ = 0;
}

std::size_t InputText::read_file(char* to, std::size_t size) {
  errno = 0;
  const std::size_t got = std::fread(to, 1, size, file_.get());
  if (std::ferror(file_.get())) fail(path_, errno);
  return got;
}

std::size_t InputText::read(char* to, std::size_t size) {
  if (!compressed_) {
    // What is added to the file meanwhile does not count.
    size = read_file(to, std::min(size, bytes_ - offset_));
    offset_ += size;
    return size;
  }
  const int status = decompressor_->read(
      to, size, [this](char* block, std::size_t most) { return read_file(block, most); });
  offset_ += size;
  if (offset_ > most_) {
    throw InputError(
        fmt::format("{}: more than {} bytes when decompressed: expected less, from {} compressed "
                    "bytes",
                    path_, most_, bytes_));
  }
  if (status != BZ_OK && status != BZ_STREAM_END) {
    throw InputError(path_ + (status == BZ_UNEXPECTED_EOF
                                  ? ": cut short: expected a complete bzip2 file"
                                  : ": damaged: expected a bzip2 file"));
  }
  return size;
}

void InputText::seek(std::size_t offset) {
  rewind();
  if (!compressed_) {
    offset_ = std::min(offset, bytes_);
    if (fseeko(file_.get(), static_cast<off_t>(offset_), SEEK_SET) != 0) fail(path_, errno);
    return;
  }
  std::vector<char> passed(block_size);
  while (offset_ < offset) {
    if (read(passed.data(), std::min(passed.size(), offset - offset_)) == 0) return;
  }
}

std::string read_text_file(const std::string& path, std::size_t most) {
  InputText input(path, most);
  std::string text;
  text.reserve(size_of(path) + block_size);  // more only if it is compressed
  for (std::size_t got = block_size; got == block_size;) {
    const std::size_t before = text.size();
    text.resize(before + block_size);
    got = input.read(text.data() + before, block_size);
    text.resize(before + got);
  }
  return text;
}

}  // namespace needlework::io
