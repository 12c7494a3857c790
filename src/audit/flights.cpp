// Whether a flight of two needles has the contacts that it should have, and no others.
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "src/audit/audit.h"
#include "src/audit/guided_flight.h"
#include "src/audit/tolerances.h"

namespace needlework::audit {
namespace {

// How the pair's flight in this image starts, given how its previous flight ended.
Start start_of(const Vector<double>& r, const std::optional<Continuation>& continuation) {
  if (!continuation) return {};
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(r[axis] - continuation->r[axis]) > 0.25) return {};
  }
  return continuation->start;
}

}  // namespace

Shift Audit::nearest_image(const Approach& approach, double s) const {
  // In which row it is comes first: where it is along x depends on that.
  Shift nearest{};
  for (const int axis : {1, 0, 2}) {
    const Vector<double> r = separation(approach, s, nearest, space_.box);
    nearest[axis] = static_cast<std::int32_t>(space_.boxes_along<double>(axis, r[axis]));
  }
  return nearest;
}

// Until now, when they are largest.
double Audit::reach_of_pair(Index i, Index j, const Instant& now) const {
  const double scale = space_.scale_at(now);
  return reach_of(needles_[i].body.grown(scale), needles_[j].body.grown(scale));
}

std::optional<Continuation> Audit::take_continuation(Index i, Index j) {
  const auto found = continuations_.find(key_of(i, j));
  if (found == continuations_.end()) return std::nullopt;
  const Continuation continuation = found->second;
  continuations_.erase(found);
  return continuation;
}

// Checks that the pair had no contact until now.
void Audit::check_flight(Index i, Index j, const Instant& now) {
  if (i > j) std::swap(i, j);
  if (!is_chosen(i, j)) return;
  const double duration = elapsed<double>(begin_of(i, j), now).middle;
  if (!(duration > 0)) return;
  ++findings_.checked;
  if (joint_of(i, j))
    return;  // other images are out of reach, as boxes are longer than two lengths
  const Approach approach = approach_of(i, j, duration);
  std::optional<Continuation> continuation;
  if (!continuations_.empty()) continuation = take_continuation(i, j);
  const double reach = reach_of_pair(i, j, now) + approach.bow;
  for_each_encounter(approach, reach, duration, space_, [&](const Encounter& encounter) {
    check_apart({i, j, approach, encounter, duration,
                 start_of(separation(approach, 0, encounter.shift, space_.box), continuation)});
  });
}

// For a pair that has collided now, before another collision of one of its needles: f continues
// from 0 with another slope.
void Audit::go_on_from_contact(Index i, Index j, const Instant& now) {
  if (!(begin_of(i, j) == now)) return;
  const auto found = continuations_.find(key_of(i, j));
  if (found == continuations_.end() || found->second.start.kind != Start::collided) return;
  const int side = found->second.start.side;
  found->second.start = {side != 0 ? Start::touching : Start::apart, side, 0.0};
}

// Checks that the pair had no contact until now, and has one now.
void Audit::check_contact(Index a, Index b, const Instant& now) {
  ++findings_.checked;
  ++findings_.contacts;
  const double duration = elapsed<double>(begin_of(a, b), now).middle;
  const Approach approach = approach_of(a, b, duration);
  const Shift nearest = nearest_image(approach, duration);
  const std::optional<Continuation> continuation = take_continuation(a, b);
  const double reach = reach_of_pair(a, b, now) + approach.bow;
  bool met = false;
  for_each_encounter(approach, reach, duration, space_, [&](const Encounter& encounter) {
    const Flown flown{
        a,        b,
        approach, encounter,
        duration, start_of(separation(approach, 0, encounter.shift, space_.box), continuation)};
    if (encounter.shift == nearest && encounter.end >= duration) {
      met = true;
      check_touching(flown);
    } else {
      check_apart(flown);
    }
  });
  if (!met) report(Kind::spurious, a, b, now);
}

// Uncertainty of the time of a contact at s.
double Audit::tolerance(PairMotion& pair, double s) const {
  const Sample sample = pair.precise(s);
  return 4 * pair.limit(sample, s) / std::abs(sample.df) + relative_tolerance * std::abs(s) +
         2 * resolution + slack_;
}

void Audit::keep_continuation(const Flown& flown, const Start& start) {
  continuations_[key_of(flown.first, flown.second)] = {
      separation(flown.approach, flown.duration, flown.encounter.shift, space_.box), start};
}

void Audit::settle(const PairMotion& pair, bool undecided) {
  findings_.escalated += pair.needed_quad();
  findings_.undecided += undecided;
}

