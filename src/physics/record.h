// A needle's record: what it carries since its own last collision.
#pragma once

#include <cstdint>
#include <mutex>
#include <unordered_map>
#include <vector>

#include "kernels/contact_function.h"
#include "src/physics/clock.h"
#include "src/physics/ids.h"
#include "src/physics/species.h"

namespace needlework {

/// A needle that this one touches to within rounding, and the side on which it stands. Valid for
/// one record of the partner only: once that has been replaced, this entry no longer applies.
struct RecordedTouch {
  Id partner;
  std::uint32_t partner_serial = 0;
  std::array<std::int16_t, 3> shift{};  ///< boxes added to the partner's recorded centre
  std::int8_t side = 0;                 ///< sign of the contact function just afterwards
  bool collided = false;                ///< the touch was a collision
  double gap = 0;                       ///< value of the contact function [L]

  static RecordedTouch of(Id partner, std::uint32_t serial, const Shift& shift,
                          const kernels::Touch& touch) {
    // A record is renewed after 2^11 lengths of flight at most, so a shift fits 16 bits.
    return {partner,
            serial,
            {static_cast<std::int16_t>(shift[0]), static_cast<std::int16_t>(shift[1]),
             static_cast<std::int16_t>(shift[2])},
            static_cast<std::int8_t>(touch.side),
            touch.collided,
            touch.gap};
  }
  bool is_with(Id other, std::uint32_t other_serial, const Shift& other_shift) const {
    return partner == other && partner_serial == other_serial && shift[0] == other_shift[0] &&
           shift[1] == other_shift[1] && shift[2] == other_shift[2];
  }
  kernels::Touch touch() const {
    return {.touching = true, .collided = collided, .side = side, .gap = gap};
  }
};

static_assert(sizeof(RecordedTouch) == 24);

/// State of a needle since its own last collision or renewal. Nothing else changes a record.
/// The first cache line, time, centre and velocity, is all that the first filter of candidates
/// reads.
struct alignas(64) Record {
  Time time;  ///< of the record
  kernels::Flight flight;
  Time renewal;                   ///< when the record is renewed to stay precise
  std::uint32_t serial = 0;       ///< counts the records of this needle
  std::uint16_t touch_count = 0;  ///< the first is below, others in Gas::further_touches
  SpeciesIndex species = 0;
  RecordedTouch first_touch;  ///< that with the partner just hit, if there is one
};

static_assert(sizeof(Record) == 192);

/// Touches of records that have more than one, which are rare: several needles through one point,
/// or lying along each other. Kept by id and serial number of the record, so that copies of a
/// record and records put back find theirs. Any number of threads may use it at once.
class FurtherTouches {
 public:
  /// Appends a touch to those of a record, `before` of which are here already.
  void add(Id owner, std::uint32_t serial, std::size_t before, const RecordedTouch& touch);
  /// Those of a record.
  std::vector<RecordedTouch> of(Id owner, std::uint32_t serial) const;

  std::size_t records() const;
  /// Forgets all but those of these records. No other thread may use it meanwhile.
  template <class Records, class Ids>
  void keep_only(const Records& records, const Ids& ids) {
    std::unordered_map<std::uint64_t, std::vector<RecordedTouch>> kept;
    for (std::size_t i = 0; i < records.size(); ++i) {
      if (records[i].touch_count < 2) continue;
      if (auto node = touches_.extract(key_of(ids[i], records[i].serial))) {
        kept.insert(std::move(node));
      }
    }
    touches_ = std::move(kept);
  }

 private:
  static std::uint64_t key_of(Id owner, std::uint32_t serial) {
    return std::uint64_t{owner.value} << 32 | serial;
  }

  mutable std::mutex mutex_;
  std::unordered_map<std::uint64_t, std::vector<RecordedTouch>> touches_;
};

}  // namespace needlework
