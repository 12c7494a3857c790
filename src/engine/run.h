// Everything of a running simulation that does not depend on how the next event is found.
#pragma once

#include <atomic>
#include <functional>
#include <optional>

#include "kernels/isa.h"
#include "needlework/simulation.h"
#include "src/engine/replaced_records.h"
#include "src/physics/collision.h"
#include "src/physics/effects.h"
#include "src/physics/gas.h"
#include "src/trajectory/tally.h"

namespace needlework {

/// State, physics, windows and counters of a run.
///
/// Simulated time is cut into windows, each about as long as the mean free time at its start;
/// window ends depend on the simulated history only. There, and only there, the mean free time and
/// the contact time in force are set anew.
class Run {
 public:
  /// Takes over scene parameters and a gas fresh from make_gas().
  Run(const Scene& scene, Gas initial);

  Totals totals() const;
  /// Copies all needles at the present time in this order. Free flight is computed with this
  /// instruction set, on which no bit depends.
  void copy(kernels::Isa isa, const std::vector<Needle>& order, State& out) const;
  /// Throws InputError for an id that does not exist.
  FreeNeedle needle(Id id) const;

  /// Of all needles, kept up by the collisions.
  double energy() const {
    return energy_at_window_ + quantum_ * static_cast<double>(tally.energy - quanta_at_window_);
  }
  /// An energy in whole quanta, far below what a double resolves of the whole: sums of them do not
  /// depend on the order.
  std::int64_t in_quanta(double energy) const {
    return static_cast<std::int64_t>(energy * per_quantum_);
  }

  /// Sets mean free time, contact time and the next window's end from the present state.
  void open_window();
  bool nothing_can_happen() const;

  /// Passes a collision of these two to the callback, or appends it to `later`. Not part of the
  /// loops, as it would enlarge their code.
  void report(Collision& collision, Needle a, Needle b, std::vector<Collision>* later) const;

  /// Replaces the velocities of all needles at the present time and opens a new window; the event
  /// loop has to be made again. `velocity(i)` and `angular_velocity(i)` are by place in storage.
  /// Returns the records as they were.
  ReplacedRecords replace_velocities(const std::function<Vec3d(Needle)>& velocity,
                                     const std::function<Vec3d(Needle)>& angular_velocity);

  Gas gas;
  Time now;
  Restitution restitution;
  Accuracy accuracy;
  Effects effects;  ///< that the scene calls for
  bool sorted;      ///< whether needles are stored in the order of their places
  double mean_free_time = 0;
  double contact_time = 0;           ///< in force in this window
  double search_span = 0;            ///< how far ahead contacts are searched for [time]
  std::vector<Time> last_collision;  ///< for the t_c rule; renewals do not count
  double initial_energy = 0;
  Tally tally;
  std::function<void(const Collision&)> callback;
  std::atomic<bool> interrupted = false;
  Time window_end;

 private:
  /// Fills in temperatures and energy.
  void sum_energies(Totals& out) const;

  std::optional<double> tc_, tc_relative_;
  double window_span_ = 0;
  double energy_at_window_ = 0, quantum_ = 1, per_quantum_ = 1;
  std::int64_t quanta_at_window_ = 0;
};

/// What the scene calls for of flight and pair rule.
Effects effects_of(const Scene& scene);

/// The needles of a state, whose arrays a run has no more use for. Throws InputError for a state
/// that cannot be run.
Gas make_gas(const Scene& scene, const State& initial);

}  // namespace needlework
