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
    set_first<Own>(own, i, ahead, looks_.front());
    return looks_.size() == 1 ? look_into_one_class<Own>(ahead) : look_into_classes<Own>(i, ahead);
  });
}

kernels::Scan RowScan::look(Needle i, double ahead) {
  return with_volume(volumes_.class_of(i).kind,
                     [&]<class Own>(Own) { return look_into_rows<Own>(i, ahead, now_); });
}

Shift RowScan::shift_in_rows(Needle i, Needle j, std::uint32_t view,
                             const Shift& between_cells) const {
  const auto is_in = [&](const Look& look) {
    return view >= look.first_view && view < look.first_view + look.views;
  };
  std::size_t n = 0;
  while (!is_in(looks_[n])) ++n;
  return between_cells + Shift{looks_[n].boxes, 0, 0} + volumes_.wraps[i] - volumes_.wraps[j];
}

template <class Own>
[[gnu::always_inline]] inline void CellScan::set_first(const ClassCells& own, Needle i,
                                                       double ahead, Look& first) {
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
  seeker.longest_half =
      there.cells.differ() ? There::besides_reach(look) : There::longest_half(look);
  look.distance = Own::own_reach(own, seeker) + There::reach(there) + look.touching + bend;
  const float in_cells = look.distance + (volume_margin + 2 * seeker.margin);
  look.reach = There::with_entries(there, in_cells) * (1 + 0x1p-18f);
}

inline kernels::Surroundings CellScan::surroundings(const Look& look) const {
  const ClassCells& there = *look.cells;
  const bool in_cache = volumes_.motions.size() <= motions_in_cache;
  return {there.cells.blocks(), there.cells.next(), views_.data() + look.first_view,
          look.views,           there.format,       in_cache ? nullptr : volumes_.motions.data(),
          there.cells.reaches()};
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

// Looks from the frame of another row, in which the own one flies past. Returns how much wider the
// box has become along x. [unit of length]
template <class Own>
inline float see_from_row(const SlidingRows::Beside& beside, const MotionFrame& frame, double ahead,
                          Look& look) {
  kernels::Seeker& seeker = look.seeker;
  const double side = look.cells->grid.sides()[0];
  // Counted from the cell of that row that it is in.
  const double x = Own::centre(seeker)[0] / frame.per_length - beside.place;
  const std::int32_t cells = look.cells->grid.cell_of({x, 0, 0})[0];
  const double by = -(beside.place + cells * side) * frame.per_length;
  look.origin[0] += cells;
  look.boxes = beside.boxes;
  seeker.motion.r[0] = static_cast<float>(seeker.motion.r[0] + by);
  seeker.r[0] = static_cast<float>(seeker.r[0] + by);
  const auto velocity = static_cast<float>(beside.velocity * frame.per_length / frame.per_time);
  seeker.motion.v[0] -= velocity;
  return Own::fly_past(frame, ahead, velocity, look);
}

// Into the rows of all classes that are within reach; see sliding_rows.h.
template <class Own>
[[gnu::noinline]] kernels::Scan CellScan::look_into_rows(Needle i, double ahead, Time now) {
  const ClassCells& own = volumes_.class_of(i);
  const MotionFrame& frame = volumes_.frame;
  const SlidingRows::Present rows(*own.rows, now);
  views_.clear();
  looks_.resize(1);
  Look first;
  set_first<Own>(own, i, ahead, first);
  first.boxes = 0;
  first.seeker.margin += own.margin;  // as a row rounds its place once more
  std::size_t room = 0;
  const auto look_into = [&]<class There>(There, const ClassCells& there, Look& base) {
    const bool is_own = &there == &own;
    set_reach<Own, There>(
        own, is_own ? 0 : bend_between(Own{}, There{}, volumes_, own, base.seeker), base);
    Own::set_straight_box(frame, ahead, base);
    for (const CellGrid::AxisCell& row : views_.rows_near(base, frame.per_length)) {
      const bool is_first = is_own && row.cell == first.origin[1];
      Look& look = is_first ? looks_.front() : looks_.emplace_back();
      look = base;
      const float wider =
          is_first ? 0
                   : see_from_row<Own>(rows.beside(first.origin[1], *there.rows, row.cell), frame,
                                       ahead, look);
      views_.add_in_row<There>(look, row, wider, frame.per_length);
      room += look.views * there.cells.longest_chain() * kernels::block_size;
    }
  };
  look_into(Own{}, own, first);
  for (const auto& each : volumes_.classes) {
    if (each.get() == &own) continue;
    Look base = first;
    base.cells = each.get();
    base.touching = volumes_.distances.largest(i, each->widest_half);
    see_from_class<Own>(own, frame, base);
    base.seeker.margin += own.margin;
    with_volume(each->kind, [&]<class There>(There there) { look_into(there, *each, base); });
  }
  found_.make_room(room);
  return scan_all([&](Look& look, const kernels::Found& found) {
    return with_volume(look.cells->kind, [&]<class There>(There) {
      return look.cells == &own
                 ? Own::scan(kernels_, surroundings(look), look, found)
                 : scan_between(Own{}, There{}, kernels_, surroundings(look), look, found);
    });
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
