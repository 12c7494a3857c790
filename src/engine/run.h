// The part of a running simulation that does not depend on how the next event is found.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "needlework/simulation.h"
#include "src/effects/driving/growing.h"
#include "src/effects/driving/kicks.h"
#include "src/effects/event_source.h"
#include "src/effects/sliding/sliding.h"
#include "src/engine/energy_account.h"
#include "src/engine/energy_shares.h"
#include "src/engine/gas_sums.h"
#include "src/engine/listeners.h"
#include "src/engine/replaced_records.h"
#include "src/engine/tally.h"
#include "src/engine/team_at_hand.h"
#include "src/engine/temperature_integral.h"
#include "src/engine/windows.h"
#include "src/physics/collisionless.h"
#include "src/physics/contact_time.h"
#include "src/physics/effects.h"
#include "src/physics/gas.h"

namespace needlework {

class Archive;

/// State, physics, windows and counters of a run.
///
/// The mean free time and the contact time in force are updated at the ends of windows and nowhere
/// else.
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
  /// See Simulation::energy_budget().
  EnergyBudget energy_budget() const;
  /// Energy of all needles, updated at each collision; without the work of gravity along periodic
  /// axes in this window.
  double present_energy() const { return energy.now(tally.energy); }
  /// See Simulation::energy_drift().
  double energy_drift() const;

  /// Opens a window for the present state.
  void open_window() {
    const std::vector<SumsOfSquares> sums = sums_now();
    open_window(sums, work_beside_events(sums));
  }
  /// The same at the end of a window, of which the drift of the energy is noted.
  void pass_window();
  /// Whether no two needles can ever collide and nothing else can happen either, so that time may
  /// pass without windows.
  bool nothing_can_happen() const;
  /// Why no two needles can ever collide, as the state shows; nothing if they may.
  std::optional<Collisionless> collisionless() const;
  /// Whether walls with a velocity have pressed bodies together so that, since it was asked some
  /// hundreds of collisions of each body ago, each has flown a small part of its size only, and the
  /// walls have moved by next to nothing: the last collision of all would never come. Or bodies
  /// have become so fast thereby that the clock does not resolve their contacts. To be asked after
  /// exactly so many collisions, so that the answer depends on the trajectory alone.
  double next_look_for_jam() const;
  bool is_jammed();
  bool is_quiet() const { return windows.are_quiet(gas.size()); }
  /// How a run ends that has no further event: since nothing can happen any more. If needles still
  /// move, their next events are beyond the range of the clock: throws InvalidStateError.
  Stop end_of_events() const;

  /// Whether so many needles have moved in space that storage should be sorted.
  bool is_out_of_order() const;
  /// Sorts the needles so that neighbours in space are neighbours in memory. Returns where each
  /// place in storage was before.
  std::vector<Needle> sort_storage();

  /// Adds a source of events. To be called before there is an event loop.
  void add_source(std::unique_ptr<EventSource> source);

  /// Throws InputError, "set_velocities: ...", if searches cannot follow velocities with these sums
  /// of squares, of which parts along the directors may be too much, or if needles would collide at
  /// times that the clock of this run does not tell apart; and as require_images() does.
  void require_followable(const std::vector<SumsOfSquares>& sums, bool moves) const;
  /// Replaces the velocities of all needles at the present time by those of a caller, and opens a
  /// new window. The event loop must be made again afterwards. `velocity(i)` and
  /// `angular_velocity(i)` are indexed by place in storage. Returns the previous records.
  ReplacedRecords set_velocities(const std::function<Vec3d(Needle)>& velocity,
                                 const std::function<Vec3d(Needle)>& angular_velocity);

  /// When all needles are kicked next, or a gas whose bodies grow is measured and cooled; never
  /// where neither is. What happens at the same instant happens before.
  Time next_instant() const {
    return kicks     ? kicks->time(gas.clock, kicks_done + 1)
           : growing ? growing->next()
                     : Time::never();
  }
  /// Whether the velocities of all needles are replaced then.
  bool replaces_velocities() const {
    return kicks || (growing && growing->parameters().cools && !growing->is_looking());
  }
  /// Contacts need to be searched up to this time: the first one after an instant at which
  /// velocities are replaced, or after that at which bodies have their largest sizes, beyond which
  /// searches know no contact. Time::never() without either.
  Time search_until() const { return search_until_; }
  /// Kicks all needles now, and replaces their records; see set_velocities().
  ReplacedRecords kick();
  /// Measures a gas whose bodies grow.
  void measure_growth();
  /// Scales its velocities back to the temperature at the start; see kick().
  ReplacedRecords cool();
  /// Sum of r12 . dp over the collisions of bodies with a width, r12 between the centres. [energy]
  double virial() const;
  /// The integral of the translational temperature over time since the start. [energy time]
  double temperature_integral_now() const;

