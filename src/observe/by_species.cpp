#include "src/observe/by_species.h"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <span>
#include <string_view>

#include "src/observe/described_fields.h"

namespace needlework::observe {

SnapshotsBySpecies::SnapshotsBySpecies(const GasSetting& gas) {
  for (std::size_t n = 0; n < gas.composition.size(); ++n) {
    parts_.push_back({.gas = gas.of_species(n),
                      .state = {},
                      .totals = {},
                      .species = {},
                      .snapshot = std::nullopt});
  }
}

void SnapshotsBySpecies::take(const Snapshot& all) {
  const State& state = all.state;
  for (std::size_t n = 0; n < parts_.size(); ++n) {
    Part& part = parts_[n];
    part.state.box = state.box;
    part.state.periodic = state.periodic;
    part.state.slide = state.slide;
    part.state.shear_rate = state.shear_rate;
    part.state.resize(0);
    part.state.peculiar_x.clear();
    const SpeciesTotals& sums = all.species.totals[n];
    part.totals = {.time = all.totals.time, .t_tr = sums.t_tr, .t_rot = sums.t_rot};
    part.totals.energy = 1.5 * sums.t_tr + sums.t_rot;
    part.species.totals = {sums};
    part.snapshot.emplace(part.gas, part.state, part.totals, part.species);
  }
  for (std::size_t i = 0; i < state.size(); ++i) {
    State& to = parts_[state.species[i]].state;
    to.position.push_back(state.position[i]);
    to.velocity.push_back(state.velocity[i]);
    to.orientation.push_back(state.orientation[i]);
    to.angular_velocity.push_back(state.angular_velocity[i]);
    if (!state.peculiar_x.empty()) to.peculiar_x.push_back(state.peculiar_x[i]);
    if (!state.image.empty()) to.image.push_back(state.image[i]);
    if (!state.id.empty()) to.id.push_back(state.id[i]);
  }
}

BySpecies::BySpecies(const GasSetting& gas, ObservablePointer (*make)(const GasSetting&),
                     const SnapshotsBySpecies& parts)
    : parts_(parts) {
  for (std::size_t n = 0; n < gas.composition.size(); ++n) {
    members_.push_back(make(gas.of_species(n)));
  }
}

std::vector<SeriesField> BySpecies::fields() const {
  std::vector<SeriesField> out = members_.front()->fields();
  for (std::size_t n = 1; n < members_.size(); ++n) {
    const std::vector<SeriesField> more = members_[n]->fields();
    for (std::size_t i = 0; i < out.size(); ++i) {
      out[i].values.insert(out[i].values.end(), more[i].values.begin(), more[i].values.end());
    }
  }
  for (SeriesField& field : out) {
    if (field.kind == SeriesField::Kind::constant) {
      const auto width = static_cast<std::ptrdiff_t>(field.width());
      const auto second = field.values.begin() + width;
      // All are equal if each is equal to the one behind it.
      if (std::equal(field.values.begin(), field.values.end() - width, second)) {
        field.values.resize(field.width());
        continue;
      }
    }
    field.shape.insert(field.shape.begin(), {"species", members_.size()});
  }
  return out;
}

void BySpecies::sample(const Snapshot&, Row& row) {
  std::vector<Row> rows(members_.size());
  for (std::size_t n = 0; n < members_.size(); ++n) members_[n]->sample(parts_[n], rows[n]);
  std::size_t begin = 0;
  for (const SeriesField& field : members_.front()->fields()) {
    if (field.kind == SeriesField::Kind::constant) continue;
    for (const Row& of : rows) {
      row.put_all(std::span(of.values()).subspan(begin, field.width()));
    }
    begin += field.width();
  }
}

void BySpecies::velocities_set() {
  for (const ObservablePointer& member : members_) member->velocities_set();
}

void BySpecies::transfer(Archive& archive) {
  for (const ObservablePointer& member : members_) member->transfer(archive);
}

namespace {

class OfSpecies : public Observable {
 public:
  explicit OfSpecies(const Composition& composition) : composition_(composition) {}

  std::vector<SeriesField> fields() const override {
    const std::vector<SeriesField::Extent> each{{"species", composition_.size()}};
    auto out = fields_of(SpeciesTotals{}, each, is_sampled);
    out.push_back({"collisions",
                   "Number of collisions since the start of the run of each two species, in the "
                   "order of the scene: of the first with itself, with the second and so on, then "
                   "of the second",
                   unit::none, by_pair(composition_, {}), SeriesField::Kind::count});
    return out;
  }

  void sample(const Snapshot& now, Row& row) override {
    put_numbers(row, now.species.totals, is_sampled);
    for (const std::uint64_t collisions : now.species.collisions) {
      row.put(static_cast<double>(collisions));
    }
  }

  bool reads_state() const override { return false; }

 private:
  // Numbers of needles do not change.
  static bool is_sampled(std::string_view name) { return name != "count"; }

  Composition composition_;
};

}  // namespace

ObservablePointer make_species_sums(const Composition& composition) {
  return std::make_unique<OfSpecies>(composition);
}

}  // namespace needlework::observe
