#include "src/search/near_search.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "kernels/inline.h"

namespace needlework {
namespace {

using kernels::NeedleBlock;
using kernels::PairColumns;

// Far more than rounding does to the place of a bounding volume. [unit of length]
constexpr double volume_margin = 0x1p-12;
constexpr double roundup = 1 + 0x1p-20;
// Motions of so many needles are near enough to the core that a scan takes longer if it prefetches
// them. Measured: that costs 1 to 3 % of the time of 1e4 to 3e4 needles, and saves 2 to 4 % of that
// of 1e5 and 1e6.
constexpr std::size_t motions_in_cache = std::size_t{1} << 15;
// Of a box of more cells, those are found that are near the segment in it. Fewer are looked through
// sooner.
constexpr std::size_t many_cells = 12;

using AxisCells = std::span<const CellGrid::AxisCell>;

}  // namespace

NearSearch::NearSearch(const Gas& gas, Counters& counters, const SearchSetup& setup,
                       BoundingVolume kind)
    : volumes_(std::make_shared<BoundingVolumes>(gas, setup, kind)),
      kind_(kind),
      counters_(counters),
      kernels_(kernels::near_kernels(setup.isa)),
      follows_(setup.float_filter),
      has_width_(gas.composition.has_width()),
      margin_(static_cast<float>(gas.margin * volumes_->per_length)),
      are_spheres_(gas.composition.are_spheres()),
      looks_(volumes_->classes.size()) {
  if (!volumes_->balls.empty()) lists_.emplace(gas.size());
}

NearSearch::NearSearch(const NearSearch& other, Counters& counters)
    : volumes_(other.volumes_),
      kind_(other.kind_),
      counters_(counters),
      kernels_(other.kernels_),
      follows_(other.follows_),
      has_width_(other.has_width_),
      margin_(other.margin_),
      are_spheres_(other.are_spheres_),
      looks_(volumes_->classes.size()) {}

Time NearSearch::place(Needle i, Time now, double half_length) {
  if (lists_) return place_in_ball(i, now);
  counters_.crossings += volumes_->place(i, now, half_length);
  return volumes_->places[i].next_event;
}

[[gnu::noinline]] Time NearSearch::place_in_ball(Needle i, Time now) {
  bool is_new;
  counters_.crossings += volumes_->place_in_ball(i, now, is_new);
  if (is_new) list_neighbours(i);
  for (const auto& each : lists_->of(i)) needlework::prefetch(&volumes_->motions[each.needle]);
  return volumes_->places[i].next_event;
}

void NearSearch::begin_again(Time now) {
  volumes_->begin_again(now);
  volumes_->leave_balls();
}

void NearSearch::renumber(const std::vector<Needle>& ranks) {
  volumes_->renumber(ranks);
  if (lists_) lists_->renumber(ranks);
}

inline void NearSearch::look_from(Needle i, const ClassCells& own, double ahead,
                                  kernels::Seeker& seeker) const {
  const BoundingVolumes& volumes = *volumes_;
  seeker.motion = volumes.motions[i];
  seeker.now = seeker.motion.time;
  seeker.ahead = static_cast<float>(ahead * volumes.per_time * roundup + kernels::time_margin);
  seeker.margin = own.margin;
  seeker.needle = i.index;
}

inline void NearSearch::make_seeker(Needle i, const ClassCells& own, double ahead,
                                    kernels::Seeker& seeker) const {
  const BoundingVolumes& volumes = *volumes_;
  look_from(i, own, ahead, seeker);
  if (own.kind == BoundingVolume::capsule) {
    const NeedleCells::Slot& slot = volumes.places[i].slot;
    const NeedleBlock& block = own.cells[slot.block];
    for (int axis = 0; axis < 3; ++axis) {
      const std::uint32_t word = block.word[axis][slot.lane];
      seeker.r[axis] = static_cast<float>(own.format.coordinate(word));
      seeker.u[axis] = own.format.director(word);
    }
  }
}

// Of another class than the needle's own: seeker and origin in the frame of its cells.
inline void NearSearch::seen_from(const ClassCells& own, Look& look) const {
  const BoundingVolumes& volumes = *volumes_;
  const ClassCells& there = *look.cells;
  kernels::Seeker& seeker = look.seeker;
  const bool capsule = look.capsule;
  const float* const r = capsule ? seeker.r : seeker.motion.r;
  const double unit = 1 / volumes.per_length;
  const Vec3d corner = own.grid.corner(look.origin);
  look.origin = there.grid.cell_of(corner + Vec3d{r[0] * unit, r[1] * unit, r[2] * unit});
  const Vec3d shift = (corner - there.grid.corner(look.origin)) * volumes.per_length;
  for (int axis = 0; axis < 3; ++axis) {
    const double by = component(shift, axis);
    seeker.motion.r[axis] = static_cast<float>(seeker.motion.r[axis] + by);
    seeker.r[axis] = static_cast<float>(seeker.r[axis] + by);
  }
  // The rounding of the seeker's place, in its own cell and in this one.
  seeker.margin = own.margin + there.margin;
  if (capsule) seeker.margin += static_cast<float>(own.format.step());
}

// The largest distance of the axis of needle i from one in that class with which it is in contact.
inline float NearSearch::touching(Needle i, const ClassCells& there) const {
  const BoundingVolumes& volumes = *volumes_;
  const float own = volumes.half_widths.empty() ? there.widest_half : volumes.half_widths[i];
  return own + there.widest_half + margin_;
}

// What the needle sweeps: the axis of its capsule, or its path in the time ahead.
inline void NearSearch::sweep(const ClassCells& own, double ahead, Look& look) const {
  const BoundingVolumes& volumes = *volumes_;
  const ClassCells& there = *look.cells;
  kernels::Seeker& seeker = look.seeker;
  const bool capsule = look.capsule;
  const bool to_capsules = there.kind == BoundingVolume::capsule;
  const float half = seeker.motion.half, longest_half = there.longest_half;
  // A needle at rest may stay longer than floats can say.
  const auto time = static_cast<float>(
      std::min<double>(ahead * volumes.per_time, std::numeric_limits<float>::max()));
  seeker.longest_half = longest_half;
  if (!to_capsules) seeker.longest_half += look.touching;
  // Another centre is not farther from this needle's axis, if it is in a capsule, than its half
  // length and both radii. The margins cover the rounding of the seeker's place in its cell, and
  // that of distances below, which grows with the sides of cells; the factor covers what grows with
  // the reach.
  look.distance = (capsule ? own.in_capsules : half) +
                  (to_capsules ? there.in_capsules : longest_half) + look.touching;
  look.reach = look.distance + (static_cast<float>(volume_margin) + 2 * seeker.margin);
  if (to_capsules) look.reach += longest_half + static_cast<float>(there.format.step());
  if (volumes.falls && looks_.size() > 1 && !(capsule && to_capsules)) {
    const float bend = volumes.bend(seeker.now, seeker.ahead, own);
    look.reach += bend;
    look.distance += bend;
  }
  look.reach *= 1 + 0x1p-18f;
  for (int axis = 0; axis < 3; ++axis) {
    if (capsule) {
      const float beside = half * std::abs(seeker.u[axis]);
      look.low[axis] = seeker.r[axis] - beside;
      look.high[axis] = seeker.r[axis] + beside;
    } else {
      const float moved = seeker.motion.v[axis] * time;
      look.low[axis] = seeker.motion.r[axis] + std::min(moved, 0.0f);
      look.high[axis] = seeker.motion.r[axis] + std::max(moved, 0.0f);
    }
  }
  if (volumes.falls && !capsule && looks_.size() == 1) {
    for (int axis = 0; axis < 3; ++axis) {
      const BoundingVolumes::Range path = volumes.path_along(axis, seeker, time);
      look.low[axis] = path.low;
      look.high[axis] = path.high;
    }
  }
  if (&own == &there) return;
  // The segment as kernels see it.
  if (capsule) {
    seeker.axis_half = half;
  } else if (to_capsules) {
    Vec3d way{look.high[0] - look.low[0], look.high[1] - look.low[1], look.high[2] - look.low[2]};
    const double length = std::sqrt(dot(way, way));
    const double per_way = length > 0 ? 1 / length : 0;
    for (int axis = 0; axis < 3; ++axis) {
      seeker.r[axis] = 0.5f * (look.low[axis] + look.high[axis]);
      const double share = component(way, axis) * per_way;
      seeker.u[axis] = static_cast<float>(seeker.motion.v[axis] < 0 ? -share : share);
    }
    seeker.axis_half = static_cast<float>(0.5 * length);
  }
}

// Prepares one look for each class, with the own one first.
inline void NearSearch::begin_looks(Needle i, double ahead) {
  const BoundingVolumes& volumes = *volumes_;
  const ClassCells& own = volumes.class_of(i);
  Look& first = looks_.front();
  first.cells = &own;
  make_seeker(i, own, ahead, first.seeker);
  first.origin = volumes.places[i].cell;
  first.capsule = own.kind == BoundingVolume::capsule;
  first.touching = touching(i, own);
  if (looks_.size() > 1) {
    std::size_t n = 1;
    for (const auto& each : volumes.classes) {
      if (each.get() == &own) continue;
      Look& look = looks_[n++];
      look = first;
      look.cells = each.get();
      look.touching = touching(i, *each);
      seen_from(own, look);
    }
  }
}

// The segment that a needle sweeps, among the cells around it: which cells are within its reach.
class NearSearch::SegmentInCells {
 public:
  /// Of the segment, as shares of its length; none if the end is before the begin.
  struct Part {
    float begin = 0, end = 1;
  };

