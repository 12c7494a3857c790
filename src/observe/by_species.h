// Observables of single needles, of each species on its own.
#pragma once

#include <optional>
#include <vector>

#include "src/observe/observable.h"

namespace needlework::observe {

/// The needles of each species at one instant, as a gas of their own. Made once for all
/// observables.
class SnapshotsBySpecies {
 public:
  explicit SnapshotsBySpecies(const GasSetting& gas);
  /// Sorts the needles by species. Valid until the next call, as long as what it is given.
  void take(const Snapshot& all);
  const Snapshot& operator[](std::size_t species) const { return parts_[species].snapshot.value(); }

 private:
  struct Part {
    GasSetting gas;
    State state;
    Totals totals;
    SpeciesSums species;
    std::optional<Snapshot> snapshot;
  };
  std::vector<Part> parts_;
};

/// One observable for each species. A row of a field has one of each of them, in the order of the
/// species; so have constants, unless they are the same for all.
class BySpecies : public Observable {
 public:
  /// Borrows the snapshots, which are of the same instant as those of sample().
  BySpecies(const GasSetting& gas, ObservablePointer (*make)(const GasSetting&),
            const SnapshotsBySpecies& parts);

  std::vector<SeriesField> fields() const override;
  void sample(const Snapshot& now, Row& row) override;
  bool reads_state() const override { return members_.front()->reads_state(); }
  void velocities_set() override;
  void transfer(Archive& archive) override;

 private:
  const SnapshotsBySpecies& parts_;
  std::vector<ObservablePointer> members_;
};

/// Totals by species and collisions of each two, which the series of a mixture always has.
ObservablePointer make_species_sums(const Composition& composition);

}  // namespace needlework::observe
