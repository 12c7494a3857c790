// Searches with SIMD kernels over rows of cells: `linked-cells` and `capsules`.
//
//   linked-cells  needles whose bounding spheres meet in flight; for dilute gases, where needles
//                 stay long in their cells and neighbours are few
//   capsules      needles whose capsules overlap; for dense gases, where the few needles next to a
//                 needle are nearly all that it can meet
//
// Why no pair is left out: two can meet before one of them searches again only if their bounding
// volumes are near each other (bounding_volumes.h), and such pairs are found by a scan of the cells
// (cell_scan.h) or, for spheres in balls, in lists (ball_lists.h). Of these the filter
// (pair_filter.h) leaves out those alone that do not meet in the time ahead. The others are
// proposed in the order of the times from which on they may meet, so that what is left when a
// meeting is known is later.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "src/memory/prefetch.h"
#include "src/search/bounding_volumes.h"
#include "src/search/candidate.h"
#include "src/search/search.h"

namespace needlework {

/// One thread's part of the search.
class NearSearch {
 public:
  /// `gas` and `counters` must outlive the search; needles are entered by place().
  NearSearch(const Gas& gas, Counters& counters, const SearchSetup& setup, BoundingVolume kind);
  /// For another thread, with counters of its own; shares the bounding volumes.
  NearSearch(const NearSearch& other, Counters& counters);
  NearSearch(NearSearch&& other) noexcept;
  ~NearSearch();

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
    for (const Candidate& candidate : candidates(query)) {
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
    if (has_balls_) prefetch_ball(i);
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
    return volumes_->frame.end();
  }

 private:
  // What one thread searches with. Hidden, so that event loops need not compile it.
  struct Parts;

  std::span<const Candidate> candidates(const SearchQuery& query);
  void prefetch_ball(Needle i) const;

  std::shared_ptr<BoundingVolumes> volumes_;
  BoundingVolume kind_;  ///< that the search is named by
  std::unique_ptr<Parts> parts_;
  bool has_balls_;        ///< whether there are lists of neighbours
  bool scans_otherwise_;  ///< whether there are, or cells slide in rows
};

static_assert(Search<NearSearch>);

}  // namespace needlework
