#include "tests/support/searches.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "src/search/all_pairs.h"
#include "src/search/linked_lists.h"
#include "src/search/near_search.h"

namespace needlework::test {
namespace {

const CellGrid* grid_of(const AllPairs&) { return nullptr; }
const CellGrid* grid_of(const LinkedLists& search) { return &search.grid(); }
const CellGrid* grid_of(const NearSearch& search) { return &search.grid(); }

template <Search S>
class Wrapped final : public AnySearch {
 public:
  template <class... Arguments>
  explicit Wrapped(const Gas& gas, Arguments&&... arguments)
      : lengths_{gas}, search_(gas, arguments...) {}

  Time place(Needle i, Time now) override { return search_.place(i, now, lengths_.half_length(i)); }
  void set_next_event(Needle i, Time time) override { search_.set_next_event(i, time); }
  void renumber(const std::vector<Needle>& ranks) override { search_.renumber(ranks); }
  void find(const SearchQuery& query, const Visit& visit) override {
    search_.find(query, lengths_, visit);
  }
  const char* name() const override { return search_.name(); }
  std::size_t cells() const override { return search_.cells(); }
  std::uint32_t cell_index(Needle i) const override { return search_.cell_index(i); }
  const CellGrid* grid() const override { return grid_of(search_); }

 private:
  BodyLengths lengths_;
  S search_;
};

constexpr const char* linked_cells = NearSearch::name_of(BoundingVolume::cell);
constexpr const char* capsules = NearSearch::name_of(BoundingVolume::capsule);

}  // namespace

bool SearchChoice::uses_simd() const { return NearSearch::kind_of(search).has_value(); }

std::string SearchChoice::name() const {
  std::string out = search;
  if (uses_simd()) out += fmt::format("_{}", kernels::name_of(setup.isa));
  if (setup.cell_side) out += fmt::format("_side_{}", *setup.cell_side);
  if (setup.capsule_radius) out += fmt::format("_radius_{}", *setup.capsule_radius);
  if (setup.by_class) out += "_by_class";
  std::replace(out.begin(), out.end(), '-', '_');
  std::replace(out.begin(), out.end(), '.', 'p');
  return out;
}

void SearchChoice::apply(Scene& scene) const {
  scene.engine.search = setup.by_class ? "auto" : search;
  scene.engine.isa = kernels::name_of(setup.isa);
  scene.engine.cell_side = setup.cell_side;
  scene.engine.capsule_radius = setup.capsule_radius;
}

std::vector<SearchChoice> search_choices() {
  const std::vector<kernels::Isa> sets = kernels::available();
  std::vector<SearchChoice> out;
  const auto add = [&](const char* search, kernels::Isa isa, std::optional<double> side,
                       std::optional<double> radius) {
    out.push_back(
        {search, {.isa = isa, .density = {}, .cell_side = side, .capsule_radius = radius}});
  };
  const std::optional<double> chosen;
  add(AllPairs::search_name, sets.front(), chosen, chosen);
  add(LinkedLists::search_name, sets.front(), chosen, chosen);
  add(LinkedLists::search_name, sets.front(), 1.6, chosen);
  for (const kernels::Isa isa : sets) {
    add(linked_cells, isa, chosen, chosen);
    add(capsules, isa, chosen, chosen);
  }
  // Small cells are seen from several cells away, wide ones hold chains of blocks; capsules may be
  // thinner and thicker than needles are apart.
  for (const double side : {0.4, 1.0, 2.5}) add(linked_cells, sets.back(), side, chosen);
  for (const double radius : {0.01, 0.3, 1.5}) add(capsules, sets.back(), chosen, radius);
  add(capsules, sets.back(), 0.4, 0.1);
  add(capsules, sets.back(), 4.0, 0.1);
  // In a mixture, capsules for the long needles and cells for the short ones.
  for (const kernels::Isa isa : {sets.front(), sets.back()}) {
    add(capsules, isa, chosen, chosen);
    out.back().setup.density = 20;
    out.back().setup.by_class = true;
  }
  return out;
}

std::unique_ptr<AnySearch> make_search(const SearchChoice& choice, const Gas& gas,
                                       Counters& counters) {
  if (const auto kind = NearSearch::kind_of(choice.search)) {
    return std::make_unique<Wrapped<NearSearch>>(gas, counters, choice.setup, *kind);
  }
  if (choice.search == AllPairs::search_name) {
    return std::make_unique<Wrapped<AllPairs>>(gas, counters, choice.setup);
  }
  if (choice.search == LinkedLists::search_name) {
    return std::make_unique<Wrapped<LinkedLists>>(gas, counters, choice.setup);
  }
  throw std::invalid_argument("no search is named " + choice.search);
}

}  // namespace needlework::test
