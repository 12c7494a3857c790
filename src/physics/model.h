// The seam between the event processor and what flies and collides.
#pragma once

#include <concepts>

#include "kernels/first_contact.h"
#include "needlework/accuracy.h"
#include "src/physics/collision.h"
#include "src/physics/effects.h"
#include "src/physics/gas.h"

namespace needlework {

/// A model of the physics: free flight, first contact, contact geometry, and the collision rule.
/// The event processor calls no kernel and knows no formula; it keeps records, order and time.
///
/// A model promises the following.
///   Purity. `pair`, `first_contact`, `geometry`, `gap` and `side_after` are functions of the two
///     records and the shift alone: not of the time of asking, of the search or of the thread.
///     Exchanging the needles and negating the shift changes no bit.
///   `first_contact(pair, from, to, spent)` gives the first contact in (0, to], in time since the
///     later record; the caller knows the time before `from` to be free. When the pair touches to
///     within rounding and its records do not tell the side, nothing is decided and `side_unknown`
///     is set.
///   `gap(pair, elapsed)` is a signed distance that vanishes at a contact and is continued from the
///     touch that the pair carries; `side_after(pair)` its sign just after the later record.
///   `collide` gives the velocities after a contact of needles that approach from `side`; `elastic`
///     asks for the rule of the contact time. It never adds energy.
///   `renew` and `renew_in_flight` replace one record and nothing else, and return by how many
///     boxes its centre was wrapped.
/// Members throw nothing. Several threads may use one model for different needles.
template <class M>
concept Model = requires(const M& model, Needle i, const Record& record, const Shift& shift,
                         Time now, const DoubleDouble& elapsed, double time,
                         const kernels::Pair& pair, kernels::SearchCounters& spent,
                         const kernels::ContactGeometry& geometry, const Vec3d& vector) {
  { M::effects } -> std::convertible_to<Effects>;
  { model.gas() } -> std::same_as<Gas&>;
  { model.restitution() } -> std::convertible_to<const Restitution&>;
  { model.accuracy() } -> std::convertible_to<const Accuracy&>;
  { model.centre(record, time) } -> std::same_as<Vec3d>;
  { model.reach(record, record) } -> std::convertible_to<double>;
  { model.pair(i, record, i, record, shift) } -> std::same_as<kernels::Pair>;
  { model.first_contact(pair, time, time, spent) } -> std::same_as<kernels::Contact>;
  { model.gap(pair, elapsed) } -> std::convertible_to<double>;
  { model.side_after(pair) } -> std::convertible_to<int>;
  { model.geometry(pair, elapsed) } -> std::same_as<kernels::ContactGeometry>;
  { model.collide(record, record, geometry, int{}, bool{}) } -> std::same_as<Impact>;
  { model.renew(i, now, vector, vector, vector) } -> std::same_as<Shift>;
  { model.renew_in_flight(i, now) } -> std::same_as<Shift>;
};

}  // namespace needlework
