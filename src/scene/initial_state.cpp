// Draws initial states: the equilibrium of an ideal gas in centres, directors and velocities.
#include "needlework/initial_state.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "src/machine/stop_request.h"
#include "src/random/needle_random.h"
#include "src/scene/confinement.h"
#include "src/scene/scene_values.h"

namespace needlework {
namespace {

using Vector = std::array<double, 3>;

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
    const Species& first = *std::max_element(
        all.begin(), all.end(),
        [&](const Species& a, const Species& b) { return square(a) < square(b); });
    const double count = static_cast<double>(composition.count());
    for (const Species& s : all) {
      factors.push_back(square(first) > 0 ? std::sqrt(square(s) / square(first)) : 0);
      weights.push_back(weight(s) / weight(first));
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
                double half_length, Vector& centre, Vector& director) {
  const auto is_inside = [&] {
    for (std::size_t i = 0; i < 3; ++i) {
      const double reach = half_length * std::abs(director[i]);
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

}  // namespace

State draw_initial_state(const Scene& scene) {
  require_drawable(scene);
  const Scene::Needles& needles = scene.needles;
  const Composition composition = scene.composition();
  State state;
  state.box = needles.box;
  const auto n = static_cast<std::size_t>(composition.count());
  state.position.resize(n);
  state.velocity.resize(n);
  state.orientation.resize(n);
  state.angular_velocity.resize(n);
  if (n == 0) return state;
  std::vector<SpeciesIndex> species = composition.in_order_of_id();
  const Drawn flight(
      composition, [](const Species& s) { return 3 * s.t_tr / s.mass; },
      [](const Species& s) { return s.mass; });
  // <I w^2 / 2> = t_rot with I = m L^2 / (2 k).
  const Drawn rotation(
      composition,
      [](const Species& s) { return 4 * s.k * s.t_rot / (s.mass * (s.length * s.length)); },
      [](const Species& s) { return s.inertia(); });
  const std::array<Gap, 3> gaps = gaps_of(scene);
  for (std::size_t id = 0; id < n; ++id) {
    StopRequest::check_in_turn(id);
    NeedleRandom random(needles.seed, id);
    draw_place(random, gaps, needles.box, 0.5 * composition[species[id]].length, state.position[id],
               state.orientation[id]);
    state.velocity[id] = random.normal();
    for (double& v : state.velocity[id]) v *= flight.factors[species[id]];
    state.angular_velocity[id] = normal_part(random.normal(), state.orientation[id]);
    for (double& w : state.angular_velocity[id]) w *= rotation.factors[species[id]];
  }
  StopRequest::check();
  if (n >= 2) remove_mean(state.velocity, species, flight.weights);
  set_mean_square(state.velocity, species, flight);
  set_mean_square(state.angular_velocity, species, rotation);
  if (composition.is_mixture()) state.species = std::move(species);
  return state;
}

}  // namespace needlework
