// All that a scene asks to observe, put together.
#pragma once

#include <span>
#include <vector>

#include "src/observe/by_species.h"
#include "src/observe/observable.h"
#include "src/observe/registry.h"

namespace needlework::observe {

/// The observables of a run, in the order of their list, whatever the order in the scene.
class Observation {
 public:
  /// Makes those that the complete scene names, and the theory of `cooling` if that is given. Those
  /// that read collisions need the species of needles, if there are several.
  explicit Observation(const Scene& scene, ObservablePointer cooling = nullptr,
                       SpeciesById species = {});
  Observation(const Observation&) = delete;
  Observation& operator=(const Observation&) = delete;

  bool empty() const { return members_.empty(); }
  std::vector<SeriesGroup> groups() const;
  bool reads_state() const;
  bool reads_collisions() const;

  /// The values of one sample: the rows of all fields, one after the other, in the order of
  /// groups() and without constants. Sums by species are needed if there are several, and those of
  /// walls and the budget of energy if there are walls or driving. Valid until the next call.
  std::span<const double> sample(const State& state, const Totals& totals,
                                 const SpeciesSums& species = {});
  void collision(const Collision& collision);
  /// A caller has replaced all velocities.
  void velocities_set();
  /// Saves or restores what the observables remember.
  void transfer(Archive& archive);

 private:
  struct Member {
    std::string name, meaning;
    ObservablePointer observable;
  };

  ObservablePointer make(const Entry& entry) const;

  GasSetting gas_;
  SnapshotsOfParts parts_;  ///< species
  std::vector<Member> members_;
  std::vector<Observable*> readers_;  ///< those that read collisions
  std::size_t width_ = 0;
  Row row_;
};

}  // namespace needlework::observe
