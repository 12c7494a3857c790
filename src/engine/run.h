// The part of a running simulation that does not depend on how the next event is found.
#pragma once

#include <unistd.h>

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "kernels/isa.h"
#include "needlework/happening.h"
#include "needlework/simulation.h"
#include "src/effects/event_source.h"
#include "src/engine/replaced_records.h"
#include "src/engine/tally.h"
#include "src/physics/collisionless.h"
#include "src/physics/contact_time.h"
#include "src/physics/effects.h"
#include "src/physics/gas.h"
#include "src/scene/derived_numbers.h"

namespace needlework {

class Archive;

/// What callbacks will need of what has happened.
struct Reports {
  std::vector<Happening> happenings;
  std::vector<double> times;  ///< of collisions
};

/// Sums over all needles of a species, on which its energy depends.
struct SumsOfSquares {
  double v2 = 0, w2 = 0;  ///< [L^2 / time^2], [1 / time^2]
};

/// State, physics, windows and counters of a run.
///
/// Simulated time is divided into windows, each about as long as the mean free time at its start.
/// The ends of windows depend on the simulated history only. The mean free time and the contact
/// time in force are updated at the ends of windows and nowhere else.
class Run {
 public:
  /// Takes the parameters of the scene, and a gas that make_gas() has made.
  Run(const Scene& scene, Gas initial);
  /// Continues from what save() has returned for the same scene; search, calendar, threads and
  /// instruction set may differ. Throws InputError if the scene describes other physics, and for
  /// damaged bytes as far as that can be seen.
  Run(const Scene& scene, const Checkpoint& saved);
  /// All on which the future of the run depends, and sums and counts of its past. `by_id` are the
  /// places of the needles in storage, in order of id.
  Checkpoint save(const Scene& scene, const std::vector<Needle>& by_id);

  Totals totals() const;
  std::vector<SpeciesTotals> species_totals() const;
  /// Copies all needles at the present time, in this order. The instruction set is used for free
  /// flight and affects no bit of the result.
  void copy(kernels::Isa isa, const std::vector<Needle>& order, State& out) const;
  /// Throws InputError for an id that does not exist.
  FreeNeedle needle(Id id) const;

  /// Energy of all needles, updated at each collision.
  double energy() const {
    const auto since_window = static_cast<std::int64_t>(tally.energy - quanta_at_window_);
    return energy_at_window_ + quantum_ * static_cast<double>(since_window);
  }
  /// An energy as a whole number of quanta, which are far smaller than the resolution of a double
  /// at the total energy. Sums of whole numbers do not depend on their order. Rounded to the
  /// nearest, so that the energy by account does not drift. They are modulo 2^64, in which those of
  /// all windows would overflow.
  std::uint64_t in_quanta(double energy) const {
    return static_cast<std::uint64_t>(
        static_cast<std::int64_t>(energy * per_quantum_ + (energy < 0 ? -0.5 : 0.5)));
  }
  /// See Simulation::energy_drift().
  double energy_drift() const;

  /// Computes the mean free time, the contact time and the end of the next window from the present
  /// state.
  void open_window();
  /// The same at the end of a window, of which the drift of the energy is noted.
  void pass_window();
  /// Whether needles do not move relative to each other, so that time may pass without events.
  bool nothing_can_happen() const;
  /// Why no two needles can ever collide, as the state shows; nothing if they may.
  std::optional<Collisionless> collisionless() const;
  /// Whether no needles have collided for so long that none are expected to: for 2^20 windows, and
  /// for 2^25 / N. Kinetic theory expects a collision of every second to fourth needle in a window.
  bool is_quiet() const {
    const auto count = static_cast<std::uint64_t>(gas.size());
    return quiet_windows_ >= long_quiet && quiet_windows_ * count >= 32 * long_quiet;
  }
  std::uint64_t long_quiet = std::uint64_t{1} << 20;  ///< [windows]
  /// How a run ends that has no further event: since nothing can happen any more. If needles still
  /// move, their next events are beyond the range of the clock: throws InvalidStateError.
  Stop end_of_events() const;

