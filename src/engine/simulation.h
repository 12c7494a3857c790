// A simulation of a gas of hard needles: the library's front door.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "src/engine/counters.h"
#include "src/scene/scene.h"

namespace needlework {

/// A needle just after a collision, bit for bit as the engine goes on with it.
struct Aftermath {
  std::array<double, 3> position, velocity, orientation, angular_velocity;
};

/// One collision, as passed to the callback. Directions are of needle `first` (the lower id).
struct Collision {
  std::int64_t epoch = 0;               ///< the time is epoch * epoch_length + offset, exactly
  double offset = 0;                    ///< [time]
  double time = 0;                      ///< the same rounded to a double [time]
  std::uint32_t first = 0;              ///< lower id
  std::uint32_t second = 0;             ///< higher id
  std::array<std::int32_t, 3> shift{};  ///< boxes added to the second needle's recorded centre
  double arm_first = 0;                 ///< s12 [L]
  double arm_second = 0;                ///< s21 [L]
  double sin_angle = 0;                 ///< |u1 x u2|
  double normal_velocity = 0;           ///< V_n before the collision [L / time]
  std::array<double, 3> impulse{};      ///< on `first` [m L / time]
  double energy_change = 0;             ///< of the system, <= 0 up to rounding
  bool contact_time_rule = false;       ///< done with epsilon = 1, beta = -1 by the t_c rule
  std::array<Aftermath, 2> after;       ///< of `first` and `second`; set for callbacks only
};

/// Sums over all needles at one instant, independent of their order.
struct Totals {
  double time = 0;                   ///< since the start of the run
  double t_tr = 0;                   ///< (2/3) <m v^2 / 2>
  double t_rot = 0;                  ///< <I w^2 / 2>
  double energy = 0;                 ///< per needle
  std::array<double, 3> momentum{};  ///< total
  std::uint64_t collisions = 0;      ///< since the start of the run
  std::uint64_t tc_collisions = 0;
};

enum class Stop { time, collisions, energy, wall_time, interrupted, nothing_can_happen };

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

/// Draws an initial state: centres and directors uniform, velocities Gaussian, total momentum 0
/// (N >= 2), temperatures exactly as asked for. A pure function of the scene's seed, the same on
/// every machine.
State draw_initial_state(const Scene& scene);

}  // namespace needlework
