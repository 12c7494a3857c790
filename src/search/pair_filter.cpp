#include "src/search/pair_filter.h"

#include <algorithm>

namespace needlework {
namespace {

using kernels::PairColumns;

}  // namespace

PairFilter::PairFilter(const BoundingVolumes& volumes, const kernels::NearKernels& kernels,
                       Counters& counters)
    : volumes_(volumes),
      counters_(counters),
      bracket_(volumes.gas.composition.are_spheres() ? kernels.bracket_spheres
               : volumes.gas.composition.has_width() ? kernels.bracket_rods
                                                     : kernels.bracket),
      has_width_(volumes.gas.composition.has_width()) {}

void PairFilter::pass(const kernels::Seeker& seeker, const kernels::Found& found, std::size_t pairs,
                      const Parting& parting, std::vector<Candidate>& out) {
  const PairColumns& columns = table_.columns_for(pairs);
  float* const from = columns.column[PairColumns::from];
  const float never = 2 * seeker.ahead + 1;
  std::fill_n(from, pairs, 0.0f);
  if (parting.pair < pairs) {
    // A pair that parts too slowly for the filter is left out of it and proposed.
    const bool parts = parting.apart > 0;
    from[parting.pair] =
        parts ? static_cast<float>(std::min<double>(parting.apart * volumes_.frame.per_time, never))
              : never;
    if (!parts) propose(found, parting.pair, 0, out);
  }
  // Of two thin needles among rods the distance is 0: not apart by more than a margin as they
  // cross.
  if (has_width_) volumes_.distances.set(columns, Needle(seeker.needle), found, pairs);
  if (volumes_.gas.slides) propose_sliding(seeker, found, pairs, never, out);
  counters_.bracket_steps += bracket_(seeker, columns, pairs);
  const float ahead = seeker.ahead;
  for (std::size_t k = 0; k < pairs; ++k) {
    if (from[k] <= ahead) propose(found, k, from[k] / volumes_.frame.per_time, out);
  }
}

// The filter sees flights of records, from which needles in contact depart.
void PairFilter::propose_sliding(const kernels::Seeker& seeker, const kernels::Found& found,
                                 std::size_t pairs, float never, std::vector<Candidate>& out) {
  const auto slides = [&](Needle i) { return volumes_.gas.records[i].is_sliding(); };
  const bool all = slides(Needle(seeker.needle));
  float* const from = table_.columns_for(pairs).column[PairColumns::from];
  for (std::size_t k = 0; k < pairs; ++k) {
    if (from[k] == never || !(all || slides(Needle(found.needle[k])))) continue;
    from[k] = never;
    propose(found, k, 0, out);
  }
}

}  // namespace needlework
