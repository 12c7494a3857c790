#include "src/observe/observation.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>

#include "src/observe/by_size.h"
#include "src/observe/effect_sums.h"
#include "src/observe/mean_of_edges.h"
#include "src/observe/rod_sums.h"
#include "src/scene/box_of.h"
#include "src/scene/confinement.h"
#include "src/scene/observable_names.h"

namespace needlework::observe {

GasSetting setting_of(const Scene& scene) {
  GasSetting gas;
  gas.count = gas.all = scene.needles.count;
  gas.box = box_of(scene);
  gas.moving_edges = moving_edges_of(scene, gas.box.edges());
  gas.is_sheared = scene.shear.has_value();
  gas.shear_rate = scene.shear ? scene.shear->rate : 0;
  gas.grows = scene.driving.growth.has_value();
  gas.cells = scene.output.grid.value_or(default_cells(gas.box.edges(), gas.count));
  gas.wall_slabs = wall_slabs(scene);
  gas.composition = scene.composition();
  if (!gas.composition.is_mixture()) {
    gas.composition.set_count(0, gas.count);
    return gas.of_species(0);
  }
  gas.length = gas.composition.longest();
  gas.mass = gas.inertia = std::numeric_limits<double>::quiet_NaN();
  return gas;
}

static double product(const Vector& edges) { return edges[0] * edges[1] * edges[2]; }

double GasSetting::volume_at(double time) const {
  return moving_edges ? product(moving_edges->distances(time)) : volume();
}

double GasSetting::mean_volume(double from, double until) const {
  return moving_edges ? mean_of_edges(*moving_edges, from, until, product) : volume();
}

GasSetting GasSetting::of_species(std::size_t index) const {
  GasSetting out = *this;
  const Species& species = composition[index];
  out.count = species.count;
  out.length = species.greatest_extent();
  out.mass = species.mass;
  out.inertia = species.inertia();
  out.rotations = std::max(2, species.rotations());  // smooth spheres have a temperature of 0
  out.composition = Composition({species}, composition.restitution(index, index));
  out.species_by_id = {};
  return out;
}

const Weights& Snapshot::weights() const {
  if (weights_) return *weights_;
  Weights& out = weights_.emplace();
  const OwnBodies& own = state.own_bodies;
  for (std::size_t i = 0; i < own.mass.size(); ++i) {
    const Species& species = gas.composition[species_of(i)];
    out.masses.push_back(species.fixed ? 1 : own.mass[i] / species.mass);
    out.inertias.push_back(species.fixed || !species.turns() ? 1
                                                             : own.inertia[i] / species.inertia());
  }
  return out;
}

std::vector<SeriesField::Extent> by_pair(const Composition& composition,
                                         std::vector<SeriesField::Extent> shape) {
  if (composition.is_mixture()) {
    shape.insert(shape.begin(), {"pairs of species", composition.pairs()});
  }
  return shape;
}

Observation::Observation(const Scene& scene, ObservablePointer cooling, SpeciesById species)
    : gas_(setting_of(scene)), parts_(settings_of_species(gas_)) {
  gas_.species_by_id = std::move(species);
  const auto& names = scene.output.observables;
  if (gas_.composition.is_mixture()) {
    members_.push_back(
        {"species", "Sums by species and by pairs of them", make_species_sums(gas_.composition)});
  }
  if (!scene.walls.empty()) {
    members_.push_back({"walls", "Hits of needles on walls", make_wall_sums(scene)});
  }
  if (acts_on_single_needles(scene)) {
    members_.push_back(
        {"energy_budget",
         "What each effect has put into the energy per needle since the start of the "
         "run, whose change is the sum of them all; negative: taken out",
         make_energy_budget(scene)});
  }
  if (gas_.composition.has_width()) {
    members_.push_back(
        {"rods", "Packing fraction, virial and pressure of rods", make_rod_sums(scene, gas_)});
  }
  if (scene.collisions.sliding) {
    members_.push_back(
        {"contacts", "Contacts of needles that slide on each other", make_contact_sums()});
  }
  if (scene.driving.growth) {
    members_.push_back(
        {"growth", "Sizes, packing and pressure of bodies that grow", make_growth_sums()});
  }
  if (cooling) {
    members_.push_back({"theory",
                        "Kinetic theory of a gas that stays homogeneous, from the same "
                        "temperatures at the start",
                        std::move(cooling)});
  }
  if (scene.output.size_classes) {
    const bool follows = std::ranges::find(names, displacement_name) != names.end();
    members_.push_back({"by_size",
                        "Classes of each species of as many needles by size, which is the length "
                        "of the axis or of spheres the diameter",
                        make_by_size(gas_, *scene.output.size_classes, follows)});
  }
  for (const Entry& entry : registry()) {
    const bool always = scene.shear && entry.name == pressure_tensor_name;
    if (!always && std::ranges::find(names, entry.name) == names.end()) continue;
    members_.push_back({std::string(entry.name), std::string(entry.meaning), make(entry)});
  }
  for (const Member& member : members_) {
    if (member.observable->reads_collisions()) readers_.push_back(member.observable.get());
    for (const SeriesField& field : member.observable->fields()) {
      if (field.kind != SeriesField::Kind::constant) width_ += field.width();
    }
  }
}

ObservablePointer Observation::make(const Entry& entry) const {
  if (entry.knows_species || !gas_.composition.is_mixture()) return entry.make(gas_);
  const std::vector<SeriesField::Extent> each{{"species", gas_.composition.size()}};
  return std::make_unique<ByPart>(each, entry.make, parts_);
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

std::span<const double> Observation::sample(const State& state, const Totals& totals,
                                            const SpeciesSums& species) {
  row_.clear();
  const bool is_mixture = gas_.composition.is_mixture();
  const SpeciesSums of_all{{{gas_.count, totals.t_tr, totals.t_rot}},
                           {totals.collisions},
                           species.walls,
                           species.energy,
                           species.virial,
                           species.t_tr_integral,
                           species.contacts,
                           species.stress,
                           species.growth};
  const Snapshot now(gas_, state, totals, is_mixture ? species : of_all);
  if (is_mixture) parts_.take(now, std::span(state.species), species.totals);
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
