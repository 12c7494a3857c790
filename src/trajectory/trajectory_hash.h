// A hash of a trajectory: the sum of a hash of every collision, which does not depend on the order
// in which threads report them.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <initializer_list>
#include <string>

#include "needlework/happening.h"

namespace needlework {

class TrajectoryHash {
 public:
  /// Adds what has happened; the kind of a collision of two needles does not enter.
  void add(const Happening& happening) { add(happening.event, happening.kind); }
  // Not inlined, because it would enlarge the event loops.
  [[gnu::noinline]] void add(const Collision& c, std::uint8_t kind = 0) {
    const auto bits = [](double x) { return std::bit_cast<std::uint64_t>(x); };
    const auto word = [](std::int32_t x) { return static_cast<std::uint64_t>(x); };
    Mixer low{0x243f6a8885a308d3}, high{0x13198a2e03707344};
    for (const std::uint64_t value :
         {static_cast<std::uint64_t>(c.epoch), bits(c.offset),
          std::uint64_t{c.first} << 32 | c.second, word(c.shift[0]), word(c.shift[1]),
          word(c.shift[2]), bits(c.impulse[0]), bits(c.impulse[1]), bits(c.impulse[2])}) {
      low.take(value);
      high.take(value);
    }
    if (kind != 0) {
      low.take(kind);
      high.take(kind);
    }
    low_ += low.state;
    high_ += high.state + (low_ < low.state);
  }

  void add(const TrajectoryHash& other) {
    low_ += other.low_;
    high_ += other.high_ + (low_ < other.low_);
  }

  std::string hex() const {
    std::string out;
    for (const std::uint64_t half : {high_, low_}) {
      for (int shift = 60; shift >= 0; shift -= 4) out += "0123456789abcdef"[half >> shift & 15];
    }
    return out;
  }

  /// Passes the state to an archive (src/archive/archive.h).
  template <class Archive>
  friend void transfer(Archive& archive, TrajectoryHash& hash) {
    archive(hash.low_, hash.high_);
  }

 private:
  // Multiply-xorshift rounds with the constants of splitmix64 (Steele, Lea, Flood 2014).
  struct Mixer {
    std::uint64_t state;
    void take(std::uint64_t value) {
      state = (state ^ value) + 0x9e3779b97f4a7c15;
      state = (state ^ (state >> 30)) * 0xbf58476d1ce4e5b9;
      state = (state ^ (state >> 27)) * 0x94d049bb133111eb;
      state ^= state >> 31;
    }
  };
  std::uint64_t low_ = 0, high_ = 0;
};

}  // namespace needlework
