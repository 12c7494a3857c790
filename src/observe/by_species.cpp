#include "src/observe/by_species.h"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <span>
#include <string_view>
#include <utility>

#include "src/observe/described_fields.h"

namespace needlework::observe {

std::vector<GasSetting> settings_of_species(const GasSetting& gas) {
  std::vector<GasSetting> out;
  for (std::size_t n = 0; n < gas.composition.size(); ++n) out.push_back(gas.of_species(n));
  return out;
}

SnapshotsOfParts::SnapshotsOfParts(std::vector<GasSetting> parts) {
  for (GasSetting& gas : parts) {
    parts_.push_back({.gas = std::move(gas),
                      .state = {},
                      .totals = {},
                      .species = {},
                      .snapshot = std::nullopt});
  }
}

void SnapshotsOfParts::begin(const Snapshot& all, std::span<const SpeciesTotals> totals) {
  const State& state = all.state;
  for (std::size_t n = 0; n < parts_.size(); ++n) {
    Part& part = parts_[n];
    part.state.box = state.box;
    part.state.low = state.low;
    part.state.periodic = state.periodic;
    part.state.slide = state.slide;
    part.state.shear_rate = state.shear_rate;
    part.state.resize(0);
    part.state.peculiar_x.clear();
    part.state.own_bodies = {};
    const SpeciesTotals& sums = totals[n];
    part.totals = {.time = all.totals.time, .t_tr = sums.t_tr, .t_rot = sums.t_rot};
    part.totals.energy = 1.5 * sums.t_tr + 0.5 * part.gas.rotations * sums.t_rot;
    part.species.totals = {sums};
    part.snapshot.emplace(part.gas, part.state, part.totals, part.species);
  }
}

void SnapshotsOfParts::add(const State& from, std::size_t i, State& to) {
  to.position.push_back(from.position[i]);
  to.velocity.push_back(from.velocity[i]);
  to.orientation.push_back(from.orientation[i]);
  to.angular_velocity.push_back(from.angular_velocity[i]);
  if (!from.peculiar_x.empty()) to.peculiar_x.push_back(from.peculiar_x[i]);
  if (!from.image.empty()) to.image.push_back(from.image[i]);
  if (!from.id.empty()) to.id.push_back(from.id[i]);
  const OwnBodies& own = from.own_bodies;
  if (own.empty()) return;
  to.own_bodies.length.push_back(own.length[i]);
  to.own_bodies.diameter.push_back(own.diameter[i]);
  to.own_bodies.mass.push_back(own.mass[i]);
  to.own_bodies.inertia.push_back(own.inertia[i]);
}

ByPart::ByPart(std::vector<SeriesField::Extent> extents,
               ObservablePointer (*make)(const GasSetting&), const SnapshotsOfParts& parts)
    : parts_(parts), extents_(std::move(extents)) {
  for (std::size_t n = 0; n < parts.size(); ++n) members_.push_back(make(parts.gas(n)));
}

std::vector<SeriesField> ByPart::fields() const {
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
    field.shape.insert(field.shape.begin(), extents_.begin(), extents_.end());
  }
  return out;
}

void ByPart::sample(const Snapshot&, Row& row) {
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

void ByPart::velocities_set() {
  for (const ObservablePointer& member : members_) member->velocities_set();
}

void ByPart::transfer(Archive& archive) {
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
