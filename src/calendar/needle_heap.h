// A 4-ary heap of needles that records where each needle is, so that any can be moved or removed.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "src/calendar/event_table.h"

namespace needlework {

/// Holds some of the needles 0 to n - 1, with the earliest event on top. Keys are stored with the
/// needles, four siblings in a cache line. Events are read only if keys are equal.
///
/// All changes are given the table of events, which must already hold the new event of the needle.
/// Each change is O(log size). 4 bytes per needle, and 16 for each needle in the heap.
class NeedleHeap {
 public:
  explicit NeedleHeap(std::size_t n) : place_(n, absent) {}

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  /// The needle with the earliest event. The heap must not be empty.
  Needle top() const { return at(root).needle; }
  bool contains(Needle i) const { return place_[i] != absent; }

  /// Inserts a needle, or moves it to its new position.
  void set(Needle i, TimeKey key, const EventTable& events) {
    const Entry entry{key, i};
    std::uint32_t hole = place_[i];
    if (hole == absent) {
      hole = root + static_cast<std::uint32_t>(size_++);
      if (hole / arity >= families_.size()) families_.emplace_back();
    }
    sift(hole, entry, events);
  }

  /// Removes a needle that is in the heap.
  void erase(Needle i, const EventTable& events) {
    const std::uint32_t hole = place_[i];
    place_[i] = absent;
    const std::uint32_t last = root + static_cast<std::uint32_t>(--size_);
    const Entry moved = at(last);
    at(last) = Entry{};
    if (hole != last) sift(hole, moved, events);
  }

  /// Removes all needles. O(size).
  void clear() {
    for (std::uint32_t at_place = root; at_place < root + size_; ++at_place) {
      place_[at(at_place).needle] = absent;
      at(at_place) = Entry{};
    }
    size_ = 0;
  }

 private:
  static constexpr std::uint32_t arity = 4;
  static constexpr std::uint32_t root = 3;  ///< so that siblings share a cache line
  static constexpr std::uint32_t absent = 0;

  // Unused entries have the greatest key, so that all four siblings can always be compared.
  struct Entry {
    TimeKey key = ~TimeKey{0};
    Needle needle = no_needle;
  };
  struct alignas(64) Family {
    std::array<Entry, arity> entry;
  };

  Entry& at(std::uint32_t place) { return families_[place / arity].entry[place % arity]; }
  const Entry& at(std::uint32_t place) const {
    return families_[place / arity].entry[place % arity];
  }
  static std::uint32_t parent_of(std::uint32_t place) { return place / arity + 2; }
  static std::uint32_t first_child_of(std::uint32_t place) { return (place - 2) * arity; }

  static bool before(const Entry& a, const Entry& b, const EventTable& events) {
    if (a.key != b.key) return a.key < b.key;
    return events.before(a.needle, b.needle);
  }

  void put(std::uint32_t place, const Entry& entry) {
    at(place) = entry;
    place_[entry.needle] = place;
  }

  // Moves an entry up or down from a free position to where it belongs.
  void sift(std::uint32_t hole, const Entry& entry, const EventTable& events) {
    const std::uint32_t start = hole;
    while (hole != root && before(entry, at(parent_of(hole)), events)) {
      put(hole, at(parent_of(hole)));
      hole = parent_of(hole);
    }
    while (hole >= start && first_child_of(hole) < root + size_) {
      const std::uint32_t child = first_child_of(hole);
      const std::array<Entry, arity>& family = families_[child / arity].entry;
      std::uint32_t least = 0;
      for (std::uint32_t n = 1; n < arity; ++n) {
        if (before(family[n], family[least], events)) least = n;
      }
      if (!before(family[least], entry, events)) break;
      put(hole, family[least]);
      hole = child + least;
    }
    put(hole, entry);
  }

  std::vector<Family> families_ = std::vector<Family>(1);
  std::size_t size_ = 0;
  std::vector<std::uint32_t> place_;  ///< position of each needle in the heap
};

}  // namespace needlework
