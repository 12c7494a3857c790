// Exact rates between walls: infinitely thin needles exclude no volume, so that in equilibrium, and
// in a state that is drawn, positions and directors are those of an ideal gas, among those at which
// both tips are inside the walls.
#include <algorithm>
#include <array>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <numbers>

#include "needlework/theory.h"
#include "src/theory/requirements.h"

namespace needlework::theory {
namespace {

constexpr unsigned points = 20;

// The integral of f over [from, to].
template <class Function>
double integral(double from, double to, const Function& f) {
  if (!(from < to)) return 0;
  return boost::math::quadrature::gauss<double, points>::integrate(f, from, to);
}

// Calls visit(place, weight) for the nodes of the same rule over [0, to].
template <class Visit>
void at_nodes(double to, const Visit& visit) {
  using Rule = boost::math::quadrature::gauss<double, points>;
  for (std::size_t n = 0; n < Rule::abscissa().size(); ++n) {
    for (const double sign : {-1.0, 1.0})
      visit(0.5 * to * (1 + sign * Rule::abscissa()[n]), 0.5 * to * Rule::weights()[n]);
  }
}

// The mean of |u1 x u2| over the angle between the planes through the axis in which two directors
// lie that have these components along it.
double mean_sine(double first, double second) {
  const double along = first * second;
  const double across = std::sqrt((1 - first * first) * (1 - second * second));
  const double mean = integral(0, std::numbers::pi, [&](double angle) {
    const double cosine = along + across * std::cos(angle);
    return std::sqrt(std::max(0.0, 1 - cosine * cosine));
  });
  return mean / std::numbers::pi;
}

// Moments of the higher of two contact points' tips: sums of weight and of weight times
// max((1/2 + x) a, (1/2 + y) b), over the unit square of arms x, y.
struct Moments {
  double weight = 0, height = 0;
};

// Over the part of the square in which p a >= r b, with p = 1/2 + x and r = 1/2 + y, in pieces on
// which the integrand is smooth.
Moments higher_of_first(double a, double b, double k) {
  Moments out;
  const auto add = [&](double from, double to, const auto& most) {
    if (!(from < to)) return;
    at_nodes(to - from, [&](double beyond, double weight) {
      const double p = from + beyond, x = p - 0.5;
      const double column = integral(
          0, most(p), [&](double r) { return std::sqrt(1 + k * (x * x + (r - 0.5) * (r - 0.5))); });
      out.weight += weight * column;
      out.height += weight * column * (p * a);
    });
  };
  const double all = std::min(1.0, b / a);  // from here on every r is below
  add(0, all, [&](double p) { return std::min(1.0, p * a / b); });
  add(all, 1, [](double) { return 1.0; });
  return out;
}

}  // namespace

std::array<WallRates, 3> wall_rates(const Species& species, const std::array<double, 3>& box,
                                    const std::array<bool, 3>& walled, Temperatures now) {
  require_valid(now);
  for (const double edge : box) require_positive("box", edge);
  require_positive("k", species.k);
  // Over an octant of directors, on which components are not negative: the room for the centre
  // along each axis, and the variance of the normal velocity of a tip.
  double room = 0;
  std::array<WallRates, 3> out;
  const auto add = [&](double weight, const std::array<double, 3>& u) {
    std::array<double, 3> width;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      width[axis] = box[axis] - (walled[axis] ? species.length * u[axis] : 0);
      require(width[axis] >= 0, "box", box[axis], "at least the length between two walls");
    }
    room += weight * width[0] * width[1] * width[2];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (!walled[axis]) continue;
      const double others = width[(axis + 1) % 3] * width[(axis + 2) % 3];
      const double turn = 0.5 * species.k * (1 - u[axis] * u[axis]);  // L^2 / (4 I) (1 - u_n^2)
      const double energy = now.t_tr + now.t_rot * turn;              // m times the variance
      out[axis].hits += weight * others * std::sqrt(energy / (2 * std::numbers::pi * species.mass));
      out[axis].force += weight * others * energy / (1 + turn);
    }
  };
  at_nodes(1, [&](double z, double weight_z) {
    at_nodes(0.5 * std::numbers::pi, [&](double angle, double weight_angle) {
      const double across = std::sqrt(1 - z * z);
      add(weight_z * weight_angle, {across * std::cos(angle), across * std::sin(angle), z});
    });
  });
  for (WallRates& rates : out) {
    rates.hits /= room;
    rates.force /= room;
  }
  return out;
}

double pair_depletion(double q, double k) {
  require_not_negative("q", q);
  require_positive("k", k);
  // By exchange of the needles, twice the part in which the first reaches higher; in two triangles
  // of |u1z|, |u2z|, as directors that are parallel are where the weight has a kink.
  Moments sum;
  const auto add = [&](double a, double b, double area) {
    const Moments moments = higher_of_first(a, b, q * k);
    const double weight = area * mean_sine(a, b);
    sum.weight += weight * moments.weight;
    sum.height += weight * moments.height;
  };
  at_nodes(1, [&](double large, double weight_large) {
    at_nodes(1, [&](double ratio, double weight_ratio) {
      const double area = weight_large * weight_ratio * large;
      add(large, large * ratio, area);
      add(large * ratio, large, area);
    });
  });
  return 2 * sum.height / sum.weight;
}

double kick_power(const Composition& composition, double translational, double rotational) {
  require_not_negative("translational", translational);
  require_not_negative("rotational", rotational);
  double count = 0, mass = 0, squares = 0, inertia = 0;
  for (const Species& each : composition.species()) {
    const auto needles = static_cast<double>(each.count);
    count += needles;
    mass += needles * each.mass;
    squares += needles * each.mass * each.mass;
    inertia += needles * each.inertia();
  }
  if (count == 0) return 0;
  return (1.5 * translational * translational * (mass - squares / mass) +
          rotational * rotational * inertia) /
         count;
}

}  // namespace needlework::theory
