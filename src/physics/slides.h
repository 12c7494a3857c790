// Needles that slide on each other: what holds them is a step of the motion in contact, which both
// records refer to.
//
// A record of a needle in contact begins with a step (kernels/sliding_motion.h). Its first touch is
// the bond with the partner. Its flight is what the needle would do if nothing pressed; until the
// end of the step the needle departs from that by no more than Body::departure, which is all that
// searches and threads have to know. A step is made from both records alone.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <unordered_map>

#include "kernels/sliding_motion.h"
#include "kernels/trajectory_contact.h"
#include "src/physics/record.h"

namespace needlework {

struct Gas;
class Archive;

/// A step of two needles in contact, the first of which has the lower id.
struct Slide {
  kernels::SlidingStep step;
  kernels::SlidingStep::Most most;  ///< of the step
  Vec3d apart;                      ///< r1 - r2 of the records, less the shift [L]
  Vec3d drift;                      ///< velocity of the centre of mass at the beginning [L / time]
  double share[2]{};   ///< of the mass, that of the other needle: what its needle takes of r
  int side = 0;        ///< sign of f before the contact
  double faster[2]{};  ///< |v| of each needle grows by no more than this [L / time]

  /// Needle 0 or 1, `elapsed` after its record, which is this.
  kernels::BodyState at(int needle, const kernels::Flight& record, const Vec3d& gravity,
                        double elapsed) const;
};

/// Share of a needle's length by which any point of it may depart from the flight of its record.
inline constexpr double most_departure = 0x1p-5;

/// The step that begins with the records of two needles, which were made at one time. The first has
/// the lower id, and `shift` is added to the second one's centre. Its end is the end of the
/// contact, or before.
Slide make_slide(const Gas& gas, Needle first, Needle second, const Shift& shift, int side);

/// The steps of all records, by id and serial number of the needle with the lower id, so that they
/// also apply to copies of a record and to records that are put back. Any number of threads may use
/// it at once.
class Slides {
 public:
  void put(Id first, std::uint32_t serial, const Slide& slide);
  /// Null if there is none. Valid until keep_only().
  const Slide* find(Id first, std::uint32_t serial) const;
  std::size_t size() const { return slides_.size(); }
  /// Removes all but those of these records. No other thread may use the object meanwhile.
  template <class Records, class Ids>
  void keep_only(const Records& records, const Ids& ids) {
    std::unordered_map<std::uint64_t, std::unique_ptr<Slide>> kept;
    for (std::size_t i = 0; i < records.size(); ++i) {
      if (!records[i].is_sliding()) continue;
      if (auto node = slides_.extract(key_of(ids[i], records[i]))) kept.insert(std::move(node));
    }
    slides_ = std::move(kept);
  }
  /// That of a sliding needle's record.
  const Slide* of(Id id, const Record& record) const {
    const std::uint64_t key = key_of(id, record);
    return find({static_cast<std::uint32_t>(key >> 32)}, static_cast<std::uint32_t>(key));
  }

 private:
  static std::uint64_t key_of(Id id, std::uint32_t serial) {
    return std::uint64_t{id.value} << 32 | serial;
  }
  static std::uint64_t key_of(Id id, const Record& record) {
    const RecordedTouch& touch = record.first_touch;
    return id < touch.partner ? key_of(id, record.serial)
                              : key_of(touch.partner, touch.partner_serial);
  }

  mutable std::mutex mutex_;
  std::unordered_map<std::uint64_t, std::unique_ptr<Slide>> slides_;
};

/// The trajectory of a needle from a later time on, whether or not it slides.
class NeedleTrajectory final : public kernels::Trajectory {
 public:
  /// `slide` is null for a needle in free flight. From `delay` after its record on.
  NeedleTrajectory(const Gas& gas, Id id, const Record& record, const Slide* slide, double delay);
  kernels::BodyState at(double s) const override;

 private:
  const Gas& gas_;
  const Record& record_;
  const Slide* slide_;
  int index_;
  double delay_;
};

/// Saves or restores the step of a record.
void transfer(Archive& archive, Slide& slide);

}  // namespace needlework
