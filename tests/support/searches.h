// Every search there is, with every instruction set of this machine and some sizes set by hand:
// behind one interface for tests of the searches alone, and as keys of a scene.
#pragma once

#include <functional>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "needlework/counters.h"
#include "needlework/scene.h"
#include "src/physics/gas.h"
#include "src/search/cell_grid.h"
#include "src/search/search.h"
#include "src/search/setup.h"

namespace needlework::test {

/// A search by its name, and what it is asked for.
struct SearchChoice {
  std::string search;
  SearchSetup setup;

  /// As a test may be named: "capsules_avx2_radius_0p3".
  std::string name() const;
  /// True for those that compute with this setup's instruction set.
  bool uses_simd() const;
  void apply(Scene& scene) const;
};

inline void PrintTo(const SearchChoice& choice, std::ostream* out) { *out << choice.name(); }

/// All-pairs first.
std::vector<SearchChoice> search_choices();

/// A search as src/search/search.h describes it, its type erased.
class AnySearch {
 public:
  using Visit = std::function<double(Needle, const Shift&, double from)>;

  virtual ~AnySearch() = default;
  virtual Time place(Needle i, Time now) = 0;
  virtual void set_next_event(Needle i, Time time) = 0;
  virtual void renumber(const std::vector<Needle>& ranks) = 0;
  virtual void find(const SearchQuery& query, const Visit& visit) = 0;
  virtual const char* name() const = 0;
  virtual std::size_t cells() const = 0;
  virtual std::uint32_t cell_index(Needle i) const = 0;
  /// Null for a search without cells.
  virtual const CellGrid* grid() const = 0;
};

/// `gas` and `counters` must outlive the search.
std::unique_ptr<AnySearch> make_search(const SearchChoice& choice, const Gas& gas,
                                       Counters& counters);

}  // namespace needlework::test
