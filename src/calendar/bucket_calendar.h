// A calendar as a bounded increasing priority queue: events are kept unsorted in buckets of time,
// and only the events of the present bucket are in a heap.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "src/calendar/calendar.h"
#include "src/calendar/event_table.h"
#include "src/calendar/needle_heap.h"

namespace needlework {

/// G. Paul, A complexity O(1) priority queue for event driven molecular dynamics simulations, J.
/// Comput. Phys. 221, 615 (2007), with two changes. A replaced event stays in its bucket until
/// that bucket becomes the present one; it is then recognised because its needle's present event
/// has another time. The width of the buckets adapts to the events.
///
/// The number of buckets is a power of two, and they are used in turn. Events beyond the last
/// bucket are kept in a list, which is searched once in each round of the buckets. Events that
/// never happen are not stored unless there are no others. The width is computed again from the
/// present events in three cases: a round had far more or fewer events than the buckets are meant
/// for, the heap has become large, or all events lie beyond the last bucket. So it follows any
/// change of the time scale.
///
/// `set` is O(1) amortised, `top` O(1). 140 to 240 bytes per needle.
class BucketCalendar {
 public:
  static constexpr const char* name = "bucket";
  static constexpr bool by_cell = false;

  BucketCalendar(std::size_t n, const Clock& clock, std::size_t);

  bool empty() const { return events_.size() == 0; }
  const Event& top() const { return events_[heap_.top()]; }
  const Event& of(Needle i) const { return events_[i]; }
  Needle likely_next() const { return heap_.top(); }
  void set(const Event& event, CellIndex);

  /// Number of events in heap, buckets and list, replaced ones included.
  std::size_t entries() const { return heap_.size() + filed_ + far_.size(); }
  /// How often all events have been put into new buckets.
  std::uint64_t restarts() const { return restarts_; }

 private:
  using Number = std::int64_t;  ///< of a bucket, counted from the origin
  static constexpr Number last_number = std::int64_t{1} << 62;
  static constexpr std::uint32_t none = 0;  ///< no further chunk: chunk 0 is always the first of a
                                            ///< bucket

  // A cache line with needles of one bucket. The first chunk of each bucket comes first in memory,
  // further chunks follow.
  struct alignas(64) Chunk {
    static constexpr std::uint32_t capacity = 14;
    std::array<Needle, capacity> needle;
    std::uint32_t count = 0;
    std::uint32_t next = none;
  };

  Number number_of(TimeKey key) const;
  Chunk& bucket(Number number) { return chunks_[static_cast<std::size_t>(number) & mask_]; }
  void file(Needle i, Number number);
  void enter(Needle i);
  void enter_if_due(Needle i);
  void advance();
  void empty_bucket(Chunk& chunk);
  bool begin_turn();
  void restart();
  void distribute(const std::vector<Needle>& needles);
  void keep_all_in_heap();

  EventTable events_;
  TimeKey never_;
  std::vector<TimeKey> keys_;  ///< of all needles, so that buckets can be emptied without reading
                               ///< events
  NeedleHeap heap_;            ///< needles whose event lies before the end of the present bucket
  std::vector<Chunk> chunks_;  ///< the first chunk of each bucket, then further chunks
  std::uint32_t free_ = none;  ///< first unused one of the further chunks
  std::vector<Needle> far_;    ///< needles with events beyond the last bucket
  std::size_t mask_ = 0;       ///< number of buckets - 1
  std::size_t filed_ = 0;      ///< entries in buckets
  Number present_ = last_number;
  double origin_ = 0;                ///< where bucket 0 begins [time]
  double per_width_ = 0;             ///< 1 / width of a bucket [1 / time]
  std::uint64_t entered_ = 0;        ///< events that have entered the heap in this round
  std::uint64_t since_restart_ = 0;  ///< events put since the last restart
  std::uint64_t restarts_ = 0;
};

}  // namespace needlework