  SegmentInCells(const Look& look, const CellGrid& grid, float overlap, double per_length)
      : overlap_(overlap),
        // Has room for what rounding does to parts.
        wide_(look.reach * (1 + 0x1p-8f) + overlap + look.seeker.margin) {
    for (int axis = 0; axis < 3; ++axis) {
      side_[axis] = static_cast<float>(grid.sides()[axis] * per_length);
      const float length = look.high[axis] - look.low[axis];
      const bool falls = (look.capsule ? look.seeker.u : look.seeker.motion.v)[axis] < 0;
      from_[axis] = falls ? look.high[axis] : look.low[axis];
      way_[axis] = falls ? -length : length;
      per_side_[axis] = 1 / side_[axis];
      per_way_[axis] = 1 / way_[axis];
    }
  }

  /// The part that comes near the layer of cells, from these parts of the segment.
  Part near(int axis, const CellGrid::AxisCell& cell, Part part) const {
    const float low = cell.offset - wide_ - from_[axis],
                high = cell.offset + side_[axis] + wide_ - from_[axis], way = way_[axis];
    const float first = low * per_way_[axis], last = high * per_way_[axis];
    if (way > 0) return {std::max(part.begin, first), std::min(part.end, last)};
    if (way < 0) return {std::max(part.begin, last), std::min(part.end, first)};
    return low <= 0 && high >= 0 ? part : Part{1, 0};
  }
  /// Those of the cells of an axis, which are in a row, that come near this part.
  AxisCells cells_near(int axis, Part part, AxisCells cells) const {
    if (part.end < part.begin) return {};
    const Interval at = interval(axis, part);
    const auto count_before = [&](float place) {
      const float cells_before = (place - cells.front().offset) * per_side_[axis];
      return static_cast<std::size_t>(
          std::clamp(cells_before, 0.0f, static_cast<float>(cells.size())));
    };
    const std::size_t first = count_before(at.low - wide_),
                      last = count_before(at.high + wide_ + side_[axis]);
    return cells.subspan(first, last - first);
  }
  /// Of the distance along an axis of this part from where needles of the cell may be.
  float gap_squared(int axis, const CellGrid::AxisCell& cell, Part part) const {
    const Interval at = interval(axis, part);
    const float gap =
        std::max({cell.offset - at.high, at.low - (cell.offset + side_[axis]), overlap_}) -
        overlap_;
    return gap * gap;
  }

