#include "src/archive/archive.h"

#include <bit>
#include <cstring>

#include "needlework/error.h"

namespace needlework {

void Archive::throw_damaged() {
  throw InputError("the saved state is damaged: expected what this version of the program saves");
}

void Archive::pass_bytes(void* values, std::size_t size) {
  static_assert(std::endian::native == std::endian::little, "bytes are in this order");
  if (size == 0) return;
  if (out_) {
    out_->append(static_cast<const char*>(values), size);
    return;
  }
  if (in_.size() < size) throw_damaged();
  std::memcpy(values, in_.data(), size);
  in_.remove_prefix(size);
}

}  // namespace needlework
