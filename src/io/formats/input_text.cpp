#include "src/io/formats/input_text.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
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

// The text of a file that is compressed: one stream, or several one after the other.
class InputText::Decompressor {
 public:
  enum class Status { more, end, cut_short, damaged };

  explicit Decompressor(Compression compression)
      : compression_(compression), block_(block_size), stream_(make_decompressor(compression)) {}

  // Fills `to` from the bytes that more(to, size) reads, which returns 0 at the end of the file.
  // Sets `size` to what has come; end: of the last stream.
  template <class More>
  Status read(char* to, std::size_t& size, More&& more) {
    buffers_.out = to;
    buffers_.out_left = size;
    Status status = Status::more;
    while (status == Status::more && buffers_.out_left > 0) {
      if (buffers_.in_left == 0) {
        buffers_.in = block_.data();
        buffers_.in_left = more(block_.data(), block_.size());
      }
      status = step();
    }
    size -= buffers_.out_left;
    return status;
  }

 private:
  Status step() {
    const std::size_t wanted = buffers_.out_left;
    const bool starved = buffers_.in_left == 0;
    if (!stream_) {  // another stream may follow in the same file
      if (starved) return Status::end;
      stream_ = make_decompressor(compression_);
    }
    switch (stream_->step(buffers_, starved)) {
      case CompressedStream::Progress::end:
        stream_.reset();
        return Status::more;
      case CompressedStream::Progress::damaged:
        return Status::damaged;
      default:
        // No input is left, and still it asks for more.
        return starved && buffers_.out_left == wanted ? Status::cut_short : Status::more;
    }
  }

  Compression compression_;
  std::vector<char> block_;
  std::unique_ptr<CompressedStream> stream_;  // null between two of them
  Buffers buffers_;
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
  compression_ = compression_of_content(beginning);
  if (is_compressed()) most_ = std::min(most, std::max(always_allowed, largest_expansion * bytes_));
  rewind();
}

InputText::~InputText() = default;

void InputText::rewind() {
  if (std::fseek(file_.get(), 0, SEEK_SET) != 0) fail(path_, errno);
  if (is_compressed()) decompressor_ = std::make_unique<Decompressor>(compression_);
  offset_ = 0;
}

std::size_t InputText::read_file(char* to, std::size_t size) {
  errno = 0;
  const std::size_t got = std::fread(to, 1, size, file_.get());
  if (std::ferror(file_.get())) fail(path_, errno);
  return got;
}

std::size_t InputText::read(char* to, std::size_t size) {
  if (!is_compressed()) {
    // What is added to the file meanwhile does not count.
    size = read_file(to, std::min(size, bytes_ - offset_));
    offset_ += size;
    return size;
  }
  const Decompressor::Status status = decompressor_->read(
      to, size, [this](char* block, std::size_t most) { return read_file(block, most); });
  offset_ += size;
  if (offset_ > most_) {
    throw InputError(
        fmt::format("{}: more than {} bytes when decompressed: expected less, from {} compressed "
                    "bytes",
                    path_, most_, bytes_));
  }
  if (status == Decompressor::Status::cut_short) {
    throw InputError(
        fmt::format("{}: cut short: expected a complete {} file", path_, name_of(compression_)));
  }
  if (status == Decompressor::Status::damaged) {
    throw InputError(fmt::format("{}: damaged: expected a {} file", path_, name_of(compression_)));
  }
  return size;
}

void InputText::seek(std::size_t offset) {
  rewind();
  if (!is_compressed()) {
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
