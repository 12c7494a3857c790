// Linked cells as classical codes and the paper have them: the box is cut into cells of about the
// length of a needle, or larger where there would be more than two cells for each needle. Each cell
// has a linked list of its needles. Simple, and slow in dense gases, since a cell cannot be smaller
// than a needle: the baseline of every benchmark.
//
// Why no pair is left out: a needle is placed again before it is out of its cell by more than a
// margin, and cells are longer than the longest needle by at least four of these. So two in contact
// are in one cell or in neighbouring ones, and all 27 are looked through.
#pragma once

#include <vector>

#include "src/memory/prefetch.h"
#include "src/search/bounding_filter.h"
#include "src/search/cell_grid.h"
#include "src/search/search.h"
#include "src/search/setup.h"

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
  void begin_again(Time) {}
  void renumber(const std::vector<Needle>& ranks);

  template <class Visit>
  void find(const SearchQuery& query, const Lengths auto& lengths, Visit&& visit) const {
    const Needle i = query.needle;
    BoundingFilter filter(gas_, counters_, query, lengths);
    grid_.for_each_around(place_[i].cell, [&](const Cell& cell, std::size_t index) {
      for (Needle j = head_[index]; j != no_needle; j = place_[j].next) {
        // An image of i itself is at least two needle lengths away. Cells that come round to those
        // at the other wall hold no neighbours.
        if (j == i) continue;
        const Shift shift = grid_.boxes_between(cell, place_[j].cell);
        if (gas_.box.has_image(shift)) filter(j, shift, visit);
      }
    });
  }

  const CellGrid& grid() const { return grid_; }

 private:
  struct Place {
    Cell cell{};
    bool linked = false;
    Needle next, previous;
  };

  void link(Needle i);
  void unlink(Needle i);

  const Gas& gas_;
  Counters& counters_;
  double margin_;  ///< of cells [L]
  CellGrid grid_;
  std::vector<Needle> head_;
  std::vector<Place> place_;
};

static_assert(Search<LinkedLists>);

}  // namespace needlework
