#include "tests/support/searches.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "src/search/all_pairs.h"
#include "src/search/linked_lists.h"
#include "src/search/near_search.h"

namespace needlework::test {
namespace {

template <class Search>
class Wrapped final : public AnySearch {
 public:
  Wrapped(const Gas& gas, Counters& counters, const SearchSetup& setup)
      : search_(gas, counters, setup) {}

  Time place(Needle i, Time now) override { return search_.place(i, now); }
  void renumber(const std::vector<Needle>& ranks) override { search_.renumber(ranks); }
  void find(Needle i, Time now, double ahead, const Visit& visit) override {
    search_.find(i, now, ahead, visit);
  }
  const CellGrid* grid() const override {
    if constexpr (requires { search_.grid(); }) {
      return &search_.grid();
    } else {
      return nullptr;
    }
  }

 private:
  Search search_;
};

}  // namespace

bool SearchChoice::by_lanes() const {
  return search == LinkedCells::name || search == Capsules::name;
}

std::string SearchChoice::name() const {
  std::string out = search;
  if (by_lanes()) out += fmt::format("_{}", kernels::name_of(setup.isa));
  if (setup.cell_side) out += fmt::format("_side_{}", *setup.cell_side);
  if (setup.capsule_radius) out += fmt::format("_radius_{}", *setup.capsule_radius);
  std::replace(out.begin(), out.end(), '-', '_');
  std::replace(out.begin(), out.end(), '.', 'p');
  return out;
}

void SearchChoice::apply(Scene& scene) const {
  scene.engine.search = search;
  scene.engine.isa = kernels::name_of(setup.isa);
  scene.engine.cell_side = setup.cell_side;
  scene.engine.capsule_radius = setup.capsule_radius;
}

std::vector<SearchChoice> search_choices() {
  const std::vector<kernels::Isa> sets = kernels::available();
  std::vector<SearchChoice> out;
  const auto add = [&](const char* search, kernels::Isa isa, std::optional<double> side,
                       std::optional<double> radius) {
    out.push_back({search, {isa, side, radius}});
  };
  const std::optional<double> chosen;
  add(AllPairs::name, sets.front(), chosen, chosen);
  add(LinkedLists::name, sets.front(), chosen, chosen);
  add(LinkedLists::name, sets.front(), 1.6, chosen);
  for (const kernels::Isa isa : sets) {
    add(LinkedCells::name, isa, chosen, chosen);
    add(Capsules::name, isa, chosen, chosen);
  }
  // Small cells are seen from several cells away, wide ones hold chains of blocks; capsules may be
  // thinner and thicker than needles are apart.
  for (const double side : {0.4, 1.0, 2.5}) add(LinkedCells::name, sets.back(), side, chosen);
  for (const double radius : {0.01, 0.3, 1.5}) add(Capsules::name, sets.back(), chosen, radius);
  add(Capsules::name, sets.back(), 0.4, 0.1);
  add(Capsules::name, sets.back(), 4.0, 0.1);
  return out;
}

std::unique_ptr<AnySearch> make_search(const SearchChoice& choice, const Gas& gas,
                                       Counters& counters) {
  const auto make = [&]<class Search>() -> std::unique_ptr<AnySearch> {
    return std::make_unique<Wrapped<Search>>(gas, counters, choice.setup);
  };
  if (choice.search == AllPairs::name) return make.operator()<AllPairs>();
  if (choice.search == LinkedLists::name) return make.operator()<LinkedLists>();
  if (choice.search == LinkedCells::name) return make.operator()<LinkedCells>();
  if (choice.search == Capsules::name) return make.operator()<Capsules>();
  throw std::invalid_argument("no search is named " + choice.search);
}

}  // namespace needlework::test
