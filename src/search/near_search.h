// Searches by lanes over rows of cells: linked cells and capsules.
//
// A needle is placed where it is: it gets a hull, a region fixed in space that it will not leave
// before a known time, and an entry in a cell. Only needles whose hulls come near can meet before
// one of them is placed anew, and whoever is placed anew searches. So nothing has to be kept: no
// lists, and no trace of a needle with its neighbours.
//
//   linked-cells  the hull is the cell and a fifth of its side around it; filtered by bounding
//                 spheres in flight.
//                 For dilute gases: needles stay long, and neighbours are few.
//   capsules      the hull is a capsule of radius delta around the needle; filtered by the overlap
//                 of capsules. For dense gases: the few needles next to this one are nearly all.
//
// What a filter passes is looked at once more, by lanes: bracket() of kernels/near_needles.h
// follows both needles until they cannot meet, or to where they may.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "kernels/near_needles.h"
#include "needlework/counters.h"
#include "src/memory/large_array.h"
#include "src/memory/prefetch.h"
#include "src/physics/gas.h"
#include "src/search/cell_grid.h"
#include "src/search/search.h"
#include "src/search/setup.h"

namespace needlework {

/// Where all needles are: their hulls, and the cells that hold them. Several threads may use it at
/// once, as long as none reads what another writes: placing a needle writes to the cells that it
/// leaves and enters, finding its neighbours reads cells within `Phase::neighbours` of its own
/// (src/engine/phase.h).
struct Hulls {
  enum class Kind { cell, capsule };

  struct Place {
    Cell cell{};
    std::uint32_t block = kernels::BlockLink::none;
    std::uint32_t lane = 0;
    Time until = Time::never();
  };

  Hulls(const Gas& gas, const SearchSetup& setup, Kind kind);

  void rebase(Time now);
  void set_motion(Needle i, Time now);
  void write_entry(Needle i, const Vec3d& centre, const Vec3d& a, Time now);
  /// Returns whether i has come from another cell.
  bool enter(Needle i, const Cell& cell);
  void leave(Needle i);
  double since_base(Time t) const { return gas.clock.difference(t, base) * unit; }

  const Gas& gas;
  Kind kind;
  double radius;       ///< of capsules; else 0 [L]
  double overlap = 0;  ///< how far a needle may go beyond its cell; 0 for capsules [L]
  CellGrid grid;
  float margin = 0;  ///< of lengths, see kernels::Seeker [L]
  double unit = 0;   ///< 1 / unit of time: a power of two; 0 before the first needle
  Time base;         ///< from which times in blocks and motions count
  LargeArray<Place> places;
  LargeArray<kernels::Motion> motions;
  LargeArray<kernels::NeedleBlock>
      blocks;  ///< first those of the cells, then those chained to them
  LargeArray<kernels::BlockLink> links;
  std::vector<std::uint32_t> free_blocks;
  std::mutex chaining;  ///< held while blocks are taken from or given to the free ones
  std::atomic<std::size_t> longest_chain = 1;  ///< blocks of one cell that there have ever been
};

/// A thread's own part of the search.
class NearSearch {
 public:
  /// `gas` must outlive the search; needles are entered by place().
  NearSearch(const Gas& gas, Counters& counters, const SearchSetup& setup, Hulls::Kind kind);
  /// For another thread, with counters of its own; shares the hulls.
  NearSearch(const NearSearch& other, Counters& counters);

  /// The kind that scenes name so, if any.
  static std::optional<Hulls::Kind> kind_of(std::string_view name) {
    if (name == "linked-cells") return Hulls::Kind::cell;
    if (name == "capsules") return Hulls::Kind::capsule;
    return std::nullopt;
  }
  const char* name() const {
    return hulls_->kind == Hulls::Kind::cell ? "linked-cells" : "capsules";
  }

  Time place(Needle i, Time now);
  void renumber(const std::vector<Needle>& ranks);
  void prefetch(Needle i) const {
    needlework::prefetch(&hulls_->places[i]);
    needlework::prefetch(&hulls_->motions[i]);
  }

  template <class Visit>
  void find(Needle i, Needle just_hit, Time now, double ahead, Visit&& visit) {
    for (const Candidate& candidate : candidates(i, just_hit, now, ahead)) {
      if (candidate.from > ahead) break;  // they are in this order
      ahead = visit(candidate.needle, candidate.shift, candidate.from, candidate.to);
    }
  }

  const Hulls& hulls() const { return *hulls_; }
  const CellGrid& grid() const { return hulls_->grid; }
  /// The cell in which needle i has been placed, in the frame of its record.
  const Cell& cell_of(Needle i) const { return hulls_->places[i].cell; }
  std::size_t cells() const { return grid().size(); }
  std::uint32_t cell_index(Needle i) const {
    return static_cast<std::uint32_t>(grid().index_of(cell_of(i)));
  }
  /// How far from its cell a needle may come before it is placed anew. [L]
  double drift() const { return hulls_->kind == Hulls::Kind::cell ? hulls_->overlap : radius(); }
  /// How far from where a needle is it may be placed. [L]
  double radius() const { return hulls_->radius; }
  /// Makes times from now on fit for place(). Returns until when they are: till then several
  /// threads may call it.
  Time prepare(Time now) {
    Hulls& hulls = *hulls_;
    // From the middle on anew, so that there is always as much ahead.
    if (hulls.unit == 0 || hulls.since_base(now) > 0.5 * kernels::longest_time) hulls.rebase(now);
    return hulls.gas.clock.add(hulls.base, kernels::longest_time / hulls.unit);
  }

 private:
  struct Candidate {
    double from, to;  ///< meets it between these times from now, if at all [time]
    Needle needle;
    std::uint32_t view;  ///< of the cell in which it was found
    Shift shift;
  };

  std::span<const Candidate> candidates(Needle i, Needle just_hit, Time now, double ahead);
  void look_around(const kernels::Seeker& seeker, const Cell& cell, double ahead);
  kernels::PairColumns pair_columns(std::size_t n);

  std::shared_ptr<Hulls> hulls_;
  Counters& counters_;
  const kernels::NearKernels& kernels_;
  bool by_lanes_;  ///< whether pairs are followed by lanes before they are proposed
  std::vector<CellGrid::AxisCell> near_[3];
  std::vector<kernels::CellView> views_;
  std::size_t view_count_ = 0;
  std::vector<Cell> view_cells_;      ///< of the views, not wrapped into the box
  std::vector<std::uint32_t> found_;  ///< needles, then their cells, each in one half
  std::vector<float> pair_storage_;
  std::size_t pair_capacity_ = 0;
  std::vector<Candidate> candidates_;
};

static_assert(Search<NearSearch>);

}  // namespace needlework
