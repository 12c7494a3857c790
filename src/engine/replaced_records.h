// The previous state of records that were replaced at one instant. It determines on which side of
// each other two needles are that touched at that instant.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "src/physics/gas.h"

namespace needlework {

/// Holds one or two records after an event, or all of them after a caller has replaced velocities.
class ReplacedRecords {
 public:
  struct Entry {
    Needle needle;
    Record record;  ///< the record before it was replaced
    Shift wraps{};  ///< number of boxes by which the new record's centre was wrapped
  };

  auto begin() const { return entries_.begin(); }
  auto end() const { return entries_.end(); }
  bool empty() const { return entries_.empty(); }
  void clear() { entries_.clear(); }
  /// If more than two are added, needles must be in ascending order.
  Entry& add(Needle i, const Record& record) {
    entries_.push_back({i, record, {}});
    return entries_.back();
  }
  /// The entry of needle i, or null if there is none.
  const Entry* find(Needle i) const {
    if (entries_.size() <= 2) {
      for (const Entry& entry : entries_) {
        if (entry.needle == i) return &entry;
      }
      return nullptr;
    }
    const auto found =
        std::lower_bound(entries_.begin(), entries_.end(), i,
                         [](const Entry& entry, Needle j) { return entry.needle < j; });
    return found != entries_.end() && found->needle == i ? &*found : nullptr;
  }

 private:
  std::vector<Entry> entries_;
};

}  // namespace needlework
