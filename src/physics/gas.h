// The needles of a run: their records, and the pairs they form.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "kernels/contact_function.h"
#include "src/memory/large_array.h"
#include "src/physics/clock.h"

namespace needlework {

/// Place of a needle in storage; changes when the storage is sorted.
using Needle = std::uint32_t;
inline constexpr Needle no_needle = 0xffffffff;

/// Boxes added to a needle's recorded centre, per axis.
using Shift = std::array<std::int32_t, 3>;
/// a == b, without a call to memcmp.
inline bool same(const Shift& a, const Shift& b) {
  return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}
inline Shift operator-(const Shift& a) { return {-a[0], -a[1], -a[2]}; }
inline Shift operator-(const Shift& a, const Shift& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline Shift operator+(const Shift& a, const Shift& b) { return a - (-b); }

/// A needle that this one touches to within rounding. The partner may get a new record at the same
/// instant; then this says nothing any more.
struct TouchEntry {
  Needle partner;
  std::uint32_t partner_serial;
  Shift shift;  ///< added to the partner's recorded centre
  kernels::Touch touch;
};

/// What a needle carries since its own last collision or renewal. Nothing else changes a record.
/// Its first cache line, time, centre and velocity, is all that the first filter of candidates
/// reads.
struct alignas(64) Record {
  Time time;  ///< of the record
  kernels::Flight flight;
  Time renewal;                     ///< when the record is made anew to stay precise
  std::uint32_t serial = 0;         ///< counts the records of this needle
  std::vector<TouchEntry> touches;  ///< the partner just hit first; almost always that or nothing
};

static_assert(sizeof(Record) == 192);

/// All needles. Contacts are pure functions of two records and a shift, made here.
struct Gas {
  LargeArray<Record> records;
  std::vector<std::uint32_t> ids;
  LargeArray<Shift> images;  ///< boxes that the recorded centre has been wrapped by
  Clock clock;
  std::array<double, 3> box{};
  double k = 6;

  std::size_t size() const { return records.size(); }
  /// Needles per L^3.
  double density() const { return static_cast<double>(size()) / (box[0] * box[1] * box[2]); }

  /// |f| that rounding two records can explain, with room for what a train of bounces adds up. [L]
  double touch_tolerance() const { return 0x1p-44 * (1 + ((box[0] + box[1]) + box[2])); }

  /// The later of two records' times: where the pair's own time starts.
  static Time start_of(const Record& a, const Record& b) { return std::max(a.time, b.time); }
};

/// The pair of two records. Needle a has the lower id; `shift` is added to b's centre.
kernels::Pair make_pair(const Gas& gas, Needle a, const Record& record_a, Needle b,
                        const Record& record_b, const Shift& shift);

/// Time after which a record is made anew: 2^10 needle lengths or radians of flight.
Time renewal_time(const Clock& clock, const Record& record);

/// A coordinate in [0, box), and the boxes taken off for that, as far as they can be counted.
struct Wrapped {
  double place;
  std::int32_t boxes;
};
Wrapped wrap(double x, double box);
/// Their sum, or the last number there is.
std::int32_t add_boxes(std::int32_t a, std::int32_t b);

/// Makes the record of needle i anew at `now` from its free flight (or from `director`), with new
/// velocities: centre wrapped into the box, director normalised, w made normal to it, touches
/// cleared. Returns the boxes by which the centre was wrapped.
Shift renew_record(Gas& gas, Needle i, Time now, const Vec3d& director, const Vec3d& velocity,
                   const Vec3d& angular_velocity);

}  // namespace needlework
