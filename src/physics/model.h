// The interface between the event processor and the physics of what flies and collides.
#pragma once

#include <concepts>
#include <type_traits>

#include "needlework/accuracy.h"
#include "src/physics/collision.h"
#include "src/physics/contact.h"
#include "src/physics/effects.h"
#include "src/physics/gas.h"

namespace needlework {

/// A model of the physics: motion, contact, and the collision rule.
/// The event processor calls no kernel and contains no formula of physics; it manages records, the
/// order of events and time.
///
/// A model promises the following.
///   `motion` is how a needle moves from its record on.
///   `has_effects` is false for a model without any effect, and `effects()` tells which there are;
///   `has_width` is true for rods of finite width, `has_sliding` where needles may slide on each
///   other.
///   `pair` is the relative motion of two needles, a pure function of the two records and the
///     shift, and `contact` is when and how such a pair touches (contact.h).
///   `collide` returns the velocities after a contact, now, of needles that approach from `side`;
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
                         Time now, const kernels::ContactGeometry& geometry, const Vec3d& vector) {
  { M::has_effects } -> std::convertible_to<bool>;
  { M::has_width } -> std::convertible_to<bool>;
  { M::has_sliding } -> std::convertible_to<bool>;
  { model.effects() } -> std::convertible_to<Effects>;
  { model.gas() } -> std::same_as<Gas&>;
  { model.restitution(record, record) } -> std::convertible_to<const Restitution&>;
  { model.accuracy() } -> std::convertible_to<const Accuracy&>;
  { model.motion(record) } -> NeedleMotion;
  { model.half_length(i) } -> std::same_as<double>;
  { model.reach(i) } -> std::same_as<double>;
  requires ContactLaw<std::remove_cvref_t<decltype(model.contact())>>;
  {
    model.pair(i, record, i, record, shift)
    } -> std::same_as<typename std::remove_cvref_t<decltype(model.contact())>::Pair>;
  { model.collide(record, record, now, geometry, int{}, bool{}) } -> std::same_as<Impact>;
  { model.renew(i, now, vector, vector, vector) } -> std::same_as<Shift>;
  { model.renew_in_flight(i, now) } -> std::same_as<Shift>;
};

}  // namespace needlework
