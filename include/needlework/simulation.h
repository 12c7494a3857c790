// A simulation of a gas of hard needles: the library's front door.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "needlework/collision.h"
#include "needlework/counters.h"
#include "needlework/predict.h"
#include "needlework/scene.h"
#include "needlework/state.h"
#include "needlework/stop.h"
#include "needlework/totals.h"

namespace needlework {

/// A running simulation. Not safe for use from several threads at once; any number of simulations
/// may live side by side.
class Simulation {
 public:
  /// Draws the initial state. Throws InputError for a bad scene, and for one whose initial state is
  /// in a file: read that (needlework/h5md.h) and use the other constructor.
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

  /// Copies all needles at the present time, by ascending id, positions wrapped into the box, into
  /// a state whose memory is used again. Costs some tens of nanoseconds a needle; nothing is kept.
  void copy(State& into) const;
  State copy() const;
  /// A copy of one needle at the present time, its position wrapped into the box. Takes a time
  /// proportional to the number of needles. Throws InputError for an id that does not exist.
  FreeNeedle needle(std::uint32_t id) const;

  /// Replaces the velocities of all needles at the present time; rows are by ascending id, and the
  /// part of an angular velocity along the director is taken off. Needles that touch stay on their
  /// sides. The memory of the t_c rule, the hash of the collisions so far, all counts and the
  /// initial energy, to which energy_ratio refers, stay as they are; temperatures, mean free time
  /// and the contact time in force follow the new velocities. Searches all needles again, so it
  /// costs about as much as making the simulation. Not to be called by the callback. Throws
  /// InputError for a wrong number of rows or numbers that are not finite, and then changes
  /// nothing.
  void set_velocities(std::span<const std::array<double, 3>> velocity,
                      std::span<const std::array<double, 3>> angular_velocity);

  std::string search() const;  ///< the search in use, `auto` resolved
  std::string queue() const;
  std::string isa() const;
  std::string effects() const;  ///< such as "inelastic tc", "elastic"

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace needlework
