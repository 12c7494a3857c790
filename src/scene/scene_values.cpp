#include "src/scene/scene_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "needlework/error.h"
#include "needlework/parse.h"
#include "src/scene/schema.h"

namespace needlework {
namespace {

// Whole numbers beyond those of TOML become a number that no key accepts.
Value toml_of(std::uint64_t n) {
  constexpr auto most = std::numeric_limits<std::int64_t>::max();
  return {n <= std::uint64_t{most} ? static_cast<std::int64_t>(n) : std::int64_t{-1}};
}
Value toml_of(int n) { return {std::int64_t{n}}; }
Value toml_of(double x) { return {x}; }
Value toml_of(bool b) { return {b}; }
Value toml_of(const std::string& text) { return {text}; }

template <class Sequence>
Value array_of(const Sequence& values) {
  Value::Array out;
  for (const auto& value : values) out.push_back(toml_of(value));
  return {std::move(out)};
}
template <class T, std::size_t size>
Value toml_of(const std::array<T, size>& values) {
  return array_of(values);
}
template <class T>
Value toml_of(const std::vector<T>& values) {
  return array_of(values);
}

// Collects the values of one section.
class Section {
 public:
  Section(std::vector<KeyValue>& out, std::string_view name) : out_(out), name_(name) {}

  template <class T>
  void operator()(std::string_view key, const T& value) {
    out_.push_back({name_, key, toml_of(value)});
  }
  template <class T>
  void operator()(std::string_view key, const std::optional<T>& value) {
    if (value) (*this)(key, *value);
  }

 private:
  std::vector<KeyValue>& out_;
  std::string_view name_;
};

void put_gas(const Scene& scene, std::vector<KeyValue>& out) {
  const auto& [count, box, k, seed] = scene.needles;
  const auto& [t_tr, t_rot, file] = scene.initial;
  Section needles(out, "needles"), initial(out, "initial");
  needles("box", box);
  needles("seed", seed);
  if (!file.empty()) initial("file", file);
  for (const Scene::Species& species : scene.species) {
    const auto& [name, its_count, length, mass, its_k, its_t_tr, its_t_rot] = species;
    Section section(out, "species");
    section("name", name);
    section("count", its_count);
    section("length", length);
    section("mass", mass);
    section("k", its_k);
    section("t_tr", its_t_tr);
    section("t_rot", its_t_rot);
  }
  needles("count", count);
  needles("k", k);
  initial("t_tr", t_tr);
  initial("t_rot", t_rot);
}

void put_engine(const Scene::Engine& engine, std::vector<KeyValue>& out) {
  const auto& [search, queue, accuracy, isolation, escalation, filter, root_tolerance,
               sampling_step, threads, team, isa, cell_side, capsule_radius, storage] = engine;
  Section section(out, "engine");
  section("search", search);
  section("queue", queue);
  section("accuracy", accuracy);
  section("isolation", isolation);
  section("escalation", escalation);
  section("filter", filter);
  section("root_tolerance", root_tolerance);
  section("sampling_step", sampling_step);
  section("threads", threads);
  section("team", team);
  section("isa", isa);
  section("cell_side", cell_side);
  section("capsule_radius", capsule_radius);
  section("storage", storage);
}

void put_output(const Scene::Output& output, std::vector<KeyValue>& out) {
  const auto& [file, series_per_decade, series_every, frame_times, frames_per_decade, observables,
               grid, events, checkpoint_every] = output;
  Section section(out, "output");
  section("file", file);
  section("series_per_decade", series_per_decade);
  section("series_every", series_every);
  section("frames", frame_times);
  section("frames", frames_per_decade);
  section("observables", observables);
  section("grid", grid);
  section("events", events);
  section("checkpoint_every", checkpoint_every);
}

void refuse(std::string_view name, std::string_view expected) {
  throw InputError(fmt::format("the scene: {}: expected {}", name, expected));
}

void require_agreement(const Scene& scene) {
  if (scene.species.size() > 1) refuse("species", "one");
  if (scene.collisions.tc && scene.collisions.tc_relative) {
    refuse("collisions", "either tc or tc_relative, not both");
  }
  const Scene::Species species = scene.one_species();
  if (species.count != scene.needles.count || species.k != scene.needles.k) {
    refuse("species", "the count and k of [needles]");
  }
  const double least = 2.01 * species.length;
  if (std::ranges::any_of(scene.needles.box, [&](double edge) { return edge < least; })) {
    refuse("needles.box", "edges of at least 2.01 needle lengths");
  }
}

}  // namespace

std::vector<KeyValue> values_of(const Scene& scene) {
  std::vector<KeyValue> out;
  out.push_back({"", "title", toml_of(scene.title)});
  put_gas(scene, out);
  const auto& [epsilon, beta, tc, tc_relative] = scene.collisions;
  Section collisions(out, "collisions");
  collisions("epsilon", epsilon);
  collisions("beta", beta);
  collisions("tc", tc);
  collisions("tc_relative", tc_relative);
  put_engine(scene.engine, out);
  const auto& [time, collisions_per_needle, energy_ratio, wall_s] = scene.until;
  Section until(out, "until");
  until("time", time);
  until("collisions_per_needle", collisions_per_needle);
  until("energy_ratio", energy_ratio);
  until("wall_s", wall_s);
  put_output(scene.output, out);
  return out;
}

void require_valid(const Scene& scene) {
  Scene again = scene;
  for (const auto& [section, name, value] : values_of(scene)) {
    const SceneKey* key = find_scene_key(section, name);
    if (key->read(again, value)) continue;
    refuse(section.empty() ? std::string(name) : fmt::format("{}.{}", section, name),
           key->expected);
  }
  require_agreement(scene);
  if (scene.text.size() > max_scene_bytes) refuse("text", "at most 1 MiB");
}

}  // namespace needlework
