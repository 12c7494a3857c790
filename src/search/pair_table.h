// The pairs that a search follows, in the columns of the SIMD kernels.
#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <vector>

#include "kernels/four.h"
#include "kernels/near_needles.h"

namespace needlework {

/// Corners of four cells less that of the seeker's, by axis. [unit of length]
struct FourOffsets {
  kernels::Four axis[3];
};

/// For needles k to k + 3 of those found, of which any after end - 1 do not count.
template <class S>
concept GivesOffsets = requires(const S& offsets, std::size_t k, std::size_t end) {
  { offsets(k, end) } -> std::same_as<FourOffsets>;
};

/// Columns for pairs, used again by each search of a thread.
class PairTable {
 public:
  /// Columns for so many pairs. They last until the next call.
  const kernels::PairColumns& columns_for(std::size_t count) {
    if (count >= capacity_) grow(count);
    return columns_;
  }
  /// Fills in the pairs of the seeker with the needles from number `begin` on, up to `end`, that it
  /// has found, all columns but `from` and `distance`; of spheres, which do not turn, only those
  /// that bracket_spheres() reads. May write to the columns of up to three pairs after these.
  template <bool turn, GivesOffsets Offsets>
  static void fill(const kernels::PairColumns& pairs, const kernels::Seeker& seeker,
                   const kernels::Motion* motions, const Offsets& offsets,
                   const kernels::Found& found, std::size_t begin, std::size_t end);

 private:
  void grow(std::size_t count);

  std::vector<float> storage_;
  kernels::PairColumns columns_{};
  std::size_t capacity_ = 0;  ///< of pairs
};

// Four pairs at once: most of the work is to turn the rows of motions into columns.
template <bool turn, GivesOffsets Offsets>
void PairTable::fill(const kernels::PairColumns& pairs, const kernels::Seeker& seeker,
                     const kernels::Motion* motions, const Offsets& offsets,
                     const kernels::Found& found, std::size_t begin, std::size_t end) {
  using C = kernels::PairColumns;
  using kernels::four, kernels::Four, kernels::Motion;
  static_assert(offsetof(Motion, r) == 0 && offsetof(Motion, v) == 12 &&
                offsetof(Motion, u) == 24 && offsetof(Motion, p) == 36 &&
                offsetof(Motion, omega) == 48 && offsetof(Motion, time) == 52 &&
                offsetof(Motion, until) == 56 && offsetof(Motion, half) == 60);
  for (std::size_t k = begin; k < end; k += 4) {
    Four part[4][4];
    for (std::size_t i = 0; i < 4; ++i) {
      const std::size_t n = std::min(k + i, end - 1);
      const auto* row = reinterpret_cast<const char*>(&motions[found.needle[n]]);
      for (int quarter = 0; quarter < 4; ++quarter) {
        if (turn || quarter != 2) part[quarter][i] = kernels::load_four(row + 16 * quarter);
      }
    }
    for (int quarter = 0; quarter < 4; ++quarter) {
      if (turn || quarter != 2) kernels::transpose(part[quarter]);
    }
    const FourOffsets offset = offsets(k, end);
    const Four r[3] = {part[0][0], part[0][1], part[0][2]},
               v[3] = {part[0][3], part[1][0], part[1][1]};
    const Four age = four(seeker.now) - part[3][1];
    const auto put = [&](int column, const Four& a) {
      kernels::store_four(a, pairs.column[column] + k);
    };
    for (int axis = 0; axis < 3; ++axis) {
      put(C::r_x + axis,
          (four(seeker.motion.r[axis]) - offset.axis[axis] - r[axis]) - v[axis] * age);
      put(C::v_x + axis, four(seeker.motion.v[axis]) - v[axis]);
    }
    if constexpr (turn) {
      put(C::u_x, part[1][2]);
      put(C::u_y, part[1][3]);
      for (int n = 0; n < 4; ++n) put(C::u_z + n, part[2][n]);
      put(C::omega, part[3][0]);
      put(C::half, part[3][3]);
      put(C::age, age);
    }
    const Four left = part[3][2] - four(seeker.now), zero = four(0);
    const Four until = (left > zero ? left : zero) + four(static_cast<float>(kernels::time_margin));
    put(C::until, until < four(seeker.ahead) ? until : four(seeker.ahead));
  }
}

}  // namespace needlework
