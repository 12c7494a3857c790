// The pressure tensor, as sums over a run: what needles carry in flight, and what collisions hand
// over between centres.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "kernels/vec3.h"
#include "needlework/totals.h"
#include "src/trajectory/exact_total.h"

namespace needlework {

/// The integral of c c over a flight of duration `t`, of a velocity that is c at its start and
/// changes by `gain` per time.
inline Tensor carried(const Vec3d& c, const Vec3d& gain, double t) {
  const double v[] = {c.x, c.y, c.z}, a[] = {gain.x, gain.y, gain.z};
  Tensor out;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      out[i][j] = t * (v[i] * v[j] +
                       t * (0.5 * (v[i] * a[j] + a[i] * v[j]) + t * (a[i] * a[j] * (1.0 / 3))));
    }
  }
  return out;
}

/// Sums of a thread, which do not depend on their order: divided by volume and time they are the
/// pressure tensor. [energy time], [energy time]
struct StressTally {
  std::array<std::array<SignedExactTotal, 3>, 3> kinetic;      ///< sum of m c c t over flights
  std::array<std::array<SignedExactTotal, 3>, 3> collisional;  ///< of r12 dp over collisions

  void add_flight(double mass, const Tensor& cc) {
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = i; j < 3; ++j) kinetic[i][j].add(mass * cc[i][j]);
    }
  }
  /// r12 is from the centre of the second needle to that of the first, dp the impulse on the first.
  void add_collision(const Vec3d& r12, const Vec3d& dp) {
    const double r[] = {r12.x, r12.y, r12.z}, p[] = {dp.x, dp.y, dp.z};
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) collisional[i][j].add(r[i] * p[j]);
    }
  }
  void take(StressTally& other) {
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) {
        kinetic[i][j].take(other.kinetic[i][j]);
        collisional[i][j].take(other.collisional[i][j]);
      }
    }
  }

  template <class Archive>
  friend void transfer(Archive& archive, StressTally& tally) {
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) {
        if (j >= i) archive(tally.kinetic[i][j]);
        archive(tally.collisional[i][j]);
      }
    }
  }
};

/// Sums at equal distances in windows of a run, from which standard errors follow: 32 to 64
/// batches, neighbours of which are joined as there come more.
class StressBatches {
 public:
  static constexpr std::size_t most = 64, fewest = 8;

  struct Boundary {
    double time = 0;
    StressSums sums;
  };
  /// At the end of each window; sums() is called for those that are the end of a batch.
  template <class Sums>
  void pass_window(double time, const Sums& sums) {
    if (++windows_ % every_ != 0) return;
    boundaries_.push_back({time, sums()});
    if (boundaries_.size() < most) return;
    for (std::size_t n = 1; n < most; n += 2) boundaries_[n / 2] = boundaries_[n];
    boundaries_.resize(most / 2);
    every_ *= 2;
  }
  /// The standard error of the mean of quantity(batch), batch a mean by between(from, to, time).
  template <class Between, class Quantity>
  double error(const Between& between, const Quantity& quantity) const {
    if (boundaries_.size() < fewest) return StressTotals::none;
    double sum = 0, squares = 0;
    Boundary last;
    for (const Boundary& next : boundaries_) {
      const double value = quantity(between(last.sums, next.sums, next.time - last.time));
      sum += value;
      squares += value * value;
      last = next;
    }
    const auto n = static_cast<double>(boundaries_.size());
    return std::sqrt(std::max(0.0, squares / n - (sum / n) * (sum / n)) / (n - 1));
  }

  template <class A>
  void transfer(A& archive) {
    archive(windows_, every_);
    std::vector<double> numbers;
    for (const Boundary& each : boundaries_) put(each, numbers);
    archive(numbers);
    if (!archive.reads()) return;
    archive.require(every_ > 0 && numbers.size() % size == 0 && numbers.size() < most * size);
    boundaries_.clear();
    for (std::size_t n = 0; n < numbers.size(); n += size) boundaries_.push_back(get(&numbers[n]));
  }

 private:
  static constexpr std::size_t size = 19;  // numbers of a boundary
  static void put(const Boundary& from, std::vector<double>& to) {
    to.push_back(from.time);
    for (const Tensor* tensor : {&from.sums.kinetic, &from.sums.collisional})
      for (const auto& row : *tensor) to.insert(to.end(), row.begin(), row.end());
  }
  static Boundary get(const double* from) {
    Boundary out;
    out.time = *from++;
    for (Tensor* tensor : {&out.sums.kinetic, &out.sums.collisional})
      for (auto& row : *tensor)
        for (double& number : row) number = *from++;
    return out;
  }

  std::uint64_t windows_ = 0, every_ = 1;
  std::vector<Boundary> boundaries_;
};

}  // namespace needlework
