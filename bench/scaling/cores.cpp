// How far two cores are apart: the time in which a cache line that one has written reaches the other.
// On a virtual machine it changes when the host moves the cores.
#include <benchmark/benchmark.h>

#include <atomic>
#include <chrono>
#include <thread>

namespace needlework::bench {
namespace {

/// Two threads write the same line in turn. Each yields its core now and then, as it may be the
/// only one.
void cache_line(benchmark::State& state) {
  constexpr int turns = 100000;
  alignas(128) std::atomic<int> turn;
  const auto wait_for = [&](int mine) {
    for (int spins = 1; turn.load(std::memory_order_acquire) != mine; ++spins) {
      if (spins % 1000 == 0) std::this_thread::yield();
    }
  };
  const auto take_turns = [&](int first) {
    for (int mine = first; mine < turns; mine += 2) {
      wait_for(mine);
      turn.store(mine + 1, std::memory_order_release);
    }
  };
  for (auto _ : state) {
    turn = -1;
    std::thread other([&] {
      turn = 0;  // it has begun
      take_turns(1);
    });
    wait_for(0);
    const auto begin = std::chrono::steady_clock::now();
    take_turns(0);
    wait_for(turns);
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - begin;
    other.join();
    state.SetIterationTime(time.count() / turns);
  }
}
BENCHMARK(cache_line)->Name("cache-line")->UseManualTime()->Iterations(3);

}  // namespace
}  // namespace needlework::bench
