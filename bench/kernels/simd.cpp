// SIMD kernels, each on all instruction sets of this CPU; scalar is the twin. Names are
// KERNEL/GAS/ISA, items are pairs of needles (free-flight: needles). The answer is compared with
// the twin's before the clock starts: flights have its bits, filters round differently and may rule
// out a few pairs more or fewer (tests/kernels has the bounds).
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "bench/kernels/neighbourhood.h"
#include "bench/kernels/pair_clock.h"
#include "kernels/free_flight.h"
#include "src/search/choice.h"

namespace needlework::bench {
namespace {

using kernels::Found;
using kernels::Isa;
using kernels::NearKernels;

constexpr std::size_t searches = 256;

void require(bool same, const std::string& kernel, Isa isa) {
  if (same) return;
  throw std::logic_error(kernel + " by " + std::string(kernels::name_of(isa)) +
                         ": expected the result of the scalar twin");
}

/// Of pairs that two filters do not rule out.
void require_similar(std::size_t count, std::size_t of_twin, const std::string& kernel, Isa isa) {
  const std::size_t difference = count > of_twin ? count - of_twin : of_twin - count;
  require(difference <= 2 + of_twin / 100, kernel, isa);
}

/// Room for the needles that a filter finds.
struct FoundBuffer {
  explicit FoundBuffer(std::size_t most)
      : needles(most + kernels::block_size), cells(most + kernels::block_size) {}
  Found view() { return {needles.data(), cells.data()}; }

