// Draws initial states: the equilibrium of an ideal gas in centres, directors and velocities.
#include "needlework/initial_state.h"

#include <array>
#include <cmath>
#include <vector>

#include "src/machine/stop_request.h"
#include "src/scene/random.h"
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

void remove_mean(std::vector<Vector>& vectors) {
  std::array<Sum, 3> sums;
  for (const Vector& v : vectors)
    for (std::size_t i = 0; i < 3; ++i) sums[i].add(v[i]);
  const auto n = static_cast<double>(vectors.size());
  const Vector mean{sums[0].value() / n, sums[1].value() / n, sums[2].value() / n};
  for (Vector& v : vectors)
    for (std::size_t i = 0; i < 3; ++i) v[i] -= mean[i];
}

// Scales all vectors by one factor, so that they have the given mean square.
void set_mean_square(std::vector<Vector>& vectors, double mean_square) {
  if (mean_square == 0) {
    for (Vector& v : vectors) v = {};  // a factor 0 would leave signs on the zeros
    return;
  }
  Sum sum;
  for (const Vector& v : vectors) sum.add(dot(v, v));
  if (sum.value() == 0) return;  // no needles
  const double factor =
      std::sqrt(mean_square / (sum.value() / static_cast<double>(vectors.size())));
  for (Vector& v : vectors)
    for (double& component : v) component *= factor;
}

}  // namespace

State draw_initial_state(const Scene& scene) {
  require_drawable(scene);
  const Scene::Needles& needles = scene.needles;
  const Scene::Species species = scene.one_species();
  State state;
  state.box = needles.box;
  const auto n = static_cast<std::size_t>(species.count);
  state.position.resize(n);
  state.velocity.resize(n);
  state.orientation.resize(n);
  state.angular_velocity.resize(n);
  for (std::size_t id = 0; id < n; ++id) {
    StopRequest::check_in_turn(id);
    NeedleRandom random(needles.seed, id);
    // A product with a number below 1 never rounds up to the edge itself.
    for (std::size_t i = 0; i < 3; ++i) state.position[id][i] = random.uniform() * needles.box[i];
    state.orientation[id] = random.direction();
    state.velocity[id] = random.normal();
    state.angular_velocity[id] = normal_part(random.normal(), state.orientation[id]);
  }
  StopRequest::check();
  if (n >= 2) remove_mean(state.velocity);
  set_mean_square(state.velocity, 3 * species.t_tr / species.mass);
  // <I w^2 / 2> = t_rot with I = m L^2 / (2 k).
  set_mean_square(state.angular_velocity, 4 * species.k * species.t_rot /
                                              (species.mass * (species.length * species.length)));
  return state;
}

}  // namespace needlework
