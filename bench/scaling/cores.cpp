// How far two cores are apart: the time in which a cache line that one has written reaches the
// other. On a virtual machine it changes when the host moves the cores.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <thread>

namespace needlework::bench {
namespace {

/// Two threads write the same line in turn. Each yields its core now and then, as it may be the
/// only one. Of some stretches of turns the median of the later half counts: the system may let
/// both threads begin on one core.
void cache_line(benchmark::State& state) {
  constexpr int stretches = 20, turns = 10000;
  alignas(128) std::atomic<int> turn;
  const auto wait_for = [&](int mine) {
    for (int spins = 1; turn.load(std::memory_order_acquire) != mine; ++spins) {
      if (spins % 1000 == 0) std::this_thread::yield();
    }
  };
  const auto take_turns = [&](int first, int end) {
    for (int mine = first; mine < end; mine += 2) {
      wait_for(mine);
      turn.store(mine + 1, std::memory_order_release);
    }
  };
  for (auto _ : state) {
    turn = 0;
    std::thread other(take_turns, 1, stretches * turns);
    std::array<double, stretches> times;
    for (int n = 0; n < stretches; ++n) {
      const auto begin = std::chrono::steady_clock::now();
      take_turns(n * turns, (n + 1) * turns);
      wait_for((n + 1) * turns);
      const std::chrono::duration<double> time = std::chrono::steady_clock::now() - begin;
      times[n] = time.count() / turns;
    }
    other.join();
    const auto later = times.begin() + stretches / 2, median = later + stretches / 4;
    std::nth_element(later, median, times.end());
    state.SetIterationTime(*median);
  }
}
BENCHMARK(cache_line)->Name("cache-line")->UseManualTime()->Iterations(1);

}  // namespace
}  // namespace needlework::bench
