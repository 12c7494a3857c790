#include "src/search/near_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

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

}  // namespace

NearSearch::NearSearch(const Gas& gas, Counters& counters, const SearchSetup& setup,
                       BoundingVolume kind)
    : volumes_(std::make_shared<BoundingVolumes>(gas, setup, kind)),
      counters_(counters),
      kernels_(kernels::near_kernels(setup.isa)),
      follows_(setup.float_filter) {}

NearSearch::NearSearch(const NearSearch& other, Counters& counters)
    : volumes_(other.volumes_),
      counters_(counters),
      kernels_(other.kernels_),
      follows_(other.follows_) {}

Time NearSearch::place(Needle i, Time now, double half_length) {
  counters_.crossings += volumes_->place(i, now, half_length);
  return volumes_->places[i].next_event;
}

inline kernels::Seeker NearSearch::seeker_for(Needle i, double ahead) const {
  const BoundingVolumes& volumes = *volumes_;
  kernels::Seeker seeker;
  seeker.motion = volumes.motions[i];
  seeker.now = seeker.motion.time;
  seeker.ahead = static_cast<float>(ahead * volumes.per_time * roundup + kernels::time_margin);
  seeker.margin = volumes.margin;
  seeker.longest_half = static_cast<float>(0.5 * volumes.longest * volumes.per_length);
  seeker.needle = i.index;
  if (volumes.kind == BoundingVolume::capsule) {
    const NeedleCells::Slot& slot = volumes.places[i].slot;
    const NeedleBlock& block = volumes.cells[slot.block];
    for (int axis = 0; axis < 3; ++axis) {
      const std::uint32_t word = block.word[axis][slot.lane];
      seeker.r[axis] = static_cast<float>(volumes.format.coordinate(word));
      seeker.u[axis] = volumes.format.director(word);
    }
  }
  return seeker;
}

// Makes views of the cells in which needles may be found: those in which a needle within reach of
// this one's bounding volume, or of its path in the time ahead, can have been placed.
inline void NearSearch::look_around(const kernels::Seeker& seeker, const Cell& cell, double ahead) {
  const BoundingVolumes& volumes = *volumes_;
  const bool capsules = volumes.kind == BoundingVolume::capsule;
  const float half = seeker.motion.half, longest_half = seeker.longest_half;
  // A needle at rest may stay longer than floats can say.
  const auto time = static_cast<float>(
      std::min<double>(ahead * volumes.per_time, std::numeric_limits<float>::max()));
  // Another centre is not farther from this needle's axis, if it is in a capsule, than its half
  // length and both radii. The margins cover the rounding of the seeker's place in its cell, and
  // that of distances below, which grows with the sides of cells; the factor covers what grows with
  // the reach.
  const auto step = static_cast<float>(volumes.format.step());
  const float reach =
      ((capsules ? longest_half + 2 * static_cast<float>(volumes.radius * volumes.per_length) + step
                 : longest_half + half) +
       (static_cast<float>(volume_margin) + 2 * volumes.margin)) *
      (1 + 0x1p-18f);
  const auto overlap = static_cast<float>(volumes.overlap * volumes.per_length);
  std::span<const CellGrid::AxisCell> near[3];
  for (int axis = 0; axis < 3; ++axis) {
    const float r = capsules ? seeker.r[axis] : seeker.motion.r[axis];
    const float moved = capsules ? 0 : seeker.motion.v[axis] * time;
    const float beside = capsules ? half * std::abs(seeker.u[axis]) : overlap;
    const std::size_t count = volumes.grid.find_near(
        axis, cell[axis], r + std::min(moved, 0.0f) - beside, r + std::max(moved, 0.0f) + beside,
        reach, volumes.per_length, near_[axis]);
    near[axis] = {near_[axis].data(), count};
  }

  const float reach_squared = reach * reach;
  const std::size_t most = near[0].size() * near[1].size() * near[2].size();
  if (most > views_.size()) {
    views_.resize(most);
    view_cells_.resize(most);
  }
  // Copied, because for all the compiler knows the stores below might change this pointer.
  const NeedleBlock* const blocks = volumes.cells.blocks();
  kernels::CellView* view = views_.data();
  Cell* view_cell = view_cells_.data();
  for (const auto& z : near[2]) {
    for (const auto& y : near[1]) {
      const float gap_squared = z.gap_squared + y.gap_squared;
      if (gap_squared > reach_squared) continue;
      const std::size_t row = volumes.grid.index(0, y.wrapped, z.wrapped);
      for (const auto& x : near[0]) {
        const std::uint32_t first = static_cast<std::uint32_t>(row + x.wrapped);
        if (gap_squared + x.gap_squared > reach_squared) continue;
        needlework::prefetch(&blocks[first].word);
        needlework::prefetch(&blocks[first].needle);
        if (!capsules) needlework::prefetch(&blocks[first].time);
        *view++ = {first, {x.offset, y.offset, z.offset}};
        *view_cell++ = {x.cell, y.cell, z.cell};
      }
    }
  }
  view_count_ = static_cast<std::size_t>(view - views_.data());
  const std::size_t room = (view_count_ * volumes.cells.longest_chain() + 1) * kernels::block_size;
  if (2 * room > found_.size()) found_.resize(4 * room);
}