template <class Check>
void Audit::with_motion(const Flown& flown, const Check& check) const {
  const Needle& first = needles_[flown.first];
  const Shift& shift = flown.encounter.shift;
  if (setup_.sliding && (joints_[flown.first] || joints_[flown.second])) {
    const Instant begin = begin_of(flown.first, flown.second);
    const auto guide = [&](Index i) {
      return guide_of(i, elapsed<double>(needles_[i].record.time, begin).middle);
    };
    GuidedFlight pair(guide(flown.first), guide(flown.second), shift, space_, flown.start,
                      flown.duration);
    return check(pair);
  }
  const Needle second = image_of(flown.second, shift, flown.first);
  PairFlight pair(first, second, shift, space_, flown.start);
  check(pair);
}

void Audit::check_apart(const Flown& flown) {
  if (have_width(flown.first, flown.second)) return check_rods_apart(flown);
  with_motion(flown, [&](PairMotion& pair) { check_apart(flown, pair); });
}

void Audit::check_apart(const Flown& flown, PairMotion& pair) {
  const double duration = flown.duration, last = flown.encounter.end;
  const bool to_the_end = last >= duration;
  if (!(pair.rate() > 0)) return;
  ContactFinder finder(pair);
  bool undecided = false;
  for (auto contact = finder.first(flown.encounter.begin, last); contact;
       contact = finder.next(contact->end, last)) {
    // An event at the same time may come first; the contact is then found in the next flight.
    const double early = contact->certain ? tolerance(pair, contact->end) : 0;
    if (to_the_end && contact->end >= duration - early) {
      const auto kind = contact->side != 0 ? Start::touching : Start::apart;
      // Counts as 0 if the contact is assumed to be due and was not.
      const double gap = pair.precise(duration).f;
      keep_continuation(flown, {kind, contact->side, gap, std::abs(gap)});
      const bool brief = (contact->end - contact->begin) * pair.rate() < longest_touch;
      return settle(pair, undecided || contact->side == 0 || !brief);
    }
    if (contact->certain) {
      report(Kind::missed, flown.first, flown.second, begin_of(flown.first, flown.second),
             contact->begin);
      return settle(pair, undecided);
    }
    undecided = true;
    if (contact->end >= last) break;
  }
  if (to_the_end && pair.is_near_contact(duration)) {
    const int side = finder.on_needles(duration, duration) >= 0 ? finder.sign(duration) : 0;
    keep_continuation(flown,
                      {side != 0 ? Start::touching : Start::apart, side, pair.precise(duration).f});
  }
  settle(pair, undecided);
}

void Audit::check_touching(const Flown& flown) {
  if (have_width(flown.first, flown.second)) return check_rods_touching(flown);
  with_motion(flown, [&](PairMotion& pair) { check_touching(flown, pair); });
}

void Audit::check_touching(const Flown& flown, PairMotion& pair) {
  const double duration = flown.duration;
  const Start& start = flown.start;
  ContactFinder finder(pair);
  const double off = tolerance(pair, duration), begin = duration - off, end = duration + off;
  bool undecided = !(off * pair.rate() < 0.25);

  // A contact before this one.
  std::optional<ContactInterval> before;
  if (begin > flown.encounter.begin) {
    before = finder.first(flown.encounter.begin, begin);
    while (before && !before->certain) {
      undecided = true;
      if (!(before->end < begin)) {
        before.reset();
        break;
      }
      before = finder.next(before->end, begin);
    }
  }
  // The contact of this collision. The touch at which the pair started does not count.
  const bool at_start = begin <= 0 && start.kind != Start::apart;
  const int side = at_start ? start.side : finder.sign(begin), after = finder.sign(end);
  const int inside = finder.on_needles(begin, end);
  // If f is curved, it may vanish now without a change of sign within the range that its slope
  // gives.
  const bool keeps_sign = side != 0 && side == after, off_contact = finder.sign(duration) != 0;
  const bool none = !undecided && (inside < 0 || (keeps_sign && off_contact));
  const auto differs = [&](Kind kind, double s) {
    report(kind, flown.first, flown.second, begin_of(flown.first, flown.second), s);
  };
  bool spurious = false;
  if (none && before) {
    differs(Kind::late, duration);
  } else if (none) {
    const auto later = finder.next(end, end + early_reach / pair.rate());
    spurious = !(later && later->certain);
    differs(spurious ? Kind::spurious : Kind::early, duration);
  } else if (before) {
    differs(Kind::missed, before->begin);
  } else if (side == 0 || after == 0 || inside == 0 || keeps_sign) {
    undecided = true;
  }
  // The needles stay on the side from which they came.
  const double approaching = pair.precise(duration).df;
  if (!spurious) {
    keep_continuation(flown, {Start::collided, undecided ? 0 : approaching < 0 ? 1 : -1, {}});
  }
  settle(pair, undecided);
}

}  // namespace needlework::audit