  std::vector<std::uint32_t> needles, cells;
};

/// A filter over the cells around a needle; `apply` calls it.
template <class Apply>
void filter(benchmark::State& state, const std::string& name, Isa isa, const Neighbourhoods& gas,
            Apply&& apply) {
  FoundBuffer found(gas.most_needles);
  const auto count_by = [&](Isa by) {
    std::size_t count = 0;
    for (const Neighbourhood& one : gas.all) {
      count += apply(kernels::near_kernels(by), one, found.view()).found;
    }
    return count;
  };
  require_similar(count_by(isa), count_by(Isa::scalar), name, isa);
  const NearKernels& chosen = kernels::near_kernels(isa);
  std::size_t n = 0;
  double pairs = 0;
  const PairClock clock;
  for (auto _ : state) {
    const Neighbourhood& one = gas.all[n];
    apply(chosen, one, found.view());
    benchmark::ClobberMemory();
    pairs += static_cast<double>(one.needles);
    n = n + 1 < gas.all.size() ? n + 1 : 0;
  }
  clock.count(state, pairs);
}

void overlapping(benchmark::State& state, Isa isa, double density) {
  const Neighbourhoods gas(density, Neighbourhoods::Columns::directors, searches);
  const auto radius = static_cast<float>(auto_capsule_radius(density));
  filter(state, "overlapping", isa, gas,
         [&](const NearKernels& kernels, const Neighbourhood& one, const Found& found) {
           return kernels.overlapping(gas.around(one), one.seeker, radius, found);
         });
}

void approaching(benchmark::State& state, Isa isa, double density) {
  const Neighbourhoods gas(density, Neighbourhoods::Columns::velocities, searches);
  filter(state, "approaching", isa, gas,
         [&](const NearKernels& kernels, const Neighbourhood& one, const Found& found) {
           return kernels.approaching(gas.around(one), one.seeker, found);
         });
}

/// All needles of a gas, to one time; as many as the engine takes at once.
void free_flight(benchmark::State& state, Isa isa, double density) {
  using C = kernels::FlightColumns;
  constexpr std::size_t count = 64;
  const std::vector<NearPair> pairs = near_pairs(density, count);
  double moved[C::columns][count];
  C columns;
  for (int c = 0; c < C::columns; ++c) columns.column[c] = moved[c];
  for (std::size_t n = 0; n < count; ++n) {
    columns.put(n, pairs[n].first, time_ahead(density));
  }
  kernels::fly(isa, columns, count);
  for (std::size_t n = 0; n < count; ++n) {
    const kernels::Flight& flight = pairs[n].first;
    require(columns.centre(n) == centre_after(flight, time_ahead(density)) &&
                columns.director(n) == director_after(flight, time_ahead(density)),
            "free-flight", isa);
  }
  double done = 0;
  const PairClock clock;
  for (auto _ : state) {
    // In place: each flight starts from the centres and directors of the one before.
    kernels::fly(isa, columns, count);
    benchmark::ClobberMemory();
    done += count;
  }
  clock.count(state, done);
}

void contact_function(benchmark::State& state, Isa isa, double density) {
  using C = kernels::ContactColumns;
  std::vector<PairBatch> batches = pair_batches(density, searches);
  std::size_t room = 0;
  for (const PairBatch& pairs : batches) room = std::max(room, pairs.size + kernels::block_size);
  std::vector<float> storage(2 * C::columns * room);
  const auto view = [&](std::size_t half) {
    C out;
    for (std::size_t c = 0; c < C::columns; ++c) {
      out.column[c] = storage.data() + (half * C::columns + c) * room;
    }
    return out;
  };
  const auto s = static_cast<float>(0.5 * time_ahead(density));
  for (PairBatch& pairs : batches) {
    const auto by = [&](Isa one, std::size_t half) {
      kernels::near_kernels(one).contact_function(pairs.seeker, pairs.columns(), pairs.size, s,
                                                  view(half));
      return view(half);
    };
    const C got = by(isa, 0), expected = by(Isa::scalar, 1);
    for (std::size_t n = 0; n < pairs.size; ++n) {
      for (const int value : {C::f, C::df, C::ddf}) {
        const int error = value - C::f + C::error_f;
        require(std::abs(got.column[value][n] - expected.column[value][n]) <=
                    got.column[error][n] + expected.column[error][n],
                "contact-function", isa);
      }
    }
  }
  const NearKernels& chosen = kernels::near_kernels(isa);
  std::size_t n = 0;
  double done = 0;
  const PairClock clock;
  for (auto _ : state) {
    PairBatch& one = batches[n];
    chosen.contact_function(one.seeker, one.columns(), one.size, s, view(0));
    benchmark::ClobberMemory();
    done += static_cast<double>(one.size);
    n = n + 1 < batches.size() ? n + 1 : 0;
  }
  clock.count(state, done);
}

void bracket(benchmark::State& state, Isa isa, double density) {
  std::vector<PairBatch> batches = pair_batches(density, searches);
  const auto count_by = [&](Isa by) {
    std::size_t count = 0;
    for (PairBatch& pairs : batches) {
      pairs.restart();
      kernels::near_kernels(by).bracket(pairs.seeker, pairs.columns(), pairs.size);
      const float* from = pairs.columns().column[kernels::PairColumns::from];
      count += static_cast<std::size_t>(
          std::count_if(from, from + pairs.size, [](float at) { return std::isfinite(at); }));
    }
    return count;
  };
  require_similar(count_by(isa), count_by(Isa::scalar), "bracket", isa);
  const NearKernels& chosen = kernels::near_kernels(isa);
  std::size_t n = 0;
  double pairs = 0, evaluations = 0;
  const PairClock clock;
  for (auto _ : state) {
    PairBatch& one = batches[n];
    one.restart();
    evaluations +=
        static_cast<double>(chosen.bracket(one.seeker, one.columns(), one.size) * chosen.lanes);
    benchmark::ClobberMemory();
    pairs += static_cast<double>(one.size);
    n = n + 1 < batches.size() ? n + 1 : 0;
  }
  clock.count(state, pairs);
  state.counters["evaluations_per_pair"] = evaluations / pairs;
}

const bool added = [] {
  const struct {
    const char* name;
    void (*measure)(benchmark::State&, Isa, double);
  } all[] = {{"free-flight", free_flight},
             {"overlapping", overlapping},
             {"approaching", approaching},
             {"contact-function", contact_function},
             {"bracket", bracket}};
  for (const auto& kernel : all) {
    for (const GasName& gas : gases) {
      for (const Isa isa : kernels::available()) {
        const std::string name =
            std::string(kernel.name) + "/" + gas.name + "/" + std::string(kernels::name_of(isa));
        benchmark::RegisterBenchmark(name.c_str(), kernel.measure, isa, gas.density);
      }
    }
  }
  return true;
}();

}  // namespace
}  // namespace needlework::bench
