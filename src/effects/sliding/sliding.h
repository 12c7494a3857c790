// Sliding contact: what becomes of two needles that touch, where trains of ever smaller bounces are
// replaced by the motion that they tend to.
//
// A contact is two records that refer to one step of its motion (src/physics/slides.h). Its steps,
// its end and what other needles do to it are events of pairs: when the record of one of the two is
// replaced by anything else, the contact is cut, and an event of the pair is due at once, which
// decides whether they collide, part or stay in contact. So strikes of third needles go on, pair by
// pair, until no touching pair approaches, lower ids first.
#pragma once

#include <cstdint>
#include <optional>

#include "src/archive/archive.h"
#include "src/effects/sliding/sliding_tally.h"
#include "src/physics/gas.h"
#include "src/physics/pair_outcome.h"
#include "src/physics/sliding_contact.h"
#include "src/physics/transfer.h"

namespace needlework {

/// When a needle has touched others, in collisions and contacts, or walls.
struct LastTouches {
  static constexpr Id wall{0xffffffff};

  Id last;                     ///< the latest partner, or `wall`
  Time with_last, others;      ///< the latest times with this one, and with any other
  std::uint32_t in_crowd = 0;  ///< collisions without a break, each soon after one with a third

  static constexpr Time long_ago{-(std::int64_t{1} << 62), 0};

  void met(Id partner, Time now, bool crowded) {
    in_crowd = crowded ? in_crowd + 1 : 0;
    note(partner, now);
  }
  /// The same of a partner, or a wall, that is no crowd.
  void note(Id partner, Time now) {
    if (last != partner) others = with_last;
    last = partner;
    with_last = now;
  }
  /// The latest time with any needle but this one, or a wall.
  Time but(Id partner) const { return last == partner ? others : with_last; }

  friend void transfer(Archive& archive, LastTouches& touches) {
    archive(touches.last.value, touches.with_last, touches.others, touches.in_crowd);
  }
};

class Sliding {
 public:
  struct Parameters {
    double below = 1e-3;  ///< threshold for the flight to the next bounce, in mean free times
    /// A strike is done with epsilon = 1: what hits a needle in contact, and what follows from that
    /// at the same instant.
    bool elastic_strikes = false;
  };
  /// Adds its column to the gas and lets needles slide.
  Sliding(Gas& gas, const Parameters& parameters);

  /// What two needles do when an event of their pair is due. Those in contact part by a collision,
  /// or without one.
  struct Outcome : PairOutcome {
    SlidingPair::Bond bond_before = SlidingPair::Bond::none;
    kernels::SlidingEnd end = kernels::SlidingEnd::None;  ///< of a contact that ends by itself
    bool crowded = false;  ///< one of the two has just touched a third needle
    bool raised = false;   ///< and epsilon has been raised for that, or for a strike
    /// How long contacts have lasted that the event cuts, of each needle with a third one, and the
    /// step of that of the two. [time]
    std::optional<double> cut_first, cut_second, step;

    /// The two are so nearly parallel that their motion in contact cannot be resolved.
    bool is_unresolvable() const { return end == kernels::SlidingEnd::Unresolvable; }
  };
  /// An event of a pair that is due.
  struct Due {
    const SlidingPair& pair;
    Time now;
    const kernels::ContactGeometry& geometry;
    int side;  ///< sign of f before it
    const Restitution& rule;
    double mean_free_time;  ///< of the window
  };
  Outcome outcome(const Gas& gas, const Due& due) const;
  /// To be called when the records of both have been replaced by those of the outcome: joins bonded
  /// ones, notes that they have touched, and counts. `shift` is that of their new records.
  void settle(Gas& gas, Needle a, Needle b, const Shift& shift, Time now, const Outcome& outcome,
              SlidingTally& tally);
  /// Makes the new records of two needles those of a contact, into which they came from `side`.
  static void join(Gas& gas, Needle a, Needle b, const Shift& shift, int side);
  /// How long the contact has lasted of which needle i has a record, which another event replaces
  /// now; nothing if it slides on no needle. An event of the pair is then due at once. [time]
  static std::optional<double> cut_by_event(const Gas& gas, Needle i, Time now);
  /// Notes that a needle has hit a wall.
  void hit_wall(Needle i, Time now) { (*last_touches_)[i].note(LastTouches::wall, now); }
  /// Notes that the contact of a needle is ended as the velocities of all are set.
  void let_go(Needle i, const Record& record, Time now) {
    if (parameters_.elastic_strikes) (*last_touches_)[i].note(record.first_touch.partner, now);
  }

  double below() const { return parameters_.below; }
  bool strikes_are_elastic() const { return parameters_.elastic_strikes; }

 private:
  Outcome decided(const Gas& gas, const Due& due) const;
  bool is_crowded(const Gas& gas, const SlidingPair& pair, Time now, double within) const;
  bool is_strike(const Gas& gas, const SlidingPair& pair, Time now) const;

  Parameters parameters_;
  Column<LastTouches>* last_touches_;
};

}  // namespace needlework
