#include "src/search/cell_scan.h"

#include <algorithm>

#include "src/search/between_classes.h"
#include "src/search/volumes.h"

namespace needlework {
namespace {

// Far more than rounding does to the place of a bounding volume. [unit of length]
constexpr float volume_margin = 0x1p-12f;
// Motions of so many needles are near enough to the core that a scan takes longer if it prefetches
// them. Measured: that costs 1 to 3 % of the time of 1e4 to 3e4 needles, and saves 2 to 4 % of that
// of 1e5 and 1e6.
constexpr std::size_t motions_in_cache = std::size_t{1} << 15;

}  // namespace

kernels::Scan CellScan::look(Needle i, double ahead) {
  const ClassCells& own = volumes_.class_of(i);
  views_.clear();
  return with_volume(own.kind, [&]<class Own>(Own) {
    set_first<Own>(own, i, ahead);
    return looks_.size() == 1 ? look_into_one_class<Own>(ahead) : look_into_classes<Own>(i, ahead);
  });
}

kernels::Scan CellScan::look_into_rows(Needle i, double ahead) {
  const ClassCells& own = volumes_.class_of(i);
  views_.clear();
  return with_volume(own.kind, [&]<class Own>(Own) {
    set_first<Own>(own, i, ahead);
    return look_into_rows<Own>(ahead);
  });
}

template <class Own>
[[gnu::always_inline]] inline void CellScan::set_first(const ClassCells& own, Needle i,
                                                       double ahead) {
  Look& first = looks_.front();
  first.cells = &own;
  first.origin = volumes_.places[i].cell;
  first.touching = volumes_.distances.largest(i, own.widest_half);
  set_seeker(volumes_, own, i, ahead, first.seeker);
  Own::read_entry(own, volumes_.places[i].slot, first.seeker);
}

// How far others, in volumes There, may be from what the seeker sweeps. The margins cover the
// rounding of the seeker's place in its cell, and that of distances, which grows with the sides of
// cells; the factor covers what grows with the reach.
template <class Own, class There>
inline void CellScan::set_reach(const ClassCells& own, float bend, Look& look) const {
  const ClassCells& there = *look.cells;
  kernels::Seeker& seeker = look.seeker;
  seeker.longest_half = There::longest_half(look);
  look.distance = Own::own_reach(own, seeker) + There::reach(there) + look.touching + bend;
  const float in_cells = look.distance + (volume_margin + 2 * seeker.margin);
  look.reach = There::with_entries(there, in_cells) * (1 + 0x1p-18f);
}

inline kernels::Surroundings CellScan::surroundings(const Look& look) const {
  const ClassCells& there = *look.cells;
  const bool in_cache = volumes_.motions.size() <= motions_in_cache;
  return {there.cells.blocks(), there.cells.next(), views_.data() + look.first_view,
          look.views,           there.format,       in_cache ? nullptr : volumes_.motions.data()};
}

template <class Own>
inline kernels::Scan CellScan::look_into_one_class(double ahead) {
  Look& look = looks_.front();
  set_reach<Own, Own>(*look.cells, 0, look);
  Own::set_box(volumes_.frame, ahead, look);
  views_.add_around_box<Own>(look, volumes_.frame.per_length);
  found_.make_room(look.views * look.cells->cells.longest_chain() * kernels::block_size);
  const kernels::Scan seen = Own::scan(kernels_, surroundings(look), look, found_.from(0));
  look.first_found = 0;
  look.found = seen.found;
  return seen;
}

template <class Own>
[[gnu::noinline]] kernels::Scan CellScan::look_into_classes(Needle i, double ahead) {
  Look& first = looks_.front();
  const ClassCells& own = *first.cells;
  std::size_t n = 1;
  for (const auto& each : volumes_.classes) {
    if (each.get() == &own) continue;
    Look& look = looks_[n++];
    look = first;
    look.cells = each.get();
    look.touching = volumes_.distances.largest(i, each->widest_half);
    see_from_class<Own>(own, volumes_.frame, look);
  }
  std::size_t room = 0;
  for (Look& look : looks_) {
    with_volume(look.cells->kind, [&]<class There>(There) {
      const float bend = bend_between(Own{}, There{}, volumes_, own, look.seeker);
      set_reach<Own, There>(own, bend, look);
      Own::set_straight_box(volumes_.frame, ahead, look);
      views_.add_around_segment<There>(look, Own::direction(look.seeker),
                                       volumes_.frame.per_length);
    });
    room += look.views * look.cells->cells.longest_chain() * kernels::block_size;
  }
  found_.make_room(room);
  return scan_all([&](Look& look, const kernels::Found& found) {
    return with_volume(look.cells->kind, [&]<class There>(There) {
      return &look == &first
                 ? Own::scan(kernels_, surroundings(look), look, found)
                 : scan_between(Own{}, There{}, kernels_, surroundings(look), look, found);
    });
  });
}

// From the frame of each row; see sliding_rows.h.
template <class Own>
[[gnu::noinline]] kernels::Scan CellScan::look_into_rows(double ahead) {
  looks_.resize(1);
  const ClassCells& own = *looks_.front().cells;
  const double unit = 1 / volumes_.frame.per_length, side = own.grid.sides()[0];
  Look first = looks_.front();
  set_reach<Own, Own>(own, 0, first);
  Own::set_box(volumes_.frame, ahead, first);
  // The rows within its reach, its own one first.
  const auto [low, high] = views_.layers_within(first, 1, volumes_.frame.per_length);
  const std::int32_t row = first.origin[1];
  looks_.clear();
  looks_.push_back(first);
  looks_.front().row = row;
  for (std::int32_t other = low; other <= high; ++other) {
    if (other == row) continue;
    Look& look = looks_.emplace_back(first);
    look.row = other;
    const SlidingRows::Beside beside = volumes_.rows->beside(row, other);
    kernels::Seeker& seeker = look.seeker;
    // Counted from the cell of the other row that it is in.
    const double x = static_cast<double>(seeker.motion.r[0]) * unit - beside.place;
    const auto cells = static_cast<std::int32_t>(std::floor(x / side));
    look.origin[0] += cells;
    seeker.motion.r[0] = static_cast<float>((x - cells * side) * volumes_.frame.per_length);
    seeker.motion.v[0] -=
        static_cast<float>(beside.velocity * volumes_.frame.per_length / volumes_.frame.per_time);
    seeker.margin = 2 * own.margin;
    set_reach<Own, Own>(own, 0, look);
    Own::set_box(volumes_.frame, ahead, look);
  }
  std::size_t room = 0;
  for (Look& look : looks_) {
    views_.add_in_row<Own>(look, volumes_.frame.per_length);
    room += look.views * own.cells.longest_chain() * kernels::block_size;
  }
  found_.make_room(room);
  return scan_all([&](Look& look, const kernels::Found& found) {
    return Own::scan(kernels_, surroundings(look), look, found);
  });
}

// All looks, one after the other.
template <class Scanned>
inline kernels::Scan CellScan::scan_all(const Scanned& scan) {
  Look& first = looks_.front();
  kernels::Scan all{};
  for (Look& look : looks_) {
    const kernels::Found found = found_.from(all.found);
    const kernels::Scan seen = scan(look, found);
    // Kernels count views from the first of this look.
    for (std::size_t k = 0; k < seen.found; ++k) {
      found.cell[k] += static_cast<std::uint32_t>(look.first_view);
    }
    look.first_found = all.found;
    look.found = seen.found;
    all.seen += seen.seen;
    all.found += seen.found;
    first.seeker.margin = std::max(first.seeker.margin, look.seeker.margin);
  }
  return all;
}

}  // namespace needlework
