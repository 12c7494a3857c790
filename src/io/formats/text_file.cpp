#include "src/io/formats/text_file.h"

#include <bzlib.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

#include "needlework/error.h"
#include "src/machine/descriptors.h"

namespace needlework::io {
namespace {

std::FILE* open_to_write(const std::string& path) {
  const StandardDescriptors occupied;
  return std::fopen(path.c_str(), "wb");
}

}  // namespace

struct TextFile::Compressor {
  explicit Compressor(std::FILE* file) {
    int status = BZ_OK;
    constexpr int largest_blocks = 9;
    stream = BZ2_bzWriteOpen(&status, file, largest_blocks, 0, 0);
  }
  ~Compressor() { close(true); }

  int write(const char* data, std::size_t size) {
    int status = BZ_OK;
    if (!stream) return BZ_MEM_ERROR;
    BZ2_bzWrite(&status, stream, const_cast<char*>(data), static_cast<int>(size));
    return status;
  }
  int close(bool abandon) {
    int status = BZ_OK;
    if (stream) BZ2_bzWriteClose(&status, stream, abandon ? 1 : 0, nullptr, nullptr);
    stream = nullptr;
    return status;
  }

  BZFILE* stream = nullptr;
};

TextFile::TextFile(const std::string& path, bool force)
    : path_(path),
      atomic_(path, force),
      file_(open_to_write(atomic_.temporary()),
            [](std::FILE* file) { return file ? std::fclose(file) : 0; }) {
  if (!file_) fail(errno);
  if (path.ends_with(".bz2")) compressor_ = std::make_unique<Compressor>(file_.get());
}

TextFile::~TextFile() = default;

void TextFile::fail(int error) const {
  throw IoError(fmt::format("{}: {}", path_, std::generic_category().message(error)));
}

void TextFile::write(std::string_view bytes) {
  block_.append(bytes.data(), bytes.data() + bytes.size());
  if (block_.size() >= block_size) write_block();
}

void TextFile::write_block() {
  // The compressor takes sizes as int.
  constexpr std::size_t most = std::size_t{1} << 30;
  errno = 0;
  for (std::size_t from = 0; from < block_.size(); from += most) {
    const std::size_t size = std::min(most, block_.size() - from);
    const bool written = compressor_
                             ? compressor_->write(block_.data() + from, size) == BZ_OK
                             : std::fwrite(block_.data() + from, 1, size, file_.get()) == size;
    if (!written) fail(errno != 0 ? errno : EIO);
  }
  block_.clear();
}

void TextFile::publish() {
  write_block();
  errno = 0;
  if (compressor_ && compressor_->close(false) != BZ_OK) fail(errno != 0 ? errno : EIO);
  if (std::fclose(file_.release()) != 0) fail(errno != 0 ? errno : EIO);
  atomic_.publish();
}

}  // namespace needlework::io
