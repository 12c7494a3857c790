// The interface of sources of events: effects that are events of single needles, such as hits on a
// wall or kicks of a thermostat.
//
// A scene has the sources that it calls for. Where there are none, the event loop has no code for
// them. A source says when the next event of a needle is, and what happens then; the engine does
// the rest: it keeps the calendar, replaces the record, searches again, adds up the energy, reports
// and hashes the event, on any number of threads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "needlework/happening.h"
#include "src/physics/gas.h"

namespace needlework {

/// A needle at an event.
struct NeedleAt {
  Needle needle;
  Id id;
  const Record& record;  ///< made before the event
  Body body;
  Time now;
  Vec3d centre;            ///< [L]
  Vec3d director;          ///< a unit vector to within rounding
  Vec3d velocity;          ///< [L / time]
  Vec3d angular_velocity;  ///< [1 / time]
};

/// The next event of a needle by one source.
struct SourceEvent {
  Time time = Time::never();
  std::int8_t detail = 0;  ///< passed to happen(), such as which tip touches
  bool resolvable = true;  ///< false: the run ends with message() if it gets there
};

/// What an event has done. Velocities need to be set only where the motion changes.
struct SourceOutcome {
  bool changes_motion = false;
  Vec3d velocity, angular_velocity;  ///< after the event
  double energy_change = 0;          ///< of the needle
  double work = 0;         ///< of it, what the motion of the object has done; the rest is heat
  double growth_work = 0;  ///< and what growth of the needle has
  // What reports hold besides (needlework/happening.h).
  std::uint32_t object = 0;    ///< of the source, such as the index of a wall
  double arm = 0;              ///< where on the needle it happens [L]
  double normal_velocity = 0;  ///< before the event [L / time]
  Vec3d impulse;               ///< on the needle [m L / time]
  double normal_impulse = 0;   ///< its component along the normal of the object, such as a wall
  bool contact_time_rule = false;
};

/// A source of events.
///
/// `next()` and `happen()` must depend on nothing but the needle's record, its values in the
/// columns that the source has added to the gas (src/physics/columns.h), and constants. Then the
/// trajectory depends on no search, calendar or thread. Several threads may call both for different
/// needles at once. Neither throws.
class EventSource {
 public:
  virtual ~EventSource() = default;

  /// As Simulation::sources() and reports name it.
  virtual const char* name() const = 0;
  /// What its events are in files and reports.
  virtual Happening::Kind kind() const { return Happening::other; }
  /// Number of the objects of which the engine counts the events and adds up the impulses, also
  /// along their normals, and the energy put in, such as walls; the object of each event is below
  /// it, unless it is 0.
  virtual std::size_t objects() const { return 0; }
  /// The first event of needle i at or after `now`, if it is not after `until`; never otherwise. Is
  /// called again whenever the needle searches, and must then give the same answer as long as the
  /// record and the columns are the same.
  virtual SourceEvent next(const Gas& gas, Needle i, Time now, Time until) const = 0;
  /// What happens at such an event. May change the needle's values in the columns of the source.
  virtual SourceOutcome happen(const Gas& gas, const NeedleAt& at, std::int8_t detail) = 0;
  /// Sets the values of its columns at the start of a run, where they depend on ids or the clock.
  virtual void begin(const Gas&) {}
  /// About the time from one of its events of a needle to the next, as far as that does not depend
  /// on the motion of needles; else infinite. [time]
  virtual double usual_time() const { return std::numeric_limits<double>::infinity(); }
  /// The temperature towards which it drives the gas, of whatever temperature that is; 0 if it does
  /// not.
  virtual double usual_temperature() const { return 0; }
  /// Why a run cannot go on at an event that is not resolvable.
  virtual std::string message(const Gas&, const NeedleAt&, std::int8_t /*detail*/) const {
    return {};
  }
  /// All numbers on which its events depend. A run is continued with the same ones only.
  virtual std::vector<double> parameters() const { return {}; }
};

}  // namespace needlework
