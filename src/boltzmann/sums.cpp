#include "src/boltzmann/sums.h"

#include <cmath>
#include <utility>
#include <vector>

namespace needlework::boltzmann {
namespace {

constexpr double Sums::*members[] = {&Sums::needles, &Sums::collisions, &Sums::v2,  &Sums::w2,
                                     &Sums::v4,      &Sums::w4,         &Sums::v2w2};

template <class Number>
Measured jackknife(const Sums& all, std::span<const Sums> without, const Number& number_of) {
  double sum = 0, squares = 0;
  std::vector<double> values;
  for (const Sums& sums : without) sum += values.emplace_back(number_of(sums));
  const auto count = static_cast<double>(without.size());
  for (const double value : values) squares += (value - sum / count) * (value - sum / count);
  return {number_of(all), std::sqrt(squares * (count - 1) / count)};
}

}  // namespace

Sums& Sums::operator+=(const Sums& other) {
  for (double Sums::*member : members) this->*member += other.*member;
  return *this;
}

Sample measured(std::span<const Sums> pools, double k) {
  Sums all;
  for (const Sums& pool : pools) all += pool;
  std::vector<Sums> without;
  for (std::size_t left_out = 0; left_out < pools.size(); ++left_out) {
    // Added up, as a difference from all would leave rounding errors where most needles are at
    // rest.
    Sums& sums = without.emplace_back();
    for (std::size_t p = 0; p < pools.size(); ++p) {
      if (p != left_out) sums += pools[p];
    }
  }
  const auto of = [&](auto number_of) { return jackknife(all, without, number_of); };
  Sample out;
  out.t_tr = of([](const Sums& s) { return s.v2 / (3 * s.needles); });
  out.t_rot = of([k](const Sums& s) { return s.w2 / (4 * k * s.needles); });
  out.energy = of([k](const Sums& s) { return (s.v2 / 2 + s.w2 / (4 * k)) / s.needles; });
  out.collisions = of([](const Sums& s) { return 2 * s.collisions / s.needles; });
  out.excess_tr = of([](const Sums& s) { return s.needles * s.v4 / (s.v2 * s.v2) * 3 / 5 - 1; });
  out.excess_rot = of([](const Sums& s) { return s.needles * s.w4 / (s.w2 * s.w2) / 2 - 1; });
  out.excess_mixed = of([](const Sums& s) { return s.needles * s.v2w2 / (s.v2 * s.w2) - 1; });
  return out;
}

}  // namespace needlework::boltzmann
