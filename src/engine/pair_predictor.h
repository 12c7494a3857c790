// Predicts the first contact of two needles, from their records alone.
#pragma once

#include <algorithm>

#include "needlework/counters.h"
#include "needlework/error.h"
#include "src/engine/replaced_records.h"
#include "src/physics/model.h"

namespace needlework {

/// The predictions of one thread. Caches what it predicted for two needles just after their
/// collision, because both search that pair, and keeps the records that the present event has
/// replaced.
template <Model M>
class PairPredictor {
 public:
  PairPredictor(const M& model, Counters& counters)
      : model_(model), gas_(model.gas()), counters_(counters) {}

  /// Begins an event at this time. No record has been replaced at it yet.
  void begin(Time time) {
    now = time;
    replaced_.clear();
  }
  /// Replaces the record of needle i by calling renew(), which returns the number of boxes by
  /// which the centre was wrapped.
  template <class Renew>
  Shift replace(Needle i, Renew&& renew) {
    ReplacedRecords::Entry& entry = replaced_.add(i, gas_.records[i]);
    return entry.wraps = renew();
  }
  /// Undoes what replace() has done at this event.
  [[gnu::cold]] void put_back() {
    for (const ReplacedRecords::Entry& entry : replaced_) {
      gas_.records[entry.needle] = entry.record;
      gas_.images[entry.needle] = gas_.images[entry.needle] - entry.wraps;
    }
    replaced_.clear();
  }
  /// Hands over the old records when a caller has just replaced some. They determine on which side
  /// of each other two needles are that touch.
  void take(ReplacedRecords replaced) { replaced_ = std::move(replaced); }
  /// Discards what is cached. To be called after needles have moved in storage, or after records
  /// have been put back.
  void forget() {
    last_ = {};
    replaced_.clear();
  }

  /// The first contact of two needles in the interval from `from_now` after now up to `until`.
  /// Needle a has the lower id; `shift` is added to b's centre.
  kernels::Contact predict(Needle a, Needle b, const Shift& shift, double from_now, Time until);

  Time now;
  /// Whether other threads read the records as well, so that none may be given a touch.
  bool shares_records = false;
#ifndef NDEBUG
  /// Whether a record from later than now has been read, of a needle in reach of contact then.
  bool read_ahead = false;
#endif

 private:
  // The prediction for two needles just after their collision.
  struct Prediction {
    Needle a, b;
    std::uint32_t serial_a = 0, serial_b = 0;
    Shift shift{};
    Time until;
    kernels::Contact contact;
  };

  template <class Pair>
  kernels::Contact first_contact(const Pair& pair, double from, double to) {
    kernels::EvaluationCounters spent;
    const kernels::Contact contact = model_.contact().first_contact(pair, from, to, spent);
    counters_.evaluated += spent.evaluated;
    counters_.escalated += spent.escalated;
    return contact;
  }
  void settle_touch(Needle a, Needle b, const Shift& shift);

