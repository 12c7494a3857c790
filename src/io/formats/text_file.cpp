#include "src/io/formats/text_file.h"

#include <cerrno>
#include <system_error>
#include <vector>

#include "needlework/error.h"
#include "src/machine/descriptors.h"

namespace needlework::io {
namespace {

std::FILE* open_to_write(const std::string& path) {
  const StandardDescriptors occupied;
  return std::fopen(path.c_str(), "wb");
}

}  // namespace

TextFile::TextFile(const std::string& path, bool force)
    : path_(path),
      atomic_(path, force),
      file_(open_to_write(atomic_.temporary()),
            [](std::FILE* file) { return file ? std::fclose(file) : 0; }) {
  if (!file_) fail(errno);
  compressor_ = make_compressor(compression_of_name(path));
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
  if (block_.size() == 0) return;
  if (compressor_) {
    compress(false);
  } else {
    write_to_file(block_.data(), block_.size());
  }
  block_.clear();
}

void TextFile::write_to_file(const char* bytes, std::size_t size) {
  errno = 0;
  if (std::fwrite(bytes, 1, size, file_.get()) != size) fail(errno != 0 ? errno : EIO);
}

// Compresses the block; `last`: and completes the stream.
void TextFile::compress(bool last) {
  std::vector<char> out(block_size);
  Buffers buffers{.in = block_.data(), .in_left = block_.size()};
  auto progress = CompressedStream::Progress::more;
  do {
    buffers.out = out.data();
    buffers.out_left = out.size();
    progress = compressor_->step(buffers, last);
    if (progress == CompressedStream::Progress::damaged) fail(EIO);
    write_to_file(out.data(), out.size() - buffers.out_left);
  } while (last ? progress != CompressedStream::Progress::end : buffers.in_left > 0);
}

void TextFile::publish() {
  write_block();
  if (compressor_) compress(true);
  errno = 0;
  if (std::fclose(file_.release()) != 0) fail(errno != 0 ? errno : EIO);
  atomic_.publish();
}

}  // namespace needlework::io
