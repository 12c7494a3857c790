// The random numbers of one needle: a counter-based stream that depends only on the seed, the
// needle's id and what the numbers are for, with the same bits on every machine. It avoids the C
// library's log, sin and exp, which select variants with different rounding by CPU.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace needlework {

/// The natural logarithm of a positive normal number, within 2 ulp, computed with + - * / only.
double natural_log(double x);

/// The seed as two numbers that doubles hold exactly.
inline std::array<double, 2> halves(std::uint64_t seed) {
  return {static_cast<double>(seed & 0xffffffff), static_cast<double>(seed >> 32)};
}

/// What random numbers are for. Numbers for different purposes are independent.
enum class RandomFor : std::uint64_t {
  initial_state,
  thermal_wall,
  thermostat,
  kick,
  velocities_of_rods,
  boltzmann,
  size  ///< `count` is which of its sizes
};

/// A stream of deviates: Philox-4x64-10 (Salmon et al., SC 2011) with the seed as key and (block,
/// id, count, purpose) as counter. Copies continue independently.
class NeedleRandom {
 public:
  /// Those of the initial state of a needle.
  NeedleRandom(std::uint64_t seed, std::uint64_t id)
      : NeedleRandom(seed, id, RandomFor::initial_state, 0) {}
  /// Those of the needle's event number `count` of this kind.
  NeedleRandom(std::uint64_t seed, std::uint64_t id, RandomFor purpose, std::uint64_t count)
      : seed_(seed), id_(id), count_(count), purpose_(static_cast<std::uint64_t>(purpose)) {}

  /// 53 random bits, as a number below 2^53.
  std::uint64_t bits();

  /// Uniform on [0, 1), a multiple of 2^-53.
  double uniform() { return static_cast<double>(bits()) * 0x1p-53; }

  /// Uniform on the unit sphere, with length 1 within 2 ulp (Marsaglia, Ann. Math. Stat. 43, 645).
  std::array<double, 3> direction();

  /// Three independent standard normal deviates (Marsaglia's polar method).
  std::array<double, 3> normal();

  /// Exponentially distributed with mean 1, in [0, 37).
  double exponential() { return -natural_log(1 - uniform()); }

 private:
  /// A point in the open unit disc other than its centre, and its squared distance from the
  /// centre.
  struct DiscPoint {
    double x, y, squared;
  };
  DiscPoint disc_point();
  std::array<double, 2> normal_pair();

  std::uint64_t seed_;
  std::uint64_t id_;
  std::uint64_t count_, purpose_;
  std::uint64_t block_ = 0;
  std::array<std::uint64_t, 4> words_{};
  std::size_t used_ = 4;
};

}  // namespace needlework
