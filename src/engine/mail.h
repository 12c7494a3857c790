// Messages between threads about changed events, and how threads detect that no event is left to
// process.
#pragma once

#include <atomic>
#include <mutex>
#include <vector>

#include "src/calendar/event.h"
#include "src/engine/backoff.h"

namespace needlework {

/// A mailbox for each thread: needles whose events other threads have changed. A thread without
/// events left rests until mail arrives. When all threads rest, no mail is on its way.
class Mail {
 public:
  explicit Mail(std::size_t threads) : boxes_(threads) {}

  /// Starts a new phase with empty mailboxes.
  void begin() {
    resting_ = 0;
    finished_ = false;
    for (Box& box : boxes_) {
      box.needles.clear();
      box.has_some = box.resting = false;
    }
  }

  void send(std::size_t thread, Needle needle) {
    Box& box = boxes_[thread];
    const std::lock_guard alone(meeting_);
    box.needles.push_back(needle);
    box.has_some.store(true, std::memory_order_release);
    if (box.resting) {
      box.resting = false;
      --resting_;
    }
  }
  bool has_some(std::size_t thread) const {
    return boxes_[thread].has_some.load(std::memory_order_acquire);
  }
  std::vector<Needle> take(std::size_t thread) {
    Box& box = boxes_[thread];
    std::vector<Needle> needles;
    const std::lock_guard alone(meeting_);
    needles.swap(box.needles);
    box.has_some.store(false, std::memory_order_relaxed);
    return needles;
  }

  /// Waits for mail. For a thread without events left, which can get new ones only by mail.
  /// Returns false when there is mail, and true when all threads rest or `given_up` is set.
  bool rest(std::size_t thread, const std::atomic<bool>& given_up, Backoff backoff) {
    {
      const std::lock_guard alone(meeting_);
      if (!boxes_[thread].needles.empty()) return false;
      boxes_[thread].resting = true;
      if (++resting_ == boxes_.size()) finished_ = true;
    }
    for (; !finished_.load() && !given_up.load(); backoff.wait()) {
      if (has_some(thread)) return false;
    }
    return true;
  }

 private:
  struct alignas(128) Box {
    std::atomic<bool> has_some = false;
    std::vector<Needle> needles;
    bool resting = false;
  };

  std::vector<Box> boxes_;
  alignas(128) std::mutex meeting_;  ///< protects the needles and resting states of all boxes
  std::size_t resting_ = 0;
  alignas(128) std::atomic<bool> finished_ = false;
};

}  // namespace needlework
