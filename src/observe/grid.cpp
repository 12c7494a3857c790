#include "src/observe/grid.h"

#include <algorithm>
#include <cmath>

namespace needlework::observe {

bool Grid::holds(const Vector& position) const {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double along = position[axis] - low_[axis];
    if (!(along >= 0 && along <= box_[axis])) return false;
  }
  return true;
}

std::size_t Grid::cell_of(const Vector& position) const {
  std::size_t cell = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double along = (position[axis] - low_[axis]) / box_[axis] * cells_[axis];
    const int n = static_cast<int>(std::clamp<double>(along, 0, cells_[axis] - 1));
    cell = cell * static_cast<std::size_t>(cells_[axis]) + static_cast<std::size_t>(n);
  }
  return cell;
}

std::array<int, 3> default_cells(const Vector& box, std::size_t count) {
  constexpr double needles_in_a_cell = 20;
  constexpr double most = 100;
  const double volume = box[0] * box[1] * box[2];
  const double cells = std::max(1.0, static_cast<double>(count) / needles_in_a_cell);
  const double side = std::cbrt(volume / cells);
  std::array<int, 3> out{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    out[axis] = static_cast<int>(std::clamp(std::round(box[axis] / side), 1.0, most));
  }
  return out;
}

CellMeans means_in_cells(const Grid& grid, const State& state, const Weights& weights) {
  const std::size_t cells = grid.size();
  CellMeans out{.count = std::vector<double>(cells),
                .mass = std::vector<double>(cells),
                .inertia = std::vector<double>(cells),
                .flow = std::vector<Vector>(cells),
                .spin = std::vector<Vector>(cells),
                .flow_v2 = std::vector<double>(cells),
                .spin_w2 = std::vector<double>(cells)};
  std::vector<std::size_t> cell_of(state.size());
  for (std::size_t i = 0; i < state.size(); ++i) {
    const bool is_inside = grid.holds(state.position[i]);
    const std::size_t cell = cell_of[i] = is_inside ? grid.cell_of(state.position[i]) : cells;
    if (!is_inside) continue;
    ++out.count[cell];
    const double mass = weights.mass(i), inertia = weights.inertia(i);
    out.mass[cell] += mass;
    out.inertia[cell] += inertia;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      out.flow[cell][axis] += mass * state.velocity[i][axis];
      out.spin[cell][axis] += inertia * state.angular_velocity[i][axis];
    }
  }
  for (std::size_t cell = 0; cell < cells; ++cell) {
    if (out.count[cell] == 0) continue;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      out.flow[cell][axis] /= out.mass[cell];
      out.spin[cell][axis] /= out.inertia[cell];
    }
  }
  for (std::size_t i = 0; i < state.size(); ++i) {
    const std::size_t cell = cell_of[i];
    if (cell == cells) continue;
    const Vector v = minus(state.velocity[i], out.flow[cell]);
    const Vector w = minus(state.angular_velocity[i], out.spin[cell]);
    out.flow_v2[cell] += weights.mass(i) * dot(v, v);
    out.spin_w2[cell] += weights.inertia(i) * dot(w, w);
  }
  for (std::size_t cell = 0; cell < cells; ++cell) {
    const double count = std::max(out.count[cell], 1.0);
    out.flow_v2[cell] /= count;
    out.spin_w2[cell] /= count;
  }
  return out;
}

}  // namespace needlework::observe
