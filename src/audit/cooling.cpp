#include "src/audit/cooling.h"

#include <algorithm>

#include "src/audit/there.h"

namespace needlework::audit {
namespace {

Quad squares_of(std::span<const Needle> needles) {
  Quad out = 0;
  for (const Needle& needle : needles) {
    const Vector<Quad> v = to<Quad>(needle.record.v);
    out += needle.body.moving_mass() * dot(v, v);
  }
  return out;
}

}  // namespace

Growth growth_of(const Scene::Growth& growth, std::span<const Needle> needles) {
  using std::sqrt;
  Quad mass = 0, diameters = 0;
  for (const Needle& needle : needles) {
    mass += needle.body.moving_mass();
    diameters += needle.body.diameter;
  }
  if (needles.empty()) return {0, 0};
  const Quad speed = sqrt(Quad(squares_of(needles) / (3 * mass)));
  const Quad mean_diameter = diameters / static_cast<double>(needles.size());
  return {growth.rate * speed / mean_diameter, needles.size()};
}

std::optional<double> Cooling::collisions_of(const Scene::Growth& growth, std::size_t bodies) {
  // Absent, so that one hundredth of the energy is taken off each time, but for fast growth.
  const double every = growth.cool_every.value_or(std::max(1.0, 0.01 / growth.rate));
  if (!(every > 0)) return std::nullopt;
  return std::max(1.0, every * static_cast<double>(bodies));
}

Cooling::Cooling(double collisions, std::span<const Needle> needles)
    : wanted_(collisions), squares_(squares_of(needles)) {}

void Cooling::pass(double is, std::uint64_t collisions, std::size_t bodies) {
  constexpr double most_change = 8;
  last_ = next(is);
  if (!(step_ > 0)) step_ = is;
  const double counted = static_cast<double>(collisions - collisions_);
  step_ *= std::clamp(wanted_ / std::max(counted, 0.5), 1 / most_change, most_change);
  collisions_ = collisions;
  const double enough = std::min(wanted_, static_cast<double>(bodies));
  if (static_cast<double>(collisions - measured_) < enough) return;
  before_ = std::max(before_, pressure_);
  pressure_ = 1 + virial_ / integral_;
  measured_ = collisions;
  virial_ = integral_ = 0;
}

// By Simpson's rule, which is exact where needles fall.
void Cooling::add_flight(const Needle& needle, const Vector<double>& gravity, const Instant& now) {
  const double age = elapsed<double>(needle.record.time, now).middle;
  const auto square = [&](double t) {
    const Vector<double> v = needle.record.v + gravity * t;
    return dot(v, v);
  };
  integral_ +=
      needle.body.moving_mass() * (square(0) + 4 * square(age / 2) + square(age)) * age / 6;
}

Quad Cooling::factor(std::span<const Needle> needles, const Vector<double>& gravity,
                     const Instant& now) const {
  using std::sqrt;
  Quad squares = 0;
  for (const Needle& needle : needles) {
    const Quad age = elapsed<Quad>(needle.record.time, now).middle;
    const Vector<Quad> v = to<Quad>(needle.record.v) + to<Quad>(gravity) * age;
    squares += needle.body.moving_mass() * dot(v, v);
  }
  return sqrt(Quad(squares_ / squares));
}

double excess_over_cooling(const Needle& before, const Record& after, const Quad& factor,
                           const Space& space) {
  constexpr double half_unit = 0x1p-53;
  const There there(before, space.gravity, after.time);
  Excess excess;
  add_place(excess, there, after.r, after.u, space);
  // Directors are off by half units, which grow with the angle turned.
  const double off = 16 * half_unit * (2 + there.turned + there.flown / before.body.extent());
  const double speed = magnitude(Quad(norm(there.v) * factor)),
               spin = magnitude(Quad(norm(there.w) * factor));
  for (int axis = 0; axis < 3; ++axis) {
    excess.add(there.v[axis] * factor - Quad(after.v[axis]), off * speed);
    excess.add(there.w[axis] * factor - Quad(after.w[axis]), off * spin);
  }
  return excess.most();
}

}  // namespace needlework::audit
