#include "src/report/local_density.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace needlework::report {
namespace {

using Vector = std::array<double, 3>;

// Needles by cells of a grid over the box whose sides are at least `radius`.
class Cells {
 public:
  Cells(const State& state, double radius) : state_(state) {
    const double most = std::cbrt(static_cast<double>(state.size())) + 1;
    for (int a = 0; a < 3; ++a) {
      count_[a] = static_cast<int>(std::max(1.0, std::min(most, state.box[a] / radius)));
    }
    first_.assign(static_cast<std::size_t>(count_[0]) * count_[1] * count_[2] + 1, 0);
    std::vector<std::size_t> cell(state.size());
    for (std::size_t i = 0; i < state.size(); ++i) {
      cell[i] = index(place(state.position[i]));
      ++first_[cell[i] + 1];
    }
    for (std::size_t c = 1; c < first_.size(); ++c) first_[c] += first_[c - 1];
    needles_.resize(state.size());
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    for (std::size_t i = 0; i < state.size(); ++i) needles_[next[cell[i]]++] = i;
  }

  // Calls `visit` with each needle of the cells around a point, once.
  template <class Visit>
  void around(const Vector& point, Visit visit) const {
    const std::array<int, 3> middle = place(point);
    std::array<std::vector<int>, 3> near;
    for (int a = 0; a < 3; ++a) {
      for (int step = -1; step <= 1; ++step) {
        near[a].push_back((middle[a] + step + count_[a]) % count_[a]);
      }
      std::sort(near[a].begin(), near[a].end());
      near[a].erase(std::unique(near[a].begin(), near[a].end()), near[a].end());
    }
    for (const int x : near[0]) {
      for (const int y : near[1]) {
        for (const int z : near[2]) {
          const std::size_t cell = index({x, y, z});
          for (std::size_t n = first_[cell]; n < first_[cell + 1]; ++n) visit(needles_[n]);
        }
      }
    }
  }

 private:
  std::array<int, 3> place(const Vector& point) const {
    std::array<int, 3> out{};
    for (int a = 0; a < 3; ++a) {
      const double share = point[a] / state_.box[a];
      out[a] = std::min(static_cast<int>((share - std::floor(share)) * count_[a]), count_[a] - 1);
    }
    return out;
  }
  std::size_t index(const std::array<int, 3>& cell) const {
    return (static_cast<std::size_t>(cell[0]) * count_[1] + cell[1]) * count_[2] + cell[2];
  }

  const State& state_;
  std::array<int, 3> count_{};
  std::vector<std::size_t> first_, needles_;
};

double squared_distance(const State& state, const Vector& a, const Vector& b) {
  double sum = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double edge = state.box[axis];
    const double d = a[axis] - b[axis];
    const double nearest = d - edge * std::round(d / edge);
    sum += nearest * nearest;
  }
  return sum;
}

}  // namespace

std::vector<float> local_density(const State& state, double radius,
                                 std::span<const std::size_t> chosen) {
  const Cells cells(state, radius);
  const double volume = 4.0 / 3.0 * std::numbers::pi * radius * radius * radius;
  std::vector<float> density;
  density.reserve(chosen.size());
  for (const std::size_t i : chosen) {
    const Vector& centre = state.position[i];
    std::size_t count = 0;
    cells.around(centre, [&](std::size_t j) {
      count += j != i && squared_distance(state, centre, state.position[j]) <= radius * radius;
    });
    density.push_back(static_cast<float>(static_cast<double>(count) / volume));
  }
  return density;
}

}  // namespace needlework::report
