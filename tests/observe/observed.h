// What tests of observables share: states made by hand, and the values that come of them.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "src/observe/observation.h"
#include "tests/support/runs.h"

namespace needlework::observe {

/// The fields of one observable, by name: the last row, or the values of a constant.
using Values = std::map<std::string, std::vector<double>>;

/// A scene of needles of length and mass 1 that calls for one observable.
inline Scene scene_with(const std::string& observable, std::size_t count, const Vector& box,
                        const std::array<int, 3>& cells = {1, 1, 1}) {
  Scene scene;
  scene.needles.count = count;
  scene.needles.box = box;
  scene.output.observables = {observable};
  scene.output.grid = cells;
  return scene;
}

/// `count` needles along z at rest at the origin.
inline State resting(std::size_t count, const Vector& box) {
  State state;
  state.resize(count);
  state.box = box;
  for (std::size_t i = 0; i < count; ++i) state.id[i] = static_cast<std::uint32_t>(i);
  std::fill(state.orientation.begin(), state.orientation.end(), Vector{0, 0, 1});
  return state;
}

inline const Vector flying_box{5, 5, 5};

/// Needles that fly with (3, 0, 4) across the boundaries, turn about y with 0.5 from z, and whose
/// velocities and angular velocities fall by 1 % in each unit of time.
inline State flying(double time) {
  State state = resting(4, flying_box);
  for (std::size_t i = 0; i < 4; ++i) {
    const Vector way{3 * time + double(i), 1, 4 * time};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double boxes = std::floor(way[axis] / 5);
      state.image[i][axis] = static_cast<std::int32_t>(boxes);
      state.position[i][axis] = way[axis] - 5 * boxes;
    }
    state.orientation[i] = {std::sin(0.5 * time), 0, std::cos(0.5 * time)};
    state.velocity[i] = {3 * std::pow(0.99, time), 0, 4 * std::pow(0.99, time)};
    state.angular_velocity[i] = {0, 0.5 * std::pow(0.99, time), 0};
  }
  return state;
}

/// Temperatures of the state, for mass 1 and this moment of inertia.
inline Totals totals_of(const State& state, double inertia, double time = 0) {
  Totals totals;
  totals.time = time;
  const double count = static_cast<double>(state.size());
  for (const Vector& v : state.velocity) totals.t_tr += dot(v, v) / (3 * count);
  for (const Vector& w : state.angular_velocity) {
    totals.t_rot += inertia * dot(w, w) / (2 * count);
  }
  totals.energy = 1.5 * totals.t_tr + totals.t_rot;
  return totals;
}

/// Sums of a gas in which nothing has happened yet, as the scene calls for them.
inline SpeciesSums no_sums(const Scene& scene) {
  SpeciesSums sums;
  sums.walls.resize(scene.wall_sides().size());
  sums.energy.walls.resize(sums.walls.size());
  if (scene.driving.andersen) sums.energy.thermostat = 0;
  if (scene.driving.growth) sums.energy.growth = sums.energy.cooling = 0;
  if (scene.driving.kicks) sums.energy.kicks = 0;
  if (scene.shear) sums.energy.shear = 0;
  return sums;
}

/// The observation of one observable.
class Observed {
 public:
  explicit Observed(const Scene& scene)
      : inertia_(setting_of(scene).inertia),
        name_(scene.output.observables.front()),
        sums_(no_sums(scene)),
        all_(scene) {}

  Values sample(const State& state, double time = 0) {
    return sample(state, totals_of(state, inertia_, time));
  }
  Values sample(const State& state, const Totals& totals) {
    const auto row = all_.sample(state, totals, sums_);
    Values out;
    auto next = row.begin();
    for (const SeriesGroup& group : all_.groups()) {
      Values fields;
      for (const SeriesField& field : group.fields) {
        if (field.kind == SeriesField::Kind::constant) {
          EXPECT_EQ(field.values.size(), field.width()) << field.name;
          fields[field.name] = field.values;
        } else {
          fields[field.name].assign(next, next + static_cast<std::ptrdiff_t>(field.width()));
          next += static_cast<std::ptrdiff_t>(field.width());
        }
      }
      // Beside it is what every file of such a gas has.
      if (group.name == name_) out = std::move(fields);
    }
    return out;
  }
  void collision(const Collision& collision) { all_.collision(collision); }

 private:
  double inertia_;
  std::string name_;
  SpeciesSums sums_;
  Observation all_;
};

inline double sum(const std::vector<double>& values) {
  double total = 0;
  for (const double value : values) total += value;
  return total;
}

}  // namespace needlework::observe
