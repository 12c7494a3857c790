// How a thread waits for another one, and how the time of waiting is counted.
#pragma once

#include <chrono>
#include <cstdint>
#include <thread>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace needlework {

/// Spins for a while, then yields the core, which the other thread may need.
class Backoff {
 public:
  explicit Backoff(int spins) : spins_(spins) {}

  /// Returns whether the core was yielded.
  bool wait() {
    if (++turns_ > spins_) {
      std::this_thread::yield();
      return true;
    }
#if defined(__x86_64__)
    _mm_pause();
#endif
    return false;
  }
  void reset() { turns_ = 0; }

 private:
  int spins_;
  int turns_ = 0;
};

/// Counts how often a thread is blocked, and for how long.
class BlockedTime {
 public:
  void begin() {
    if (!blocked_) since_ = SteadyClock::now();
    blocked_ = true;
  }
  void end(std::uint64_t& count, std::uint64_t& nanoseconds) {
    if (!blocked_) return;
    blocked_ = false;
    ++count;
    const SteadyClock::duration time = SteadyClock::now() - since_;
    total_ += time;
    const auto whole = std::chrono::duration_cast<std::chrono::nanoseconds>(time);
    nanoseconds += static_cast<std::uint64_t>(whole.count());
  }
  /// Whether the thread, which is blocked, has been so for longer than `least` in all, and for most
  /// of the time since this object was made.
  bool is_most(std::chrono::milliseconds least) const {
    const SteadyClock::time_point now = SteadyClock::now();
    const SteadyClock::duration blocked = total_ + (now - since_);
    return blocked > least && 2 * blocked > now - made_;
  }

 private:
  using SteadyClock = std::chrono::steady_clock;

  bool blocked_ = false;
  SteadyClock::time_point made_ = SteadyClock::now(), since_;
  SteadyClock::duration total_{};
};

/// Called before a thread reads or publishes progress. Does nothing in a normal build. In a build
/// with NEEDLEWORK_RANDOM_YIELDS it delays the thread at random by some microseconds, or yields
/// the core, to produce orders of execution that are otherwise very rare.
inline void random_pause() {
#ifdef NEEDLEWORK_RANDOM_YIELDS
  thread_local unsigned state =
      static_cast<unsigned>(reinterpret_cast<std::uintptr_t>(&state) >> 4);
  state = state * 1664525u + 1013904223u;
  const unsigned drawn = state >> 22;
  if (drawn < 64) std::this_thread::yield();
  if (drawn >= 1016) {
    Backoff backoff(4096);
    for (unsigned turns = (state >> 10) % 4096; turns > 0; --turns) backoff.wait();
  }
#endif
}

}  // namespace needlework
