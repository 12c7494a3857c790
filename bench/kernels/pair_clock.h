// Time per pair, in units that are printed as they are: Google Benchmark writes "s" or "/s" behind
// every counter that it divides by the time.
#pragma once

#include <benchmark/benchmark.h>

#include <cstdint>
#include <ctime>

namespace needlework::bench {

/// Made right before the loop of a benchmark, which must not pause; counts right after it.
class PairClock {
 public:
  void count(benchmark::State& state, double pairs) const {
    const double seconds = now() - start_;
    state.SetItemsProcessed(static_cast<std::int64_t>(pairs));
    state.counters["ns_per_pair"] = 1e9 * seconds / pairs;
    state.counters["pairs_per_cycle"] =
        pairs / (seconds * benchmark::CPUInfo::Get().cycles_per_second);
  }

 private:
  static double now() {
    std::timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  }

  double start_ = now();
};

}  // namespace needlework::bench
