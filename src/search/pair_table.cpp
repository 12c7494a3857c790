#include "src/search/pair_table.h"

#include <algorithm>

#include "kernels/four.h"

namespace needlework {

using kernels::CellView;
using kernels::Motion;
using kernels::PairColumns;

void PairTable::grow(std::size_t count) {
  capacity_ = 2 * count + 1;
  // Kernels use up to one block more.
  const std::size_t size = capacity_ + kernels::block_size;
  storage_.assign(size * PairColumns::columns, 0.0f);
  for (int c = 0; c < PairColumns::columns; ++c) columns_.column[c] = storage_.data() + c * size;
}

// Four pairs at once: most of the work is to turn the rows of motions into columns.
void PairTable::fill(const PairColumns& pairs, const kernels::Seeker& seeker, const Motion* motions,
                     const CellView* cells, const kernels::Found& found, std::size_t begin,
                     std::size_t end) {
  using C = PairColumns;
  using kernels::four, kernels::Four;
  static_assert(offsetof(Motion, r) == 0 && offsetof(Motion, v) == 12 &&
                offsetof(Motion, u) == 24 && offsetof(Motion, p) == 36 &&
                offsetof(Motion, omega) == 48 && offsetof(Motion, time) == 52 &&
                offsetof(Motion, until) == 56 && offsetof(Motion, half) == 60 &&
                offsetof(CellView, offset) == 4);
  for (std::size_t k = begin; k < end; k += 4) {
    Four part[4][4], offset[4];  // of the motions; of the cells, after their block
    for (std::size_t i = 0; i < 4; ++i) {
      const std::size_t n = std::min(k + i, end - 1);
      const auto* row = reinterpret_cast<const char*>(&motions[found.needle[n]]);
      for (int quarter = 0; quarter < 4; ++quarter) {
        part[quarter][i] = kernels::load_four(row + 16 * quarter);
      }
      offset[i] = kernels::load_four(&cells[found.cell[n]]);
    }
    for (Four(&rows)[4] : part) kernels::transpose(rows);
    kernels::transpose(offset);
    const Four r[3] = {part[0][0], part[0][1], part[0][2]},
               v[3] = {part[0][3], part[1][0], part[1][1]};
    const Four age = four(seeker.now) - part[3][1];
    const auto put = [&](int column, const Four& a) {
      kernels::store_four(a, pairs.column[column] + k);
    };
    for (int axis = 0; axis < 3; ++axis) {
      put(C::r_x + axis,
          (four(seeker.motion.r[axis]) - offset[1 + axis] - r[axis]) - v[axis] * age);
      put(C::v_x + axis, four(seeker.motion.v[axis]) - v[axis]);
    }
    put(C::u_x, part[1][2]);
    put(C::u_y, part[1][3]);
    for (int n = 0; n < 4; ++n) put(C::u_z + n, part[2][n]);
    put(C::omega, part[3][0]);
    put(C::half, part[3][3]);
    put(C::age, age);
    const Four left = part[3][2] - four(seeker.now), zero = four(0);
    const Four until = (left > zero ? left : zero) + four(static_cast<float>(kernels::time_margin));
    put(C::until, until < four(seeker.ahead) ? until : four(seeker.ahead));
  }
}

}  // namespace needlework
