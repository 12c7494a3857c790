// Draws initial states: the equilibrium of an ideal gas in centres, directors and velocities.
#include "src/scene/drawing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>
#include <vector>

#include "src/box/vector.h"
#include "src/composition/compensated_sum.h"
#include "src/composition/convex_body.h"
#include "src/machine/stop_request.h"
#include "src/random/needle_random.h"
#include "src/scene/box_of.h"
#include "src/scene/confinement.h"
#include "src/scene/own_bodies.h"
#include "src/scene/rod_grid.h"
#include "src/scene/rod_lattice.h"

namespace needlework {
namespace {

double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

// The part of a normal to the unit vector u. Computed twice, because the first pass leaves a
// rounding error of the size of a, which matters if the result is small.
Vector normal_part(Vector a, const Vector& u) {
  for (int pass = 0; pass < 2; ++pass) {
    const double along = dot(a, u);
    for (std::size_t i = 0; i < 3; ++i) a[i] -= along * u[i];
  }
  return a;
}

// One quantity of all needles, velocities or angular velocities, that are drawn for the species of
// largest mean square. That of another species is smaller by a factor.
struct Drawn {
  std::vector<double> factors;  ///< by species; 1 where there is one
  std::vector<double> weights;  ///< masses or moments of inertia over that of this species
  double mean_square = 0;       ///< of all needles that move, by these weights

  // `square(species)` is the mean square of the quantity, `weight(species)` the mass or the moment
  // of inertia.
  template <class Square, class Weight>
  Drawn(const Composition& composition, const Square& square, const Weight& weight) {
    const auto& all = composition.species();
    // Of those with needles: another one must not change how numbers round.
    const Species& first = *std::ranges::max_element(all, [&](const Species& a, const Species& b) {
      const auto rank = [&](const Species& s) {
        return std::tuple(s.count > 0, !s.fixed, square(s));
      };
      return rank(a) < rank(b);
    });
    const double count = static_cast<double>(composition.count() - composition.fixed());
    for (const Species& s : all) {
      if (s.fixed) {
        factors.push_back(0);
        weights.push_back(0);
        continue;
      }
      factors.push_back(square(first) > 0 ? std::sqrt(square(s) / square(first)) : 0);
      weights.push_back(weight(first) > 0 ? weight(s) / weight(first) : 0);  // smooth spheres
      mean_square += static_cast<double>(s.count) / count * (square(s) * weights.back());
    }
  }
};

// Takes the velocity of the centre of mass off all velocities.
template <class WeightOf>
void remove_mean(std::vector<Vector>& vectors, const WeightOf& weight_of) {
  std::array<CompensatedSum, 3> sums;
  CompensatedSum total;
  for (std::size_t n = 0; n < vectors.size(); ++n) {
    const double weight = weight_of(n);
    total.add(weight);
    for (std::size_t i = 0; i < 3; ++i) sums[i].add(weight * vectors[n][i]);
  }
  const double all = total.value();
  const Vector mean{sums[0].value() / all, sums[1].value() / all, sums[2].value() / all};
  for (Vector& v : vectors)
    for (std::size_t i = 0; i < 3; ++i) v[i] -= mean[i];
}

// Scales all vectors by one factor, so that those that move have the given mean square.
template <class WeightOf>
void set_mean_square(std::vector<Vector>& vectors, double mean_square, std::size_t moving,
                     const WeightOf& weight_of) {
  if (mean_square == 0) {
    for (Vector& v : vectors) v = {};  // a factor 0 would leave signs on the zeros
    return;
  }
  CompensatedSum sum;
  for (std::size_t n = 0; n < vectors.size(); ++n) {
    sum.add(weight_of(n) * dot(vectors[n], vectors[n]));
  }
  if (sum.value() == 0) return;  // no needles
  const double factor = std::sqrt(mean_square / (sum.value() / static_cast<double>(moving)));
  for (Vector& v : vectors)
    for (double& component : v) component *= factor;
}

// Draws centre and director, uniformly among those at which both tips are inside the walls.
void draw_place(NeedleRandom& random, const std::array<Gap, 3>& gaps, const Vector& box,
                const BodyNumbers& body, Vector& centre, Vector& director) {
  const double half_length = 0.5 * body.length, radius = 0.5 * body.diameter;
  const auto is_inside = [&] {
    for (std::size_t i = 0; i < 3; ++i) {
      const double reach = half_length * std::abs(director[i]) + radius;
      if (gaps[i].is_walled() && gaps[i].beyond(centre[i], reach, box[i]) >= 0) return false;
    }
    return true;
  };
  do {
    // A product with a number below 1 never rounds up to the edge itself.
    for (std::size_t i = 0; i < 3; ++i) {
      const Gap& gap = gaps[i];
      centre[i] = gap.low + random.uniform() * (box[i] + gap.high - gap.low);
    }
    director = random.direction();
  } while (!is_inside());
}

BodyNumbers scaled(BodyNumbers body, double scale) {
  body.length *= scale;
  body.diameter *= scale;
  return body;
}

// Draws velocities for needles of all species.
class Velocities {
 public:
  explicit Velocities(const Members& members)
      : members_(members),
        flight_(
            members.composition, [](const Species& s) { return 3 * s.t_tr / s.mass; },
            [](const Species& s) { return s.mass; }),
        // <I w^2 / 2> = t_rot of those with an axis, 1.5 t_rot of rough spheres.
        rotation_(
            members.composition, [](const Species& s) { return s.w2_at(s.t_rot); },
            [](const Species& s) { return s.inertia(); }) {}

