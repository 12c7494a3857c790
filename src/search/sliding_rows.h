// Uniform shear: rows of cells that slide along x with the flow.
//
// Why no pair is left out: each row is a frame of reference of its own, in which its bodies fly
// along straight lines and their cells are at rest; they are as fast there as in a gas without
// shear, but for what the flow differs within a row. A body that searches looks into each row that
// comes within its reach from that row's frame: from the place and with the velocity that it has
// there. So what is shown for bodies and cells at rest (in_cells.h) holds for each row. The row
// next to the last is the first one of the row of boxes above, which has slid by what the box says.
#pragma once

#include <cstdint>
#include <vector>

#include "src/physics/gas.h"
#include "src/search/cell_grid.h"

namespace needlework {

class SlidingRows {
 public:
  /// `gas` and `grid` must outlive it.
  SlidingRows(const Gas& gas, const CellGrid& grid);

  /// All bodies will be placed now.
  void begin_again(Time now);
  /// Brings the places of rows into the box. Returns by how many boxes each is less than it was, by
  /// which its bodies are to be wrapped more.
  std::vector<std::int32_t> carry(Time now);
  /// Of what follows.
  void set_now(Time now);

  /// A body as its row sees it: the one into whose cells it is placed, so far ahead of where it is.
  struct Seen {
    kernels::Flight flight;  ///< since its record
    Shift boxes;             ///< less than that of the record, along x modulo 2^32
  };
  Seen see(const Record& record, double elapsed, double ahead) const;
  /// The same of a body that stays in this row, and where it has been wrapped by so many boxes.
  kernels::Flight see_from(std::int32_t row, const Shift& boxes, const Record& record,
                           double elapsed) const;

  /// A row, by its number along y, which may be beyond the box, as another one sees it.
  struct Beside {
    double place, velocity;  ///< along x [L, L / time]
    /// The boxes to be added to a body that is found in it, besides those between cells.
    std::int32_t boxes;
  };
  Beside beside(std::int32_t row, std::int32_t other) const;

 private:
  double velocity_of(double row) const { return gas_.shear->velocity() * (row / rows_); }
  double place_of(std::int32_t row) const;

  const Gas& gas_;
  const CellGrid& grid_;
  double rows_;                 ///< number of them in the box
  std::vector<double> places_;  ///< along x, of the rows of the box, at `base_` [L]
  Time base_, now_;
  Box box_;  ///< now
};

}  // namespace needlework
