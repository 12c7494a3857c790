// Arrays of vectors as callers lay them out.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "needlework.h"

namespace needlework::c {

/// Where the component `axis` of row n is.
template <class Vectors>
auto* place_of(const Vectors& vectors, std::size_t n, int axis) {
  const std::ptrdiff_t row = vectors.row ? vectors.row : 3;
  const std::ptrdiff_t column = vectors.column ? vectors.column : 1;
  return vectors.data + static_cast<std::ptrdiff_t>(n) * row + axis * column;
}

inline std::array<double, 3> vector_at(const needlework_const_vectors& vectors, std::size_t n) {
  return {*place_of(vectors, n, 0), *place_of(vectors, n, 1), *place_of(vectors, n, 2)};
}

/// All rows; zeros if the vectors are absent.
inline std::vector<std::array<double, 3>> rows_of(const needlework_const_vectors& vectors,
                                                  std::size_t count) {
  std::vector<std::array<double, 3>> rows(count);
  if (!vectors.data) return rows;
  for (std::size_t n = 0; n < count; ++n) rows[n] = vector_at(vectors, n);
  return rows;
}

/// Does nothing if the vectors are not wanted.
inline void copy_rows(const std::vector<std::array<double, 3>>& rows,
                      const needlework_vectors& into) {
  if (!into.data) return;
  for (std::size_t n = 0; n < rows.size(); ++n) {
    for (int axis = 0; axis < 3; ++axis) *place_of(into, n, axis) = rows[n][axis];
  }
}

}  // namespace needlework::c