 private:
  struct Interval {
    float low, high;
  };
  Interval interval(int axis, Part part) const {
    const float a = from_[axis] + way_[axis] * part.begin, b = from_[axis] + way_[axis] * part.end;
    return {std::min(a, b), std::max(a, b)};
  }

  float overlap_, wide_, side_[3], per_side_[3], from_[3], way_[3], per_way_[3];
};

inline void NearSearch::make_room_for_views(std::size_t count) {
  if (count <= views_.size()) return;
  views_.resize(count);
  view_cells_.resize(count);
}

// Makes views of the cells in which needles may be found: those in which a needle within reach of
// this one's bounding volume, or of its path in the time ahead, can have been placed.
inline void NearSearch::look_around(Look& look) {
  const BoundingVolumes& volumes = *volumes_;
  const ClassCells& there = *look.cells;
  const bool capsules = there.kind == BoundingVolume::capsule;
  const auto overlap = static_cast<float>(there.overlap * volumes.per_length);
  AxisCells near[3];
  for (int axis = 0; axis < 3; ++axis) {
    const std::size_t count = there.grid.find_near(
        axis, look.origin[axis], look.low[axis] - overlap, look.high[axis] + overlap, look.reach,
        volumes.per_length, near_[axis]);
    near[axis] = {near_[axis].data(), count};
  }

  const float reach_squared = look.reach * look.reach;
  const std::size_t most = near[0].size() * near[1].size() * near[2].size();
  make_room_for_views(look.first_view + most);
  // Copied, because for all the compiler knows the stores below might change this pointer.
  const NeedleBlock* const blocks = there.cells.blocks();
  kernels::CellView* view = views_.data() + look.first_view;
  Cell* view_cell = view_cells_.data() + look.first_view;
  const auto add = [&](const CellGrid::AxisCell& z, const CellGrid::AxisCell& y,
                       const CellGrid::AxisCell& x, std::size_t row) {
    const std::uint32_t first = static_cast<std::uint32_t>(row + x.wrapped);
    needlework::prefetch(&blocks[first].word);
    needlework::prefetch(&blocks[first].needle);
    if (!capsules) needlework::prefetch(&blocks[first].time);
    *view++ = {first, {x.offset, y.offset, z.offset}};
    *view_cell++ = {x.cell, y.cell, z.cell};
  };
  if (looks_.size() == 1 || most < many_cells) {
    // Copies, for the same reason.
    for (const CellGrid::AxisCell z : near[2]) {
      for (const CellGrid::AxisCell y : near[1]) {
        const float gap_squared = z.gap_squared + y.gap_squared;
        if (gap_squared > reach_squared) continue;
        const std::size_t row = there.grid.index(0, y.wrapped, z.wrapped);
        for (const CellGrid::AxisCell& x : near[0]) {
          if (gap_squared + x.gap_squared > reach_squared) continue;
          add(z, y, x, row);
        }
      }
    }
  } else {
    // Only those along the segment. A part of it is near a layer of cells, a part of that near a
    // row of them, a part of that near a cell.
    const SegmentInCells segment(look, there.grid, overlap, volumes.per_length);
    for (const auto& z : near[2]) {
      const SegmentInCells::Part in_layer = segment.near(2, z, {});
      for (const auto& y : segment.cells_near(1, in_layer, near[1])) {
        const SegmentInCells::Part in_row = segment.near(1, y, in_layer);
        const float gap_squared = z.gap_squared + segment.gap_squared(1, y, in_layer);
        if (gap_squared > reach_squared) continue;
        const std::size_t row = there.grid.index(0, y.wrapped, z.wrapped);
        for (const auto& x : segment.cells_near(0, in_row, near[0])) {
          if (gap_squared + segment.gap_squared(0, x, in_row) > reach_squared) continue;
          add(z, y, x, row);
        }
      }
    }
  }
  look.views = static_cast<std::size_t>(view - views_.data()) - look.first_view;
}

inline kernels::Scan NearSearch::scan(const ClassCells& own, const Look& look,
                                      const kernels::Found& found) const {
  const BoundingVolumes& volumes = *volumes_;
  const ClassCells& there = *look.cells;
  const bool in_cache = volumes.motions.size() <= motions_in_cache;
  const kernels::Surroundings around{
      there.cells.blocks(), there.cells.next(), views_.data() + look.first_view,
      look.views,           there.format,       in_cache ? nullptr : volumes.motions.data()};
  const bool paths = there.kind == BoundingVolume::cell;
  if (&own == &there && !paths) {
    return kernels_.overlapping(around, look.seeker, 0.5f * look.distance, found);
  }
  if (!paths) return kernels_.near_capsules(around, look.seeker, look.distance, found);
  if (own.kind == BoundingVolume::capsule) {
    return kernels_.near_paths(around, look.seeker, look.distance, found);
  }
  return kernels_.approaching(around, look.seeker, found);
}

// The boxes to be added to the centre of a needle found in this view.
inline Shift NearSearch::shift_of(Needle j, std::uint32_t view) const {
  if (lists_) return shift_in_list(j, view);
  return volumes_->class_of(j).grid.boxes_between(view_cells_[view], volumes_->places[j].cell);
}

[[gnu::noinline]] Shift NearSearch::shift_in_list(Needle j, std::uint32_t neighbour) const {
  const Needle i(looks_.front().seeker.needle);
  Cell seen = volumes_->places[i].cell;
  for (int axis = 0; axis < 3; ++axis) seen[axis] += lists_->of(i)[neighbour].cells[axis];
  return volumes_->class_of(j).grid.boxes_between(seen, volumes_->places[j].cell);
}

inline void NearSearch::propose(const kernels::Found& found, std::size_t k, double from) {
  const Needle j(found.needle[k]);
  needlework::prefetch(&volumes_->places[j]);
  needlework::prefetch(&volumes_->gas.records[j]);
  needlework::prefetch(&volumes_->gas.ids[j]);
  candidates_.push_back({from, j, found.cell[k], {}});
}

inline std::size_t NearSearch::bracket(const kernels::Seeker& seeker, const PairColumns& pairs,
                                       std::size_t count) const {
  if (has_width_) {
    return are_spheres_ ? kernels_.bracket_spheres(seeker, pairs, count)
                        : kernels_.bracket_rods(seeker, pairs, count);
  }
  return kernels_.bracket(seeker, pairs, count);
}

// How far apart the axes of the pairs are in contact.
void NearSearch::set_distances(Needle i, const kernels::Found& found, std::size_t count) {
  const BoundingVolumes& volumes = *volumes_;
  float* const distance = pairs_.columns_for(count).column[PairColumns::distance];
  if (volumes.half_widths.empty()) {
    std::fill_n(distance, count, 2 * volumes.classes.front()->widest_half);
    return;
  }
  const float own = volumes.half_widths[i];
  for (std::size_t k = 0; k < count; ++k) {
    distance[k] = own + volumes.half_widths[Needle(found.needle[k])];
  }
}

// The filter sees flights of records, from which needles in contact depart.
void NearSearch::leave_out_sliding(const kernels::Found& found, std::size_t count, float never) {
  const auto slides = [&](Needle i) { return volumes_->gas.records[i].is_sliding(); };
  const bool all = slides(Needle(looks_.front().seeker.needle));
  float* const from = pairs_.columns_for(count).column[PairColumns::from];
  for (std::size_t k = 0; k < count; ++k) {
    if (from[k] == never || !(all || slides(Needle(found.needle[k])))) continue;
    from[k] = never;
    propose(found, k, 0);
  }
}

// Proposes those of the needles found that may meet the seeker, with the earliest time at which
// they may.
inline void NearSearch::follow(const JustHit& just_hit, const kernels::Found& found,
                               std::size_t count) {
  const BoundingVolumes& volumes = *volumes_;
  const PairColumns& pairs = pairs_.columns_for(count);
  kernels::Seeker& seeker = looks_.front().seeker;
  for (const Look& look : looks_) {
    PairTable::fill(pairs, look.seeker, volumes.motions.data(), views_.data(), found,
                    look.first_found, look.first_found + look.found);
    seeker.margin = std::max(seeker.margin, look.seeker.margin);
  }
  float* const from = pairs.column[PairColumns::from];
  // A pair that parts too slowly for the filter is left out of it and proposed.
  const bool parts = just_hit.apart > 0;
  const float never = 2 * seeker.ahead + 1;
  const auto apart =
      parts ? static_cast<float>(std::min<double>(just_hit.apart * volumes.per_time, never))
            : never;
  std::fill_n(from, count, 0.0f);
  for (std::size_t k = 0; k < count; ++k) {
    if (found.needle[k] != just_hit.needle.index ||
        !same(shift_of(just_hit.needle, found.cell[k]), just_hit.shift))
      continue;
    from[k] = apart;
    if (!parts) propose(found, k, 0);
  }
  if (has_width_) set_distances(Needle(seeker.needle), found, count);
  if (margin_ > 0) leave_out_sliding(found, count, never);
  counters_.bracket_steps += bracket(seeker, pairs, count);
  const float ahead = seeker.ahead;
  for (std::size_t k = 0; k < count; ++k) {
    if (from[k] <= ahead) propose(found, k, from[k] / volumes.per_time);
  }
}

NEEDLEWORK_INLINE kernels::Found NearSearch::found() {
  return {found_.data(), found_.data() + found_.size() / 2};
}

// Finds those whose bounding volumes are near that of needle i, or near its path in the time ahead.
NEEDLEWORK_INLINE kernels::Scan NearSearch::look_into_cells(Needle i, double ahead) {
  begin_looks(i, ahead);
  const ClassCells& own = *looks_.front().cells;
  std::size_t views = 0, room = kernels::block_size;
  for (Look& look : looks_) {
    look.first_view = views;
    sweep(own, ahead, look);
    look_around(look);
    views += look.views;
    room += look.views * look.cells->cells.longest_chain() * kernels::block_size;
  }
  if (2 * room > found_.size()) found_.resize(4 * room);
  const kernels::Found found = this->found();
  std::size_t entries = 0, count = 0;
  for (Look& look : looks_) {
    look.first_found = count;
    const kernels::Scan seen = scan(own, look, {found.needle + count, found.cell + count});
    look.found = seen.found;
    entries += seen.seen;
    count += seen.found;
    // Kernels count views from the first of this look.
    if (look.first_view == 0) continue;
    for (std::size_t k = look.first_found; k < count; ++k) {
      found.cell[k] += static_cast<std::uint32_t>(look.first_view);
    }
  }
  return {entries, count};
}

// The same from the body's list. Each neighbour has a view of its own.
[[gnu::noinline]] kernels::Scan NearSearch::look_into_list(Needle i, double ahead) {
  Look& look = looks_.front();
  look.cells = &volumes_->class_of(i);
  look_from(i, *look.cells, ahead, look.seeker);
  const std::span<const NeighbourLists::Neighbour> list = lists_->of(i);
  const std::size_t count = list.size();
  make_room_for_views(count);
  if (2 * (count + kernels::block_size) > found_.size()) {
    found_.resize(4 * (count + kernels::block_size));
  }
  const kernels::Found found = this->found();
  const std::array<double, 3> grid_sides = look.cells->grid.sides();
  float sides[3];
  for (int axis = 0; axis < 3; ++axis) {
    sides[axis] = static_cast<float>(grid_sides[axis] * volumes_->per_length);
  }
  for (std::size_t k = 0; k < count; ++k) {
    found.needle[k] = list[k].needle.index;
    found.cell[k] = static_cast<std::uint32_t>(k);
    for (int axis = 0; axis < 3; ++axis) {
      views_[k].offset[axis] = static_cast<float>(list[k].cells[axis]) * sides[axis];
    }
  }
  look.found = count;
  return {count, count};
}

// Body i has got another bounding volume.
[[gnu::noinline]] void NearSearch::list_neighbours(Needle i) {
  const std::size_t count = look_into_cells(i, 0).found;
  const kernels::Found found = this->found();
  neighbours_.clear();
  const Cell& own = volumes_->places[i].cell;
  for (std::size_t k = 0; k < count; ++k) {
    const Cell& seen = view_cells_[found.cell[k]];
    NeighbourLists::Neighbour each{Needle(found.needle[k]), {}};
    for (int axis = 0; axis < 3; ++axis) {
      const std::int32_t cells = seen[axis] - own[axis];
      assert(std::abs(cells) <= NeighbourLists::farthest + 1);
      each.cells[axis] = static_cast<std::int8_t>(cells);
    }
    neighbours_.push_back(each);
  }
  lists_->replace(i, neighbours_);
}

std::span<const NearSearch::Candidate> NearSearch::candidates(Needle i, const JustHit& just_hit,
                                                              double ahead) {
  const BoundingVolumes& volumes = *volumes_;
  const auto [entries, count] = lists_ ? look_into_list(i, ahead) : look_into_cells(i, ahead);
  const kernels::Found found = this->found();
  counters_.candidates += entries;

  for (std::size_t k = 0; k < count; ++k) {
    needlework::prefetch(&volumes.motions[found.needle[k]]);
  }
  candidates_.clear();
  if (follows_) {
    follow(just_hit, found, count);
  } else {
    for (std::size_t k = 0; k < count; ++k) propose(found, k, 0);
  }
  std::sort(candidates_.begin(), candidates_.end(),
            [](const Candidate& a, const Candidate& b) { return a.from < b.from; });
  for (Candidate& candidate : candidates_) {
    candidate.shift = shift_of(candidate.needle, candidate.view);
  }
  // Cells that come round to those at the other wall hold no neighbours.
  if (volumes.walled) {
    std::erase_if(candidates_, [&](const Candidate& candidate) {
      return !volumes.gas.box.has_image(candidate.shift);
    });
  }
  counters_.filtered += entries - candidates_.size();
  return candidates_;
}

}  // namespace needlework