  void draw(NeedleRandom& random, State& state, std::size_t i) const {
    const SpeciesIndex species = members_.species[i];
    const auto scaled = [&](double factor, double share) {
      return share == 1 ? factor : factor / std::sqrt(share);
    };
    const double flight = scaled(flight_.factors[species], members_.share_of_mass(i));
    state.velocity[i] = random.normal();
    for (double& v : state.velocity[i]) v *= flight;
    const double rotation = scaled(rotation_.factors[species], members_.share_of_inertia(i));
    const Vector spin = random.normal();
    state.angular_velocity[i] =
        members_.composition[species].has_axis() ? normal_part(spin, state.orientation[i]) : spin;
    for (double& w : state.angular_velocity[i]) w *= rotation;
  }
  // Makes the total momentum 0, unless fixed bodies take up what it is, and the temperatures those
  // asked for.
  void adjust(State& state) const {
    const auto mass = [&](std::size_t i) {
      return flight_.weights[members_.species[i]] * members_.share_of_mass(i);
    };
    const auto inertia = [&](std::size_t i) {
      return rotation_.weights[members_.species[i]] * members_.share_of_inertia(i);
    };
    const std::size_t moving = state.size() - members_.composition.fixed();
    if (state.size() >= 2 && moving == state.size()) remove_mean(state.velocity, mass);
    set_mean_square(state.velocity, flight_.mean_square, moving, mass);
    set_mean_square(state.angular_velocity, rotation_.mean_square, moving, inertia);
  }

