// The tensor of the nematic order, <(3 u u - 1) / 2> over directors u.
#pragma once

#include <array>
#include <cstddef>

#include "src/observe/observable.h"
#include "src/observe/vector.h"

namespace needlework::observe {

/// Its largest eigenvalue is the nematic order, and the component along an axis twice is the mean
/// of P2(u . e) with e along it.
class OrderTensor {
 public:
  void add(const Vector& u) {
    ++count_;
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t b = 0; b < 3; ++b) squares_[a][b] += u[a] * u[b];
  }
  /// Puts its nine components; NaN without directors.
  void put(Row& row) const {
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t b = 0; b < 3; ++b) row.put(at(a, b));
  }
  double at(std::size_t a, std::size_t b) const {
    return 1.5 * squares_[a][b] / count_ - (a == b ? 0.5 : 0);
  }

 private:
  double count_ = 0;
  std::array<Vector, 3> squares_{};
};

}  // namespace needlework::observe
