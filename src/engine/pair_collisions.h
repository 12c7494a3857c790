// Events of pairs whose needles do nothing but collide. SlidingPairEvents
// (src/effects/sliding/sliding_events.h) is the same for needles that may stay in contact; both
// have the members below, so that the event loop is the same for all.
#pragma once

#include <optional>

#include "needlework/happening.h"
#include "src/effects/sliding/sliding_tally.h"
#include "src/engine/run.h"
#include "src/physics/model.h"

namespace needlework {

/// What events make of pairs, and what needles keep of it. The members that change something are
/// called with records that have been replaced.
template <Model M>
class PairCollisions {
 public:
  using Outcome = PairOutcome;

  PairCollisions(Run& run, const M& model) : run_(run), model_(model) {}

  /// What an event, now, makes of two needles that are in contact, on this side of each other
  /// before. Throws InvalidStateError, and changes nothing, if that cannot be resolved.
  Outcome outcome(const typename M::Law::Pair&, Needle a, Needle b, const Shift& shift, Time now,
                  const kernels::ContactGeometry& contact, int side) const {
    const bool elastic = is_elastic(a, now) || is_elastic(b, now);
    Outcome out = model_.collide(a, b, shift, now, contact, side, elastic);
    out.contact_time_rule = elastic;
    return out;
  }
  /// Enters into both new records what the pair has done. `shift` is that of these records.
  void settle(Needle a, Needle b, const Shift& shift, Time now, const Outcome& outcome,
              SlidingTally&) {
    part(run_.gas, a, b, shift, outcome.side);
    if (!M::has_effects || !run_.contact_time_rule) return;
    run_.contact_time_rule->collided(a, now);
    run_.contact_time_rule->collided(b, now);
  }
  /// What the event is in reports, and in the hash of the trajectory.
  static Happening::Kind kind(const Outcome&) { return Happening::pair; }
  static Happening::Kind kind_in_hash(const Outcome&) { return Happening::pair; }
  /// Calls send() with each report of the event, of which `happening` is the first draft.
  template <class Send>
  static void report(Happening& happening, const Outcome&, const Send& send) {
    send(happening);
  }
  /// A source has acted on needle i: notes that, and returns how long a contact has lasted that
  /// this has cut, if there was one. Called before its record is replaced. [time]
  static std::optional<double> source_acts(Needle, Time, Happening::Kind) { return std::nullopt; }

 private:
  bool is_elastic(Needle i, Time now) const {
    return M::has_effects && run_.contact_time_rule &&
           run_.contact_time_rule->is_recent(i, now, run_.contact_time);
  }

  Run& run_;
  const M& model_;
};

}  // namespace needlework
