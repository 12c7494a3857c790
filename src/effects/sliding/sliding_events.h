// Events of pairs whose needles may slide on each other, with the members of PairCollisions
// (src/engine/pair_collisions.h). `Run` is that of the engine.
#pragma once

#include <fmt/format.h>

#include <optional>

#include "needlework/error.h"
#include "needlework/happening.h"
#include "src/effects/sliding/sliding.h"

namespace needlework {

template <class Run, class M>
class SlidingPairEvents {
 public:
  using Outcome = Sliding::Outcome;

  SlidingPairEvents(Run& run, const M& model) : run_(run), model_(model) {}

  Outcome outcome(const SlidingPair& pair, Needle a, Needle b, const Shift&, Time now,
                  const kernels::ContactGeometry& contact, int side) const {
    const Gas& gas = run_.gas;
    const Outcome out = run_.sliding->outcome(
        gas, {pair, now, contact, side, model_.restitution(gas.records[a], gas.records[b]),
              run_.windows.mean_free_time()});
    if (!out.is_unresolvable()) return out;
    const std::uint32_t first = gas.ids[a].value, second = gas.ids[b].value;
    throw InvalidStateError(
        fmt::format("needles {} and {} slide on each other at time {:.17g} and are so nearly "
                    "parallel that their motion cannot be resolved",
                    first, second, gas.clock.since_start(now)),
        {{first, second}});
  }
  void settle(Needle a, Needle b, const Shift& shift, Time now, const Outcome& outcome,
              SlidingTally& tally) {
    run_.sliding->settle(run_.gas, a, b, shift, now, outcome, tally);
    if (!run_.contact_time_rule || !outcome.collides) return;
    run_.contact_time_rule->collided(a, now);
    run_.contact_time_rule->collided(b, now);
  }
  static Happening::Kind kind(const Outcome& outcome) {
    if (outcome.bond == BondChange::begins) return Happening::contact_entered;
    if (outcome.bond == BondChange::ends && !outcome.collides) return Happening::contact_ended;
    return Happening::pair;
  }
  /// There, what continues a contact enters it again.
  static Happening::Kind kind_in_hash(const Outcome& outcome) {
    return outcome.are_bonded() ? Happening::contact_entered : kind(outcome);
  }
  template <class Send>
  static void report(Happening& happening, const Outcome& outcome, const Send& send) {
    // Needles that collide as their contact has been cut have ended it before.
    if (outcome.collides && outcome.bond_before == SlidingPair::Bond::cut) {
      Happening ended = happening;
      ended.kind = Happening::contact_ended;
      ended.event.impulse = {};
      ended.event.energy_change = 0;
      send(ended);
    }
    if (outcome.bond != BondChange::continues) send(happening);
  }
  std::optional<double> source_acts(Needle i, Time now, Happening::Kind kind) {
    if (kind == Happening::wall) run_.sliding->hit_wall(i, now);
    return Sliding::cut_by_event(run_.gas, i, now);
  }

 private:
  Run& run_;
  const M& model_;
};

}  // namespace needlework
