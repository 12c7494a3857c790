#include "bench/strategies/cases.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <sstream>
#include <string_view>

#include "needlework/error.h"
#include "src/calendar/names.h"
#include "src/runs/engine_choice.h"
#include "src/search/choice.h"

namespace needlework::bench {
namespace {

struct GasScene {
  std::string name;
  std::uint64_t needles;
  double box;
  Scene::Collisions collisions = {};
  double k = 6;
  std::vector<Species> species = {};
};

struct Parts {
  std::string search, calendar, isa, storage = "sorted";
  double volume_size = 1;  ///< size of the bounding volumes, in units of what `auto` chooses
  bool operator==(const Parts&) const = default;
};

// The method of the original paper: cells of side about L with linked lists, no SIMD, a heap.
const Parts baseline{"linked-lists", "indexed-heap", "scalar"};

std::string widest() { return runs::instruction_sets().back(); }
Parts searched_by(const std::string& search) { return {search, "auto", widest()}; }

const GasScene dilute{"dilute", 10000, 24};
const GasScene dense{"dense", 20000, 12};

GasScene gas_of(std::uint64_t needles, double density) {
  return {fmt::format("n={},N={}", density, needles), needles,
          std::cbrt(static_cast<double>(needles) / density)};
}

Case make_case(const GasScene& gas, const Parts& parts) {
  Case out;
  out.scene_name = gas.name;
  out.scene.needles.count = gas.needles;
  out.scene.needles.box = {gas.box, gas.box, gas.box};
  out.scene.needles.k = gas.k;
  out.scene.species = gas.species;
  out.scene.collisions = gas.collisions;
  out.scene.engine.search = parts.search;
  out.scene.engine.queue = parts.calendar;
  out.scene.engine.isa = parts.isa;
  out.scene.engine.storage = parts.storage;
  out.scene.engine.threads = 1;
  const double density = static_cast<double>(gas.needles) / std::pow(gas.box, 3);
  if (parts.search == "linked-cells" && parts.volume_size != 1) {
    out.scene.engine.cell_side = parts.volume_size * auto_cell_side(density);
  } else if (parts.volume_size != 1) {
    out.scene.engine.capsule_radius = parts.volume_size * auto_capsule_radius(density);
  }
  out.is_baseline = parts == baseline;
  return out;
}

// Each gas with the baseline and with all other parts.
std::vector<Case> product(const std::vector<GasScene>& gases, const std::vector<Parts>& others) {
  std::vector<Case> out;
  for (const GasScene& gas : gases) {
    out.push_back(make_case(gas, baseline));
    for (const Parts& parts : others) out.push_back(make_case(gas, parts));
  }
  return out;
}

const std::vector<std::string> fast_searches{"linked-cells", "capsules"};

std::vector<Parts> all_searches() {
  std::vector<Parts> out{searched_by("linked-lists")};
  for (const std::string& search : fast_searches) out.push_back(searched_by(search));
  return out;
}

std::vector<Parts> all_calendars() {
  std::vector<Parts> out;
  for (const std::string& calendar : calendar_names()) {
    out.push_back({"auto", calendar, widest()});
  }
  return out;
}

std::vector<Parts> all_instruction_sets() {
  std::vector<Parts> out;
  for (const std::string& isa : runs::instruction_sets()) out.push_back({"auto", "auto", isa});
  return out;
}

// From the baseline to the default, changing one part at a time.
std::vector<Parts> all_steps() {
  return {{"auto", baseline.calendar, baseline.isa},
          {"auto", baseline.calendar, widest()},
          {"auto", "auto", widest()}};
}

std::vector<Parts> each_search_and_auto() {
  std::vector<Parts> out;
  for (const std::string& search : fast_searches) out.push_back(searched_by(search));
  out.push_back(searched_by("auto"));
  return out;
}

std::vector<Case> by_density() {
  std::vector<GasScene> gases;
  for (const double density : {0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0}) {
    gases.push_back(gas_of(10000, density));
  }
  return product(gases, each_search_and_auto());
}

std::vector<Case> by_size() {
  std::vector<GasScene> gases;
  for (const std::uint64_t needles : {1000, 10000, 100000, 1000000}) {
    gases.push_back(gas_of(needles, 0.72));
  }
  for (const std::uint64_t needles : {1000, 10000, 100000}) gases.push_back(gas_of(needles, 11.6));
  return product(gases, {searched_by("auto")});
}

// Every search with SIMD, with every calendar.
std::vector<Case> by_all() {
  std::vector<GasScene> gases;
  for (const std::uint64_t needles : {1000, 10000, 100000}) {
    for (const double density : {0.1, 0.72, 11.6, 50.0}) gases.push_back(gas_of(needles, density));
  }
  for (const double density : {0.72, 11.6}) gases.push_back(gas_of(1000000, density));
  std::vector<Parts> parts;
  for (const std::string& search : fast_searches) {
    for (Parts one : all_calendars()) {
      one.search = search;
      parts.push_back(one);
    }
  }
  return product(gases, parts);
}

// Needles at random positions, which storage by id leaves in random order.
std::vector<Case> by_storage() {
  return product({gas_of(10000, 0.72), gas_of(100000, 0.72), gas_of(1000000, 0.72)},
                 {searched_by("auto"), {"auto", "auto", widest(), "by-id"}});
}

// Given sizes around the chosen ones, for uniform rods and for masses at the tips and at the
// centre.
std::vector<Case> by_volume_sizes() {
  std::vector<Case> out;
  for (const double k : {2.0, 6.0, 100.0}) {
    for (const double density : {0.1, 0.72, 2.0, 4.0, 11.6, 50.0}) {
      GasScene gas = gas_of(8000, density);
      gas.k = k;
      gas.name += fmt::format(",k={}", k);
      std::vector<Parts> sizes;
      for (const double size : {0.5, 0.7, 0.85, 1.0, 1.2, 1.4, 2.0}) {
        sizes.push_back(searched_by(chosen_search("auto", density, {})));
        sizes.back().volume_size = size;
      }
      for (Case& one : product({gas}, sizes)) out.push_back(std::move(one));
    }
  }
  return out;
}

std::vector<Case> by_effects() {
  // Without the t_c rule a pair of inelastic needles would collapse.
  const Scene::Collisions elastic, rough{.beta = 0, .tc = {}, .tc_relative = {}},
      inelastic{.epsilon = 0.9, .tc = {}, .tc_relative = 1e-3},
      all{.epsilon = 0.9, .beta = 0, .tc = {}, .tc_relative = 1e-3};
  GasScene spheres{"spheres", 10000, 24, elastic};
  // They collide about as often as the needles.
  spheres.species = {{.name = "sphere", .count = 10000, .length = 0, .diameter = 0.4}};
  GasScene rough_spheres = spheres;
  rough_spheres.name = "rough-spheres";
  rough_spheres.collisions = rough;
  return product({{"elastic", 10000, 24, elastic},
                  {"rough", 10000, 24, rough},
                  {"inelastic-tc", 10000, 24, inelastic},
                  {"inelastic-rough-tc", 10000, 24, all},
                  spheres,
                  rough_spheres},
                 {searched_by("auto")});
}

// A cloud of density 37 in a box of density 0.064: with cells suited to the mean density, and with
// the chosen size.
std::vector<Case> by_cloud() {
  const GasScene gas{"cloud", 8000, 50};
  std::vector<Case> out = product({gas}, {searched_by("linked-cells"), searched_by("auto")});
  for (Case& one : out) one.filled = 0.12;
  out[1].scene.engine.cell_side = auto_cell_side(8000 / std::pow(gas.box, 3));
  return out;
}

// Needles of length 1 and a share of long ones, at this many needles per cube of the mean length.
GasScene mixture_of(std::uint64_t needles, double density, double length, double share) {
  const auto long_ones =
      static_cast<std::uint64_t>(std::llround(share * static_cast<double>(needles)));
  const double mean = 1 + share * (length - 1);
  GasScene out = gas_of(needles, density);
  out.name = fmt::format("n={},1:{},{}%", density, length, 100 * share);
  out.box *= mean;
  out.species = {{.name = "short", .count = needles - long_ones, .length = 1},
                 {.name = "long", .count = long_ones, .length = length}};
  return out;
}

// Mixtures in one grid, with the sizes that the mean length asks for, and as chosen; before those
// of a density, the gas of one length that collides as often.
std::vector<Case> by_mixture() {
  std::vector<Case> out;
  for (const double density : {0.1, 1.0, 10.0}) {
    std::vector<GasScene> gases{gas_of(100000, density), mixture_of(100000, density, 4, 0.5),
                                mixture_of(100000, density, 20, 0.5)};
    // Denser, the box would be too small for the long ones.
    if (density <= 1) gases.push_back(mixture_of(100000, density, 20, 0.01));
    for (const GasScene& gas : gases) {
      Case chosen = make_case(gas, searched_by("auto"));
      Case one_grid = chosen;
      const double mean = gas.box / gas_of(gas.needles, density).box;
      one_grid.scene.engine.search = chosen_search("auto", density, {});
      if (one_grid.scene.engine.search == "linked-cells") {
        one_grid.scene.engine.cell_side = mean * auto_cell_side(density);
      } else {
        one_grid.scene.engine.capsule_radius = mean * auto_capsule_radius(density);
      }
      one_grid.is_baseline = true;
      out.push_back(one_grid);
      out.push_back(chosen);
    }
  }
  return out;
}

// Finishes at once, to try things out.
std::vector<Case> by_smoke() { return product({gas_of(200, 1)}, {searched_by("auto")}); }

}  // namespace

std::string Case::name() const {
  const Scene::Engine& engine = scene.engine;
  std::string name =
      fmt::format("{}/{}/{}/{}/{}/threads:{}", scene_name, engine.search, engine.queue,
                  engine.accuracy, engine.isa, engine.threads.value_or(1));
  if (engine.storage != "sorted") name += "/" + engine.storage;
  if (engine.cell_side) name += fmt::format("/side:{:.3g}", *engine.cell_side);
  if (engine.capsule_radius) name += fmt::format("/radius:{:.3g}", *engine.capsule_radius);
  if (!setting.empty()) name += "/" + setting;
  return name;
}

const std::vector<NameParts::Named> NameParts::all{{"scene", &NameParts::scene},
                                                   {"search_asked", &NameParts::search},
                                                   {"queue_asked", &NameParts::queue},
                                                   {"accuracy", &NameParts::accuracy},
                                                   {"isa", &NameParts::isa},
                                                   {"threads", &NameParts::threads},
                                                   {"storage", &NameParts::storage},
                                                   {"cell_side", &NameParts::cell_side},
                                                   {"capsule_radius", &NameParts::capsule_radius},
                                                   {"setting", &NameParts::setting}};

NameParts parts_of(const std::string& name) {
  NameParts out;
  out.storage = "sorted";
  std::string* const by_place[] = {&out.scene, &out.search, &out.queue, &out.accuracy, &out.isa};
  std::istringstream words(name);
  std::size_t place = 0;
  for (std::string word; std::getline(words, word, '/'); ++place) {
    const auto value_of = [&](std::string_view prefix) { return word.substr(prefix.size()); };
    if (place < std::size(by_place)) {
      *by_place[place] = word;
    } else if (word.starts_with("threads:")) {
      out.threads = value_of("threads:");
    } else if (word.starts_with("side:")) {
      out.cell_side = value_of("side:");
    } else if (word.starts_with("radius:")) {
      out.capsule_radius = value_of("radius:");
    } else if (word.find('=') != word.npos) {  // the last part, whose value may have any sign
      std::string rest;
      out.setting = std::getline(words, rest, '\0') ? word + '/' + rest : word;
    } else {
      out.storage = word;
    }
  }
  return out;
}

const std::vector<Subset>& subsets() {
  static const std::vector<Subset> all{
      {"quick", "both scenes of the paper by each SIMD search; under a minute",
       [] {
         return product({dilute, dense}, each_search_and_auto());
       }},
      {"dilute", "10000 needles in a box of 24: each search",
       [] { return product({dilute}, all_searches()); }},
      {"dense", "20000 needles in a box of 12: each search",
       [] { return product({dense}, all_searches()); }},
      {"searches", "both scenes: each search",
       [] {
         return product({dilute, dense}, all_searches());
       }},
      {"queues", "both scenes: each calendar",
       [] {
         return product({dilute, dense}, all_calendars());
       }},
      {"isa", "both scenes: each instruction set of this CPU",
       [] {
         return product({dilute, dense}, all_instruction_sets());
       }},
      {"steps", "both scenes: from the baseline on, first the search, then SIMD, then the calendar",
       [] {
         return product({dilute, dense}, all_steps());
       }},
      {"density", "10000 needles at n L^3 = 0.1 to 50", by_density},
      {"size", "1000 to 1000000 needles at n L^3 = 0.72, to 100000 at 11.6", by_size},
      {"matrix",
       "1000 to 1000000 needles at n L^3 = 0.1 to 50: each SIMD search by each calendar; 40 "
       "minutes",
       by_all},
      {"storage", "10000 to 1000000 needles, stored by place or by id", by_storage},
      {"hulls", "8000 needles, k = 2, 6, 100: cells and capsules smaller and larger than chosen",
       by_volume_sizes},
      {"cloud", "8000 needles in a part of their box: cells for the whole box, and as chosen",
       by_cloud},
      {"effects",
       "10000 needles in a box of 24: what collisions may do; and spheres, smooth and rough",
       by_effects},
      {"mixtures",
       "100000 needles, and mixtures 1:4 and 1:20 in length that collide as often: in one grid, "
       "and "
       "as chosen; 10 minutes",
       by_mixture},
      {"smoke", "200 needles, over at once", by_smoke}};
  return all;
}

const Subset& subset_of(const std::string& name) {
  std::string names;
  for (const Subset& subset : subsets()) {
    if (subset.name == name) return subset;
    names += (names.empty() ? "" : ", ") + subset.name;
  }
  throw InputError(fmt::format("SUBSET {}: expected one of {}", name, names));
}

}  // namespace needlework::bench
