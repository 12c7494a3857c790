// Simulates a gas of hard needles. This is the main header of the library.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "needlework/collision.h"
#include "needlework/composition.h"
#include "needlework/counters.h"
#include "needlework/happening.h"
#include "needlework/predict.h"
#include "needlework/scene.h"
#include "needlework/state.h"
#include "needlework/stop.h"
#include "needlework/totals.h"

namespace needlework {

/// What Simulation::checkpoint() saves: the state of a run to its last bit, as bytes for this
/// version of the library. It holds no checksum.
struct Checkpoint {
  std::string bytes;
};

/// Throws InputError where Simulation(scene, initial) would for what the state is: without a search
/// for events, which takes most of that time.
void require_simulable(const Scene& scene, const State& initial);

/// Why no two needles of this initial state can ever collide, in words ("all needles are parallel
/// and do not rotate"), or empty if they may: there are fewer than two, they move alike, they are
/// parallel and do not rotate, or they lie and move in planes normal to an axis. Empty, too, where
/// walls or driving may change that, or another end of the run does not need collisions of needles.
std::string why_no_collision(const Scene& scene, const State& initial);
/// The same for the state that the scene draws.
std::string why_no_collision(const Scene& drawn);

/// A running simulation. It computes in the default floating-point environment, whatever the caller
/// has chosen for itself; callbacks find that, too. Only one thread at a time may use a simulation,
/// except for interrupt(); any number of simulations may exist side by side.
class Simulation {
 public:
  /// Draws the initial state. Throws InputError for a value that a scene file could not hold
  /// (docs/scenes.md gives the ranges), and for a scene whose initial state is in a file: read the
  /// file (needlework/h5md.h) and use the other constructor. Title, until and output of the scene
  /// are ignored here, as by the other constructors.
  explicit Simulation(const Scene& scene);
  /// Starts from the given state; box, count and temperatures of the scene are ignored. Throws
  /// InputError for a value of the scene that a file could not hold, and for an invalid state.
  Simulation(const Scene& scene, const State& initial);
  /// Continues a run from a checkpoint of it, with the same collisions to the last bit. Box,
  /// needles, collisions and accuracy of the scene must be those of the run; search, calendar,
  /// threads and instruction set may be others. Throws InputError if not, or for damaged bytes.
  Simulation(const Scene& scene, const Checkpoint& checkpoint);
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;
  ~Simulation();

  /// Runs until the first of the conditions is met. They count from the start of the run, not from
  /// the present time. Throws InvalidStateError if the run cannot continue correctly; the state
  /// then stays as it was before the event that failed, unless the error is an
  /// UnfinishedEventError. Throws InputError if no condition is given and bodies do not grow, if
  /// one is not a number, or if OpenMP has fewer threads than at the start; the call may be
  /// repeated.
  Stop advance(const Scene::Until& until);

  /// Lets all needles search their first events, which advance() does otherwise and which may take
  /// longer than anything else before the first collision. Returns nothing when it is done, and
  /// else what advance() would return without any event: also where a limit on wall time or
  /// interrupt() has stopped it. The next call, or advance(), then continues.
  std::optional<Stop> prepare(const Scene::Until& until);

  /// The same for the present state; or, that no needles have collided for 2^20 windows of the run
  /// and 2^25 / N, in which kinetic theory expects 2^23 collisions and more. Without a limit on
  /// time, advance() returns Stop::nothing_can_happen then.
  std::string why_no_collision() const;

  /// Sets a function that is called once for each collision, in order of time. It takes the time
  /// and the new states from the Collision: time() and copy() are not yet, or with several threads
  /// no longer, at that moment. If it throws, the simulation cannot go on. It must not set another
  /// function, but may call interrupt().
  void on_collision(std::function<void(const Collision&)> callback);
  /// The same for everything that changes the motion of needles. Both functions may be set.
  void on_happening(std::function<void(const Happening&)> callback);
  /// Sets a function that is called with the times of collisions [time], each once, in any order,
  /// and before advance() returns. It costs less than on_collision(), above all with several
  /// threads, which need not keep and sort whole collisions. If it throws, the simulation cannot go
  /// on.
  void on_collision_times(std::function<void(std::span<const double>)> callback);

  /// Sets a function that is called after each kick of all needles, and after the velocities of
  /// bodies that grow have been scaled back, before anything else happens at that instant: time()
  /// and copy() are those with which the run goes on. If it throws, the simulation cannot go on.
  void on_kick(std::function<void()> callback);

  /// Stops `advance` soon, with one thread before the next event: the call in progress, or else the
  /// next one, which then returns before any further event. May be called from a signal handler or
  /// another thread.
  void interrupt() noexcept;

  /// The names of the sources of events that the scene calls for.
  std::vector<std::string> sources() const;
  /// The number of events of each of them since the start of the run.
  std::vector<std::uint64_t> events_by_source() const;
  /// What has happened at each object of each of them.
  std::vector<std::vector<ObjectTotals>> objects_by_source() const;

