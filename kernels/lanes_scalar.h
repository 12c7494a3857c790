// One lane with the interface of lanes-inl.h: what makes the scalar twin of a kernel by lanes.
#pragma once

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace needlework::kernels::scalar {

struct Mask {
  bool m;
};

inline Mask operator&(Mask a, Mask b) { return {a.m && b.m}; }
inline Mask operator|(Mask a, Mask b) { return {a.m || b.m}; }
inline Mask operator!(Mask a) { return {!a.m}; }

struct Lanes {
  float v;

  Lanes() = default;
  Lanes(float a) : v(a) {}
};

inline constexpr std::size_t lanes_at_once = 1;
inline Lanes load_lanes(const float* p) { return *p; }
inline void store_lanes(Lanes a, float* p) { *p = a.v; }
inline Lanes counting() { return 0.0f; }

inline Lanes operator+(Lanes a, Lanes b) { return a.v + b.v; }
inline Lanes operator-(Lanes a, Lanes b) { return a.v - b.v; }
inline Lanes operator*(Lanes a, Lanes b) { return a.v * b.v; }
inline Lanes operator/(Lanes a, Lanes b) { return a.v / b.v; }
inline Lanes operator-(Lanes a) { return -a.v; }
inline Mask operator<(Lanes a, Lanes b) { return {a.v < b.v}; }
inline Mask operator>(Lanes a, Lanes b) { return {a.v > b.v}; }
inline Mask operator<=(Lanes a, Lanes b) { return {a.v <= b.v}; }
inline Mask operator>=(Lanes a, Lanes b) { return {a.v >= b.v}; }

inline Lanes minimum(Lanes a, Lanes b) { return a.v < b.v ? a : b; }
inline Lanes maximum(Lanes a, Lanes b) { return a.v > b.v ? a : b; }
inline Lanes absolute(Lanes a) { return std::abs(a.v); }
inline Lanes square_root(Lanes a) { return std::sqrt(a.v); }
inline Lanes select(Mask m, Lanes a, Lanes b) { return m.m ? a : b; }
inline Mask select(Mask m, Mask a, Mask b) { return m.m ? a : b; }
inline bool any(Mask m) { return m.m; }

struct Packing {
  std::size_t count;
};
inline Packing packing_of(Mask m) { return {m.m}; }
inline Lanes packed(Lanes a, Packing) { return a; }

inline Lanes load_numbers(const std::uint32_t* p) { return std::bit_cast<float>(*p); }
inline void store_numbers(Lanes a, std::uint32_t* p) { *p = std::bit_cast<std::uint32_t>(a.v); }
inline Lanes number(std::uint32_t a) { return std::bit_cast<float>(a); }
inline Mask same_numbers(Lanes a, Lanes b) {
  return {std::bit_cast<std::uint32_t>(a.v) == std::bit_cast<std::uint32_t>(b.v)};
}

inline void turn(Lanes shifted, Lanes& cosine, Lanes& sine) {
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