  /// Whether anybody wants to know of collisions, or of what else happens.
  bool has_callback() const { return callback || times_callback || happening_callback; }
  /// Passes what has happened to these two needles, or to the one if b is none, to the callbacks,
  /// or appends what they need to `later`. Kept out of the event loops, whose code it would
  /// enlarge.
  void report(Happening& happening, Needle a, Needle b, Reports* later) const;
  /// Passes it to the callbacks that want whole happenings.
  void pass_on(const Happening& happening) const;

  /// Adds a source of events. To be called before there is an event loop.
  void add_source(std::unique_ptr<EventSource> source);

  /// Throws InputError, "set_velocities: ...", if searches cannot follow velocities with these sums
  /// of squares, of which parts along the directors may be too much, or if needles would collide at
  /// times that the clock of this run does not tell apart; and as require_images(now) does.
  void require_followable(const std::vector<SumsOfSquares>& sums, bool moves) const;
  /// Throws InvalidStateError if needles that fly freely until then have crossed more boxes than
  /// are counted.
  void require_images(Time at) const;
  /// Replaces the velocities of all needles at the present time and opens a new window. The event
  /// loop must be made again afterwards. `velocity(i)` and `angular_velocity(i)` are indexed by
  /// place in storage. Returns the previous records.
  ReplacedRecords replace_velocities(const std::function<Vec3d(Needle)>& velocity,
                                     const std::function<Vec3d(Needle)>& angular_velocity);

  Gas gas;
  Time now;
  Accuracy accuracy;
  Effects effects;  ///< effects that the scene requires
  bool sorted;      ///< whether needles are stored in spatial order
  double mean_free_time = 0;
  double contact_time = 0;  ///< contact time of the t_c rule in this window
  double search_span = 0;   ///< length of time ahead in which contacts are searched
  std::optional<ContactTimeRule> contact_time_rule;
  std::vector<std::unique_ptr<EventSource>> sources;
  double initial_energy = 0;
  Tally tally;
  std::function<void(const Collision&)> callback;
  std::function<void(std::span<const double>)> times_callback;
  std::function<void(const Happening&)> happening_callback;
  std::atomic<bool> interrupted = false;
  Time window_end;
  /// To be set to the number of threads that have just worked together, which can share work on all
  /// needles, or to 1.
  void set_threads_at_hand(int threads) { threads_ = threads, process_ = getpid(); }
  /// Is 1 in a forked child, where OpenMP would wait for its threads without end.
  int threads_at_hand() const { return process_ == getpid() ? threads_ : 1; }

 private:
  /// Takes the parameters of the scene; without needles.
  explicit Run(const Scene& scene);
  /// Adds the columns of the effects to the gas.
  void add_columns();
  void transfer(Archive& archive, const std::vector<Needle>& by_id);
  void require_consistent() const;
  GasNumbers numbers_with(const std::vector<SumsOfSquares>& sums, bool moves) const;
  GasNumbers numbers() const;
  /// Of all needles of each species.
  std::vector<SumsOfSquares> sums_of_squares() const;
  SpeciesTotals totals_of(SpeciesIndex species, const SumsOfSquares& sums) const;
  /// Computes temperatures and energy.
  void set_energies(const std::vector<SumsOfSquares>& sums, Totals& out) const;
  double mean_free_time_of(const std::vector<SumsOfSquares>& sums) const;
  /// The relative difference between this energy of all needles and that by account.
  static double drift_to(double energy_of_all, double by_account);

  /// Computes what follows from the mean free time and the energy at the start of a window: energy
  /// quantum, contact time and spans.
  void set_scales();

  std::optional<double> tc_, tc_relative_;
  double window_span_ = 0;
  double energy_at_window_ = 0, quantum_ = 1, per_quantum_ = 1;
  std::uint64_t quanta_at_window_ = 0;
  double drift_of_windows_ = 0;                              ///< of those that have ended
  std::uint64_t quiet_windows_ = 0, collisions_before_ = 0;  ///< since the last collision
  int threads_ = 1;
  pid_t process_ = 0;  ///< in which these are
};

/// The effects on flight and pair rule that the scene requires.
Effects effects_of(const Scene& scene);

/// Makes the needles of a run from a state. Throws InputError for a state that cannot be
/// simulated.
Gas make_gas(const Scene& scene, const State& initial);

}  // namespace needlework
