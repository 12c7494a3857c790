// Linked cells as classical codes and the paper have them: the box is cut into cells of about the
// length of a needle, or larger where there would be more than two cells for each needle. Each cell
// has a linked list of its needles. Simple, and slow in dense gases, since a cell cannot be smaller
// than a needle: the baseline of every benchmark. Where rows of boxes slide, rows of cells do
// (sliding_rows.h).
//
// Why no pair is left out: a needle is placed again before it is out of its cell by more than a
// margin, and cells are longer than the longest needle by at least four of these. So two in contact
// are in one cell or in neighbouring ones, and all 27 are looked through; of another row that
// slides, those that come so near in the time ahead.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "src/memory/prefetch.h"
#include "src/search/bounding_filter.h"
#include "src/search/cell_grid.h"
#include "src/search/search.h"
#include "src/search/setup.h"
#include "src/search/sliding_rows.h"

namespace needlework {

class LinkedLists {
 public:
  static constexpr const char* search_name = "linked-lists";

  /// `gas` must outlive the search; needles are entered by place().
  LinkedLists(const Gas& gas, Counters& counters, const SearchSetup& setup);

  const char* name() const { return search_name; }
  std::size_t cells() const { return grid_.size(); }
  std::uint32_t cell_index(Needle i) const {
    return static_cast<std::uint32_t>(grid_.index_of(place_[i].cell));
  }
  void prefetch(Needle i) const { needlework::prefetch(&place_[i]); }
  Time place(Needle i, Time now, double half_length);
  void set_next_event(Needle, Time) {}
  Time next_event(Needle) const { return Time::never(); }
  void begin_again(Time now) {
    if (rows_) rows_->begin_again(now);
  }
  void renumber(const std::vector<Needle>& ranks);

  template <class Visit>
  void find(const SearchQuery& query, const Lengths auto& lengths, Visit&& visit) const {
    const Needle i = query.needle;
    BoundingFilter filter(gas_, counters_, query, lengths);
    if (rows_) return find_in_rows(query, filter, visit);
    grid_.for_each_around(place_[i].cell, [&](const Cell& cell, std::size_t index) {
      for_each_in(index, i, [&](Needle j) {
        // Cells that come round to those at the other wall hold no neighbours.
        const Shift shift = grid_.boxes_between(cell, place_[j].cell);
        if (gas_.box.has_image(shift)) filter(j, shift, visit);
      });
    });
  }

  const CellGrid& grid() const { return grid_; }

 private:
  struct Place {
    Cell cell{};
    bool linked = false;
    Needle next, previous;
    Shift wraps{};  ///< if cells slide in rows: boxes subtracted from the centre of its record
  };

  // An image of needle i itself is at least two needle lengths away.
  template <class Visit>
  void for_each_in(std::size_t cell, Needle i, Visit&& visit) const {
    for (Needle j = head_[cell]; j != no_needle; j = place_[j].next) {
      if (j != i) visit(j);
    }
  }
  // From the frame of each row.
  template <class Filter, class Visit>
  void find_in_rows(const SearchQuery& query, Filter& filter, Visit& visit) const {
    const Place& own = place_[query.needle];
    const SlidingRows::Present rows(*rows_, query.now);
    for (std::int32_t y = own.cell[1] - 1; y <= own.cell[1] + 1; ++y) {
      const auto beside = rows.beside(own.cell[1], *rows_, y);
      const auto [first, last] = columns_near(query, rows, beside);
      for (std::int32_t z = own.cell[2] - 1; z <= own.cell[2] + 1; ++z) {
        for (std::int32_t x = first; x <= last; ++x) {
          const Cell cell{x, y, z};
          for_each_in(grid_.index_of(cell), query.needle, [&](Needle j) {
            const Shift shift = grid_.boxes_between(cell, place_[j].cell) +
                                Shift{beside.boxes, 0, 0} + own.wraps - place_[j].wraps;
            if (gas_.box.has_image(shift)) filter(j, shift, visit);
          });
        }
      }
    }
  }
  /// The first and the last one, along x, of the cells of a row that it comes near.
  std::pair<std::int32_t, std::int32_t> columns_near(const SearchQuery& query,
                                                     const SlidingRows::Present& rows,
                                                     const SlidingRows::Beside& beside) const;
  double enter(Needle i, const MotionFrom<FreeFlight>& motion);
  Time place_in_row(Needle i, Time now);
  void carry_rows(Time now);
  void link(Needle i);
  void unlink(Needle i);

  const Gas& gas_;
  Counters& counters_;
  double margin_;  ///< of cells [L]
  CellGrid grid_;
  std::vector<Needle> head_;
  std::vector<Place> place_;
  std::optional<SlidingRows> rows_;
};

static_assert(Search<LinkedLists>);

}  // namespace needlework
