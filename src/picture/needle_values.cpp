#include "src/picture/needle_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "src/box/box.h"
#include "src/picture/camera.h"

namespace needlework::picture {
namespace {

// Whether it has an infinite mass; of a file that does not say masses, none has.
bool is_fixed(const State& state, std::size_t i) {
  const std::vector<double>&own = state.own_bodies.mass, &all = state.bodies.mass;
  if (!own.empty()) return std::isinf(own[i]);
  const std::size_t species = state.species.empty() ? 0 : state.species[i];
  return species < all.size() && std::isinf(all[species]);
}

// Of the needles that move.
double root_mean_square(const std::vector<double>& values, const State& state) {
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (is_fixed(state, i)) continue;
    sum += values[i] * values[i];
    ++count;
  }
  return count > 0 ? std::sqrt(sum / count) : 0;
}

// Divides by the root mean square, which is named in the label.
void make_relative(NeedleValues& result, const State& state, const std::string& name) {
  const double unit = root_mean_square(result.values, state);
  if (unit > 0) {
    for (double& value : result.values) value /= unit;
  }
  result.label = fmt::format("{} / {:.3g} (rms)", name, unit);
}

std::vector<double> lengths(const std::vector<Vector>& vectors) {
  std::vector<double> lengths;
  lengths.reserve(vectors.size());
  for (const Vector& v : vectors) lengths.push_back(std::hypot(v[0], v[1], v[2]));
  return lengths;
}

// Q = 3 (u . v)^2 / v^2 - 1, as the observable `alignment` has it; 0, its mean, for needles at
// rest.
std::vector<double> alignments(const State& state, const std::vector<Vector>& velocities) {
  std::vector<double> all;
  for (std::size_t i = 0; i < state.size(); ++i) {
    const Vector& v = velocities[i];
    const double speed = std::hypot(v[0], v[1], v[2]);
    const double cosine = speed > 0 ? dot(state.orientation[i], v) / speed : std::sqrt(1.0 / 3);
    all.push_back(3 * cosine * cosine - 1);
  }
  return all;
}

// Finds the centres around each centre, with cells at least as wide as the radius.
class Neighbours {
 public:
  Neighbours(const State& state, double radius)
      : state_(state), box_(box_of(state)), radius_(radius) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      count_[axis] =
          static_cast<std::size_t>(std::clamp(std::floor(box_.edge(axis) / radius), 1.0, 200.0));
    }
    cells_.resize(count_[0] * count_[1] * count_[2]);
    for (std::size_t i = 0; i < state.size(); ++i) {
      cells_[number(cell_of(i))].push_back(i);
    }
  }

  /// action(j) for each needle whose centre is within the radius of that of needle i, without i.
  template <class Action>
  void for_each(std::size_t i, Action action) const {
    const Cell cell = cell_of(i);
    Cell other;
    for_neighbours(cell[1], count_[1], [&](std::size_t y) {
      for_columns(cell, y, [&](std::size_t x) {
        for_neighbours(cell[2], count_[2], [&](std::size_t z) {
          other = {x, y, z};
          for (const std::size_t j : cells_[number(other)]) {
            if (j != i && are_near(i, j)) action(j);
          }
        });
      });
    });
  }

 private:
  using Cell = std::array<std::size_t, 3>;

  // Each of the cells around this one once, although the box is periodic.
  template <class Action>
  static void for_neighbours(std::size_t cell, std::size_t count, Action action) {
    action(cell);
    if (count > 1) action((cell + 1) % count);
    if (count > 2) action((cell + count - 1) % count);
  }

  // Along x, of a row of cells beside that of this cell. Across the border along y cells are not
  // beside those of the same number if rows of boxes have slid, so all are looked at: few needles
  // are there.
  template <class Action>
  void for_columns(const Cell& cell, std::size_t row, Action action) const {
    const bool across = count_[1] <= 2 || std::max(cell[1], row) - std::min(cell[1], row) > 1;
    if (state_.slide == 0 || !across) return for_neighbours(cell[0], count_[0], action);
    for (std::size_t x = 0; x < count_[0]; ++x) action(x);
  }

  std::size_t number(const Cell& cell) const {
    return (cell[2] * count_[1] + cell[1]) * count_[0] + cell[0];
  }
  Cell cell_of(std::size_t i) const {
    const Vector share = box_.share(state_.position[i]);
    Cell cell;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double place = share[axis] * static_cast<double>(count_[axis]);
      cell[axis] = std::min(static_cast<std::size_t>(place), count_[axis] - 1);
    }
    return cell;
  }
  bool are_near(std::size_t i, std::size_t j) const {
    const Vector &a = state_.position[i], &b = state_.position[j];
    const Vec3d apart = box_.shortest({a[0] - b[0], a[1] - b[1], a[2] - b[2]});
    return dot(apart, apart) < radius_ * radius_;
  }

  const State& state_;
  Box box_;
  double radius_;
  Cell count_;
  std::vector<std::vector<std::size_t>> cells_;
};

/// What is around each needle: a ball that holds 30 others in the mean, or the largest that fits
/// into the box.
struct Ball {
  double radius;
  double mean;  ///< number of others in it

  explicit Ball(const State& state) {
    constexpr double wanted = 30, unit = 4 * std::numbers::pi / 3;
    const double others = static_cast<double>(state.size()) - 1;
    const double volume = state.box[0] * state.box[1] * state.box[2];
    const double shortest = *std::min_element(state.box.begin(), state.box.end());
    radius = std::min(std::cbrt(wanted * volume / (others * unit)), shortest / 2);
    mean = others * unit * radius * radius * radius / volume;
  }
};

