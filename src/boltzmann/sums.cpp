#include "src/boltzmann/sums.h"

#include <cmath>
#include <utility>
#include <vector>

namespace needlework::boltzmann {
namespace {

constexpr double Sums::*members[] = {&Sums::needles, &Sums::collisions, &Sums::tr,    &Sums::rot,
                                     &Sums::tr_tr,   &Sums::rot_rot,    &Sums::tr_rot};

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

Means measured(std::span<const Sums> pools) {
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
  Means out;
  out.t_tr = of([](const Sums& s) { return s.tr / (3 * s.needles); });
  out.t_rot = of([](const Sums& s) { return s.rot / (2 * s.needles); });
  out.energy = of([](const Sums& s) { return (s.tr + s.rot) / 2 / s.needles; });
  out.collisions = of([](const Sums& s) { return s.collisions / s.needles; });
  out.excess_tr = of([](const Sums& s) { return s.needles * s.tr_tr / (s.tr * s.tr) * 3 / 5 - 1; });
  out.excess_rot =
      of([](const Sums& s) { return s.needles * s.rot_rot / (s.rot * s.rot) / 2 - 1; });
  out.excess_mixed = of([](const Sums& s) { return s.needles * s.tr_rot / (s.tr * s.rot) - 1; });
  return out;
}

}  // namespace needlework::boltzmann
