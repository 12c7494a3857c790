#include "src/observe/observation.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "needlework/error.h"
#include "src/observe/registry.h"

namespace needlework::observe {

GasSetting setting_of(const Scene& scene) {
  const Composition composition = scene.composition();
  const Species& species = composition[0];
  GasSetting gas;
  gas.count = scene.needles.count;
  gas.box = scene.needles.box;
  gas.length = species.length;
  gas.mass = species.mass;
  gas.inertia = species.mass * species.length * species.length / (2 * species.k);
  gas.cells = scene.output.grid.value_or(default_cells(gas.box, gas.count));
  return gas;
}

Observation::Observation(const Scene& scene, ObservablePointer cooling) : gas_(setting_of(scene)) {
  const auto& names = scene.output.observables;
  if (scene.species.size() > 1 && !names.empty()) {
    throw InputError(
        "output.observables: expected none for several species: observables are of one "
        "species, for now");
  }
  if (cooling) {
    members_.push_back({"theory",
                        "Kinetic theory of a gas that stays homogeneous, from the same "
                        "temperatures at the start",
                        std::move(cooling)});
  }
  for (const Entry& entry : registry()) {
    if (std::ranges::find(names, entry.name) == names.end()) continue;
    members_.push_back({std::string(entry.name), std::string(entry.meaning), entry.make(gas_)});
  }
  for (const Member& member : members_) {
    if (member.observable->reads_collisions()) readers_.push_back(member.observable.get());
    for (const SeriesField& field : member.observable->fields()) {
      if (field.kind != SeriesField::Kind::constant) width_ += field.width();
    }
  }
}

std::vector<SeriesGroup> Observation::groups() const {
  std::vector<SeriesGroup> out;
  for (const Member& member : members_) {
    out.push_back({member.name, member.meaning, member.observable->fields()});
  }
  return out;
}

bool Observation::reads_state() const {
  return std::ranges::any_of(members_,
                             [](const Member& member) { return member.observable->reads_state(); });
}

bool Observation::reads_collisions() const { return !readers_.empty(); }

std::span<const double> Observation::sample(const State& state, const Totals& totals) {
  row_.clear();
  const Snapshot now(gas_, state, totals);
  for (const Member& member : members_) member.observable->sample(now, row_);
  if (row_.values().size() != width_) {
    throw std::logic_error("an observable's row does not have the size of its fields");
  }
  return row_.values();
}

void Observation::velocities_set() {
  for (const Member& member : members_) member.observable->velocities_set();
}

void Observation::transfer(Archive& archive) {
  for (const Member& member : members_) member.observable->transfer(archive);
}

void Observation::collision(const Collision& collision) {
  for (Observable* reader : readers_) reader->collision(collision);
}

}  // namespace needlework::observe
