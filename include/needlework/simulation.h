// A simulation of a gas of hard needles: the library's front door.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "needlework/collision.h"
#include "needlework/counters.h"
#include "needlework/scene.h"
#include "needlework/state.h"
#include "needlework/stop.h"
#include "needlework/totals.h"

namespace needlework {

/// A running simulation. Not safe for use from several threads at once; any number of simulations
/// may live side by side.
class Simulation {
 public:
  /// Draws the initial state, or reads it from scene.initial.file; then count and box of the scene
  /// must be 0 or as there.
  /// Throws InputError for a bad scene and IoError for an unreadable file.
  explicit Simulation(const Scene& scene);
  /// Starts from arrays; box, count and temperatures of the scene are ignored.
  Simulation(const Scene& scene, const State& initial);
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;
  ~Simulation();

  /// Runs until the first of the conditions is met; `until` counts from the start of the run, not
  /// from now. Throws InvalidStateError when the run cannot go on correctly; the state stays as it
  /// was before the event that failed. Throws InputError without any condition, and when OpenMP no
  /// longer gives as many threads as at the start; the run may then be tried again.
  Stop advance(const Scene::Until& until);

  /// Called for each collision, in order, after it happened.
  void on_collision(std::function<void(const Collision&)> callback);

  /// Stops `advance` soon; may be called from a signal handler or another thread.
  void interrupt() noexcept;

  Totals totals() const;
  const Counters& counters() const;

  double time() const;                  ///< since the start of the run
  double epoch_length() const;          ///< power of two near the initial mean free time
  double mean_free_time() const;        ///< at the last window's end: 1 / collision rate per needle
  std::string trajectory_hash() const;  ///< 32 hexadecimal digits

  /// All needles at the present time, by ascending id; positions wrapped into the box.
  State state() const;

  std::string search() const;  ///< the search in use, `auto` resolved
  std::string queue() const;
  std::string isa() const;
  std::string effects() const;  ///< such as "inelastic tc", "elastic"

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace needlework
