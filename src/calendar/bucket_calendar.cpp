#include "src/calendar/bucket_calendar.h"

#include <algorithm>
#include <bit>
#include <limits>

namespace needlework {
namespace {

// Measured: 4 to 16 events per bucket cost the same; fewer need more cache lines.
constexpr double wanted_per_bucket = 8;
// A heap of this size or less need not be made smaller.
constexpr std::size_t large_heap = 128;
// Number of present events for each bucket. The buckets then extend a few times as far as the
// average event.
constexpr std::size_t events_per_bucket = 2;

}  // namespace

BucketCalendar::BucketCalendar(std::size_t n, const Clock& clock, std::size_t)
    : events_(n, clock), never_(events_.key_of(Time::never())), keys_(n, never_), heap_(n) {
  keep_all_in_heap();
}

void BucketCalendar::set(const Event& event, CellIndex) {
  const Needle i = event.owner;
  keys_[i] = events_.put(event);
  const Number number = number_of(keys_[i]);
  if (number <= present_) {
    enter(i);
  } else {
    if (heap_.contains(i)) heap_.erase(i, events_);
    file(i, number);
  }
  ++since_restart_;
  // Either happens after at least n calls of set, so that its cost is O(1) per call.
  const bool crowded = heap_.size() > large_heap && since_restart_ >= events_.size();
  if (crowded || filed_ + far_.size() > 4 * events_.size() + 64) restart();
  while (heap_.empty()) advance();
}

// Increases with time, so that events in different buckets are in order.
BucketCalendar::Number BucketCalendar::number_of(TimeKey key) const {
  const double number = (EventTable::time_of(key) - origin_) * per_width_;
  if (!(number < static_cast<double>(last_number))) return last_number;
  return number > 0 ? static_cast<Number>(number) : 0;
}

void BucketCalendar::enter(Needle i) {
  entered_ += !heap_.contains(i);
  heap_.set(i, keys_[i], events_);
}

// For an entry whose event may have been replaced, or which may occur twice.
void BucketCalendar::enter_if_due(Needle i) {
  if (number_of(keys_[i]) > present_ || heap_.contains(i)) return;
  events_.prefetch(i);
  enter(i);
}

void BucketCalendar::file(Needle i, Number number) {
  if (number > present_ + static_cast<Number>(mask_)) {
    // Events that never happen are not stored. Neither are events in the last 256 of the 2^62
    // epochs, which have the same key.
    if (keys_[i] != never_) far_.push_back(i);
    return;
  }
  ++filed_;
  Chunk* chunk = &bucket(number);
  if (chunk->count == Chunk::capacity) {
    // The full first chunk is moved behind an empty one, which becomes the first.
    std::uint32_t behind = free_;
    if (behind == none) {
      behind = static_cast<std::uint32_t>(chunks_.size());
      chunks_.emplace_back();
      chunk = &bucket(number);
    } else {
      free_ = chunks_[behind].next;
    }
    chunks_[behind] = *chunk;
    chunk->count = 0;
    chunk->next = behind;
  }
  chunk->needle[chunk->count++] = i;
}

// Goes on to the next bucket.
void BucketCalendar::advance() {
  if (filed_ == 0) {
    std::vector<Needle> left;
    left.swap(far_);
    distribute(left);
    return;
  }
  ++present_;
  if ((static_cast<std::size_t>(present_) & mask_) == 0 && !begin_turn()) return;
  empty_bucket(bucket(present_));
}

void BucketCalendar::empty_bucket(Chunk& first) {
  for (Chunk* chunk = &first;;) {
    for (std::uint32_t n = 0; n < chunk->count; ++n) enter_if_due(chunk->needle[n]);
    filed_ -= chunk->count;
    chunk->count = 0;
    const std::uint32_t next = chunk->next;
    if (chunk != &first) {
      chunk->next = free_;
      free_ = static_cast<std::uint32_t>(chunk - chunks_.data());
    } else {
      chunk->next = none;
    }
    if (next == none) return;
    chunk = &chunks_[next];
  }
}

// Returns whether the buckets have stayed the same.
bool BucketCalendar::begin_turn() {
  const double per_bucket = static_cast<double>(entered_) / static_cast<double>(mask_ + 1);
  entered_ = 0;
  if (per_bucket > 4 * wanted_per_bucket || per_bucket < wanted_per_bucket / 4) {
    restart();
    return false;
  }
  std::vector<Needle> far;
  far.swap(far_);
  for (const Needle i : far) {
    const Number number = number_of(keys_[i]);
    if (number <= present_) {
      enter_if_due(i);
    } else {
      file(i, number);
    }
  }
  return true;
}

// Puts all events into new buckets. O(n).
void BucketCalendar::restart() {
  ++restarts_;
  heap_.clear();
  chunks_.clear();
  free_ = none;
  filed_ = 0;
  far_.clear();
  std::vector<Needle> needles(events_.size());
  for (Needle i{0}; i < needles.size(); ++i) needles[i] = i;
  distribute(needles);
}

// Chooses origin and width of the buckets for the events of these needles, which are all events
// but some that never happen. Heap, buckets and list must be empty. The width is based on the rate
// of the first eighth of the events, which is the rate at which events will be taken out.
void BucketCalendar::distribute(const std::vector<Needle>& needles) {
  since_restart_ = entered_ = 0;
  std::vector<TimeKey> ahead;
  for (const Needle i : needles) {
    if (keys_[i] != never_) ahead.push_back(keys_[i]);
  }
  if (ahead.empty()) {
    keep_all_in_heap();
    return;
  }
  const std::size_t eighth = (ahead.size() - 1) / 8;
  std::nth_element(ahead.begin(), ahead.begin() + static_cast<std::ptrdiff_t>(eighth), ahead.end());
  const auto first =
      std::min_element(ahead.begin(), ahead.begin() + static_cast<std::ptrdiff_t>(eighth + 1));
  origin_ = EventTable::time_of(*first);
  double width = (EventTable::time_of(ahead[eighth]) - origin_) * wanted_per_bucket /
                 static_cast<double>(eighth + 1);
  if (width == 0)
    width = EventTable::time_of(*std::max_element(ahead.begin(), ahead.end())) - origin_;
  width = std::max(width, events_.clock().resolution());
  per_width_ = std::min(1 / width, std::numeric_limits<double>::max());
  present_ = 0;
  const std::size_t buckets = std::bit_ceil(ahead.size() / events_per_bucket + 2);
  mask_ = buckets - 1;
  free_ = none;
  chunks_.assign(buckets, Chunk{});
  for (const Needle i : needles) {
    const Number number = number_of(keys_[i]);
    if (number <= present_) {
      enter(i);
    } else {
      file(i, number);
    }
  }
  entered_ = 0;
}

// For the beginning, when no event ever happens. All events then count as in the present bucket,
// until the heap becomes large and causes a restart.
void BucketCalendar::keep_all_in_heap() {
  present_ = last_number;
  per_width_ = 0;
  since_restart_ = 0;
  for (Needle i{0}; i < events_.size(); ++i) heap_.set(i, keys_[i], events_);
}

}  // namespace needlework