 private:
  const Members& members_;
  Drawn flight_, rotation_;
};

State without_velocities(const Scene& scene, std::size_t count) {
  State state;
  state.box = scene.needles.box;
  state.periodic = scene.periodic();
  state.position.resize(count);
  state.velocity.resize(count);
  state.orientation.resize(count);
  state.angular_velocity.resize(count);
  return state;
}

// What a state says of them.
void enter(const Members& members, State& state) {
  if (members.composition.is_mixture()) state.species = members.species;
  state.own_bodies = columns_of(members.own);
}

}  // namespace

State draw_needles(const Scene& scene) {
  const Members members = drawn_members(scene);
  State state = without_velocities(scene, members.size());
  if (state.size() == 0) return state;
  const Velocities velocities(members);
  const std::array<Gap, 3> gaps = gaps_of(scene);
  for (std::size_t id = 0; id < state.size(); ++id) {
    StopRequest::check_in_turn(id);
    NeedleRandom random(scene.needles.seed, id);
    draw_place(random, gaps, state.box, members.body(id), state.position[id],
               state.orientation[id]);
    velocities.draw(random, state, id);
  }
  StopRequest::check();
  velocities.adjust(state);
  enter(members, state);
  return state;
}

namespace {

// The ids in the order in which rods are inserted: a large one finds no place among many small
// ones, which find theirs around it.
std::vector<std::size_t> largest_first(const Members& members) {
  std::vector<double> excluded;
  for (std::size_t id = 0; id < members.size(); ++id) {
    const BodyNumbers body = members.body(id);
    const Species its{.length = body.length, .diameter = body.diameter};
    excluded.push_back(excluded_volume(its, its));
  }
  std::vector<std::size_t> out(excluded.size());
  std::iota(out.begin(), out.end(), std::size_t{0});
  std::ranges::stable_sort(out, std::ranges::greater(),
                           [&](std::size_t id) { return excluded[id]; });
  return out;
}

}  // namespace

Insertion insert_rods(const Scene& scene, std::uint64_t most_tries, double most_on_average,
                      double scale) {
  const Members members = drawn_members(scene);
  const std::size_t rods = members.size();
  std::vector<RodShape> shapes;
  for (std::size_t id = 0; id < rods; ++id) {
    const BodyNumbers its = scaled(members.body(id), scale);
    shapes.push_back({its.length, its.diameter, members.species[id]});
  }
  Insertion out{without_velocities(scene, rods), 0, 0};
  const std::array<Gap, 3> gaps = gaps_of(scene);
  RodGrid grid(members.composition, shapes, box_at_start(scene));
  for (const std::size_t id : largest_first(members)) {
    NeedleRandom random(scene.needles.seed, id);
    bool placed = false;
    const auto is_too_slow = [&] {
      return static_cast<double>(out.tries) > most_on_average * static_cast<double>(rods);
    };
    for (std::uint64_t n = 0; n < most_tries && !placed && !is_too_slow(); ++n) {
      if (out.tries++ % 256 == 0) {
        StopRequest::check(
            {"placing rods", static_cast<double>(out.placed) / static_cast<double>(rods)});
      }
      Vector &centre = out.state.position[id], &director = out.state.orientation[id];
      draw_place(random, gaps, out.state.box, scaled(members.body(id), scale), centre, director);
      if (grid.overlap(centre, director, shapes[id], 0)) continue;
      grid.enter(centre, director, shapes[id]);
      placed = true;
    }
    if (!placed) return out;
    ++out.placed;
  }
  enter(members, out.state);
  return out;
}

std::optional<State> place_rods_on_lattice(const Scene& scene, RodOrder order) {
  const Members members = drawn_members(scene);
  const Composition& composition = members.composition;
  const std::array<Gap, 3> gaps = gaps_of(scene);
  LatticeBox room;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Gap& gap = gaps[axis];
    room.periodic[axis] = !gap.is_walled();
    room.low[axis] = gap.low;
    room.high[axis] = scene.needles.box[axis] + gap.high;
  }
  double length = 0;
  for (const Species& each : composition.species())
    length = std::max(length, each.greatest_length());
  State state = without_velocities(scene, composition.count());
  const double diameter = composition.widest();
  const auto lattice = order == RodOrder::parallel
                           ? rod_lattice(room, length, diameter, state.size())
                           : crossed_rods(room, length, diameter, state.size());
  if (!lattice) return std::nullopt;
  state.position = lattice->position;
  state.orientation = lattice->director;
  // Which rod is where is drawn, so that a mixture begins mixed.
  for (std::size_t n = state.size(); n > 1; --n) {
    NeedleRandom random(scene.needles.seed, n - 1);
    const auto other = static_cast<std::size_t>(random.uniform() * static_cast<double>(n));
    std::swap(state.position[n - 1], state.position[other]);
    std::swap(state.orientation[n - 1], state.orientation[other]);
  }
  enter(members, state);
  return state;
}

void draw_velocities(const Scene& scene, State& state) {
  if (state.size() == 0) return;
  const Members members = members_of(scene.composition(), state);
  const Velocities velocities(members);
  for (std::size_t id = 0; id < state.size(); ++id) {
    StopRequest::check_in_turn(id);
    NeedleRandom random(scene.needles.seed, id, RandomFor::velocities_of_rods, 0);
    velocities.draw(random, state, id);
  }
  velocities.adjust(state);
}

}  // namespace needlework
