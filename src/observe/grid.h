// Sums over the needles in each cell of a grid, which several observables share.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "needlework/state.h"
#include "src/observe/vector.h"

namespace needlework::observe {

/// Equal cells that fill the box, which begins at 0 or where its low edges are. The last axis runs
/// fastest, as in the rows of a file.
class Grid {
 public:
  Grid(const Vector& box, const std::array<int, 3>& cells, const Vector& low = {})
      : box_(box), low_(low), cells_(cells) {}

  std::size_t size() const {
    return static_cast<std::size_t>(cells_[0]) * static_cast<std::size_t>(cells_[1]) *
           static_cast<std::size_t>(cells_[2]);
  }
  /// Whether a position is inside the box. Needles leave it by an open side, and where a wall has
  /// moved outwards.
  bool holds(const Vector& position) const;
  /// The cell of a position, that next to it if it is outside the box.
  std::size_t cell_of(const Vector& position) const;
  double cell_volume() const { return box_[0] * box_[1] * box_[2] / static_cast<double>(size()); }

 private:
  Vector box_, low_;
  std::array<int, 3> cells_;
};

/// The number of cells along each axis such that a cell is nearly a cube and holds about 20
/// needles, which is what the definition of the order of the flow is meant for; at most 100.
std::array<int, 3> default_cells(const Vector& box, std::size_t count);

/// Masses and moments of inertia of the needles of a state in those of their species; empty where
/// all are 1. Fixed needles, which have no velocities to weigh, have 1. [1]
struct Weights {
  std::vector<double> masses = {}, inertias = {};

  double mass(std::size_t i) const { return masses.empty() ? 1 : masses[i]; }
  double inertia(std::size_t i) const { return inertias.empty() ? 1 : inertias[i]; }
};

/// What is in each cell. A cell without needles has zeros; needles outside the box are in none.
struct CellMeans {
  std::vector<double> count;          ///< number of needles
  std::vector<double> mass, inertia;  ///< of them, in those of their species
  std::vector<Vector> flow;           ///< U, mean velocity by mass
  std::vector<Vector> spin;           ///< mean angular velocity by moment of inertia
  std::vector<double> flow_v2;        ///< mean of |v - U|^2, each times its mass
  std::vector<double> spin_w2;        ///< mean of |w - spin|^2, each times its moment of inertia
};

/// Sums in the order of the needles in the state, so that they depend on nothing else. Deviations
/// are summed after the means are known, so that they are never negative, and exactly 0 where all
/// velocities are equal and have few digits.
CellMeans means_in_cells(const Grid& grid, const State& state, const Weights& weights);

}  // namespace needlework::observe
