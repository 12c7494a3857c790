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
  /// `gas` must outlive it, as its rows do.
  SlidingRows(const Gas& gas, const CellGrid& grid);

  /// All bodies will be placed now.
  void begin_again(Time now);
  /// Brings the places of rows into the box. Returns by how many boxes each is less than it was, by
  /// which its bodies are to be wrapped more.
  std::vector<std::int32_t> carry(Time now);

  /// A body as its row sees it: the one into whose cells it is placed.
  struct Seen {
    kernels::Flight flight;  ///< since its record
    Shift boxes;             ///< less than that of the record, along x modulo 2^32
    std::int32_t row;
  };
  /// A row, by its number along y, which may be beyond the box, as another one sees it.
  struct Beside {
    double place, velocity;  ///< along x [L, L / time]
    /// The boxes to be added to a body that is found in it, besides those between cells.
    std::int32_t boxes;
  };

  /// The rows at one instant.
  class Present {
   public:
    Present(const SlidingRows& rows, Time now)
        : rows_(rows), box_(rows.gas_.box_at<double>(now)), elapsed_(rows.since_base(now)) {}

    /// A body whose place in a cell is so far ahead along y of where it is. [L]
    Seen see(const Record& record, double elapsed, double ahead) const;
    /// The same of a body that stays in this row, and where it has been wrapped by so many boxes.
    kernels::Flight see_from(std::int32_t row, const Shift& boxes, const Record& record,
                             double elapsed) const;
    /// A row of cells of another size class, or of the same, as this row sees it.
    Beside beside(std::int32_t row, const SlidingRows& there, std::int32_t other) const;

   private:
    const SlidingRows& rows_;
    Box box_;
    double elapsed_;  ///< since the places of rows [time]
  };

  /// By how much a row slides past the next one. [L / time]
  double slide() const { return velocity_of(1); }
  /// Time since the places of rows were brought into the box.
  double age(Time now) const { return since_base(now); }

 private:
  double since_base(Time now) const { return gas_.clock.difference(now, base_); }
  double velocity_of(double row) const { return gas_.shear->velocity() * (row / rows_); }
  double place_of(std::int32_t row, double elapsed) const {
    return places_[row] + velocity_of(row + 0.5) * elapsed;
  }

  const Gas& gas_;
  CellGrid grid_;
  double rows_;                 ///< number of them in the box
  std::vector<double> places_;  ///< along x, of the rows of the box, at `base_` [L]
  Time base_;
};

}  // namespace needlework
