#include "src/search/pair_table.h"

namespace needlework {

using kernels::PairColumns;

void PairTable::grow(std::size_t count) {
  capacity_ = 2 * count + 1;
  // Kernels use up to one block more.
  const std::size_t size = capacity_ + kernels::block_size;
  storage_.assign(size * PairColumns::columns, 0.0f);
  for (int c = 0; c < PairColumns::columns; ++c) columns_.column[c] = storage_.data() + c * size;
}

}  // namespace needlework
