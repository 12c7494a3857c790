// The filter for the pairs that a scan has found: not before when each of them meets.
//
// Why no pair is left out: it is ruled out only by bracket() of kernels/near_needles.h, which
// computes with the records of both, in single precision with margins for every rounding, up to the
// end of the time ahead or to the other's next event, when that one searches. Pairs that it cannot
// follow are passed on: of needles in contact, whose flights are not those of their records, and
// those that have just collided and part too slowly.
#pragma once

#include <cstddef>
#include <vector>

#include "needlework/counters.h"
#include "src/memory/prefetch.h"
#include "src/search/bounding_volumes.h"
#include "src/search/candidate.h"
#include "src/search/pair_table.h"

namespace needlework {

class PairFilter {
 public:
  /// `volumes` and `counters` must outlive the filter.
  PairFilter(const BoundingVolumes& volumes, const kernels::NearKernels& kernels,
             Counters& counters);

  /// One of the pairs that has just collided.
  struct Parting {
    std::size_t pair;  ///< its number; that of pairs if there is none
    double apart;      ///< so long they do not meet again; 0 if not known [time]
  };

  /// Columns for so many pairs, to be filled by PairTable::fill().
  const kernels::PairColumns& columns_for(std::size_t pairs) { return table_.columns_for(pairs); }
  /// Appends those of the pairs filled in that may meet, without their shifts.
  void pass(const kernels::Seeker& seeker, const kernels::Found& found, std::size_t pairs,
            const Parting& parting, std::vector<Candidate>& out);
  /// Appends one of the needles found. From: a time from now. [time]
  void propose(const kernels::Found& found, std::size_t pair, double from,
               std::vector<Candidate>& out) const {
    const Needle j(found.needle[pair]);
    needlework::prefetch(&volumes_.places[j]);
    needlework::prefetch(&volumes_.gas.records[j]);
    needlework::prefetch(&volumes_.gas.ids[j]);
    out.push_back({from, j, found.cell[pair], {}});
  }

 private:
  void propose_sliding(const kernels::Seeker& seeker, const kernels::Found& found,
                       std::size_t pairs, float never, std::vector<Candidate>& out);

  using Bracket = std::size_t (*)(const kernels::Seeker&, const kernels::PairColumns&, std::size_t);

  const BoundingVolumes& volumes_;
  Counters& counters_;
  Bracket bracket_;  ///< for needles, rods or spheres
  bool has_width_;   ///< whether axes in contact are apart
  PairTable table_;
};

}  // namespace needlework
