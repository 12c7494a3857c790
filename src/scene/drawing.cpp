// Draws initial states: the equilibrium of an ideal gas in centres, directors and velocities.
#include "src/scene/drawing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "src/box/vector.h"
#include "src/composition/convex_body.h"
#include "src/machine/stop_request.h"
#include "src/random/needle_random.h"
#include "src/scene/box_of.h"
#include "src/scene/confinement.h"
#include "src/scene/rod_grid.h"
#include "src/scene/rod_lattice.h"

namespace needlework {
namespace {

// A sum with a running correction (Neumaier), so that a sum of a million terms loses no digits.
class Sum {
 public:
  void add(double x) {
    const double total = total_ + x;
    correction_ += std::abs(total_) >= std::abs(x) ? (total_ - total) + x : (x - total) + total_;
    total_ = total;
  }
  double value() const { return total_ + correction_; }

 private:
  double total_ = 0;
  double correction_ = 0;
};

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
  double mean_square = 0;       ///< of all needles, by these weights

  // `square(species)` is the mean square of the quantity, `weight(species)` the mass or the moment
  // of inertia.
  template <class Square, class Weight>
  Drawn(const Composition& composition, const Square& square, const Weight& weight) {
    const auto& all = composition.species();
    // Of those with needles: another one must not change how numbers round.
    const Species& first = *std::ranges::max_element(all, [&](const Species& a, const Species& b) {
      return std::pair(a.count > 0, square(a)) < std::pair(b.count > 0, square(b));
    });
    const double count = static_cast<double>(composition.count());
    for (const Species& s : all) {
      factors.push_back(square(first) > 0 ? std::sqrt(square(s) / square(first)) : 0);
      weights.push_back(weight(first) > 0 ? weight(s) / weight(first) : 0);  // spheres do not turn
      mean_square += static_cast<double>(s.count) / count * (square(s) * weights.back());
    }
  }
};

// Takes the velocity of the centre of mass off all velocities.
void remove_mean(std::vector<Vector>& vectors, const std::vector<SpeciesIndex>& species,
                 const std::vector<double>& weights) {
  std::array<Sum, 3> sums;
  Sum total;
  for (std::size_t n = 0; n < vectors.size(); ++n) {
    const double weight = weights[species[n]];
    total.add(weight);
    for (std::size_t i = 0; i < 3; ++i) sums[i].add(weight * vectors[n][i]);
  }
  const double all = total.value();
  const Vector mean{sums[0].value() / all, sums[1].value() / all, sums[2].value() / all};
  for (Vector& v : vectors)
    for (std::size_t i = 0; i < 3; ++i) v[i] -= mean[i];
}

// Scales all vectors by one factor, so that they have the given mean square.
void set_mean_square(std::vector<Vector>& vectors, const std::vector<SpeciesIndex>& species,
                     const Drawn& drawn) {
  if (drawn.mean_square == 0) {
    for (Vector& v : vectors) v = {};  // a factor 0 would leave signs on the zeros
    return;
  }
  Sum sum;
  for (std::size_t n = 0; n < vectors.size(); ++n) {
    sum.add(drawn.weights[species[n]] * dot(vectors[n], vectors[n]));
  }
  if (sum.value() == 0) return;  // no needles
  const double factor =
      std::sqrt(drawn.mean_square / (sum.value() / static_cast<double>(vectors.size())));
  for (Vector& v : vectors)
    for (double& component : v) component *= factor;
}

// Draws centre and director, uniformly among those at which both tips are inside the walls.
void draw_place(NeedleRandom& random, const std::array<Gap, 3>& gaps, const Vector& box,
                const Species& species, Vector& centre, Vector& director) {
  const double half_length = 0.5 * species.length, radius = 0.5 * species.diameter;
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

// Draws velocities for needles of all species.
class Velocities {
 public:
  explicit Velocities(const Composition& composition)
      : flight_(
            composition, [](const Species& s) { return 3 * s.t_tr / s.mass; },
            [](const Species& s) { return s.mass; }),
        // <I w^2 / 2> = t_rot with I = m L^2 / (2 k).
        rotation_(
            composition,
            [](const Species& s) {
              return s.turns() ? 4 * s.k * s.t_rot / (s.mass * (s.length * s.length)) : 0;
            },
            [](const Species& s) { return s.inertia(); }) {}

  void draw(NeedleRandom& random, SpeciesIndex species, State& state, std::size_t i) const {
    state.velocity[i] = random.normal();
    for (double& v : state.velocity[i]) v *= flight_.factors[species];
    state.angular_velocity[i] = normal_part(random.normal(), state.orientation[i]);
    for (double& w : state.angular_velocity[i]) w *= rotation_.factors[species];
  }
  // Makes the total momentum 0 and the temperatures those asked for.
  void adjust(const std::vector<SpeciesIndex>& species, State& state) const {
    if (state.size() >= 2) remove_mean(state.velocity, species, flight_.weights);
    set_mean_square(state.velocity, species, flight_);
    set_mean_square(state.angular_velocity, species, rotation_);
  }

 private:
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

}  // namespace

State draw_needles(const Scene& scene) {
  const Composition composition = scene.composition();
  State state = without_velocities(scene, composition.count());
  if (state.size() == 0) return state;
  std::vector<SpeciesIndex> species = composition.in_order_of_id();
  const Velocities velocities(composition);
  const std::array<Gap, 3> gaps = gaps_of(scene);
  for (std::size_t id = 0; id < state.size(); ++id) {
    StopRequest::check_in_turn(id);
    NeedleRandom random(scene.needles.seed, id);
    draw_place(random, gaps, state.box, composition[species[id]], state.position[id],
               state.orientation[id]);
    velocities.draw(random, species[id], state, id);
  }
  StopRequest::check();
  velocities.adjust(species, state);
  if (composition.is_mixture()) state.species = std::move(species);
  return state;
}

namespace {

// The ids in the order in which rods are inserted: a large one finds no place among many small
// ones, which find theirs around it.
std::vector<std::size_t> largest_first(const Composition& composition,
                                       const std::vector<SpeciesIndex>& species) {
  std::vector<std::size_t> out(species.size());
  std::iota(out.begin(), out.end(), std::size_t{0});
  std::ranges::stable_sort(out, std::ranges::greater(), [&](std::size_t id) {
    return excluded_volume(composition[species[id]], composition[species[id]]);
  });
  return out;
}

}  // namespace

Insertion insert_rods(const Scene& scene, std::uint64_t most_tries, double most_on_average) {
  const Composition composition = scene.composition();
  Insertion out{without_velocities(scene, composition.count()), 0, 0};
  const std::vector<SpeciesIndex> species = composition.in_order_of_id();
  const std::array<Gap, 3> gaps = gaps_of(scene);
  RodGrid grid(composition, box_at_start(scene), species.size());
  for (const std::size_t id : largest_first(composition, species)) {
    NeedleRandom random(scene.needles.seed, id);
    bool placed = false;
    const auto is_too_slow = [&] {
      return static_cast<double>(out.tries) > most_on_average * static_cast<double>(species.size());
    };
    for (std::uint64_t n = 0; n < most_tries && !placed && !is_too_slow(); ++n) {
      if (out.tries++ % 256 == 0) {
        StopRequest::check({"placing rods",
                            static_cast<double>(out.placed) / static_cast<double>(species.size())});
      }
      Vector &centre = out.state.position[id], &director = out.state.orientation[id];
      draw_place(random, gaps, out.state.box, composition[species[id]], centre, director);
      if (grid.overlap(centre, director, species[id], 0)) continue;
      grid.enter(centre, director, species[id]);
      placed = true;
    }
    if (!placed) return out;
    ++out.placed;
  }
  if (composition.is_mixture()) out.state.species = species;
  return out;
}

std::optional<State> place_rods_on_lattice(const Scene& scene, RodOrder order) {
  const Composition composition = scene.composition();
  const std::array<Gap, 3> gaps = gaps_of(scene);
  LatticeBox room;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Gap& gap = gaps[axis];
    room.periodic[axis] = !gap.is_walled();
    room.low[axis] = gap.low;
    room.high[axis] = scene.needles.box[axis] + gap.high;
  }
  double length = 0;
  for (const Species& each : composition.species()) length = std::max(length, each.length);
  State state = without_velocities(scene, composition.count());
  const double diameter = composition.widest();
  const auto lattice = order == RodOrder::parallel
                           ? rod_lattice(room, length, diameter, state.size())
                           : crossed_rods(room, length, diameter, state.size());
  if (!lattice) return std::nullopt;
  state.position = lattice->position;
  state.orientation = lattice->director;
  std::vector<SpeciesIndex> species = composition.in_order_of_id();
  // Which rod is where is drawn, so that a mixture begins mixed.
  for (std::size_t n = state.size(); n > 1; --n) {
    NeedleRandom random(scene.needles.seed, n - 1);
    const auto other = static_cast<std::size_t>(random.uniform() * static_cast<double>(n));
    std::swap(state.position[n - 1], state.position[other]);
    std::swap(state.orientation[n - 1], state.orientation[other]);
  }
  if (composition.is_mixture()) state.species = std::move(species);
  return state;
}

void draw_velocities(const Scene& scene, State& state) {
  const Composition composition = scene.composition();
  if (state.size() == 0) return;
  const std::vector<SpeciesIndex> species = composition.in_order_of_id(state.species);
  const Velocities velocities(composition);
  for (std::size_t id = 0; id < state.size(); ++id) {
    StopRequest::check_in_turn(id);
    NeedleRandom random(scene.needles.seed, id, RandomFor::velocities_of_rods, 0);
    velocities.draw(random, species[id], state, id);
  }
  velocities.adjust(species, state);
}

}  // namespace needlework
