// A log of what a thread has replaced since the threads last met, so that it can be restored.
#pragma once

#include <cstddef>
#include <vector>

#include "src/physics/gas.h"

namespace needlework {

/// Holds the records that needles had when the phase began. Records made in the phase are told by
/// their time, and need not be kept.
class RollbackLog {
 public:
  /// Takes room for the records of a long phase at once: to move a log as it grows costs a thread
  /// more than to write it. Memory that is never used is never touched.
  RollbackLog() { entries_.reserve(std::size_t{1} << 15); }

  /// Starts a new phase, whose events are not before this time.
  void begin(Time time) {
    start_ = time;
    used_ = 0;
    scheduled_.clear();
  }
  /// To be called before the record of needle i is replaced.
  void replaced(Needle i, const Record& record, const Shift& image, Time last_collision) {
    if (is_of_phase(record)) return;
    if (used_ == entries_.size()) entries_.emplace_back();
    Entry& entry = entries_[used_++];
    entry.needle = i;
    entry.record = record;
    entry.image = image;
    entry.last_collision = last_collision;
    scheduled_.push_back(i);
  }
  /// To be called before the event of needle i, which has this record, is replaced.
  void scheduled(Needle i, const Record& record) {
    if (!is_of_phase(record)) scheduled_.push_back(i);
  }

  std::size_t entries() const { return used_; }
  /// Needles whose event has been replaced; a needle may occur several times.
  const std::vector<Needle>& scheduled() const { return scheduled_; }

  /// Restores the records that are older than the present ones. After this has been done for the
  /// logs of all threads, the oldest records are in place. `last_collision` may be empty.
  void put_back(Gas& gas, std::vector<Time>& last_collision) {
    for (std::size_t n = 0; n < used_; ++n) {
      Entry& entry = entries_[n];
      Record& record = gas.records[entry.needle];
      if (!is_older(entry.record, record)) continue;
      std::swap(record, entry.record);
      gas.images[entry.needle] = entry.image;
      if (!last_collision.empty()) last_collision[entry.needle] = entry.last_collision;
    }
  }

 private:
  // If so, the needle is in the log of the thread that made the record.
  bool is_of_phase(const Record& record) const { return record.time > start_; }
  // Serial numbers are modulo 2^32; both belong to one phase, in which they differ by far less.
  static bool is_older(const Record& a, const Record& b) {
    return static_cast<std::int32_t>(b.serial - a.serial) > 0;
  }

  struct Entry {
    Needle needle;
    Record record;
    Shift image{};
    Time last_collision;
  };
  Time start_;
  std::vector<Entry> entries_;
  std::size_t used_ = 0;
  std::vector<Needle> scheduled_;
};

}  // namespace needlework
