// A log of what a thread has replaced since the threads last met, so that it can be restored.
#pragma once

#include <cstddef>
#include <vector>

#include "src/memory/large_array.h"
#include "src/physics/gas.h"

namespace needlework {

/// Holds the records that needles had when the phase began. Records made in the phase are told by
/// their time, and need not be kept.
class RollbackLog {
 public:
  /// Takes room for the records of a long phase at once: to move a log as it grows costs a thread
  /// more than to write it. Memory that is never used is never touched.
  RollbackLog() {
    constexpr std::size_t many = std::size_t{1} << 15;
    records_.reserve(many);
    places_.reserve(many);
  }

  /// Starts a new phase, whose events are not before this time.
  void begin(Time time) {
    start_ = time;
    records_.clear();
    places_.clear();
    columns_.clear();
    changes_.clear();
    scheduled_.clear();
  }
  /// To be called before the record of needle i is replaced, or its values in columns.
  void replaced(Needle i, const Gas& gas) {
    const Record& record = gas.records[i];
    if (is_of_phase(record)) return;
    scheduled_.push_back(i);
    places_.push_back({i, gas.images[i]});
    if (!gas.columns.empty()) {
      gas.columns.append(i, columns_);
      changes_.push_back(gas.columns.changes(i));
    }
    records_.push_back(record);  // last, as it counts the entries, and memory may run out
  }
  /// To be called before the event of needle i, which has this record, is replaced.
  void scheduled(Needle i, const Record& record) {
    if (!is_of_phase(record)) scheduled_.push_back(i);
  }

  std::size_t entries() const { return records_.size(); }
  /// Needles whose event has been replaced; a needle may occur several times.
  const std::vector<Needle>& scheduled() const { return scheduled_; }

  /// Restores the records that are older than the present ones. After this has been done for the
  /// logs of all threads, the oldest records are in place.
  void put_back(Gas& gas) {
    for (std::size_t n = 0; n < records_.size(); ++n) {
      const Needle i = places_[n].needle;
      Record& record = gas.records[i];
      const bool older = gas.columns.empty() ? is_older(records_[n].serial, record.serial)
                                             : is_older(records_[n].serial + changes_[n],
                                                        record.serial + gas.columns.changes(i));
      if (!older) continue;
      record = records_[n];
      gas.images[i] = places_[n].image;
      if (!gas.columns.empty()) {
        gas.columns.put_back(i, &columns_[n * gas.columns.bytes_per_needle()]);
      }
    }
  }

 private:
  // If so, the needle is in the log of the thread that made the record.
  bool is_of_phase(const Record& record) const { return record.time > start_; }
  // Serial numbers, and sums of them and changes, grow modulo 2^32; both belong to one phase, in
  // which they differ by far less.
  static bool is_older(std::uint32_t a, std::uint32_t b) {
    return static_cast<std::int32_t>(b - a) > 0;
  }

  struct Place {
    Needle needle;
    Shift image;
  };
  Time start_;
  // Apart, as they would be padded to whole cache lines together with a record.
  LargeArray<Record> records_;
  LargeArray<Place> places_;
  std::vector<std::byte> columns_;  ///< rows of Columns::bytes_per_needle()
  std::vector<std::uint32_t> changes_;
  std::vector<Needle> scheduled_;
};

}  // namespace needlework
