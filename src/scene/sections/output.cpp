// [output]: what is written of a run.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>

#include "src/scene/observable_names.h"
#include "src/scene/read_value.h"
#include "src/scene/sections/sections.h"
#include "src/scene/suggest.h"

namespace needlework {
namespace {

constexpr ValueRange positive{std::numeric_limits<double>::denorm_min()};
constexpr ValueRange per_decade{positive.least, 1e6};
constexpr ValueRange cells_along_an_axis{1, 10000};
constexpr double most_cells = 1e6;
constexpr ValueRange size_classes{1, 64};

std::optional<std::vector<double>> increasing_times(const Value& value) {
  const auto* array = value.as<Value::Array>();
  if (!array) return std::nullopt;
  std::vector<double> times;
  for (const Value& element : *array) {
    const auto time = from_value::number(element, {0});
    if (!time || (!times.empty() && *time <= times.back())) return std::nullopt;
    times.push_back(*time);
  }
  return times;
}

bool read_frames(Scene& scene, const Value& value, const ValueRange& range) {
  if (from_value::store(scene.output.frames_per_decade, from_value::number(value, range)))
    return true;
  return from_value::store(scene.output.frame_times, increasing_times(value));
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
    const auto name = from_value::text(element);
    if (!name || !is_observable(*name)) return std::nullopt;
    names.push_back(*name);
  }
  return names;
}

std::string_view expected_observables() {
  static const std::string all =
      fmt::format("an array of names among \"{}\", \"{}\"", fmt::join(observable_names, "\", \""),
                  fmt::join(total_names, "\", \""));
  return all;
}

std::optional<std::array<int, 3>> grid(const Value& value, const ValueRange& range) {
  std::array<int, 3> cells{};
  if (const auto all = from_value::whole_number(value, range)) {
    cells.fill(static_cast<int>(*all));
  } else {
    const auto* array = value.as<Value::Array>();
    if (!array || array->size() != 3) return std::nullopt;
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (!from_value::store(cells[axis], from_value::whole_number((*array)[axis], range)))
        return std::nullopt;
  }
  const double product = double(cells[0]) * cells[1] * cells[2];
  return product <= most_cells ? std::optional(cells) : std::nullopt;
}

std::optional<Violation> no_walls_to_observe(const Scene& scene) {
  if (!scene.walls.empty()) return {};
  for (const std::string& name : scene.output.observables) {
    if (std::ranges::find(wall_observable_names, name) == wall_observable_names.end()) continue;
    return Violation{
        .key = "output.observables",
        .value = in_quotes(name),
        .reason = fmt::format("expected an entry [[walls]] for {}, which is along axes with walls",
                              name)};
  }
  return {};
}

std::optional<Violation> no_growth_to_observe(const Scene& scene) {
  if (scene.driving.growth || std::ranges::find(scene.output.observables, contact_network_name) ==
                                  scene.output.observables.end())
    return {};
  return Violation{.key = "output.observables",
                   .value = in_quotes(contact_network_name),
                   .reason = "expected a driving.growth, whose pressure tells which bodies touch"};
}

std::optional<Violation> contacts_carry_momentum(const Scene& scene) {
  if (!scene.collisions.sliding) return {};
  if (std::ranges::find(scene.output.observables, pressure_tensor_name) ==
      scene.output.observables.end())
    return {};
  return Violation{.key = "output.observables",
                   .value = in_quotes(pressure_tensor_name),
                   .reason =
                       "expected no pressure_tensor beside collisions.sliding: what contacts "
                       "that last carry is not counted"};
}

}  // namespace

SceneSection output_section() {
  using namespace from_value;
  using V = const Value&;
  using R = const ValueRange&;
  return {
      .name = "output",
      .keys =
          {
              {"file",
               Aspect::output,
               {},
               "the path of a file to write, or \"\" for none",
               [](Scene& s, V v, R) { return store(s.output.file, text(v)); }},
              {"series_per_decade", Aspect::output, per_decade, "a number > 0 (at most 1e6)",
               [](Scene& s, V v, R r) { return store(s.output.series_per_decade, number(v, r)); }},
              {"series_every", Aspect::output, positive, "a time > 0",
               [](Scene& s, V v, R r) { return store(s.output.series_every, number(v, r)); }},
              {"frames", Aspect::output, per_decade,
               "a number > 0 (frames per decade, at most 1e6) or an array of times >= 0, "
               "increasing",
               read_frames},
              {"frames_every", Aspect::output, positive, "a time > 0",
               [](Scene& s, V v, R r) { return store(s.output.frames_every, number(v, r)); }},
              {"observables",
               Aspect::output,
               {},
               expected_observables(),
               [](Scene& s, V v, R) { return store(s.output.observables, observables(v)); },
               Presence::optional,
               unknown_observable},
              {"grid", Aspect::output, cells_along_an_axis,
               "a whole number in digits, from 1 to 10000, or an array of three, at most 1e6 "
               "cells",
               [](Scene& s, V v, R r) { return store(s.output.grid, grid(v, r)); }},
              {"size_classes", Aspect::output, size_classes,
               "a whole number in digits, from 1 to 64",
               [](Scene& s, V v, R r) { return store(s.output.size_classes, whole_number(v, r)); }},
              {"events",
               Aspect::output,
               {},
               "true or false",
               [](Scene& s, V v, R) { return store(s.output.events, truth(v)); }},
              {"checkpoint_every",
               Aspect::output,
               {0},
               "a number >= 0 of seconds; 0: none",
               [](Scene& s, V v, R r) { return store(s.output.checkpoint_every, number(v, r)); }},
          },
      .rules = {{Aspect::effects, contacts_carry_momentum},
                {Aspect::output, no_walls_to_observe},
                {Aspect::output, no_growth_to_observe}},
      .exclusions = {{"output.series_per_decade", "output.series_every",
                      "expected either series_per_decade or series_every, not both",
                      Replaces::each_the_other},
                     {"output.frames", "output.frames_every",
                      "expected either frames or frames_every, not both",
                      Replaces::each_the_other}},
  };
}

}  // namespace needlework
