// Observables of single needles, of each species or other part of a gas on its own.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "src/observe/observable.h"

namespace needlework::observe {

/// The needles of each part of a gas, such as a species, at one instant, as a gas of their own.
class SnapshotsOfParts {
 public:
  explicit SnapshotsOfParts(std::vector<GasSetting> parts);
  /// Sorts the needles: `part_of` has that of each row of the state, and `totals` the sums of each
  /// part. Valid until the next call, as long as what it is given.
  template <class Index>
  void take(const Snapshot& all, std::span<const Index> part_of,
            std::span<const SpeciesTotals> totals) {
    begin(all, totals);
    for (std::size_t i = 0; i < all.state.size(); ++i) add(all.state, i, parts_[part_of[i]].state);
  }
  const Snapshot& operator[](std::size_t part) const { return parts_[part].snapshot.value(); }
  const GasSetting& gas(std::size_t part) const { return parts_[part].gas; }
  std::size_t size() const { return parts_.size(); }

 private:
  void begin(const Snapshot& all, std::span<const SpeciesTotals> totals);
  static void add(const State& from, std::size_t i, State& to);

  struct Part {
    GasSetting gas;
    State state;
    Totals totals;
    SpeciesSums species;
    std::optional<Snapshot> snapshot;
  };
  std::vector<Part> parts_;
};

/// The parts that are species.
std::vector<GasSetting> settings_of_species(const GasSetting& gas);

/// One observable for each part. A row of a field has one of each of them, in their order; so have
/// constants, unless they are the same for all.
class ByPart : public Observable {
 public:
  /// Borrows the snapshots, which are of the same instant as those of sample(). `extents` are those
  /// by which the parts are counted, such as {"species", 3}.
  ByPart(std::vector<SeriesField::Extent> extents, ObservablePointer (*make)(const GasSetting&),
         const SnapshotsOfParts& parts);

  std::vector<SeriesField> fields() const override;
  void sample(const Snapshot& now, Row& row) override;
  bool reads_state() const override { return members_.front()->reads_state(); }
  void velocities_set() override;
  void transfer(Archive& archive) override;

 private:
  const SnapshotsOfParts& parts_;
  std::vector<SeriesField::Extent> extents_;
  std::vector<ObservablePointer> members_;
};

/// Totals by species and collisions of each two, which the series of a mixture always has.
ObservablePointer make_species_sums(const Composition& composition);

}  // namespace needlework::observe