  const M& model_;
  Gas& gas_;
  Counters& counters_;
  Prediction last_;
  ReplacedRecords replaced_;
};

template <Model M>
kernels::Contact PairPredictor<M>::predict(Needle a, Needle b, const Shift& shift, double from_now,
                                           Time until) {
  ++counters_.predicted;
  const Record& first = gas_.records[a];
  const Record& second = gas_.records[b];
  const Time start = Gas::start_of(first, second);
  // With several threads a record may be from later than now. Before its time the needles do not
  // meet.
  if (until < start) return {};
  // The interval is rounded outwards. The times themselves are compared exactly.
  double from = std::max(0.0, (gas_.clock.difference(now, start) + from_now) * (1 - 0x1p-50));
  // A slightly later contact may round to the same time, for which the ids decide the order.
  const double to = (gas_.clock.difference(until, start) + gas_.clock.resolution()) * (1 + 0x1p-50);
  auto pair = model_.pair(a, first, b, second, shift);
#ifndef NDEBUG
  if (start > now) {
    const Vec3d apart = (model_.motion(first).centre(pair.elapsed_first.hi) -
                         model_.motion(second).centre(pair.elapsed_second.hi)) -
                        to_double(pair.shift);
    const double reach = model_.reach(a) + model_.reach(b);
    if (dot(apart, apart) <= reach * reach) read_ahead = true;
  }
#endif
  // Both needles of a collision search the pair, with records made at the present time.
  const bool shared = pair.touch.collided && first.time == second.time;
  const Prediction& last = last_;
  if (shared && last.a == a && last.b == b && same(last.shift, shift) &&
      last.serial_a == first.serial && last.serial_b == second.serial) {
    if (last.contact.found || until <= last.until) return last.contact;
    from = gas_.clock.difference(last.until, start) * (1 - 0x1p-50);
  }
  kernels::Contact contact = first_contact(pair, from, to);
  if (contact.side_unknown) {
    settle_touch(a, b, shift);
    pair = model_.pair(a, first, b, second, shift);
    contact = first_contact(pair, from, to);
  }
  // A return so soon that its time cannot be distinguished from that of the previous collision.
  if (contact.found && pair.touch.collided && contact.elapsed.hi < 64 * gas_.clock.resolution()) {
    contact.unresolvable = true;
  }
  if (shared) last_ = {a, b, first.serial, second.serial, shift, until, contact};
  return contact;
}

// Decides on which side of each other two needles are that touch to within rounding. Rounding the
// new record may have moved one to the other side, so the gap is continued from the records
// before.
template <Model M>
void PairPredictor<M>::settle_touch(Needle a, Needle b, const Shift& shift) {
  if (shares_records) {
    throw UnfinishedEventError("needles touch while other threads read their records");
  }
  if (std::max(gas_.records[a].time, gas_.records[b].time) > now) {
    throw UnfinishedEventError("needles touch at an event that another thread has done before");
  }
  ++counters_.touches;
  const Record* first = &gas_.records[a];
  const Record* second = &gas_.records[b];
  Shift old_shift = shift;
  if (const auto* old = replaced_.find(a)) {
    first = &old->record;
    old_shift = old_shift + old->wraps;
  }
  if (const auto* old = replaced_.find(b)) {
    second = &old->record;
    old_shift = old_shift - old->wraps;
  }
  const auto before = model_.pair(a, *first, b, *second, old_shift);
  const Time start = Gas::start_of(*first, *second);
  const double elapsed = gas_.clock.difference(now, start);
  kernels::Touch touch{.touching = true, .collided = false, .side = 0, .gap = 0};
  const double tick = gas_.clock.resolution();
  // Largest error of the predicted time of a contact, relative to that time.
  const double off = std::max(0x1p-38, 2 * model_.accuracy().root_tolerance);
  const kernels::Contact due = first_contact(before, std::max(0.0, elapsed - tick) * (1 - 0x1p-50),
                                             (elapsed + tick) * (1 + off));
  const double gap = model_.contact().gap(before, gas_.clock.exact_difference(now, start));
  const int side = gap > 0 ? 1 : gap < 0 ? -1 : 0;
  // A contact is due now and has not happened yet, or it is due so soon that its predicted time
  // lies after the root of f.
  if (due.found && (gas_.clock.add(start, due.elapsed.hi) <= now || side != due.side)) {
    touch.side = due.side;
  } else {
    touch.gap = gap;
    touch.side = side;
    // Exactly at contact: either a collision at this instant or a touch without one.
    const bool just_had = before.touch.touching && elapsed == 0;
    if (touch.side == 0)
      touch.side = just_had ? before.touch.side : model_.contact().side_after(before);
    // Needles at rest relative to each other stay on the side that they had.
    if (touch.side == 0) touch.side = before.touch.side;
    // Needles that rotate with coinciding centres had no side before.
    if (touch.side == 0) {
      touch.side =
          model_.contact().side_after(model_.pair(a, gas_.records[a], b, gas_.records[b], shift));
    }
  }
  const Record &mine = gas_.records[a], &other = gas_.records[b];
  if (mine.time >= other.time) {
    gas_.add_touch(a, RecordedTouch::of(gas_.ids[b], other.serial, shift, touch));
  } else {
    gas_.add_touch(b, RecordedTouch::of(gas_.ids[a], mine.serial, -shift, touch));
  }
}

}  // namespace needlework
