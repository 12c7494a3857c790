// The interface between the event processor and the physics of what flies and collides.
#pragma once

#include <concepts>

#include "kernels/first_contact.h"
#include "needlework/accuracy.h"
#include "src/physics/collision.h"
#include "src/physics/effects.h"
#include "src/physics/gas.h"

namespace needlework {

/// A model of the physics: free flight, first contact, contact geometry, and the collision rule.
/// The event processor calls no kernel and contains no formula of physics; it manages records, the
/// order of events and time.
///
/// A model promises the following.
///   `has_effects` is false for a model without any effect, and `effects()` tells which there are.
///   `pair`, `first_contact`, `geometry`, `gap`, `side_after` and `time_apart` are pure functions
///     of the two records and the shift. They do not depend on when they are called, on the search
///     or on the thread. Exchanging the needles and negating the shift changes no bit.
///   `first_contact(pair, from, to, spent)` returns the first contact in (0, to], as a time since
///     the later record. The caller knows that there is no contact before `from`. If the pair
///     touches to within rounding and its records do not hold the side, the function decides
///     nothing and sets `side_unknown`.
///   `gap(pair, elapsed)` is the value of the contact function [L], which is 0 at a contact; where
///     the pair holds a touch, it is continued from that touch. `side_after(pair)` is for a pair
///     that touches at the time of the later record: the sign of `gap` just after it, or 0 if there
///     is none.
///   `time_apart(pair)` is for a pair that has just collided, at the time of both records: no
///     contact comes before it.
///   `collide` returns the velocities after a contact of needles that approach from `side`;
///     `elastic` selects the rule for collisions within the contact time. It never adds energy.
///   `renew` replaces the record of one needle by its state at `now` with a new director, velocity
///     and angular velocity; `renew_in_flight` by the state to which its present flight has led.
///     Both add to the needle's entry in Gas::images the number of boxes by which its centre was
///     wrapped, return that number, and change nothing else.
/// `renew` and `renew_in_flight` throw InvalidStateError, and change nothing, if a needle crosses
/// more boxes than are counted; other members throw nothing. Several threads may use one model for
/// different needles.
template <class M>
concept Model = requires(const M& model, Needle i, const Record& record, const Shift& shift,
                         Time now, const DoubleDouble& elapsed, double time,
                         const kernels::Pair& pair, kernels::EvaluationCounters& spent,
                         const kernels::ContactGeometry& geometry, const Vec3d& vector) {
  { M::has_effects } -> std::convertible_to<bool>;
  { model.effects() } -> std::convertible_to<Effects>;
  { model.gas() } -> std::same_as<Gas&>;
  { model.restitution(record, record) } -> std::convertible_to<const Restitution&>;
  { model.accuracy() } -> std::convertible_to<const Accuracy&>;
  { model.centre(record, time) } -> std::same_as<Vec3d>;
  { model.half_length(i) } -> std::same_as<double>;
  { model.reach(record, record) } -> std::convertible_to<double>;
  { model.pair(i, record, i, record, shift) } -> std::same_as<kernels::Pair>;
  { model.first_contact(pair, time, time, spent) } -> std::same_as<kernels::Contact>;
  { model.gap(pair, elapsed) } -> std::convertible_to<double>;
  { model.side_after(pair) } -> std::convertible_to<int>;
  { model.time_apart(pair) } -> std::convertible_to<double>;
  { model.geometry(pair, elapsed) } -> std::same_as<kernels::ContactGeometry>;
  { model.collide(record, record, geometry, int{}, bool{}) } -> std::same_as<Impact>;
  { model.renew(i, now, vector, vector, vector) } -> std::same_as<Shift>;
  { model.renew_in_flight(i, now) } -> std::same_as<Shift>;
};

}  // namespace needlework
