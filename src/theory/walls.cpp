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

// Calls visit(place, weight) for the nodes of a rule with so many points over [from, to].
template <unsigned count = points, class Visit>
void at_nodes(double from, double to, const Visit& visit) {
  using Rule = boost::math::quadrature::gauss<double, count>;
  const double half = 0.5 * (to - from);
  for (std::size_t n = 0; n < Rule::abscissa().size(); ++n) {
    const double at = Rule::abscissa()[n], weight = half * Rule::weights()[n];
    visit(from + half * (1 + at), weight);
    if (at != 0) visit(from + half * (1 - at), weight);
  }
}

// The same over the pieces of [0, 1] between these places, in any order, of which those beyond an
// end do not count.
template <unsigned count, std::size_t breaks, class Visit>
void at_nodes_between(std::array<double, breaks> places, const Visit& visit) {
  for (double& place : places) place = std::clamp(place, 0.0, 1.0);
  std::sort(places.begin(), places.end());
  double from = 0;
  for (std::size_t n = 0; n <= breaks; ++n) {
    const double to = n < breaks ? places[n] : 1;
    if (to > from) at_nodes<count>(from, to, visit);
    from = to;
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

// The room for the height of a contact of two needles between walls, and its weight: how often
// needles collide so.
struct Room {
  double weight = 0, height = 0;  ///< sums, that of the height weighted
};

// Adds, for needles that reach this far along the normal of the walls, all contacts, at p and r of
// their lengths from the lower tips. A contact is not lower than the part of either needle below
// it, nor higher than the part above it lets it be.
Room room_of(double first, double second, double gap, const auto& speed) {
  Room out;
  // Where the integrand has kinks, as one or the other needle decides, and where no room is left.
  const std::array<double, 4> kinks = {second / first, 1 - second / first, (gap - second) / first,
                                       1 - (gap - second) / first};
  at_nodes_between<7>(kinks, [&](double p, double weight) {
    const double below = p * first, above = (1 - p) * first;
    const std::array<double, 4> of_second = {below / second, 1 - above / second,
                                             (below + second - gap) / second,
                                             (gap - above) / second};
    at_nodes_between<7>(of_second, [&](double r, double part) {
      const double left = gap - std::max(below, r * second) - std::max(above, (1 - r) * second);
      const double often = weight * part * speed(p - 0.5, r - 0.5);
      out.weight += often;
      out.height += often * std::max(0.0, left);
    });
  });
  return out;
}

}  // namespace

// Of tips whose normal velocity has the variance energy / mass, for a density of 1, on a wall that
// moves towards them: with V its speed and s = V / sqrt(2 energy / mass), hits sqrt(energy / (2 pi
// mass)) (exp(-s^2) + sqrt(pi) s (1 + erf s)), and twice the mean of mass V_n^2 / 2 over V_n < 0.
static WallRates onto(double advance, double energy, double mass) {
  const double thermal = std::sqrt(energy / (2 * std::numbers::pi * mass));
  if (advance == 0) return {thermal, energy};
  const double s = advance / std::sqrt(2 * energy / mass), slow = std::exp(-s * s);
  const double ahead = 1 + std::erf(s);
  return {thermal * slow + 0.5 * advance * ahead,
          (energy + mass * advance * advance) * ahead + 2 * mass * thermal * advance * slow};
}

std::array<WallRates, 3> wall_rates(const Species& species, const std::array<double, 3>& box,
                                    const std::array<bool, 3>& walled, Temperatures now,
                                    double advance) {
  require_valid(now);
  require(std::isfinite(advance), "advance", advance, "a finite number");
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
      // L^2 / (4 I) (1 - u_n^2)
      const double turn = species.has_axis() ? 0.5 * species.k * (1 - u[axis] * u[axis]) : 0;
      const double energy = now.t_tr + now.t_rot * turn;  // m times the variance
      const auto [hits, force] = onto(advance, energy, species.mass);
      out[axis].hits += weight * others * hits;
      out[axis].force += weight * others * force / (1 + turn);
    }
  };
  at_nodes(0, 1, [&](double z, double weight_z) {
    at_nodes(0, 0.5 * std::numbers::pi, [&](double angle, double weight_angle) {
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

double pair_factor_between_walls(const Species& a, Temperatures at_a, const Species& b,
                                 Temperatures at_b, double gap) {
  require_valid(at_a);
  require_valid(at_b);
  require_positive("k", a.k);
  require_positive("k", b.k);
  require(gap >= a.length && gap >= b.length, "gap", gap, "at least the lengths");
  // The variance of the normal velocity of two contact points: T / m of both, and T_rot s^2 / I
  // with I = m L^2 / (2 k).
  const double flight = at_a.t_tr / a.mass + at_b.t_tr / b.mass;
  const double turn_a = 2 * a.k * at_a.t_rot / a.mass, turn_b = 2 * b.k * at_b.t_rot / b.mass;
  const auto speed = [&](double x, double y) {
    return std::sqrt(flight + turn_a * x * x + turn_b * y * y);
  };
  // By components of both directors along the normal.
  Room sum;
  const double both = a.length + b.length;
  const std::array<double, 4> kinks = {b.length / a.length, (gap - b.length) / a.length,
                                       0.5 * gap / a.length, gap / both};
  at_nodes_between<10>(kinks, [&](double first, double weight) {
    const double reach = first * a.length;
    const std::array<double, 3> of_second = {reach / b.length, (gap - reach) / b.length, first};
    at_nodes_between<10>(of_second, [&](double second, double part) {
      const Room room = room_of(reach, second * b.length, gap, speed);
      const double often = weight * part * mean_sine(first, second);
      sum.weight += often * room.weight;
      sum.height += often * room.height;
    });
  });
  if (!(sum.weight > 0)) return 1;  // nothing moves
  return gap / (gap - 0.5 * a.length) * (sum.height / sum.weight) / (gap - 0.5 * b.length);
}

double kick_power(const Composition& composition, double translational, double rotational) {
  require_not_negative("translational", translational);
  require_not_negative("rotational", rotational);
  double count = 0, mass = 0, squares = 0, inertia = 0;
  for (const Species& each : composition.species()) {
    if (each.fixed) continue;
    const auto needles = static_cast<double>(each.count);
    const double width = each.sizes ? each.sizes->mass.width : 0;
    count += needles;
    mass += needles * each.mass;
    squares += needles * each.mass * each.mass * (1 + width * width);
    inertia += needles * (0.5 * each.rotations() * each.inertia());
  }
  if (count == 0) return 0;
  const double taken_off = composition.has_fixed() ? 0 : squares / mass;
  return (1.5 * translational * translational * (mass - taken_off) +
          rotational * rotational * inertia) /
         count;
}

}  // namespace needlework::theory
