#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "kernels/default_arithmetic.h"
#include "needlework/boltzmann.h"
#include "src/boltzmann/pool.h"

namespace needlework::boltzmann {
namespace {

// Independent of each other, so that their spread gives the errors.
constexpr std::size_t pools = 16;
// Four in each pool.
constexpr std::uint64_t least_needles = 4 * pools;

void require(const std::string& name, double value, bool holds, const char* expected) {
  if (!holds) {
    throw std::invalid_argument(fmt::format("{} = {:g}: expected {}", name, value, expected));
  }
}

void require_valid(const Composition& composition) {
  for (std::size_t a = 0; a < composition.size(); ++a) {
    const Species& species = composition[a];
    if (species.count == 0) continue;  // it has no temperatures then
    const std::string of = composition.is_mixture() ? species.name + ": " : "";
    require(of + "k", species.k, species.k >= 1e-12 && species.k <= 1e12,
            "a number in [1e-12, 1e12]");
    for (const auto& [name, value] :
         {std::pair("length", species.length), {"mass", species.mass}}) {
      require(of + name, value, value >= 1e-12 && value <= 1e12, "a number in [1e-12, 1e12]");
    }
    require(of + "diameter", species.diameter, species.diameter == 0, "0: thin needles");
    for (const auto& [name, value] : {std::pair("t_tr", species.t_tr), {"t_rot", species.t_rot}}) {
      require(of + name, value, value >= 0 && value <= 1e100, "a number in [0, 1e100]");
    }
    for (std::size_t b = a; b < composition.size(); ++b) {
      const auto [epsilon, beta] = composition.restitution(a, b);
      require(of + "epsilon", epsilon, epsilon >= 0 && epsilon <= 1, "a number in [0, 1]");
      require(of + "beta", beta, beta >= -1 && beta <= 1, "a number in [-1, 1]");
    }
  }
}

void require_in_range(const Settings& settings, std::span<const double> taus) {
  const Composition& composition = settings.composition;
  require_valid(composition);
  const auto count = static_cast<double>(composition.count());
  require("count", count, count > 0, "1 or more");
  double t_tr = 0;
  for (const Species& species : composition.species()) {
    t_tr = std::max(t_tr, species.count > 0 ? species.t_tr : 0);
  }
  require("t_tr", t_tr, t_tr >= 1e-100, "a number in [1e-100, 1e100]");
  const bool may_collapse =
      settings.pairs == Pairs::encounters && (composition.is_inelastic() || composition.is_rough());
  require("contact_time", settings.contact_time,
          settings.contact_time >= 0 && settings.contact_time <= 1e100 &&
              !(may_collapse && settings.contact_time < 1e-9),
          may_collapse ? "a number in [1e-9, 1e100], as encounters of this gas may collapse"
                       : "a number in [0, 1e100]");
  const auto needles = static_cast<double>(settings.needles);
  require("needles", needles, needles >= least_needles && needles <= 1e9, "a number in [64, 1e9]");
  double last = 0;
  for (const double tau : taus) {
    require("tau", tau, std::isfinite(tau) && tau >= last, "finite times >= 0 in ascending order");
    last = tau;
  }
}

// The needles of each species.
std::vector<std::uint64_t> needles_of(const Settings& settings) {
  const Composition& composition = settings.composition;
  const auto all = static_cast<double>(composition.count());
  std::vector<std::uint64_t> out;
  for (const Species& species : composition.species()) {
    const double share = static_cast<double>(species.count) / all;
    const double needles = std::round(share * static_cast<double>(settings.needles));
    if (species.count > 0 && needles < least_needles) {
      throw std::invalid_argument(fmt::format(
          "needles = {}: expected more, as {} of them are of species {}, and {} must be",
          settings.needles, needles, species.name, least_needles));
    }
    out.push_back(static_cast<std::uint64_t>(needles));
  }
  return out;
}

// What pool p has of so many needles.
std::uint64_t part_of(std::uint64_t needles, std::uint64_t p) {
  return needles * (p + 1) / pools - needles * p / pools;
}

/// Of all pools at one time.
struct AtTime {
  std::array<std::vector<Sums>, pools> species;
  std::array<std::vector<std::uint64_t>, pools> collisions_between;

  Sample sample() const {
    std::array<Sums, pools> all, part;
    for (std::size_t p = 0; p < pools; ++p) {
      for (const Sums& sums : species[p]) all[p] += sums;
    }
    Sample out{measured(all), 0, {}, {}};
    for (std::size_t n = 0; n < species[0].size(); ++n) {
      for (std::size_t p = 0; p < pools; ++p) part[p] = species[p][n];
      out.species.push_back(measured(part));
    }
    for (std::size_t n = 0; n < collisions_between[0].size(); ++n) {
      for (std::size_t p = 0; p < pools; ++p) {
        part[p] = {.needles = all[p].needles,
                   .collisions = static_cast<double>(collisions_between[p][n])};
      }
      out.collisions_between.push_back(measured(part).collisions);
    }
    return out;
  }
};

}  // namespace

Composition one_species(const theory::Gas& gas, const theory::Temperatures& initial) {
  return Composition(
      {{.name = {}, .count = 1, .k = gas.k, .t_tr = initial.t_tr, .t_rot = initial.t_rot}},
      {gas.epsilon, gas.beta});
}

Result simulate(const Settings& settings, std::span<const double> taus, int threads) {
  require_in_range(settings, taus);
  const std::vector<std::uint64_t> needles = needles_of(settings);
  std::vector<std::unique_ptr<Pool>> all(pools);
  std::vector<AtTime> at(taus.size());
#pragma omp parallel for num_threads(threads) schedule(dynamic)
  for (std::size_t p = 0; p < pools; ++p) {
    const kernels::DefaultArithmetic arithmetic;
    std::vector<std::uint64_t> mine;
    for (const std::uint64_t each : needles) mine.push_back(part_of(each, p));
    all[p] = std::make_unique<Pool>(settings, p, mine);
    for (std::size_t n = 0; n < taus.size(); ++n) {
      all[p]->advance(taus[n]);
      at[n].species[p] = all[p]->sums();
      at[n].collisions_between[p] = all[p]->collisions_between();
    }
  }
  Result out;
  for (const auto& pool : all) pool->add_to(out);
  for (std::size_t n = 0; n < taus.size(); ++n) {
    out.samples.push_back(at[n].sample());
    out.samples.back().tau = taus[n];
  }
  return out;
}

}  // namespace needlework::boltzmann
