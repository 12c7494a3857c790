#include "src/observe/ideal_pairs.h"

#include <algorithm>
#include <array>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <numbers>

namespace needlework::observe {

IdealPairs::IdealPairs(const GasSetting& gas, const Vector& edges)
    : composition_(gas.composition), box_(edges) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    (gas.box.is_periodic(axis) ? periodic_ : walled_).push_back(axis);
  }
}

double IdealPairs::reach() const {
  if (periodic_.empty()) return std::sqrt(dot(box_, box_));
  double shortest = box_[periodic_.front()];
  for (const std::size_t axis : periodic_) shortest = std::min(shortest, box_[axis]);
  return shortest / 2;
}

std::vector<double> IdealPairs::shares(std::size_t a, std::size_t b,
                                       const std::vector<double>& borders) const {
  std::vector<double> out;
  double before = within(borders.front() * borders.front(), 0, a, b);
  for (std::size_t n = 1; n < borders.size(); ++n) {
    const double now = within(borders[n] * borders[n], 0, a, b);
    out.push_back(now - before);
    before = now;
  }
  return out;
}

double IdealPairs::Profile::at(double place) const {
  const double depth = std::min(place - low, high - place);
  if (!(depth > 0)) return 0;
  return std::min(1.0, depth / ramp) / (high - low - ramp);
}

IdealPairs::Profile IdealPairs::profile(std::size_t species, std::size_t axis) const {
  const Species& of = composition_[species];
  return {of.diameter / 2, box_[axis] - of.diameter / 2, of.length / 2};
}

// The density of z_b - z_a there. Between corners of the profiles their product is a parabola.
double IdealPairs::overlap(const Profile& a, const Profile& b, double apart) const {
  std::array<double, 8> corners{
      a.low,         a.low + a.ramp,         a.high - a.ramp,         a.high,
      b.low - apart, b.low + b.ramp - apart, b.high - b.ramp - apart, b.high - apart};
  std::ranges::sort(corners);
  double sum = 0;
  for (std::size_t n = 1; n < corners.size(); ++n) {
    const double begin = corners[n - 1], end = corners[n];
    const auto product = [&](double z) { return a.at(z) * b.at(z + apart); };
    // Of spheres the profile jumps at its ends, where it is taken from within.
    const double step = 0x1p-30 * (end - begin);
    sum += (end - begin) / 6 *
           (product(begin + step) + 4 * product((begin + end) / 2) + product(end - step));
  }
  return sum;
}

// The share of pairs whose distance, along the axes with walls from the first of these on and along
// all periodic ones, is within the root of this square.
double IdealPairs::within(double square, std::size_t first, std::size_t a, std::size_t b) const {
  if (first == walled_.size()) {
    constexpr double pi = std::numbers::pi;
    const double r = std::sqrt(std::max(0.0, square));
    const std::array<double, 4> balls{1, 2 * r, pi * r * r, 4 * pi / 3 * r * r * r};
    double share = balls[periodic_.size()];
    for (const std::size_t axis : periodic_) share /= box_[axis];
    return share;
  }
  const Profile of_a = profile(a, walled_[first]), of_b = profile(b, walled_[first]);
  const double farthest = std::max(of_a.high - of_b.low, of_b.high - of_a.low);
  if (!(of_a.high > of_a.low && of_b.high > of_b.low)) return within(square, first + 1, a, b);
  // By the angle whose sine is the distance along this axis, as roots end at the largest.
  const double most = std::min(std::sqrt(square), farthest);
  const auto at = [&](double angle) {
    const double apart = most * std::sin(angle);
    return most * std::cos(angle) * overlap(of_a, of_b, apart) *
           within(square - apart * apart, first + 1, a, b);
  };
  using Rule = boost::math::quadrature::gauss<double, 20>;
  return 2 * Rule::integrate(at, 0.0, std::numbers::pi / 2);
}

}  // namespace needlework::observe