  Gas gas;
  Time now;
  /// When the run ends, whatever is asked for, and why: walls meet (see Meeting), or bodies have
  /// grown.
  Time last_time = Time::never();
  Stop at_last_time = Stop::walls_meet;
  Windows windows;
  EnergyAccount energy;
  EnergyShares energy_shares;
  /// Counts what a needle has carried in a flight that is over now, and what two have handed over
  /// in a collision, as tally.stress and tally.flow say.
  void count(const FlightCarries& over, Tally& to) const {
    if (to.stress.empty()) to.stress.resize(1);
    to.stress.front().add_flight(over.mass, over.cc);
    if (gas.shear) count_flow(over.mass * over.cc[0][1], to);
  }
  void count_collision(const Vec3d& between, const Vec3d& impulse, Tally& to) const {
    if (to.stress.empty()) to.stress.resize(1);
    to.stress.front().add_collision(between, impulse);
    if (gas.shear) count_flow(between.y * impulse.x, to);
  }
  /// The pressure tensor of the run so far, times volume and time. [energy time]
  StressSums stress_sums() const;
  /// Its mean over the run, where it is measured.
  StressTotals stress() const;

  /// By gravity along periodic axes, which events do not count; work_of_pull().
  double work_at_start = 0, work_at_opening = 0;
  TemperatureIntegral temperature_integral;
  StressBatches stress_batches;
  Tally tally;
  Accuracy accuracy;
  Effects effects;  ///< effects that the scene requires
  bool sorted;      ///< whether needles are stored in spatial order
  double initial_energy = 0;
  double contact_time = 0;  ///< contact time of the t_c rule in this window
  std::optional<ContactTimeRule> contact_time_rule;
  std::optional<Sliding> sliding;
  std::vector<std::unique_ptr<EventSource>> sources;
  std::vector<std::size_t> first_object;  ///< of each source, among the objects of all
  std::size_t objects = 0;                ///< number of them
  std::optional<Kicks> kicks;
  std::uint64_t kicks_done = 0;
  std::optional<Growing> growing;
  Listeners listeners;
  TeamAtHand team;
  std::atomic<bool> interrupted = false;

 private:
  std::vector<SumsOfSquares> sums_now() const { return sums_of_squares(gas, now, team.threads()); }
  void open_window(const std::vector<SumsOfSquares>& sums, double work);
  /// The same after a time in which events and gravity have changed the energy, of which the drift
  /// is noted.
  void open_window_and_note_drift();
  /// Whoever does it; see set_velocities().
  ReplacedRecords replace_velocities(const std::function<Vec3d(Needle)>& velocity,
                                     const std::function<Vec3d(Needle)>& angular_velocity);
  /// Energy of all needles by the account, where these are their sums now.
  double energy_by_account(const std::vector<SumsOfSquares>& sums) const {
    return present_energy() + (work_beside_events(sums) - work_at_opening);
  }
  /// Of gravity along periodic axes, and of the flow in flights that are not over.
  double work_beside_events(const std::vector<SumsOfSquares>& sums) const;
  void count_flow(double carried, Tally& to) const {
    const Quanta quanta = energy.in_quanta(-gas.shear->rate() * carried);
    to.energy += quanta;
    to.flow += quanta;
  }
  void count_strikes();
  /// Takes the parameters of the scene; without needles.
  explicit Run(const Scene& scene);
  /// Makes what the effects of the scene need besides.
  void add_effects(const Scene& scene);
  void expect_energy();
  double usual_time_of_events(const std::vector<SumsOfSquares>& sums) const;
  void find_next_instant();
  void find_last_time(const Scene& scene);
  Growing::Parameters parameters_of_growing(const Scene& scene) const;
  void transfer(Archive& archive, const std::vector<Needle>& by_id);
  void transfer_growth(Archive& archive);
  void require_consistent() const;
  GasNumbers numbers() const;
  void set_contact_time();

  std::optional<double> tc_, tc_relative_;
  struct JamLook {
    Time time;
    std::uint64_t collisions = 0;  ///< by then
  };
  JamLook looked_for_jam_, looked_long_for_jam_;
  Time search_until_ = Time::never();
  std::uint64_t sorted_at_ = 0;  ///< value of the counter `crossings` at the last sorting
};

/// The effects on motion and pair rule that the scene requires.
Effects effects_of(const Scene& scene);

}  // namespace needlework
