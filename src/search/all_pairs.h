// Search without a structure: every needle, every image that could come near. Other searches are
// tested against it. Its cost grows with the number of needles.
#pragma once

#include "src/search/bounding_filter.h"
#include "src/search/search.h"
#include "src/search/setup.h"

namespace needlework {

/// Every needle and image that could come near.
class AllPairs {
 public:
  static constexpr const char* search_name = "all-pairs";

  AllPairs(const Gas& gas, Counters& counters, const SearchSetup&)
      : gas_(gas), counters_(counters) {}

  const char* name() const { return search_name; }
  std::size_t cells() const { return 1; }
  std::uint32_t cell_index(Needle) const { return 0; }
  void prefetch(Needle) const {}
  Time place(Needle, Time, double /*half_length*/) { return Time::never(); }
  void set_next_event(Needle, Time) {}
  Time next_event(Needle) const { return Time::never(); }
  void begin_again(Time) {}
  void renumber(const std::vector<Needle>&) {}

  template <class Visit>
  void find(const SearchQuery& query, const Lengths auto& lengths, Visit&& visit) const {
    const Needle i = query.needle;
    BoundingFilter filter(gas_, counters_, query, lengths);
    const Box box = gas_.box_at(query.now);
    for (Needle j{0}; j < gas_.size(); ++j) {
      if (j == i) continue;
      const auto other = gas_.motion_from(gas_.records[j], query.now);
      const Vec3d r = filter.centre() - other.centre(), v = filter.velocity() - other.velocity();
      const double reach = lengths.reach(i) + lengths.reach(j);
      box.for_each_image_near(r, v, reach, filter.ahead(),
                              [&](const Shift& shift) { filter(j, shift, visit); });
    }
  }

 private:
  const Gas& gas_;
  Counters& counters_;
};

static_assert(Search<AllPairs>);

}  // namespace needlework
