// The random numbers of one needle: a counter-based stream that depends only on the seed and the
// needle's id, with the same bits on every machine. It avoids the C library's log, sin and exp,
// which select variants with different rounding by CPU.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace needlework {

/// The natural logarithm of a positive normal number, within 2 ulp, computed with + - * / only.
double natural_log(double x);

/// A stream of deviates: Philox-4x64-10 (Salmon et al., SC 2011) with the seed as key and (block,
/// id) as counter. Copies continue independently.
class NeedleRandom {
 public:
  NeedleRandom(std::uint64_t seed, std::uint64_t id) : seed_(seed), id_(id) {}

  /// Uniform on [0, 1), a multiple of 2^-53.
  double uniform();

  /// Uniform on the unit sphere, with length 1 within 2 ulp (Marsaglia, Ann. Math. Stat. 43, 645).
  std::array<double, 3> direction();

  /// Three independent standard normal deviates (Marsaglia's polar method).
  std::array<double, 3> normal();

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
  std::uint64_t block_ = 0;
  std::array<std::uint64_t, 4> words_{};
  std::size_t used_ = 4;
};

}  // namespace needlework
