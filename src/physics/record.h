// A needle's record: its state at its own last collision or renewal, and the needles it touches.
#pragma once

#include <cstdint>
#include <mutex>
#include <unordered_map>
#include <vector>

#include "kernels/contact_function.h"
#include "src/box/box.h"
#include "src/physics/body.h"
#include "src/physics/clock.h"
#include "src/physics/ids.h"

namespace needlework {

/// What two needles that touch have done.
enum class TouchKind : std::uint8_t {
  near,       ///< nothing: rounding cannot tell their contact function from 0
  collision,  ///< collided
  bond,       ///< come into contact, in which they slide on each other (slides.h)
};

/// A needle that this one touches to within rounding, and the side on which it is. The entry is
/// valid for one record of the partner only; it no longer applies once that record has been
/// replaced.
struct RecordedTouch {
  Id partner;
  std::uint32_t partner_serial = 0;
  std::array<std::int16_t, 3> shift{};  ///< boxes added to the partner's recorded centre
  std::int8_t side = 0;  ///< sign of the contact function just after the touch; just before it, of
                         ///< a bond
  TouchKind kind = TouchKind::near;
  double gap = 0;  ///< value of the contact function [L]; of a bond, by how much the needle may
                   ///< become faster than its flight [L / time]

  static RecordedTouch of(Id partner, std::uint32_t serial, const Shift& shift,
                          const kernels::Touch& touch) {
    // A record is renewed after at most 2^11 lengths of flight, so a shift fits 16 bits.
    return {partner,
            serial,
            {static_cast<std::int16_t>(shift[0]), static_cast<std::int16_t>(shift[1]),
             static_cast<std::int16_t>(shift[2])},
            static_cast<std::int8_t>(touch.side),
            touch.collided ? TouchKind::collision : TouchKind::near,
            touch.gap};
  }
  static RecordedTouch bond(Id partner, std::uint32_t serial, const Shift& shift, int side,
                            double faster) {
    RecordedTouch out = of(partner, serial, shift, {.touching = true, .side = side, .gap = faster});
    out.kind = TouchKind::bond;
    return out;
  }
  bool is_with(Id other, std::uint32_t other_serial, const Shift& other_shift) const {
    // Where rows slide, numbers along x are of any size, and their last 16 bits tell images apart.
    return partner == other && partner_serial == other_serial &&
           shift[0] == static_cast<std::int16_t>(other_shift[0]) && shift[1] == other_shift[1] &&
           shift[2] == other_shift[2];
  }
  kernels::Touch touch() const {
    return {.touching = true, .collided = kind != TouchKind::near, .side = side, .gap = gap};
  }
};

static_assert(sizeof(RecordedTouch) == 24);

/// The state of a needle at its own last collision or renewal, or when a caller has set its
/// velocities. Until the next of these only touches are added to it. The filter of the scalar
/// searches reads only the first cache line, with time, centre and velocity.
struct alignas(64) Record {
  Time time;  ///< at which the record was made
  kernels::Flight flight;
  Time renewal;                   ///< time at which the record is renewed to keep its precision
  std::uint32_t serial = 0;       ///< number of records of this needle so far
  std::uint16_t touch_count = 0;  ///< the first touch is below, others are in Gas::further_touches
  SpeciesIndex species = 0;
  RecordedTouch first_touch;  ///< the touch with the partner of the last collision, if there is one

  /// Whether it slides on the partner of its first touch, as it was when the record was made.
  bool is_sliding() const { return touch_count > 0 && first_touch.kind == TouchKind::bond; }
};

static_assert(sizeof(Record) == 192);

/// The touches of a record after its first, which is in the record itself. Records with more than
/// one are rare: several needles pass through one point, or lie along each other. Touches are
/// stored by id and serial number of the record, so that they also apply to copies of a record and
/// to records that are put back. Any number of threads may use it at once.
class FurtherTouches {
 public:
  /// Appends a touch to those of a record, `before` of which are already stored here.
  void add(Id owner, std::uint32_t serial, std::size_t before, const RecordedTouch& touch);
  /// The touches of a record that are stored here.
  std::vector<RecordedTouch> of(Id owner, std::uint32_t serial) const;

  std::size_t records() const;
  /// Removes all entries but those of these records. No other thread may use the object meanwhile.
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
