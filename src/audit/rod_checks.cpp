// Whether a flight of two rods of finite width has the contacts that it should have, and no others.
#include <algorithm>
#include <cmath>
#include <optional>

#include "src/audit/audit.h"
#include "src/audit/rod_flight.h"
#include "src/audit/tolerances.h"

namespace needlework::audit {

void Audit::settle(const RodFlight& pair) {
  findings_.escalated += pair.needed_quad();
  findings_.undecided += pair.gave_up();
}

// A pair that overlaps, by a contact that was missed or late, has been reported; until the rods are
// out of each other, it is not reported again. Returns from when on they have to be apart.
double Audit::after_overlap(const Flown& flown, RodFlight& pair) const {
  if (flown.start.kind != Start::overlapping) return flown.encounter.begin;
  return pair.end_of_overlap(flown.encounter.begin, flown.encounter.end);
}

void Audit::keep_if_overlapping(const Flown& flown, RodFlight& pair) {
  if (pair.at(flown.duration).most < pair.contact(flown.duration) - pair.limit(flown.duration)) {
    keep_continuation(flown, {Start::overlapping, -1, {}});
  }
}

// Of two rods whose records, of the same time, are those after their collision: rounding them may
// have moved one into the other.
void Audit::measure_overlap(Index a, Index b) {
  const Shift shift = nearest_image(approach_of(a, b, 0), 0);
  const Needle second = image_of(b, shift, a);
  const RodFlight pair(needles_[a], second, shift, space_);
  double& most = findings_.overlaps->at_collisions;
  most = std::max(most, pair.overlap_at(0));
}

void Audit::check_rods_apart(const Flown& flown) {
  const Needle second = image_of(flown.second, flown.encounter.shift, flown.first);
  RodFlight pair(needles_[flown.first], second, flown.encounter.shift, space_, slack_);
  const double last = flown.encounter.end;
  const double from = after_overlap(flown, pair);
  const bool leaves = from < last || flown.start.kind != Start::overlapping;
  const auto overlap = leaves ? pair.overlap(from, last) : std::nullopt;
  findings_.overlaps->at_most = std::max(findings_.overlaps->at_most, pair.certified(last));
  if (overlap) {
    report(Kind::missed, flown.first, flown.second, begin_of(flown.first, flown.second), *overlap);
  }
  if ((overlap || !leaves) && last >= flown.duration) keep_if_overlapping(flown, pair);
  settle(pair);
}

void Audit::check_rods_touching(const Flown& flown) {
  const double now = flown.duration;
  const Needle second = image_of(flown.second, flown.encounter.shift, flown.first);
  RodFlight pair(needles_[flown.first], second, flown.encounter.shift, space_, slack_);
  const auto differs = [&](Kind kind, double s) {
    report(kind, flown.first, flown.second, begin_of(flown.first, flown.second), s);
  };
  const double from = after_overlap(flown, pair);
  const bool starts_over = flown.start.kind == Start::overlapping;
  const auto before = from < now || !starts_over ? pair.overlap(from, now) : std::nullopt;
  RodOverlaps& largest = *findings_.overlaps;
  largest.at_most = std::max(largest.at_most, pair.certified(now));
  largest.at_collisions = std::max(largest.at_collisions, pair.overlap_at(now));
  const RodFlight::Distance there = pair.at(now);
  const bool overlaps = there.most < pair.contact(now) - pair.limit(now);
  const double off =
      pair.limit(now) + std::abs(there.rate) * (relative_tolerance * now + 2 * resolution);
  if (overlaps) {
    differs(Kind::late, now);
  } else if (before) {
    differs(Kind::missed, *before);
  } else if (there.least > pair.contact(now) + off) {
    // About to meet, or far from it.
    const auto later = pair.overlap(now, now + early_reach / pair.rate());
    differs(later ? Kind::early : Kind::spurious, now);
  } else if (there.rate > pair.noise_of_rate(now)) {
    differs(Kind::spurious, now);
  }
  keep_if_overlapping(flown, pair);
  settle(pair);
}

}  // namespace needlework::audit
