#include "src/search/near_search.h"

#include <algorithm>
#include <vector>

#include "src/search/ball_lists.h"
#include "src/search/cell_scan.h"
#include "src/search/pair_filter.h"

namespace needlework {

struct NearSearch::Parts {
  Parts(BoundingVolumes& all, const kernels::NearKernels& its_kernels, bool filters_pairs,
        Counters& its_counters)
      : volumes(all),
        kernels(its_kernels),
        filters(filters_pairs),
        counters(its_counters),
        cells(all, its_kernels),
        filter(all, its_kernels, its_counters) {
    if (all.gas.shear) rows.emplace(all, its_kernels);
  }

  template <class Source>
  std::span<const Candidate> find(Source& source, const SearchQuery& query);

  BoundingVolumes& volumes;
  const kernels::NearKernels& kernels;
  bool filters;  ///< whether pairs are bracketed by SIMD before they are proposed
  Counters& counters;
  CellScan cells;
  std::optional<RowScan> rows;     ///< absent where cells do not slide
  std::optional<BallLists> balls;  ///< absent where all neighbours are looked for at each search
  PairFilter filter;
  std::vector<Candidate> candidates;
};

NearSearch::NearSearch(const Gas& gas, Counters& counters, const SearchSetup& setup,
                       BoundingVolume kind)
    : volumes_(std::make_shared<BoundingVolumes>(gas, setup, kind)),
      kind_(kind),
      parts_(std::make_unique<Parts>(*volumes_, kernels::near_kernels(setup.isa),
                                     setup.float_filter, counters)),
      has_balls_(BallLists::suit(*volumes_)),
      scans_otherwise_(has_balls_ || gas.shear) {
  if (has_balls_) parts_->balls.emplace(*volumes_);
}

NearSearch::NearSearch(const NearSearch& other, Counters& counters)
    : volumes_(other.volumes_),
      kind_(other.kind_),
      parts_(std::make_unique<Parts>(*volumes_, other.parts_->kernels, other.parts_->filters,
                                     counters)),
      has_balls_(false),
      scans_otherwise_(volumes_->gas.shear.has_value()) {}

NearSearch::NearSearch(NearSearch&&) noexcept = default;
NearSearch::~NearSearch() = default;

Time NearSearch::place(Needle i, Time now, double half_length) {
  Parts& own = *parts_;
  own.counters.crossings +=
      has_balls_ ? own.balls->place(i, now, own.cells) : volumes_->place(i, now, half_length);
  return volumes_->places[i].next_event;
}

void NearSearch::begin_again(Time now) {
  volumes_->begin_again(now);
  if (has_balls_) parts_->balls->begin_again();
}

void NearSearch::renumber(const std::vector<Needle>& ranks) {
  volumes_->renumber(ranks);
  if (has_balls_) parts_->balls->renumber(ranks);
}

void NearSearch::prefetch_ball(Needle i) const { parts_->balls->prefetch(i); }

std::span<const Candidate> NearSearch::candidates(const SearchQuery& query) {
  Parts& own = *parts_;
  if (!scans_otherwise_) return own.find(own.cells, query);
  if (has_balls_) return own.find(*own.balls, query);
  own.rows->set_now(query.now);
  return own.find(*own.rows, query);
}

template <class Source>
inline std::span<const Candidate> NearSearch::Parts::find(Source& source,
                                                          const SearchQuery& query) {
  const JustHit& just_hit = query.just_hit;
  const auto [entries, count] = source.look(query.needle, query.ahead);
  const kernels::Found found = source.found();
  if constexpr (!std::is_same_v<Source, BallLists>) {
    for (std::size_t k = 0; k < count; ++k) {
      needlework::prefetch(&volumes.motions[found.needle[k]]);
    }
  }
  // The boxes to be added to the centre of a needle found in this view.
  const auto shift_of = [&](Needle j, std::uint32_t view) {
    const Shift shift =
        volumes.class_of(j).grid.boxes_between(source.cell_seen(view), volumes.places[j].cell);
    if constexpr (std::is_same_v<Source, RowScan>)
      return source.shift_in_rows(query.needle, j, view, shift);
    else
      return shift;
  };
  candidates.clear();
  if (filters) {
    const kernels::PairColumns& columns = filter.columns_for(count);
    const kernels::Motion* const motions = volumes.motions.data();
    source.for_each_seeker([&](const kernels::Seeker& seeker, std::size_t begin, std::size_t end) {
      const auto offsets = source.offsets();
      if (volumes.are_spheres)
        PairTable::fill<false>(columns, seeker, motions, offsets, found, begin, end);
      else if constexpr (!std::is_same_v<Source, BallLists>)
        PairTable::fill<true>(columns, seeker, motions, offsets, found, begin, end);
    });
    PairFilter::Parting parting{0, just_hit.apart};
    for (; parting.pair < count; ++parting.pair) {
      if (found.needle[parting.pair] == just_hit.needle.index &&
          same(shift_of(just_hit.needle, found.cell[parting.pair]), just_hit.shift))
        break;
    }
    filter.pass(source.seeker(), found, count, parting, candidates);
  } else {
    for (std::size_t k = 0; k < count; ++k) filter.propose(found, k, 0, candidates);
  }
  std::sort(candidates.begin(), candidates.end(),
            [](const Candidate& a, const Candidate& b) { return a.from < b.from; });
  for (Candidate& candidate : candidates) {
    candidate.shift = shift_of(candidate.needle, candidate.view);
  }
  // Cells that come round to those at the other wall hold no neighbours.
  if (!volumes.gas.box.is_periodic()) {
    std::erase_if(candidates, [&](const Candidate& candidate) {
      return !volumes.gas.box.has_image(candidate.shift);
    });
  }
  counters.candidates += entries;
  counters.filtered += entries - candidates.size();
  return candidates;
}

}  // namespace needlework
