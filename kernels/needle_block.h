// Needles of a cell as the SIMD filters read them: in few cache lines, since each search reads all
// cells around, and threads on different cores read what the others have written.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace needlework::kernels {

inline constexpr std::size_t block_size = 16;  ///< needles in a block: one vector of AVX-512

/// How a word of 32 bits holds one coordinate of a centre, and one of a velocity or a director. The
/// lowest 13 bits count steps of the coordinate from `low`. All 32 bits, these included, are the
/// velocity, read as a float, or the director, read as a number of 2^-31: the nearest that ends in
/// the bits of the coordinate. So velocities are off by up to 2^-11 of themselves, directors by
/// 2^-19, next to +-1 by 2^-18.
struct WordFormat {
  static constexpr int place_bits = 13;
  static constexpr std::uint32_t places = std::uint32_t{1} << place_bits;

  float low = 0;              ///< the least coordinate, a multiple of the step [unit of length]
  float base = 0x1p23f;       ///< 2^23 steps: floats from here on are a step apart [unit of length]
  double steps_per_unit = 1;  ///< [1 / unit of length]

  /// For coordinates from `from` to `to`, and beyond by a tenth of their distance. [unit of length]
  static WordFormat holding(double from, double to) {
    int exponent;
    std::frexp((to - from) * 1.25, &exponent);
    const double step = std::ldexp(1, exponent - place_bits);
    const double spare = 0.5 * (places * step - (to - from));
    return {static_cast<float>(std::floor((from - spare) / step) * step),
            static_cast<float>(std::ldexp(step, 23)), 1 / step};
  }

  double step() const { return 0x1p-23 * base; }
  bool holds(double coordinate) const {
    const double steps = (coordinate - low) * steps_per_unit + 0.5;
    return steps >= 0 && steps < places;
  }

  // What words do not hold becomes what they hold nearest to it.

  std::uint32_t with_velocity(double coordinate, double velocity) const {
    // Squares of smaller ones would be subnormal, with which processors are slow.
    const auto least = std::bit_cast<std::uint32_t>(0x1p-50f);
    const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(velocity));
    const std::uint32_t sign = bits & 0x80000000;
    return sign | static_cast<std::uint32_t>(
                      nearest(std::max(bits & 0x7fffffff, least), place_of(coordinate)));
  }
  std::uint32_t with_director(double coordinate, double director) const {
    // What is nearest must not be too large for 32 bits.
    constexpr double most = 0x1p31 - 0.5 * places;
    const auto number = static_cast<std::int64_t>(std::clamp(director * 0x1p31, -most, most - 1));
    return static_cast<std::uint32_t>(nearest(number, place_of(coordinate)));
  }

  double coordinate(std::uint32_t word) const { return low + (word % places) * step(); }
  static float velocity(std::uint32_t word) { return std::bit_cast<float>(word); }
  static float director(std::uint32_t word) {
    return static_cast<float>(static_cast<std::int32_t>(word)) * 0x1p-31f;
  }

 private:
  std::uint32_t place_of(double coordinate) const {
    const double steps = (coordinate - low) * steps_per_unit + 0.5;
    return static_cast<std::uint32_t>(std::clamp<double>(steps, 0, places - 1));
  }
  // The integer next to `number` that ends in the bits of `place`.
  static std::int64_t nearest(std::int64_t number, std::uint32_t place) {
    return ((number - place + places / 2) & -std::int64_t{places}) + place;
  }
};

/// Up to 16 needles of one cell, in the first lanes of columns, with centres relative to the corner
/// of the cell. For capsules the words hold centre and director of the capsule; for cells
/// they hold centre and velocity of the needle at `time`. Cells with more needles chain blocks, of
/// which all but the last are full.
struct alignas(64) NeedleBlock {
  static constexpr std::uint32_t none = 0xffffffff;  ///< no needle, or no block

  std::uint32_t word[3][block_size];  ///< by axis, see WordFormat
  std::uint32_t needle[block_size];   ///< none in free lanes, whose columns may hold anything
  float time[block_size];             ///< of the centre; not used for capsules

  NeedleBlock() : word{}, time{} { std::fill_n(needle, block_size, none); }
  std::uint32_t size() const {
    std::uint32_t out = 0;
    for (const std::uint32_t i : needle) out += i != none;
    return out;
  }
  bool is_full() const { return needle[block_size - 1] != none; }
};

/// How far each needle of a block reaches, where they differ.
struct alignas(64) BlockReaches {
  float reach[block_size] = {};  ///< [unit of length]
};

}  // namespace needlework::kernels
