// The interface between the event processor and the physics of what flies and collides.
#pragma once

#include <concepts>
#include <type_traits>

#include "needlework/accuracy.h"
#include "src/physics/collision.h"
#include "src/physics/contact.h"
#include "src/physics/effects.h"
#include "src/physics/gas.h"
#include "src/physics/pair_outcome.h"

namespace needlework {

/// A model of the physics: motion, contact, and the collision rule.
/// The event processor calls no kernel and contains no formula of physics; it manages records, the
/// order of events and time.
///
/// A model promises the following.
///   `motion` is how a needle moves from its record on.
///   `has_effects` is false for a model without any effect, and `effects()` tells which there are;
///   `has_sliding` is true where needles may slide on each other.
///   `body` is what a needle is, and `half_length` and `reach` parts of it that searches ask for.
///   `pair` is the relative motion of two needles, a pure function of the two records and the
///     shift, and `contact` is when and how such a pair touches (contact.h).
///   `time_apart` is that of the contact (contact.h) for two needles that have just collided, or
///     more where they never meet again.
///   `collide` is the outcome of a contact, now, of needles that approach from `side`, the second
///     with `shift` boxes added; `elastic` selects the rule for collisions within the contact time.
///     It adds no energy but the work of growth.
///   `present` is the state to which a needle's motion has led at `now`, and `renew` replaces its
///     record by such a state with other velocities. It adds to the needle's entry in Gas::images
///     the number of boxes by which its centre was wrapped, returns that number, and changes
///     nothing else.
/// `renew` throws InvalidStateError, and changes nothing, if a needle crosses more boxes than are
/// counted; other members throw nothing. Several threads may use one model for different needles.
template <class M>
concept Model = requires(const M& model, Needle i, const Record& record, const Shift& shift,
                         Time now, const kernels::ContactGeometry& geometry,
                         const kernels::BodyState& state) {
  { M::has_effects } -> std::convertible_to<bool>;
  { M::has_sliding } -> std::convertible_to<bool>;
  requires ContactLaw<typename M::Law>;
  { model.effects() } -> std::convertible_to<Effects>;
  { model.gas() } -> std::same_as<Gas&>;
  { model.restitution(record, record) } -> std::convertible_to<const Restitution&>;
  { model.accuracy() } -> std::convertible_to<const Accuracy&>;
  { model.motion(record) } -> NeedleMotion;
  { model.body(i) } -> std::convertible_to<Body>;
  { model.half_length(i) } -> std::same_as<double>;
  { model.reach(i) } -> std::same_as<double>;
  { model.contact() } -> std::same_as<const typename M::Law&>;
  { model.pair(i, record, i, record, shift) } -> std::same_as<typename M::Law::Pair>;
  { model.time_apart(i, i, shift) } -> std::same_as<double>;
  { model.collide(i, i, shift, now, geometry, int{}, bool{}) } -> std::same_as<PairOutcome>;
  { model.present(i, now) } -> std::same_as<kernels::BodyState>;
  { model.renew(i, now, state) } -> std::same_as<Shift>;
};

}  // namespace needlework