// The boxes to be added to the centre of a needle found in this view.
inline Shift NearSearch::shift_of(Needle j, std::uint32_t view) const {
  return volumes_->grid.boxes_between(view_cells_[view], volumes_->places[j].cell);
}

inline void NearSearch::propose(const kernels::Found& found, std::size_t k, double from) {
  const Needle j(found.needle[k]);
  needlework::prefetch(&volumes_->places[j]);
  needlework::prefetch(&volumes_->gas.records[j]);
  needlework::prefetch(&volumes_->gas.ids[j]);
  candidates_.push_back({from, j, found.cell[k], {}});
}

// Proposes those of the needles found that may meet the seeker, with the earliest time at which
// they may.
inline void NearSearch::follow(const kernels::Seeker& seeker, const JustHit& just_hit,
                               const kernels::Found& found, std::size_t count) {
  const BoundingVolumes& volumes = *volumes_;
  const PairColumns pairs =
      pairs_.fill(seeker, volumes.motions.data(), views_.data(), found, count);
  float* const from = pairs.column[PairColumns::from];
  // A pair that parts too slowly for the filter is left out of it and proposed.
  const bool parts = just_hit.apart > 0;
  const float never = 2 * seeker.ahead + 1;
  const auto apart =
      parts ? static_cast<float>(std::min<double>(just_hit.apart * volumes.per_time, never))
            : never;
  for (std::size_t k = 0; k < count; ++k) {
    const bool hit = found.needle[k] == just_hit.needle.index &&
                     same(shift_of(just_hit.needle, found.cell[k]), just_hit.shift);
    from[k] = hit ? apart : 0;
    if (hit && !parts) propose(found, k, 0);
  }
  counters_.bracket_steps += kernels_.bracket(seeker, pairs, count);
  for (std::size_t k = 0; k < count; ++k) {
    if (from[k] <= seeker.ahead) propose(found, k, from[k] / volumes.per_time);
  }
}

std::span<const NearSearch::Candidate> NearSearch::candidates(Needle i, const JustHit& just_hit,
                                                              double ahead) {
  const BoundingVolumes& volumes = *volumes_;
  const kernels::Seeker seeker = seeker_for(i, ahead);
  look_around(seeker, volumes.places[i].cell, ahead);
  const bool in_cache = volumes.motions.size() <= motions_in_cache;
  const kernels::Surroundings around{
      volumes.cells.blocks(), volumes.cells.next(),
      views_.data(),          view_count_,
      volumes.format,         in_cache ? nullptr : volumes.motions.data()};
  const kernels::Found found{found_.data(), found_.data() + found_.size() / 2};
  const auto radius = static_cast<float>(volumes.radius * volumes.per_length);
  const auto [entries, count] = volumes.kind == BoundingVolume::cell
                                    ? kernels_.approaching(around, seeker, found)
                                    : kernels_.overlapping(around, seeker, radius, found);
  counters_.candidates += entries;

  for (std::size_t k = 0; k < count; ++k) {
    needlework::prefetch(&volumes.motions[found.needle[k]]);
  }
  candidates_.clear();
  if (follows_) {
    follow(seeker, just_hit, found, count);
  } else {
    for (std::size_t k = 0; k < count; ++k) propose(found, k, 0);
  }
  std::sort(candidates_.begin(), candidates_.end(),
            [](const Candidate& a, const Candidate& b) { return a.from < b.from; });
  for (Candidate& candidate : candidates_) {
    candidate.shift = shift_of(candidate.needle, candidate.view);
  }
  counters_.filtered += entries - candidates_.size();
  return candidates_;
}

}  // namespace needlework
