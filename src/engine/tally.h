// Totals that a thread accumulates while it processes events. They are sums, so that those of
// several threads can be added in any order.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "kernels/vec3.h"
#include "needlework/counters.h"
#include "src/effects/sliding/sliding_tally.h"
#include "src/engine/quanta.h"
#include "src/engine/stress.h"
#include "src/physics/clock.h"
#include "src/trajectory/exact_total.h"
#include "src/trajectory/trajectory_hash.h"

namespace needlework {

/// What a source of events has done.
struct SourceTally {
  std::uint64_t events = 0;
  Quanta energy;  ///< change of the energy of all needles, as Tally::energy

  template <class Archive>
  friend void transfer(Archive& archive, SourceTally& tally) {
    archive(tally.events, tally.energy);
  }
};

/// What has happened at one object of a source of events, such as a wall.
struct ObjectTally {
  std::uint64_t events = 0;
  Quanta energy;                             ///< the same
  ExactTotal impulse;                        ///< sum of |J| [m L / time]
  SignedExactTotal normal_impulse;           ///< of components along its normal
  SignedExactTotal work;                     ///< of its motion [energy]
  std::array<SignedExactTotal, 3> momentum;  ///< sum of J

  template <class Archive>
  friend void transfer(Archive& archive, ObjectTally& tally) {
    archive(tally.events, tally.energy, tally.impulse, tally.normal_impulse, tally.work,
            tally.momentum[0], tally.momentum[1], tally.momentum[2]);
  }
};

struct Tally {
  std::uint64_t collisions = 0, tc_collisions = 0;
  Quanta energy;  ///< change of the total energy, in quanta of the windows
  TrajectoryHash hash;
  Counters counters;
  Time instant;                        ///< time of the last collision
  std::uint64_t at_instant = 0;        ///< number of collisions at that time
  std::vector<std::uint64_t> by_pair;  ///< collisions by Composition::pair_index; empty as long as
                                       ///< no mixture has had one

  std::vector<SourceTally> by_source;  ///< the same of events of sources
  std::vector<ObjectTally> by_object;  ///< of all sources, by Run::first_object; the same

  /// Of rods, sum of r12 . dp over their collisions, r12 from the second centre to the first and dp
  /// the impulse on the first; none as long as no rods have collided; where thin needles are among
  /// them, which may be rough, a second number to be subtracted. [energy]
  std::vector<ExactTotal> virial;

  SlidingTally sliding;

  std::vector<StressTally> stress;  ///< one, or none where it is not measured
  Quanta flow;  ///< of `energy`, what the flow has put in, in flights that are over and collisions
  Quanta growth;  ///< and what growth has

  /// Counts one more of kind `index` out of so many.
  static void count(std::vector<std::uint64_t>& counts, std::size_t index, std::size_t kinds) {
    if (counts.empty()) counts.resize(kinds);
    ++counts[index];
  }
  /// Counts an event of source `index` out of so many, which has changed the energy by so many
  /// quanta.
  void count_source(std::size_t index, const Quanta& quanta, std::size_t sources) {
    if (by_source.empty()) by_source.resize(sources);
    ++by_source[index].events;
    by_source[index].energy += quanta;
  }
  /// An event at an object.
  struct AtObject {
    Quanta quanta;
    double normal_impulse, work;
    Vec3d impulse;
  };
  /// Counts one at object `index` out of so many.
  void count_object(std::size_t index, const AtObject& event, std::size_t objects) {
    if (by_object.empty()) by_object.resize(objects);
    ObjectTally& object = by_object[index];
    ++object.events;
    object.energy += event.quanta;
    object.impulse.add(std::sqrt(dot(event.impulse, event.impulse)));
    object.normal_impulse.add(event.normal_impulse);
    if (event.work != 0) object.work.add(event.work);
    object.momentum[0].add(event.impulse.x);
    object.momentum[1].add(event.impulse.y);
    object.momentum[2].add(event.impulse.z);
  }

  /// Moves the sums of `other` into this object. Not its last instant, because later events have
  /// later times.
  void take(Tally& other) {
    collisions += other.collisions;
    tc_collisions += other.tc_collisions;
    energy += other.energy;
    hash.add(other.hash);
    counters += other.counters;
    add(by_pair, other.by_pair);
    add(by_source, other.by_source);
    add(by_object, other.by_object);
    add(virial, other.virial);
    sliding.take(other.sliding);
    add(stress, other.stress);
    flow += other.flow;
    growth += other.growth;
    other = {};
  }

 private:
  static void add(std::uint64_t& to, std::uint64_t from) { to += from; }
  static void add(SourceTally& to, const SourceTally& from) {
    to.events += from.events;
    to.energy += from.energy;
  }
  static void add(ObjectTally& to, ObjectTally& from) {
    to.events += from.events;
    to.energy += from.energy;
    to.impulse.take(from.impulse);
    to.normal_impulse.take(from.normal_impulse);
    to.work.take(from.work);
    for (std::size_t n = 0; n < 3; ++n) to.momentum[n].take(from.momentum[n]);
  }
  static void add(ExactTotal& to, ExactTotal& from) { to.take(from); }
  static void add(StressTally& to, StressTally& from) { to.take(from); }
  template <class Sum>
  static void add(std::vector<Sum>& to, std::vector<Sum>& from) {
    if (to.empty()) return to.swap(from);
    for (std::size_t n = 0; n < from.size(); ++n) add(to[n], from[n]);
  }
};

}  // namespace needlework
