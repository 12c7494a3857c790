// First contact of two rods of finite width: the definition of every collision of rods.
//
// The distance d of the axes is the least of those of all pairs of points on them, each of which
// has a second derivative of its square that is at most
//   C = 2 V^2 + 2 d A,
// where V bounds the relative velocity of such points and A their relative acceleration. So
// d^2 - C s^2 / 2 is concave, whatever kind of contact it is, and also where the nearest points
// jump, as they do for nearly parallel rods. Hence, on an interval of length h,
//   free     d^2 is not below its chord by more than C (s - a)(b - s) / 2: no contact if that stays
//            above the square of the distance at contact,
//   falling  where d^2 falls faster than C h at the begin, it falls in all of the interval: one
//            contact or none, by the values at its ends.
// Time since the later record is cut into intervals of equal length, each of which is halved until
// one of these settles it. All is decided in double where its error bounds allow and in
// double-double otherwise. The result depends on the pair alone: not on when or from which interval
// the search starts, nor where it ends.
#pragma once

#include "kernels/first_contact.h"
#include "kernels/rod_pair.h"
#include "needlework/accuracy.h"

namespace needlework::kernels {

/// The first contact with elapsed time in [0, until]. The caller promises that there is none before
/// `from`, so that intervals wholly before it are skipped. `until` must be finite.
///
/// A pair is in contact when the distance of its axes falls below `distance`, or below the distance
/// that they have at s = 0, if that is the smaller one: rounding the records at a contact moves the
/// rods by so much. Where they are that near and approach, contact is at once, elapsed 0. The
/// side is 1. `unresolvable` is set where a pair that has just collided returns at once, with a
/// velocity that is rounding. `overlap` is set where the rods are nearer at s = 0 than rounding
/// explains, which is `touch_within` or, where that is 0, what rounding of this pair's numbers may
/// do: a contact has been lost. It comes with `found` and `unresolvable`, at elapsed 0.
///
/// Of `accuracy`, root_tolerance counts, and Escalation::always. Otherwise double-double decides
/// what double cannot, since a contact that is lost leaves an overlap; and all methods of isolation
/// are this one, whose bounds include the rounding errors.
Contact rod_contact(const RodPair& pair, double from, double until, EvaluationCounters& counters,
                    const Accuracy& accuracy = standard_accuracy);

/// The pair at the moment of contact. The normal is the unit vector from the nearest point of the
/// second axis to that of the first. Axes that are parallel and along each other meet in the middle
/// of what they have in common.
ContactGeometry rod_geometry(const RodPair& pair, const DoubleDouble& elapsed);

/// Two rods that have collided at s = 0, the time of both records, surely do not meet again before
/// this [time]; it is 0 if they hardly part.
double rod_time_apart(const RodPair& pair);

/// The distance of the axes less that at contact, evaluated in double-double: below 0, the rods
/// overlap by so much. [L]
double rod_gap(const RodPair& pair, const DoubleDouble& elapsed);

}  // namespace needlework::kernels
