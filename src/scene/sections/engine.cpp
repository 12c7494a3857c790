// [engine]: how events are found.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "kernels/isa.h"
#include "src/calendar/names.h"
#include "src/scene/engine_parts.h"
#include "src/scene/read_value.h"
#include "src/scene/sections/sections.h"

namespace needlework {
namespace {

constexpr double most_threads = 1024;

std::optional<std::string> calendar(const Value& value) {
  const auto name = from_value::text(value);
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

bool read_threads(Scene& scene, const Value& value, const ValueRange& range) {
  Scene::Engine& engine = scene.engine;
  engine.threads.reset();
  engine.threads_by_size = from_value::one_of(value, {"auto"}).has_value();
  return engine.threads_by_size ||
         from_value::store(engine.threads, from_value::whole_number(value, range));
}

std::optional<Violation> parts_are_for_one_thread(const Scene& scene) {
  const Scene::Engine& engine = scene.engine;
  if (engine.threads.value_or(1) <= 1 || is_for_threads(engine)) return {};
  return Violation{
      .key = "engine.threads",
      .value = fmt::to_string(*engine.threads),
      .reason = fmt::format("expected 1 with search {} and queue {}; several threads need search "
                            "{} and queue {}",
                            engine.search, engine.queue, fmt::join(parallel_searches, ", "),
                            fmt::join(parallel_calendars, ", "))};
}

std::optional<Violation> processor_lacks_instructions(const Scene& scene) {
  const std::string& isa = scene.engine.isa;
  const std::vector<std::string> names = instruction_sets();
  if (isa == "auto" || std::ranges::find(names, isa) != names.end()) return {};
  return Violation{
      .key = "engine.isa",
      .value = in_quotes(isa),
      .reason = fmt::format("expected auto or one that this CPU has ({})", fmt::join(names, ", "))};
}

}  // namespace

SceneSection engine_section() {
  using namespace from_value;
  using V = const Value&;
  using R = const ValueRange&;
  return {
      .name = "engine",
      .keys =
          {
              {"search",
               Aspect::effects,
               {},
               R"("auto", "all-pairs", "linked-lists", "linked-cells" or "capsules")",
               [](Scene& s, V v, R) {
                 return store(s.engine.search, one_of(v, {"auto", "all-pairs", "linked-lists",
                                                          "linked-cells", "capsules"}));
               }},
              {"queue",
               Aspect::effects,
               {},
               calendars_to_choose(),
               [](Scene& s, V v, R) { return store(s.engine.queue, calendar(v)); }},
              {"accuracy",
               Aspect::effects,
               {},
               R"("fast", "standard" or "rigorous")",
               [](Scene& s, V v, R) {
                 return store(s.engine.accuracy, one_of(v, {"fast", "standard", "rigorous"}));
               }},
              {"isolation",
               Aspect::effects,
               {},
               R"("sampling", "bounds" or "intervals")",
               [](Scene& s, V v, R) {
                 return store(s.engine.isolation, one_of(v, {"sampling", "bounds", "intervals"}));
               }},
              {"escalation",
               Aspect::effects,
               {},
               R"("never", "undecided" or "always")",
               [](Scene& s, V v, R) {
                 return store(s.engine.escalation, one_of(v, {"never", "undecided", "always"}));
               }},
              {"filter",
               Aspect::effects,
               {},
               R"("float" or "double")",
               [](Scene& s, V v, R) {
                 return store(s.engine.filter, one_of(v, {"float", "double"}));
               }},
              {"root_tolerance",
               Aspect::effects,
               {0, 1e-3},
               "a number from 0 to 1e-3",
               [](Scene& s, V v, R r) { return store(s.engine.root_tolerance, number(v, r)); }},
              {"sampling_step",
               Aspect::effects,
               {1e-4, 0.5},
               "a number from 1e-4 to 0.5",
               [](Scene& s, V v, R r) { return store(s.engine.sampling_step, number(v, r)); }},
              {"threads",
               Aspect::effects,
               {1, most_threads},
               R"("auto" or a whole number in digits, from 1 to 1024)",
               read_threads},
              {"team",
               Aspect::effects,
               {},
               R"("auto" or "all")",
               [](Scene& s, V v, R) {
                 return store(s.engine.team, one_of(v, {"auto", "all"}));
               }},
              {"isa",
               Aspect::effects,
               {},
               R"("auto", "scalar", "sse4", "avx2" or "avx512")",
               [](Scene& s, V v, R) {
                 return store(s.engine.isa,
                              one_of(v, {"auto", "scalar", "sse4", "avx2", "avx512"}));
               }},
              {"cell_side",
               Aspect::effects,
               {0.1},
               "a length from 0.1",
               [](Scene& s, V v, R r) { return store(s.engine.cell_side, number(v, r)); }},
              {"capsule_radius",
               Aspect::effects,
               {1e-3, 10},
               "a length from 1e-3 to 10",
               [](Scene& s, V v, R r) { return store(s.engine.capsule_radius, number(v, r)); }},
              {"storage",
               Aspect::effects,
               {},
               R"("sorted" or "by-id")",
               [](Scene& s, V v, R) {
                 return store(s.engine.storage, one_of(v, {"sorted", "by-id"}));
               }},
          },
      .rules = {{Aspect::machine, parts_are_for_one_thread},
                {Aspect::machine, processor_lacks_instructions}},
  };
}

}  // namespace needlework
