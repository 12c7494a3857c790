// All that a scene asks to observe, put together.
#pragma once

#include <span>
#include <vector>

#include "src/observe/observable.h"

namespace needlework::observe {

/// The observables of a run, in the order of their list, whatever the order in the scene.
class Observation {
 public:
  /// Makes those that the complete scene names, and the theory of `cooling` if that is given.
  explicit Observation(const Scene& scene, ObservablePointer cooling = nullptr);

  bool empty() const { return members_.empty(); }
  std::vector<SeriesGroup> groups() const;
  bool reads_state() const;
  bool reads_collisions() const;

  /// The values of one sample: the rows of all fields, one after the other, in the order of
  /// groups() and without constants. Valid until the next call.
  std::span<const double> sample(const State& state, const Totals& totals);
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

  GasSetting gas_;
  std::vector<Member> members_;
  std::vector<Observable*> readers_;  ///< those that read collisions
  std::size_t width_ = 0;
  Row row_;
};

}  // namespace needlework::observe
