// Searches with SIMD kernels over rows of cells: `linked-cells` and `capsules`.
//
// Both look through the cells around a needle (bounding_volumes.h) with a filter. For the
// pairs that pass it, bracket() of kernels/near_needles.h finds the time before which a pair cannot
// meet, or that it does not meet at all.
//
//   linked-cells  needles whose bounding spheres meet in flight; for dilute gases, where needles
//                 stay long in their cells and neighbours are few
//   capsules      needles whose capsules overlap; for dense gases, where the few needles next to a
//                 needle are nearly all that it can meet
//
// Spheres stay in their capsules, which are balls, through collisions, and keep lists of those
// whose balls overlap. Needles would leave theirs too soon (bench/experiments.md).
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "src/memory/prefetch.h"
#include "src/search/bounding_volumes.h"
#include "src/search/neighbour_lists.h"
#include "src/search/pair_table.h"
#include "src/search/search.h"

namespace needlework {

/// One thread's part of the search.
class NearSearch {
 public:
  /// `gas` and `counters` must outlive the search; needles are entered by place().
  NearSearch(const Gas& gas, Counters& counters, const SearchSetup& setup, BoundingVolume kind);
  /// For another thread, with counters of its own; shares the bounding volumes.
  NearSearch(const NearSearch& other, Counters& counters);

  static constexpr const char* name_of(BoundingVolume kind) {
    return kind == BoundingVolume::cell ? "linked-cells" : "capsules";
  }
  /// The kind that scenes name so, if any.
  static std::optional<BoundingVolume> kind_of(std::string_view name) {
    for (const auto kind : {BoundingVolume::cell, BoundingVolume::capsule}) {
      if (name == name_of(kind)) return kind;
    }
    return std::nullopt;
  }

  Time place(Needle i, Time now, double half_length);
  void set_next_event(Needle i, Time time) { volumes_->set_next_event(i, time); }
  Time next_event(Needle i) const { return volumes_->places[i].next_event; }
  void begin_again(Time now);
  void renumber(const std::vector<Needle>& ranks);
  /// Candidates come in the order of the times from which on they may meet.
  template <class Visit>
  void find(const SearchQuery& query, const Lengths auto&, Visit&& visit) {
    double ahead = query.ahead;
    for (const Candidate& candidate : candidates(query.needle, query.just_hit, ahead)) {
      if (candidate.from > ahead) break;
      ahead = visit(candidate.needle, candidate.shift, candidate.from);
    }
  }
  const char* name() const { return name_of(kind_); }
  std::size_t cells() const { return grid().size(); }
  std::uint32_t cell_index(Needle i) const {
    return static_cast<std::uint32_t>(grid().index_of(cell_of(i)));
  }
  void prefetch(Needle i) const {
    needlework::prefetch(&volumes_->places[i]);
    needlework::prefetch(&volumes_->motions[i]);
    if (!lists_) return;
    needlework::prefetch(&volumes_->balls[i]);
    lists_->prefetch(i);
  }

  const BoundingVolumes& volumes() const { return *volumes_; }
  /// The grid by which needles are found; of a mixture, the one that contains those of its classes.
  const CellGrid& grid() const { return volumes_->grid; }
  /// The cell of this grid in which needle i has been placed, in the frame of its record.
  Cell cell_of(Needle i) const { return volumes_->common_cell_of(i); }
  /// How far from its cell a needle may come before it is placed again, at most. [L]
  double drift() const { return volumes_->drift; }
  /// How far from where a needle is it may be placed, at most. [L]
  double radius() const { return volumes_->radius; }
  /// Makes times from now on fit for place(). Returns until when they are: up to then several
  /// threads may call place().
  Time prepare(Time now, int threads) {
    volumes_->prepare(now, threads);
    return volumes_->prepared_until();
  }

 private:
  struct Candidate {
    double from;  ///< does not meet it before, as a time from now [time]
    Needle needle;
    std::uint32_t view;  ///< of the cell in which it was found
    Shift shift;
  };

  // One size class, as one search looks at it.
  struct Look {
    const ClassCells* cells;
    kernels::Seeker seeker;  ///< lengths count from the corner of `origin`
    Cell origin;             ///< the cell that the needle is in
    bool capsule;            ///< whether it is in a capsule
    float low[3], high[3];   ///< the box around the axis of that, or around its path
    float touching = 0;      ///< largest distance of axes in contact
    float distance = 0;      ///< of centres from axes, or of axes, in contact or in overlap
    float reach = 0;         ///< how far from that segment centres may be
    std::size_t views = 0, first_view = 0;
    std::size_t found = 0, first_found = 0;
  };

  class SegmentInCells;

  std::span<const Candidate> candidates(Needle i, const JustHit& just_hit, double ahead);
  Time place_in_ball(Needle i, Time now);
  void list_neighbours(Needle i);
  kernels::Scan look_into_cells(Needle i, double ahead);
  kernels::Scan look_into_list(Needle i, double ahead);
  kernels::Found found();
  void begin_looks(Needle i, double ahead);
  void look_from(Needle i, const ClassCells& own, double ahead, kernels::Seeker& seeker) const;
  void make_seeker(Needle i, const ClassCells& own, double ahead, kernels::Seeker& seeker) const;
  void seen_from(const ClassCells& own, Look& look) const;
  float touching(Needle i, const ClassCells& there) const;
  void sweep(const ClassCells& own, double ahead, Look& look) const;
  void make_room_for_views(std::size_t count);
  void look_around(Look& look);
  kernels::Scan scan(const ClassCells& own, const Look& look, const kernels::Found& found) const;
  void follow(const JustHit& just_hit, const kernels::Found& found, std::size_t count);
  std::size_t bracket(const kernels::Seeker& seeker, const kernels::PairColumns& pairs,
                      std::size_t count) const;
  void set_distances(Needle i, const kernels::Found& found, std::size_t count);
  void leave_out_sliding(const kernels::Found& found, std::size_t count, float never);
  void propose(const kernels::Found& found, std::size_t k, double from);
  Shift shift_of(Needle j, std::uint32_t view) const;
  Shift shift_in_list(Needle j, std::uint32_t neighbour) const;

  std::shared_ptr<BoundingVolumes> volumes_;
  BoundingVolume kind_;  ///< that the search is named by
  Counters& counters_;
  const kernels::NearKernels& kernels_;
  bool follows_;             ///< whether pairs are followed by SIMD before they are proposed
  bool has_width_;           ///< whether axes in contact are apart
  float margin_;             ///< Gas::margin [unit of length]
  bool are_spheres_;         ///< whether no body has an axis
  std::vector<Look> looks_;  ///< the own class first
  std::vector<CellGrid::AxisCell> near_[3];
  std::vector<kernels::CellView> views_;
  std::vector<Cell> view_cells_;      ///< of the views, not wrapped into the box
  std::vector<std::uint32_t> found_;  ///< needles, then their cells, each in one half
  /// Absent where all neighbours are looked for at each search.
  std::optional<NeighbourLists> lists_;
  std::vector<NeighbourLists::Neighbour> neighbours_;  ///< of one body
  PairTable pairs_;
  std::vector<Candidate> candidates_;
};

static_assert(Search<NearSearch>);

}  // namespace needlework
