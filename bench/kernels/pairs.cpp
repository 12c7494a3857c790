// Kernels of one pair in double, and in double-double where double cannot decide. Names are
// KERNEL/GAS, items are pairs whose bounding spheres meet within the time ahead.
#include <benchmark/benchmark.h>

#include <stdexcept>
#include <string>

#include "bench/kernels/neighbourhood.h"
#include "bench/kernels/pair_clock.h"
#include "kernels/bounding_spheres.h"
#include "kernels/closest_approach.h"
#include "kernels/first_contact.h"

namespace needlework::bench {
namespace {

constexpr std::size_t pair_count = 4096;

/// Calls apply(pair, n) for one pair after the other.
template <class Apply>
void for_pairs(benchmark::State& state, const std::vector<NearPair>& pairs, Apply&& apply) {
  if (pairs.size() != pair_count) throw std::logic_error("expected as many pairs as asked for");
  std::size_t n = 0;
  const PairClock clock;
  for (auto _ : state) {
    benchmark::DoNotOptimize(apply(pairs[n], n));
    n = n + 1 < pairs.size() ? n + 1 : 0;
  }
  clock.count(state, static_cast<double>(state.iterations()));
}

void spheres(benchmark::State& state, double density) {
  const std::vector<NearPair> pairs = near_pairs(density, pair_count);
  const double ahead = time_ahead(density);
  for_pairs(state, pairs, [&](const NearPair& pair, std::size_t) {
    return kernels::spheres_stay_apart(pair.first.r - pair.second.r, pair.first.v - pair.second.v,
                                       1, ahead);
  });
}

void closest_approach(benchmark::State& state, double density) {
  for_pairs(state, near_pairs(density, pair_count), [](const NearPair& pair, std::size_t) {
    const Vec3d x = cross(pair.first.u, pair.second.u);
    return kernels::segment_distance_squared(pair.first.r - pair.second.r, pair.first.u,
                                             pair.second.u, x, dot(x, x),
                                             kernels::half_lengths(0.5, 0.5));
  });
}

template <class T>
void contact_function(benchmark::State& state, double density) {
  const std::vector<NearPair> pairs = near_pairs(density, pair_count);
  std::vector<kernels::Frame<T>> frames;
  for (const NearPair& pair : pairs) {
    frames.push_back(kernels::make_frame<T>(pair.view(), kernels::scale_of(pair.view())));
  }
  const T s(0.5 * time_ahead(density));
  for_pairs(state, pairs, [&](const NearPair&, std::size_t n) {
    return kernels::estimate(frames[n], s, kernels::evaluate(frames[n], s));
  });
}

void first_contact(benchmark::State& state, double density) {
  const std::vector<NearPair> pairs = near_pairs(density, pair_count);
  const double ahead = time_ahead(density);
  kernels::EvaluationCounters counters;
  std::size_t found = 0;
  for_pairs(state, pairs, [&](const NearPair& pair, std::size_t) {
    const kernels::Contact contact = kernels::first_contact(pair.view(), 0, ahead, counters);
    found += contact.found;
    return contact.elapsed.hi;
  });
  const auto done = static_cast<double>(state.iterations());
  state.counters["evaluations_per_pair"] = static_cast<double>(counters.evaluated) / done;
  state.counters["found_share"] = static_cast<double>(found) / done;
}

const bool added = [] {
  const struct {
    const char* name;
    void (*measure)(benchmark::State&, double);
  } all[] = {{"spheres-stay-apart", spheres},
             {"closest-approach", closest_approach},
             {"contact-function-double", contact_function<double>},
             {"contact-function-double-double", contact_function<DoubleDouble>},
             {"first-contact", first_contact}};
  for (const auto& kernel : all) {
    for (const GasName& gas : gases) {
      const std::string name = std::string(kernel.name) + "/" + gas.name;
      benchmark::RegisterBenchmark(name.c_str(), kernel.measure, gas.density);
    }
  }
  return true;
}();

}  // namespace
}  // namespace needlework::bench
