#include "src/scene/accuracy.h"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "needlework/error.h"

namespace needlework {
namespace {

template <class Value, std::size_t n>
Value value_of(const std::string& name, const char* key,
               const std::array<std::pair<const char*, Value>, n>& offered) {
  std::string names;
  for (const auto& [known, value] : offered) {
    if (name == known) return value;
    names += (names.empty() ? "" : ", ") + std::string(known);
  }
  throw InputError(fmt::format("engine.{} = \"{}\": expected one of {}", key, name, names));
}

}  // namespace

Accuracy accuracy_of(const Scene::Engine& engine) {
  using Level = std::pair<const char*, Accuracy>;
  Accuracy out =
      value_of(engine.accuracy, "accuracy",
               std::array{Level{"fast", fast_accuracy}, Level{"standard", standard_accuracy},
                          Level{"rigorous", rigorous_accuracy}});
  if (engine.isolation) {
    using Name = std::pair<const char*, Isolation>;
    out.isolation = value_of(
        *engine.isolation, "isolation",
        std::array{Name{"sampling", Isolation::sampling}, Name{"bounds", Isolation::bounds},
                   Name{"intervals", Isolation::intervals}});
  }
  if (engine.escalation) {
    using Name = std::pair<const char*, Escalation>;
    out.escalation = value_of(
        *engine.escalation, "escalation",
        std::array{Name{"never", Escalation::never}, Name{"undecided", Escalation::undecided},
                   Name{"always", Escalation::always}});
  }
  if (engine.filter) {
    using Name = std::pair<const char*, bool>;
    out.float_filter =
        value_of(*engine.filter, "filter", std::array{Name{"float", true}, Name{"double", false}});
  }
  if (engine.root_tolerance) out.root_tolerance = *engine.root_tolerance;
  if (engine.sampling_step) out.sampling_step = *engine.sampling_step;
  return out;
}

std::string accuracy_name(const Scene::Engine& engine) {
  std::string out = engine.accuracy;
  const auto add = [&](const char* key, const auto& value) {
    if (value) out += fmt::format(", {} {}", key, *value);
  };
  add("isolation", engine.isolation);
  add("escalation", engine.escalation);
  add("filter", engine.filter);
  add("root_tolerance", engine.root_tolerance);
  add("sampling_step", engine.sampling_step);
  return out;
}

}  // namespace needlework
