// Whether a run begins with the gas of its scene, and ends where its scene says.
#include <algorithm>
#include <boost/math/constants/constants.hpp>
#include <cmath>
#include <limits>

#include "src/audit/audit.h"

namespace needlework::audit {
namespace {

// Relative: of sums over all needles in another order than that of the engine.
constexpr double sums = 1e-11;
// Of one number that may have been rounded a few times.
constexpr double rounding = 0x1p-45;

bool near(double a, double b, double relative) { return std::abs(a - b) <= relative * std::abs(b); }

bool near(const Vector<double>& a, const Vector<double>& b, double size) {
  const Vector<double> difference = a - b;
  return norm(difference) <= rounding * size;
}

}  // namespace

// The directors and velocities are those with which the run begins: unit vectors, and angular
// velocities normal to them.
bool Audit::is_proper(const Needle& needle) const {
  const Record& record = needle.record;
  if (!is_inside(needle)) return false;
  for (int axis = 0; axis < 3; ++axis) {
    if (!space_.periodic[static_cast<std::size_t>(axis)]) continue;
    if (!(record.r[axis] >= 0 && record.r[axis] < space_.box[axis])) return false;
  }
  return near(dot(record.u, record.u), 1, rounding) &&
         (needle.body.has_axis() ? std::abs(dot(record.u, record.w)) <= rounding * norm(record.w)
                                 : needle.body.q > 0 || norm(record.w) == 0);
}

// Neither tip is in a wall.
bool Audit::is_inside(const Needle& needle) const {
  return std::ranges::all_of(walls_, [&](const Wall& wall) {
    return TipFlight(needle, space_, wall, 1).height(0) >= -tip_tolerance(needle) &&
           TipFlight(needle, space_, wall, -1).height(0) >= -tip_tolerance(needle);
  });
}

// With the potential energy, which a flight keeps. Heights count from the edges to which gravity
// points. Along periodic axes there is none, and no end depends on the energy; so in uniform shear.
double Audit::energy() const {
  Vector<double> lowest{}, weight = space_.gravity;
  for (int axis = 0; axis < 3; ++axis) {
    if (space_.periodic[static_cast<std::size_t>(axis)]) weight[axis] = 0;
    if (weight[axis] > 0) lowest[axis] = space_.box[static_cast<std::size_t>(axis)];
  }
  long double sum = energy_of(needles_);
  for (const Needle& needle : needles_) {
    sum += needle.body.moving_mass() * dot(weight, lowest - needle.record.r);
  }
  return static_cast<double>(sum);
}

bool Audit::is_as_given(const Needle& needle, const State& given, std::size_t i) const {
  const Record& record = needle.record;
  const double epoch = setup_.epoch_length;
  const Vector<double> director = vector(given.orientation[i]);
  const Vector<double> u = director * (1 / norm(director));
  const Vector<double> v = vector(given.velocity[i]) * (epoch / unit_);
  const Vector<double> spin = vector(given.angular_velocity[i]) * epoch;
  const Vector<double> w = needle.body.has_axis() ? spin - u * dot(u, spin) : spin;
  double beside = 0, past = 0;  // of the row that it is given in
  for (const int axis : {1, 0, 2}) {
    const double position = given.position[i][axis] / unit_ - (axis == 0 ? beside : 0);
    const double boxes = (position - record.r[axis]) / space_.box[axis];
    const double size = std::abs(position) / space_.box[axis] + 1;
    const bool periodic = space_.periodic[static_cast<std::size_t>(axis)];
    const double whole = periodic ? std::round(boxes) : 0;
    if (!(std::abs(boxes - whole) <= rounding * size)) return false;
    if (axis == 1 && space_.rows) {
      beside = whole * space_.rows->at({}).offset;
      past = whole * space_.rows->velocity();
    }
  }
  const bool of_species =
      given.species.empty() || bodies_.size() == 1 || given.species[i] == needle.body.species;
  return of_species && near(record.u, u, 1) &&
         near(record.v, v - Vector<double>{{past, 0, 0}}, norm(v) + std::abs(past)) &&
         near(record.w, w, norm(spin));
}

void Audit::check_start(const Scene& scene, const State* given) {
  if (resumed_) return;
  const Composition composition = scene.composition();
  bool right = std::ranges::all_of(needles_, [&](const Needle& n) { return is_proper(n); });
  for (std::size_t index = 0; index < bodies_.size(); ++index) {
    const auto count = std::ranges::count_if(
        needles_, [&](const Needle& needle) { return needle.body.species == index; });
    right &= static_cast<std::uint64_t>(count) == composition[index].count;
  }
  for (int axis = 0; axis < 3; ++axis) {
    right &= space_.box[axis] == scene.needles.box[axis] / unit_;
  }
  if (right && given) {
    std::vector<std::size_t> order(given->size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    if (!given->id.empty()) std::ranges::sort(order, {}, [&](auto i) { return given->id[i]; });
    right = order.size() == needles_.size();
    for (std::size_t i = 0; right && i < order.size(); ++i) {
      right = is_as_given(needles_[i], *given, order[i]);
    }
  } else if (right && !needles_.empty()) {
    // Each species is drawn with temperatures of its own, around which it scatters; the needles
    // together have exactly the energies of all of them.
    const double speed = setup_.epoch_length / unit_, scale = speed * speed;
    double t_tr = 0, t_rot = 0, found_tr = 0, found_rot = 0;
    const std::vector<Needle> needles = beside_flow(needles_, {});
    const auto found = temperatures_of(needles, bodies_);
    for (std::size_t index = 0; index < bodies_.size(); ++index) {
      const Species& species = composition[index];
      const double count = static_cast<double>(species.count);
      if (count == 0) continue;
      t_tr += count * species.t_tr * scale;
      const double rotations = count * bodies_[index].rotations();
      t_rot += rotations * species.t_rot * scale;
      found_tr += count * found[index].t_tr;
      found_rot += rotations * found[index].t_rot;
    }
    Vector<double> momentum{};
    double most = 0;
    for (const Needle& needle : needles) {
      momentum = momentum + needle.record.v * needle.body.moving_mass();
      most += needle.body.moving_mass() * norm(needle.record.v);
    }
    right = near(found_tr, t_tr, sums) && near(found_rot, t_rot, sums) &&
            (needles_.size() < 2 || composition.has_fixed() || norm(momentum) <= sums * most);
  }
  const double usual = windows_.usual_time();
  if (follows_windows() && std::isfinite(usual))
    right &= usual > 1 - Windows::tolerance && usual < 2 + Windows::tolerance;
  if (!right) report(Kind::wrong_start);
}

// The energy, with that in gravity, changes by events only.
void Audit::check_end(const Scene::Until& until, Stop reason, double time) {
  const double count = static_cast<double>(needles_.size());
  const double collisions = static_cast<double>(findings_.collisions);
  const double infinity = std::numeric_limits<double>::infinity();
  const double latest = until.time.value_or(infinity);
  const double most = until.collisions_per_needle.value_or(infinity) * count / 2;
  // In a uniform flow, energy changes in flight: of its end, that it was an end is all there is.
  const double least_energy =
      until.energy_ratio && !space_.rows ? *until.energy_ratio * initial_energy_ : -infinity;
  const double energy = this->energy();
  const double before = energy - last_energy_change_;
  const double last = last_ ? since_start(last_->first) * setup_.epoch_length : 0;
  const double slack = sums * initial_energy_ * std::min(1.0, until.energy_ratio.value_or(0));

  // No condition was met before the last collision, or in the flight after it.
  bool right = last <= latest * (1 + rounding) && time <= latest * (1 + rounding) &&
               last <= time * (1 + rounding);
  if (findings_.events() > 0) right &= collisions - 1 < most && before > least_energy - slack;
  const auto& growth = setup_.driving.growth;
  const double scale = space_.scale_at(instant_at(time / setup_.epoch_length));
  const double packing = packing_fraction() * (scale * scale * scale);
  if (growth) right &= packing <= growth->until_packing.value_or(1) * (1 + sums);
  const bool has_moving_walls =
      std::ranges::any_of(walls_, [](const Wall& wall) { return wall.velocity != 0; });
  switch (reason) {
    case Stop::time:
      right &= until.time && near(time, latest, rounding);
      break;
    case Stop::collisions:
      right &= collisions >= most && near(time, last, rounding);
      break;
    case Stop::energy:
      if (space_.rows) return;
      right &= energy <= least_energy + slack && near(time, last, rounding);
      break;
    case Stop::nothing_can_happen:
      right &= is_at_rest();
      break;
    case Stop::walls_meet:
      right &= has_moving_walls;
      break;
    case Stop::jammed:
      right &= has_moving_walls || (growth && !growth->until_pressure && is_at_pressure(1e6));
      break;
    case Stop::wall_time:
    case Stop::interrupted:
      return;
    case Stop::grown:
      right &= growth && near(packing, growth->until_packing.value_or(packing), sums);
      break;
    case Stop::pressure:
      right &= growth && growth->until_pressure && is_at_pressure(*growth->until_pressure);
      break;
    case Stop::no_room:
      right &= growth && has_no_room(scale);
      break;
  }
  if (reason == Stop::time || reason == Stop::grown || reason == Stop::no_room) {
    right &= collisions < most && energy > least_energy - slack;
  }
  if (!right) report(Kind::wrong_end);
}

// Of the sizes at the start.
double Audit::packing_fraction() const {
  constexpr double pi = boost::math::constants::pi<double>();
  long double sum = 0;
  for (const Needle& needle : needles_) {
    const double length = needle.body.length, diameter = needle.body.diameter;
    sum += pi * diameter * diameter * (diameter / 6 + length / 4);
  }
  return static_cast<double>(sum) / (space_.box[0] * space_.box[1] * space_.box[2]);
}

// Whether bodies that grow are at this pressure for the first time. Where they are never cooled,
// the times are not known at which it is measured.
bool Audit::is_at_pressure(double pressure) const {
  // The engine knows temperatures at the ends of windows only.
  constexpr double roughly = 0.1;
  return !cooling_ || (cooling_->pressure() > pressure * (1 - roughly) &&
                       cooling_->pressure_before() < pressure * (1 + roughly));
}

// Whether the longest body, so much larger than at the start, has its whole length only between two
// walls, or half of an edge that is periodic; to a hundredth.
bool Audit::has_no_room(double scale) const {
  double longest = 0;
  for (const Needle& needle : needles_) longest = std::max(longest, scale * needle.body.extent());
  for (int axis = 0; axis < 3; ++axis) {
    const auto each = static_cast<std::size_t>(axis);
    double room = space_.box[each] / 2;
    if (!space_.periodic[each]) {
      room = space_.box[each];
      for (const Wall& wall : walls_) room -= wall.axis == axis ? wall.amplitude : 0;
    }
    if (longest >= 0.99 * room) return true;
  }
  return false;
}

// Whether no two needles can ever meet: all pass through each other, or none turns, and all move
// alike.
bool Audit::is_at_rest() const {
  const Scene::Driving& driving = setup_.driving;
  const bool passing = !setup_.composition.any_meet();
  if (!walls_.empty() || norm(space_.gravity) != 0 || driving.kicks || driving.andersen ||
      ((space_.rows || space_.growth) && needles_.size() > 1 && !passing)) {
    return needles_.empty();
  }
  if (needles_.size() < 2 || passing) return true;
  const Vector<double>& v = needles_.front().record.v;
  return std::ranges::all_of(needles_, [&](const Needle& needle) {
    const Record& record = needle.record;
    return needle.flight.omega.middle == 0 && norm(record.v - v) == 0;
  });
}

void Audit::report(Kind kind) {
  ++findings_.differences[static_cast<std::size_t>(kind)];
  const double time = last_ ? since_start(last_->first) * setup_.epoch_length : 0;
  if (findings_.listed.size() < most_listed) findings_.listed.push_back({kind, time, {}, {}});
}

}  // namespace needlework::audit
