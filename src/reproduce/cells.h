// The fields of a run in the cells of its grid at one sample.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "src/reproduce/paper_runs.h"

namespace needlework::reproduce {

/// The collisions per needle after which the paper shows the dense gas.
inline constexpr double shown_collisions = 600;
/// The same if the paper counts each collision once, and not for both needles.
inline constexpr double shown_collisions_once = 2 * shown_collisions;

struct CellFields {
  std::array<std::size_t, 3> cells{};
  std::array<double, 3> box{};
  double collisions = 0;                    ///< per needle
  double t_tr = 0;                          ///< of the whole gas
  std::vector<double> excess;               ///< density / mean - 1, the last axis fastest
  std::vector<std::array<double, 3>> flow;  ///< mean velocities

  std::size_t index(const std::array<std::size_t, 3>& place) const {
    return (place[0] * cells[1] + place[1]) * cells[2] + place[2];
  }
  /// The middle of a cell along an axis.
  double middle(std::size_t axis, std::size_t place) const {
    return (static_cast<double>(place) + 0.5) * box[axis] / static_cast<double>(cells[axis]);
  }
  /// The borders of the cells along an axis.
  std::vector<double> edges(std::size_t axis) const;
};

/// All places of a grid in the order of the cells.
template <class Action>
void for_each_cell(const std::array<std::size_t, 3>& cells, Action action) {
  for (std::size_t x = 0; x < cells[0]; ++x)
    for (std::size_t y = 0; y < cells[1]; ++y)
      for (std::size_t z = 0; z < cells[2]; ++z) action(std::array{x, y, z});
}

CellFields cell_fields(const FinishedRun& run, std::size_t sample);

/// The wave of the flow with the most energy among those of the mean flow of slabs across an axis.
struct ShearWave {
  std::size_t gradient = 0;  ///< the axis along which the flow changes
  std::size_t along = 1;     ///< the component of the flow that changes
  std::size_t number = 1;    ///< waves in the box; each is two bands
  double share = 0;          ///< of the energy of the flow
};

ShearWave strongest_shear_wave(const CellFields& fields);

/// Share of the cells with more than 1.5 times the mean density.
double dense_share(const CellFields& fields);
inline constexpr double dense_excess = 0.5;

/// Correlation coefficient over the cells of the density and the energy of the flow, U^2.
double density_flow_correlation(const CellFields& fields);

}  // namespace needlework::reproduce
