// Records that were replaced at one instant: what settles on which side of each other needles
// stand that touched just then.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "src/physics/gas.h"

namespace needlework {

/// One or two records after an event; all of them after velocities have been replaced by a caller.
class ReplacedRecords {
 public:
  struct Entry {
    Needle needle;
    Record record;  ///< as it was before
    Shift wraps{};  ///< boxes by which the new record's centre was wrapped
  };

  bool empty() const { return entries_.empty(); }
  void clear() { entries_.clear(); }
  /// More than two have to be added by ascending needle.
  Entry& add(Needle i, const Record& record) {
    entries_.push_back({i, record, {}});
    return entries_.back();
  }
  /// The entry of needle i, or null.
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
