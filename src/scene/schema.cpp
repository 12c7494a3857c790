#include "src/scene/schema.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "src/calendar/names.h"
#include "src/scene/box_edges.h"
#include "src/scene/observable_names.h"
#include "src/scene/printable.h"
#include "src/scene/suggest.h"

namespace needlework {
namespace {

constexpr double unlimited = std::numeric_limits<double>::max();
constexpr double smallest_positive = std::numeric_limits<double>::denorm_min();

constexpr double shortest_edge = 1e-6;  // of the shortest needles, between walls; see Room
// Limits beyond which squares and products of physical quantities would exceed the range of a
// double.
constexpr double least_temperature = 1e-200;
constexpr double largest_temperature = 1e200;
constexpr double most_per_decade = 1e6;
// Limit of frequencies, accelerations and strengths of kicks; the least is its inverse.
constexpr double largest_rate = 1e100;

constexpr std::uint64_t largest_seed = std::numeric_limits<std::int64_t>::max();
constexpr std::uint64_t most_threads = 1024;
constexpr std::uint64_t most_cells_along_an_axis = 10000;  // of output.grid
constexpr double most_cells = 1e6;

// Stores a value that was read. Returns false if there is none.
template <typename T, typename U>
bool store(T& target, std::optional<U> value) {
  if (!value) return false;
  target = static_cast<T>(*std::move(value));
  return true;
}

std::optional<double> number(const Value& value, double least, double greatest = unlimited) {
  std::optional<double> x;
  if (const auto* integer = value.as<std::int64_t>()) x = static_cast<double>(*integer);
  if (const auto* real = value.as<double>()) x = *real;
  if (x && *x >= least && *x <= greatest) return x;  // false for NaN
  return std::nullopt;
}

std::optional<bool> truth(const Value& value) {
  const auto* is = value.as<bool>();
  return is ? std::optional(*is) : std::nullopt;
}

std::optional<double> temperature(const Value& value) {
  const auto x = number(value, 0, largest_temperature);
  return x && (*x == 0 || *x >= least_temperature) ? x : std::nullopt;
}

std::optional<double> diameter(const Value& value) {
  const auto x = number(value, 0, 1e6);
  return x && (*x == 0 || *x >= 1e-6) ? x : std::nullopt;
}

std::optional<std::uint64_t> whole_number(const Value& value, std::uint64_t least,
                                          std::uint64_t greatest) {
  const auto* integer = value.as<std::int64_t>();
  if (!integer || *integer < 0) return std::nullopt;
  const auto n = static_cast<std::uint64_t>(*integer);
  return n >= least && n <= greatest ? std::optional(n) : std::nullopt;
}

std::optional<std::string> text(const Value& value) {
  const auto* string = value.as<std::string>();
  return string && is_printable(*string) ? std::optional(*string) : std::nullopt;
}

// Files that exist may have any name that the system allows. Messages escape what is not printable.
std::optional<std::string> path_to_read(const Value& value) {
  const auto* string = value.as<std::string>();
  const bool is_path = string && !string->empty() && string->find('\0') == string->npos;
  return is_path ? std::optional(*string) : std::nullopt;
}

std::optional<std::string> one_of(const Value& value,
                                  std::initializer_list<std::string_view> names) {
  const auto name = text(value);
  const bool known = name && std::find(names.begin(), names.end(), *name) != names.end();
  return known ? name : std::nullopt;
}

std::optional<std::string> calendar(const Value& value) {
  const auto name = text(value);
  const auto& names = calendar_names();
  const bool known = name == "auto" || std::find(names.begin(), names.end(), name) != names.end();
  return known ? name : std::nullopt;
}

// "auto", "a", "b" or "c".
std::string_view calendars_to_choose() {
  static const std::string all = [] {
    std::string out = "\"auto\"";
    for (const std::string& name : calendar_names()) {
      out += (name == calendar_names().back() ? " or \"" : ", \"") + name + '"';
    }
    return out;
  }();
  return all;
}

std::optional<double> box_edge(const Value& value) {
  return number(value, shortest_edge, largest_edge(1));
}

std::optional<std::array<double, 3>> box(const Value& value) {
  if (const auto side = box_edge(value)) return std::array{*side, *side, *side};
  const auto* edges = value.as<Value::Array>();
  if (!edges || edges->size() != 3) return std::nullopt;
  std::array<double, 3> result{};
  for (std::size_t i = 0; i < 3; ++i)
    if (!store(result[i], box_edge((*edges)[i]))) return std::nullopt;
  return result;
}

std::optional<std::array<std::string, 2>> two_names(const Value& value) {
  const auto* names = value.as<Value::Array>();
  if (!names || names->size() != 2) return std::nullopt;
  std::array<std::string, 2> out;
  for (std::size_t n = 0; n < 2; ++n)
    if (!store(out[n], text((*names)[n]))) return std::nullopt;
  return out;
}

std::optional<std::array<double, 3>> acceleration(const Value& value) {
  const auto* components = value.as<Value::Array>();
  if (!components || components->size() != 3) return std::nullopt;
  std::array<double, 3> out{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto g = number((*components)[axis], -largest_rate, largest_rate);
    if (!store(out[axis], g) || (*g != 0 && std::abs(*g) < 1 / largest_rate)) return std::nullopt;
  }
  return out;
}

// The tables of keys, made by the first key of theirs that is read.
// clang 14 does not know that emplace() can make what a class nested in another one contains.
template <class T>
T& made(std::optional<T>& value) {
  if (!value) value = T{};
  return *value;
}
Scene::WallMotion& motion_of(Scene& scene) {
  auto& motion = scene.walls.back().motion;
  return made(motion);
}
Scene::Kicks& kicks_of(Scene& scene) {
  auto& kicks = scene.driving.kicks;
  return made(kicks);
}
Scene::Andersen& andersen_of(Scene& scene) {
  auto& andersen = scene.driving.andersen;
  return made(andersen);
}

std::optional<std::vector<double>> increasing_times(const Value& value) {
  const auto* array = value.as<Value::Array>();
  if (!array) return std::nullopt;
  std::vector<double> times;
  for (const Value& element : *array) {
    const auto time = number(element, 0);
    if (!time || (!times.empty() && *time <= times.back())) return std::nullopt;
    times.push_back(*time);
  }
  return times;
}

std::optional<double> per_decade(const Value& value) {
  return number(value, smallest_positive, most_per_decade);
}

bool read_frames(Scene& scene, const Value& value) {
  if (store(scene.output.frames_per_decade, per_decade(value))) return true;
  return store(scene.output.frame_times, increasing_times(value));
}

std::vector<std::string_view> all_observables() {
  std::vector<std::string_view> names(observable_names.begin(), observable_names.end());
  names.insert(names.end(), total_names.begin(), total_names.end());
  return names;
}

bool is_observable(std::string_view name) {
  const auto names = all_observables();
  return std::find(names.begin(), names.end(), name) != names.end();
}

std::optional<UnknownWord> unknown_observable(const Value& value) {
  const auto* array = value.as<Value::Array>();
  for (const Value& element : array ? *array : Value::Array()) {
    const auto* name = element.as<std::string>();
    if (name && !is_observable(*name))
      return UnknownWord{*name, nearest_word(*name, all_observables())};
  }
  return std::nullopt;
}

std::optional<std::vector<std::string>> observables(const Value& value) {
  const auto* array = value.as<Value::Array>();
  if (!array) return std::nullopt;
  std::vector<std::string> names;
  for (const Value& element : *array) {
    const auto name = text(element);
    if (!name || !is_observable(*name)) return std::nullopt;
    names.push_back(*name);
  }
  return names;
}

const std::string expected_observables =
    fmt::format("an array of names among \"{}\", \"{}\"", fmt::join(observable_names, "\", \""),
                fmt::join(total_names, "\", \""));

std::optional<int> cells_along_an_axis(const Value& value) {
  int cells = 0;
  const bool read = store(cells, whole_number(value, 1, most_cells_along_an_axis));
  return read ? std::optional(cells) : std::nullopt;
}

std::optional<std::array<int, 3>> grid(const Value& value) {
  std::array<int, 3> cells{};
  if (const auto all = cells_along_an_axis(value)) {
    cells.fill(*all);
  } else {
    const auto* array = value.as<Value::Array>();
    if (!array || array->size() != 3) return std::nullopt;
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (!store(cells[axis], cells_along_an_axis((*array)[axis]))) return std::nullopt;
  }
  const double product = double(cells[0]) * cells[1] * cells[2];
  return product <= most_cells ? std::optional(cells) : std::nullopt;
}

using V = const Value&;

// In the order of their documentation, in which messages list them.
const SceneKey keys[] = {
    {"", "title", "a string without control characters",
     [](Scene& s, V v) { return store(s.title, text(v)); }},

    {"needles", "count", "a whole number in digits, from 0 to 4294967294",
     [](Scene& s, V v) { return store(s.needles.count, whole_number(v, 0, most_needles)); }},
    {"needles", "box", "an edge from 2.01 to 1e9, or an array of three edges",
     [](Scene& s, V v) { return store(s.needles.box, box(v)); }},
    {"needles", "k", "a number > 0 (from 1e-9 to 1e9; 6 is a uniform rod)",
     [](Scene& s, V v) { return store(s.needles.k, number(v, 1e-9, 1e9)); }},
    {"needles", "diameter", "a diameter >= 0 (0 for thin needles, or from 1e-6 to 1e6)",
     [](Scene& s, V v) { return store(s.needles.diameter, diameter(v)); }},
    {"needles", "seed", "a whole number in digits, from 0 to 9223372036854775807",
     [](Scene& s, V v) { return store(s.needles.seed, whole_number(v, 0, largest_seed)); }},

    {"species", "name", "a name without control characters, not empty",
     [](Scene& s, V v) {
       return store(s.species.back().name, text(v)) && !s.species.back().name.empty();
     }},
    {"species", "count", "a whole number in digits, from 0 to 4294967294",
     [](Scene& s, V v) { return store(s.species.back().count, whole_number(v, 0, most_needles)); }},
    {"species", "length", "a number > 0 (from 1e-6 to 1e6), or 0 for spheres",
     [](Scene& s, V v) { return store(s.species.back().length, diameter(v)); }},
    {"species", "diameter", "a diameter >= 0 (0 for thin needles, or from 1e-6 to 1e6)",
     [](Scene& s, V v) { return store(s.species.back().diameter, diameter(v)); }},
    {"species", "mass", "a number > 0 (from 1e-100 to 1e100)",
     [](Scene& s, V v) { return store(s.species.back().mass, number(v, 1e-100, 1e100)); }},
    {"species", "k", "a number > 0 (from 1e-9 to 1e9; 6 is a uniform rod)",
     [](Scene& s, V v) { return store(s.species.back().k, number(v, 1e-9, 1e9)); }},
    {"species", "inertia", "a number > 0 (from 1e-200 to 1e200), in place of k",
     [](Scene& s, V v) {
       return store(s.species.back().given_inertia, number(v, 1e-200, 1e200));
     }},
    {"species", "t_tr", "a temperature >= 0 (0, or from 1e-200 to 1e200)",
     [](Scene& s, V v) { return store(s.species.back().t_tr, temperature(v)); }},
    {"species", "t_rot", "a temperature >= 0 (0, or from 1e-200 to 1e200)",
     [](Scene& s, V v) { return store(s.species.back().t_rot, temperature(v)); }},

    {"initial", "t_tr", "a temperature >= 0 (0, or from 1e-200 to 1e200)",
     [](Scene& s, V v) { return store(s.initial.t_tr, temperature(v)); }},
    {"initial", "t_rot", "a temperature >= 0 (0, or from 1e-200 to 1e200)",
     [](Scene& s, V v) { return store(s.initial.t_rot, temperature(v)); }},
    {"initial", "file", "the path of an H5MD file",
     [](Scene& s, V v) { return store(s.initial.file, path_to_read(v)); }},
    {"initial", "packing", R"("auto", "insertion", "lattice" or "crossed")",
     [](Scene& s, V v) {
       return store(s.initial.packing, one_of(v, {"auto", "insertion", "lattice", "crossed"}));
     }},

    {"collisions", "epsilon", "a number from 0 to 1",
     [](Scene& s, V v) { return store(s.collisions.epsilon, number(v, 0, 1)); }},
    {"collisions", "beta", "a number from -1 (smooth) to 1 (perfectly rough)",
     [](Scene& s, V v) { return store(s.collisions.beta, number(v, -1, 1)); }},
    {"collisions", "tc", "a time >= 0",
     [](Scene& s, V v) { return store(s.collisions.tc, number(v, 0)); }},
    {"collisions", "tc_relative", "a number >= 0 of mean free times",
     [](Scene& s, V v) { return store(s.collisions.tc_relative, number(v, 0)); }},
    {"collisions", "sliding", "true or false",
     [](Scene& s, V v) { return store(s.collisions.sliding, truth(v)); }},
    {"collisions", "sliding_below", "a number from 1e-6 to 0.1 of mean free times",
     [](Scene& s, V v) { return store(s.collisions.sliding_below, number(v, 1e-6, 0.1)); }},
    {"collisions", "elastic_strikes", "true or false",
     [](Scene& s, V v) { return store(s.collisions.elastic_strikes, truth(v)); }},

    {"pairs", "between", "an array of the names of two species",
     [](Scene& s, V v) { return store(s.pairs.back().between, two_names(v)); }},
    {"pairs", "epsilon", "a number from 0 to 1",
     [](Scene& s, V v) { return store(s.pairs.back().epsilon, number(v, 0, 1)); }},
    {"pairs", "beta", "a number from -1 (smooth) to 1 (perfectly rough)",
     [](Scene& s, V v) { return store(s.pairs.back().beta, number(v, -1, 1)); }},

    {"walls", "axis", R"("x", "y" or "z")",
     [](Scene& s, V v) {
       return store(s.walls.back().axis, one_of(v, {"x", "y", "z"}));
     }},
    {"walls", "side", R"("low", "high" or "both")",
     [](Scene& s, V v) {
       return store(s.walls.back().side, one_of(v, {"low", "high", "both"}));
     }},
    {"walls", "epsilon", "a number from 0 to 1",
     [](Scene& s, V v) { return store(s.walls.back().epsilon, number(v, 0, 1)); }},
    {"walls", "temperature", "a temperature > 0 (from 1e-200 to 1e200)",
     [](Scene& s, V v) {
       return store(s.walls.back().temperature, number(v, least_temperature, largest_temperature));
     }},
    {"walls", "motion.amplitude", "a length >= 0 (at most 1e9)",
     [](Scene& s, V v) { return store(motion_of(s).amplitude, number(v, 0, 1e9)); }},
    {"walls", "motion.frequency", "a number > 0 of cycles per time (from 1e-100 to 1e100)",
     [](Scene& s, V v) {
       return store(motion_of(s).frequency, number(v, 1 / largest_rate, largest_rate));
     }},
    {"walls", "motion.phase", "an angle in radians, from -1000 to 1000",
     [](Scene& s, V v) { return store(motion_of(s).phase, number(v, -1000, 1000)); }},

    {"forces", "gravity", "an array of three accelerations (each 0, or from 1e-100 to 1e100)",
     [](Scene& s, V v) { return store(s.forces.gravity, acceleration(v)); }},

    {"driving", "kicks.every", "a time > 0 (from 1e-100 to 1e100)",
     [](Scene& s, V v) {
       return store(kicks_of(s).every, number(v, 1 / largest_rate, largest_rate));
     }},
    {"driving", "kicks.translational", "a number >= 0 (at most 1e100)",
     [](Scene& s, V v) { return store(kicks_of(s).translational, number(v, 0, largest_rate)); }},
    {"driving", "kicks.rotational", "a number >= 0 (at most 1e100)",
     [](Scene& s, V v) { return store(kicks_of(s).rotational, number(v, 0, largest_rate)); }},
    {"driving", "andersen.rate", "a number > 0 of redraws per time (from 1e-100 to 1e100)",
     [](Scene& s, V v) {
       return store(andersen_of(s).rate, number(v, 1 / largest_rate, largest_rate));
     }},
    {"driving", "andersen.temperature", "a temperature > 0 (from 1e-200 to 1e200)",
     [](Scene& s, V v) {
       return store(andersen_of(s).temperature,
                    number(v, least_temperature, largest_temperature));
     }},

    {"engine", "search", R"("auto", "all-pairs", "linked-lists", "linked-cells" or "capsules")",
     [](Scene& s, V v) {
       return store(s.engine.search,
                    one_of(v, {"auto", "all-pairs", "linked-lists", "linked-cells", "capsules"}));
     }},
    {"engine", "queue", calendars_to_choose(),
     [](Scene& s, V v) { return store(s.engine.queue, calendar(v)); }},
    {"engine", "accuracy", R"("fast", "standard" or "rigorous")",
     [](Scene& s, V v) {
       return store(s.engine.accuracy, one_of(v, {"fast", "standard", "rigorous"}));
     }},
    {"engine", "isolation", R"("sampling", "bounds" or "intervals")",
     [](Scene& s, V v) {
       return store(s.engine.isolation, one_of(v, {"sampling", "bounds", "intervals"}));
     }},
    {"engine", "escalation", R"("never", "undecided" or "always")",
     [](Scene& s, V v) {
       return store(s.engine.escalation, one_of(v, {"never", "undecided", "always"}));
     }},
    {"engine", "filter", R"("float" or "double")",
     [](Scene& s, V v) {
       return store(s.engine.filter, one_of(v, {"float", "double"}));
     }},
    {"engine", "root_tolerance", "a number from 0 to 1e-3",
     [](Scene& s, V v) { return store(s.engine.root_tolerance, number(v, 0, 1e-3)); }},
    {"engine", "sampling_step", "a number from 1e-4 to 0.5",
     [](Scene& s, V v) { return store(s.engine.sampling_step, number(v, 1e-4, 0.5)); }},
    {"engine", "threads", R"("auto" or a whole number in digits, from 1 to 1024)",
     [](Scene& s, V v) {
       s.engine.threads.reset();
       s.engine.threads_by_size = one_of(v, {"auto"}).has_value();
       return s.engine.threads_by_size || store(s.engine.threads, whole_number(v, 1, most_threads));
     }},
    {"engine", "team", R"("auto" or "all")",
     [](Scene& s, V v) {
       return store(s.engine.team, one_of(v, {"auto", "all"}));
     }},
    {"engine", "isa", R"("auto", "scalar", "sse4", "avx2" or "avx512")",
     [](Scene& s, V v) {
       return store(s.engine.isa, one_of(v, {"auto", "scalar", "sse4", "avx2", "avx512"}));
     }},

    {"engine", "cell_side", "a length from 0.1",
     [](Scene& s, V v) { return store(s.engine.cell_side, number(v, 0.1)); }},
    {"engine", "capsule_radius", "a length from 1e-3 to 10",
     [](Scene& s, V v) { return store(s.engine.capsule_radius, number(v, 1e-3, 10)); }},

    {"engine", "storage", R"("sorted" or "by-id")",
     [](Scene& s, V v) {
       return store(s.engine.storage, one_of(v, {"sorted", "by-id"}));
     }},

    {"until", "time", "a time >= 0",
     [](Scene& s, V v) { return store(s.until.time, number(v, 0)); }},
    {"until", "collisions_per_needle", "a number >= 0",
     [](Scene& s, V v) { return store(s.until.collisions_per_needle, number(v, 0)); }},
    {"until", "energy_ratio", "a number > 0",
     [](Scene& s, V v) { return store(s.until.energy_ratio, number(v, smallest_positive)); }},
    {"until", "wall_s", "a number >= 0 of seconds",
     [](Scene& s, V v) { return store(s.until.wall_s, number(v, 0)); }},

    {"output", "file", "the path of a file to write, or \"\" for none",
     [](Scene& s, V v) { return store(s.output.file, text(v)); }},
    {"output", "series_per_decade", "a number > 0 (at most 1e6)",
     [](Scene& s, V v) { return store(s.output.series_per_decade, per_decade(v)); }},
    {"output", "series_every", "a time > 0",
     [](Scene& s, V v) { return store(s.output.series_every, number(v, smallest_positive)); }},
    {"output", "frames",
     "a number > 0 (frames per decade, at most 1e6) or an array of times >= 0, increasing",
     read_frames},
    {"output", "frames_every", "a time > 0",
     [](Scene& s, V v) { return store(s.output.frames_every, number(v, smallest_positive)); }},
    {"output", "observables", expected_observables,
     [](Scene& s, V v) { return store(s.output.observables, observables(v)); }, unknown_observable},
    {"output", "grid",
     "a whole number in digits, from 1 to 10000, or an array of three, at most 1e6 cells",
     [](Scene& s, V v) { return store(s.output.grid, grid(v)); }},
    {"output", "events", "true or false",
     [](Scene& s, V v) {
       const bool* events = v.as<bool>();
       return store(s.output.events, events ? std::optional(*events) : std::nullopt);
     }},
    {"output", "checkpoint_every", "a number >= 0 of seconds; 0: none",
     [](Scene& s, V v) { return store(s.output.checkpoint_every, number(v, 0)); }},
};

constexpr std::string_view sections[] = {"needles", "species", "initial", "collisions",
                                         "pairs",   "walls",   "forces",  "driving",
                                         "engine",  "until",   "output"};

std::vector<std::string_view> keys_of(std::string_view section) {
  std::vector<std::string_view> names;
  for (const SceneKey& k : keys)
    if (k.section == section) names.push_back(k.key);
  return names;
}

std::string did_you_mean(std::string_view name) {
  return name.empty() ? "" : fmt::format(", did you mean {}?", name);
}

std::string expected_instead_of_section(std::string_view name) {
  const std::string_view nearest = nearest_word(name, sections);
  return fmt::format("expected one of the sections {}{}", fmt::join(sections, ", "),
                     did_you_mean(nearest));
}

}  // namespace

std::string SceneKey::expected_instead_of(const Value& value) const {
  const auto unknown = unknown_word ? unknown_word(value) : std::nullopt;
  if (!unknown) return fmt::format("expected {}", expected);
  return fmt::format("\"{}\": expected {}{}", printable(unknown->word, 60), expected,
                     did_you_mean(unknown->nearest));
}

std::span<const SceneKey> scene_keys() { return keys; }

const SceneKey* find_scene_key(std::string_view section, std::string_view key) {
  const auto* found = std::find_if(std::begin(keys), std::end(keys), [&](const SceneKey& k) {
    return k.section == section && k.key == key;
  });
  return found == std::end(keys) ? nullptr : found;
}

bool is_scene_section(std::string_view section) {
  return std::find(std::begin(sections), std::end(sections), section) != std::end(sections);
}

std::span<const std::string_view> scene_sections() { return sections; }

bool is_scene_table(std::string_view section, std::string_view key) {
  return std::any_of(std::begin(keys), std::end(keys), [&](const SceneKey& k) {
    return k.section == section && k.key.size() > key.size() && k.key.starts_with(key) &&
           k.key[key.size()] == '.';
  });
}

bool accepts(const SceneKey& key, const Value& value) {
  Scene scene;
  scene.species.emplace_back();
  scene.pairs.emplace_back();
  scene.walls.emplace_back();
  return key.read(scene, value);
}

std::string expected_instead(const Entry& unknown) {
  if (is_scene_table(unknown.section, unknown.key)) {
    std::vector<std::string_view> inner;
    for (const std::string_view name : keys_of(unknown.section)) {
      if (name.starts_with(unknown.key + ".")) inner.push_back(name.substr(unknown.key.size() + 1));
    }
    return fmt::format("expected {{{} = ...}}", fmt::join(inner, " = ..., "));
  }
  if (unknown.section.empty() && is_scene_section(unknown.key))
    return fmt::format("expected a section [{}]", unknown.key);
  if (!unknown.section.empty() && !is_scene_section(unknown.section))
    return expected_instead_of_section(unknown.section);
  if (is_scene_section(unknown.key)) {
    return fmt::format(
        "expected [{0}] as a section of its own, or {0}.KEY above the first [section]",
        unknown.key);
  }
  const std::vector<std::string_view> names = keys_of(unknown.section);
  const std::string_view nearest = nearest_word(unknown.key, names);
  std::string suggestion(nearest);
  // If no key of the section is similar, looks for the same key in another section.
  for (const SceneKey& k : keys) {
    if (!nearest.empty() || k.key != unknown.key) continue;
    suggestion += suggestion.empty() ? "" : " or ";
    suggestion += k.section.empty() ? k.key : fmt::format("{}.{}", k.section, k.key);
  }
  if (unknown.section.empty() && suggestion.empty())
    suggestion = nearest_word(unknown.key, sections);
  return fmt::format("expected {}{}{}", unknown.section.empty() ? "a section or " : "one of ",
                     fmt::join(names, ", "), did_you_mean(suggestion));
}

}  // namespace needlework
