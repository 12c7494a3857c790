// Vectors of one float with the interface of simd-inl.h: they make the scalar twin of a SIMD
// kernel.
#pragma once

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "kernels/lane_shares.h"

namespace needlework::kernels::scalar {

struct Mask {
  bool m;
};

inline Mask operator&(Mask a, Mask b) { return {a.m && b.m}; }
inline Mask operator|(Mask a, Mask b) { return {a.m || b.m}; }
inline Mask operator!(Mask a) { return {!a.m}; }

struct Floats {
  float v;

  Floats() = default;
  Floats(float a) : v(a) {}
};

inline constexpr std::size_t floats_at_once = 1;
inline Floats load_floats(const float* p) { return *p; }
inline void store_floats(Floats a, float* p) { *p = a.v; }
inline Mask first_lanes(std::size_t n) { return {n > 0}; }

inline Floats operator+(Floats a, Floats b) { return a.v + b.v; }
inline Floats operator-(Floats a, Floats b) { return a.v - b.v; }
inline Floats operator*(Floats a, Floats b) { return a.v * b.v; }
inline Floats operator/(Floats a, Floats b) { return a.v / b.v; }
inline Floats multiply_add(Floats a, Floats b, Floats c) { return a.v * b.v + c.v; }
inline Floats multiply_subtract(Floats a, Floats b, Floats c) { return a.v * b.v - c.v; }
inline Floats subtract_product(Floats c, Floats a, Floats b) { return c.v - a.v * b.v; }
inline Floats operator-(Floats a) { return -a.v; }
inline Mask operator<(Floats a, Floats b) { return {a.v < b.v}; }
inline Mask operator>(Floats a, Floats b) { return {a.v > b.v}; }
inline Mask operator<=(Floats a, Floats b) { return {a.v <= b.v}; }
inline Mask operator>=(Floats a, Floats b) { return {a.v >= b.v}; }

inline Floats minimum(Floats a, Floats b) { return a.v < b.v ? a : b; }
inline Floats maximum(Floats a, Floats b) { return a.v > b.v ? a : b; }
inline Floats absolute(Floats a) { return std::abs(a.v); }
inline Floats square_root(Floats a) { return std::sqrt(a.v); }
// No rougher than other operations, so that margins for rough ones are 0 here.
inline constexpr float rough_error = 0;
inline Floats rough_quotient(Floats a, Floats b) { return a.v / b.v; }
inline Floats rough_root(Floats a) { return std::sqrt(a.v); }
inline Floats rough_inverse_root(Floats a) { return 1 / std::sqrt(a.v); }
inline Floats rough_square(Floats a) { return a.v * a.v; }
inline Floats select(Mask m, Floats a, Floats b) { return m.m ? a : b; }
inline bool any(Mask m) { return m.m; }
inline std::size_t count_of(Mask m) { return m.m; }

struct Packing {
  std::size_t count;
};
inline Packing packing_of(Mask m) { return {m.m}; }
inline Floats packed(Floats a, Packing) { return a; }

struct Filling {
  Mask filled;
};
inline Filling filling_of(Mask chosen, Mask offered) { return {chosen & offered}; }
inline Floats filled(Floats a, Filling filling, Floats b) { return select(filling.filled, a, b); }

inline Floats load_numbers(const std::uint32_t* p) { return std::bit_cast<float>(*p); }
inline void store_numbers(Floats a, std::uint32_t* p) { *p = std::bit_cast<std::uint32_t>(a.v); }
inline Floats number(std::uint32_t a) { return std::bit_cast<float>(a); }
inline Floats numbers_of_lanes() { return number(0); }
inline Floats permuted(Floats a, Floats) { return a; }
inline Mask same_numbers(Floats a, Floats b) {
  return {std::bit_cast<std::uint32_t>(a.v) == std::bit_cast<std::uint32_t>(b.v)};
}

inline Floats with_bits(Floats a, Floats numbers, Floats mask) {
  const auto bits = [](Floats x) { return std::bit_cast<std::uint32_t>(x.v); };
  return std::bit_cast<float>(bits(a) | (bits(numbers) & bits(mask)));
}
inline Floats signed_numbers(Floats numbers) {
  return static_cast<float>(std::bit_cast<std::int32_t>(numbers.v));
}

inline void turn(Floats shifted, Floats& cosine, Floats& sine) {
  const auto q = std::bit_cast<std::uint32_t>(shifted.v);
  const auto flipped = [](float a, bool flip) {
    return std::bit_cast<float>(std::bit_cast<std::uint32_t>(a) ^
                                (flip ? std::uint32_t{1} << 31 : 0));
  };
  const float c = q & 1 ? sine.v : cosine.v;
  const float s = q & 1 ? cosine.v : sine.v;
  cosine = flipped(c, (q + 1) & 2);
  sine = flipped(s, q & 2);
}

}  // namespace needlework::kernels::scalar