  /// Of each wall, in the order of Scene::wall_sides().
  std::vector<WallTotals> wall_totals() const;
  EnergyBudget energy_budget() const;
  /// Where needles may slide on each other.
  std::optional<SlidingContacts> sliding_contacts() const;
  /// How rods of finite width have found room in a state that was drawn, in words; else empty.
  const std::string& placement() const;
  /// Of rods of finite width, the sum of r12 . dp over the collisions so far, r12 from the second
  /// centre to the first and dp the impulse on the first: the pressure times the volume is N T plus
  /// a third of what comes to it in a unit of time. 0 for needles. [m L^2 / time]
  double virial() const;

  /// The pressure tensor since the start of the run, where the scene has [shear] or asks for the
  /// observable pressure_tensor: its mean over the run with standard errors, and the sums from
  /// which means over any part of the run follow.
  std::optional<StressTotals> stress() const;
  std::optional<StressSums> stress_sums() const;

  /// Integral of Totals::t_tr over the time since the start, from its values at the ends of windows
  /// of about a mean free time and now. [energy time]
  double t_tr_integral() const;

  Totals totals() const;
  /// Of each species, in the order of the scene.
  std::vector<SpeciesTotals> species_totals() const;
  /// The species of each needle, in order of id; empty if there is one species.
  std::vector<std::uint8_t> species() const;
  /// The numbers of each needle, in order of id, where those of a species differ or bodies grow, as
  /// they are now; otherwise empty.
  OwnBodies own_bodies() const;
  /// The same at the start, and empty where those of a species are alike.
  OwnBodies own_bodies_at_start() const;
  /// What the gas is made of, with the counts of the state; bodies that grow as at the start.
  const Composition& composition() const;
  /// Collisions since the start of the run of each pair of species, by Composition::pair_index.
  std::vector<std::uint64_t> collisions_by_pair() const;
  const Counters& counters() const;

  /// The distances of the edges of the box, which walls with a velocity move. [L]
  std::array<double, 3> box() const;
  /// Where the low edges are: 0, but where such a wall has moved one. [L]
  std::array<double, 3> low() const;

  /// Of a scene with driving.growth.
  std::optional<GrowthTotals> growth() const;

  std::size_t needles() const;       ///< number of needles
  std::uint64_t collisions() const;  ///< of all needles since the start of the run
  double time() const;               ///< since the start of the run
  double initial_energy() const;     ///< per needle at the start, to which energy_ratio refers
  /// How far rounding has moved the energy since the start. Each window of the run, about a mean
  /// free time long, adds the relative difference between the energy of all needles and that by
  /// account, which changes with each collision by its energy change. In an elastic gas, that is
  /// the relative change of the energy. Costs about as much as totals().
  double energy_drift() const;
  double epoch_length() const;          ///< power of two near the initial mean free time
  double mean_free_time() const;        ///< by kinetic theory, from the temperatures at the start
                                        ///< of the present window
  std::string trajectory_hash() const;  ///< 32 hexadecimal digits

  /// Copies all needles at the present time into `into`, whose memory is reused. They are in order
  /// of id, with positions wrapped into the box. Costs some tens of nanoseconds per needle;
  /// nothing is kept inside the simulation.
  void copy(State& into) const;
  State copy() const;
  /// A copy of one needle at the present time, with its position wrapped into the box. The cost is
  /// proportional to the number of needles. Throws InputError for an unknown id.
  FreeNeedle needle(std::uint32_t id) const;

  /// Replaces the velocities of all needles at the present time. Rows are in order of id, as copy()
  /// gives them: with the flow of a shear rate, across which their momentum must be 0 unless a
  /// thermostat or thermal walls change it. The part of an angular velocity along the director is
  /// removed. Needles that touch stay on their sides. Temperatures, mean free time and the contact
  /// time in force follow the new velocities. The memory of the t_c rule, the hash of previous
  /// collisions, all counts and the initial energy, to which energy_ratio refers, are kept. Costs
  /// about as much as constructing the simulation, as all needles are searched again. Must not be
  /// called by the callback. Throws InputError for a wrong number of rows, numbers not finite or
  /// motion of fixed needles, and then changes nothing.
  void set_velocities(std::span<const std::array<double, 3>> velocity,
                      std::span<const std::array<double, 3>> angular_velocity);

  /// All that is needed to continue from the present time. Conditions of advance() then count from
  /// the original start, and totals, counters and hash go on. Must not be called by the callback.
  Checkpoint checkpoint() const;

  std::string search() const;  ///< the search in use, after `auto` is resolved
  std::string queue() const;
  std::string isa() const;
  std::string effects() const;  ///< the effects in use, such as "inelastic tc" or "elastic"

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
  class Access;
  Access access() const;
};

}  // namespace needlework