// Density of centres around each centre, as a multiple of the mean; chance alone changes it by a
// fifth.
std::vector<double> densities(const State& state) {
  if (state.size() < 2) return std::vector<double>(state.size(), 1.0);
  const Ball ball(state);
  const Neighbours neighbours(state, ball.radius);
  std::vector<double> all;
  for (std::size_t i = 0; i < state.size(); ++i) {
    double found = 0;
    neighbours.for_each(i, [&](std::size_t) { ++found; });
    all.push_back(found / ball.mean);
  }
  return all;
}

// A component of the mean velocity of each needle and those around it.
std::vector<double> flows(const State& state, const std::vector<Vector>& velocities,
                          std::size_t axis) {
  if (state.size() < 2) return std::vector<double>(state.size(), 0.0);
  const Neighbours neighbours(state, Ball(state).radius);
  std::vector<double> all;
  for (std::size_t i = 0; i < state.size(); ++i) {
    double sum = velocities[i][axis], count = 1;
    neighbours.for_each(i, [&](std::size_t j) {
      sum += velocities[j][axis];
      ++count;
    });
    all.push_back(sum / count);
  }
  return all;
}

// The axis along which most needles lie: the eigenvector of the largest eigenvalue of the mean of
// u u, which has none below 0, by powers of it.
Vector axis_of_order(const State& state) {
  std::array<Vector, 3> squares{};
  for (const Vector& u : state.orientation) {
    for (std::size_t a = 0; a < 3; ++a) {
      for (std::size_t b = 0; b < 3; ++b) squares[a][b] += u[a] * u[b];
    }
  }
  Vector axis{1, 1.1, 1.2};  // across no axis of the box
  for (int power = 0; power < 200; ++power) {
    const Vector next{dot(squares[0], axis), dot(squares[1], axis), dot(squares[2], axis)};
    const double length = std::hypot(next[0], next[1], next[2]);
    if (!(length > 0)) break;  // no needles
    for (std::size_t a = 0; a < 3; ++a) axis[a] = next[a] / length;
  }
  return axis;
}

// Angle between each needle and the axis of order [degrees].
std::vector<double> tilts(const State& state) {
  const Vector axis = axis_of_order(state);
  const double length = std::hypot(axis[0], axis[1], axis[2]);
  std::vector<double> all;
  for (const Vector& u : state.orientation) {
    const double cosine = std::min(std::abs(dot(u, axis)) / length, 1.0);
    all.push_back(std::acos(cosine) * 180 / std::numbers::pi);
  }
  return all;
}

}  // namespace

const std::vector<std::string>& quantities() {
  static const std::vector<std::string> all{
      "speed",  "spin",      "vx",      "vy",      "vz",          "flow-x", "flow-y",
      "flow-z", "alignment", "density", "species", "orientation", "none"};
  return all;
}

std::vector<Vector> velocities_beside_flow(const State& state) {
  if (state.peculiar_velocity.size() == state.size()) return state.peculiar_velocity;
  std::vector<Vector> all = state.velocity;
  if (state.shear_rate == 0) return all;
  for (std::size_t i = 0; i < all.size(); ++i) all[i][0] -= state.shear_rate * state.position[i][1];
  return all;
}

NeedleValues values_of(const std::string& quantity, const State& state, bool dark) {
  NeedleValues result{{}, "", {0, 2}, sequential_gradient(dark)};
  const std::vector<Vector> velocities = velocities_beside_flow(state);
  if (quantity == "speed") {
    result.values = lengths(velocities);
    make_relative(result, state, "speed");
  } else if (quantity == "spin") {
    result.values = lengths(state.angular_velocity);
    make_relative(result, state, "spin");
  } else if (quantity == "vx" || quantity == "vy" || quantity == "vz") {
    const auto axis = static_cast<std::size_t>(quantity[1] - 'x');
    for (const Vector& v : velocities) result.values.push_back(v[axis]);
    make_relative(result, state, quantity);
    result.range = {-2, 2};
    result.gradient = diverging_gradient(dark);
  } else if (quantity == "flow-x" || quantity == "flow-y" || quantity == "flow-z") {
    result.values = flows(state, velocities, static_cast<std::size_t>(quantity.back() - 'x'));
    const double unit = root_mean_square(lengths(velocities), state) / std::sqrt(3);
    if (unit > 0) {
      for (double& value : result.values) value /= unit;
    }
    result.label = fmt::format("{} / {:.3g} (thermal)", quantity, unit);
    result.range = {-1.5, 1.5};
    result.gradient = diverging_gradient(dark);
  } else if (quantity == "alignment") {
    result.values = alignments(state, velocities);
    result.label = "alignment of needle and velocity";
    result.range = {-1, 2};
  } else if (quantity == "density") {
    result.values = densities(state);
    result.label = "density / mean density";
  } else if (quantity == "species") {
    result.values.assign(state.species.begin(), state.species.end());
    result.values.resize(state.size());  // of one species, states need not say it
    const auto last = std::max_element(result.values.begin(), result.values.end());
    result.label = "species, from 0 in the order of the scene";
    result.range = {0, last == result.values.end() ? 1 : std::max(*last, 1.0)};
  } else if (quantity == "orientation") {
    result.values = tilts(state);
    result.label = "angle to the mean axis / degrees";
    result.range = {0, 90};
  } else if (quantity == "none") {
    result.values.assign(state.size(), 1.0);
  } else {
    throw std::invalid_argument("quantity " + quantity);
  }
  return result;
}

}  // namespace needlework::picture
